//! Conversions of values to another reference or space, for the present values and all their keys.

use glam::{EulerRot, Mat3A, Vec3, Vec3A};

use super::channel::Channel;
use super::track::{Posed, Track};
use super::{Document, Timeline};
use crate::kinematics::angle;
use crate::kinematics::limb_ik::Limb;
use crate::kinematics::skeleton::{JointId, JointRemap, Skeleton, nearest_angles};
use crate::kinematics::spline::{Knot, Slopes};
use crate::kinematics::twist::TwistReferenceKind;
use crate::rig::{LimbSettings, Target, TargetSpace, UpAxis};

/// Conversions of targets and of the poles of limbs.
impl Document {
    /// Moves the target of a joint to another space. The target stays where it is, and the hand
    /// keeps its orientation, at `time`, at which this document is evaluated, and at each of their
    /// keys.
    pub fn set_target_space(&mut self, joint: JointId, space: TargetSpace, time: f64) {
        let channels =
            [Channel::Target(joint), Channel::TargetOrientation(joint), Channel::TargetAim(joint)];
        self.convert_target(joint, channels, time, |target, pose, time, near| {
            target.in_space(space, pose, time, near)
        });
    }

    /// Moves the pole of the limb of a joint's target to another space. The pole stays where it is
    /// at `time`, at which this document is evaluated, and at each of its keys.
    pub fn set_pole_space(&mut self, joint: JointId, space: TargetSpace, time: f64) {
        self.convert_target(joint, [Channel::TargetPole(joint)], time, |target, pose, _, _| {
            target.with_pole_in_space(space, pose)
        });
    }

    /// Changes what the twist of a limb is measured from. The elbow stays where it is at `time`, at
    /// which this document is evaluated, and at each key of the twist.
    ///
    /// A limb that has no pole yet gets one in front of its elbow; a target without a limb stays as it
    /// is.
    pub fn set_limb_reference(&mut self, joint: JointId, to: TwistReferenceKind, time: f64) {
        let channel = Channel::TargetTwist(joint);
        let before = Track::new(self);
        let own = before.pose(self.clone(), time);
        let index = self.rig.target(joint);
        let pole = index.and_then(|it| self.rig.new_pole(own.evaluated_skeleton(), it));
        let Some(limb) = self.limb_settings_mut(joint) else { return };
        if to == TwistReferenceKind::Pole {
            let Some(pole) = limb.pole.or(pole) else { return };
            limb.pole = Some(pole);
        }
        let mut untwisted = self.clone();
        untwisted.keys.clear(channel);
        let Some(limb) = untwisted.limb_settings_mut(joint) else { return };
        (limb.reference, limb.twist) = (to, 0.0);
        let after = Track::new(&untwisted);
        let twist_in = |own: &Posed, zero: &Posed| {
            let pose = |posed: &Posed| Some(posed.limb_frames(joint)?.solution.pose);
            Some(pose(zero)?.elbow_turn_to(&pose(own)?))
        };
        let mut shift = 0.0;
        for knot in self.keys.track(channel).map_or(Vec::new(), |keys| keys.knots().to_vec()) {
            if let Some(twist) = twist_in(&before.at(knot.time), &after.at(knot.time)) {
                shift = angle::nearest(twist - knot.value.x, shift);
                self.keys.insert(channel, knot.time, knot.value + Vec3::X * shift);
            }
        }
        let twist = twist_in(&own, &after.pose(untwisted, time));
        if let Some(limb) = self.limb_settings_mut(joint) {
            limb.reference = to;
            limb.twist = twist.map_or(limb.twist, |twist| angle::nearest(twist, limb.twist));
        }
    }

    /// Lets the target of a joint turn the hand of its limb, or lets the hand follow the bone above
    /// it by its own angles. The hand keeps its orientation at `time`, at which this document is
    /// evaluated, and at each key of the angles that had turned it; those keys become keys of the
    /// angles that turn it now.
    pub fn set_hand_kept(&mut self, joint: JointId, is_kept: bool, time: f64) {
        let limb = Limb::ending_at(self.skeleton(), joint).ok();
        let (Some(hand), Some(index)) = (limb.and_then(|it| it.hand), self.rig.target(joint))
        else {
            return;
        };
        let own = [Channel::Rotation(hand), Channel::TargetOrientation(joint)];
        let [from, to] = if is_kept { own } else { [own[1], own[0]] };
        let target = &self.rig.targets[index];
        // A target that aims its joint turns it already.
        if target.orientation.is_some() == is_kept || target.aim.is_some() {
            return;
        }
        let angles = |posed: &Posed, near: Option<Vec3>| {
            let (pose, target) = (posed.skeleton(), &posed.document().rig.targets[index]);
            let rotation = pose[hand].rotation;
            if is_kept {
                let in_world = pose.rotation_in_world(hand).as_quat();
                target.orientation_angles(pose, in_world, near.unwrap_or(rotation))
            } else {
                let Vec3 { x, y, z } = rotation;
                let turned = Mat3A::from_euler(EulerRot::ZYX, z, y, x);
                nearest_angles(turned, near.unwrap_or(rotation))
            }
        };
        let track = Track::new(self);
        let present = angles(&track.pose(self.clone(), time), None);
        let mut last = None;
        for knot in self.keys.track(from).map_or(Vec::new(), |keys| keys.knots().to_vec()) {
            let value = angles(&track.at(knot.time), last);
            last = Some(value);
            self.keys.insert_key(to, Knot { value, slopes: None, ..knot });
        }
        self.keys.clear(from);
        self.rig.targets[index].orientation = is_kept.then_some(present);
        if !is_kept {
            to.set(self, present);
        }
    }

    /// Settings of the limb target of a joint.
    fn limb_settings_mut(&mut self, joint: JointId) -> Option<&mut LimbSettings> {
        let index = self.rig.target(joint)?;
        self.rig.targets[index].limb_mut()
    }

    /// Replaces a target by `converted` of it, and the keys of `channels` by their values in the
    /// converted targets. The last argument of `converted` is the value near which angles should
    /// be: that of the key before.
    fn convert_target<const N: usize>(
        &mut self,
        joint: JointId,
        channels: [Channel; N],
        time: f64,
        converted: impl Fn(Target, &Skeleton, f64, Option<Vec3>) -> Target,
    ) {
        let Some(index) = self.rig.target(joint) else { return };
        let track = Track::new(self);
        let convert = |posed: &Posed, near: Option<Vec3>| {
            let target = posed.document().rig.targets[index];
            converted(target, posed.skeleton(), posed.time(), near)
        };
        for channel in channels {
            let mut last = None;
            for knot in track.document().keys.track(channel).map_or(&[][..], |track| track.knots())
            {
                let posed = track.at(knot.time);
                let target = convert(&posed, last);
                let mut document = posed.into_document();
                document.rig.targets[index] = target;
                if let Some(value) = channel.value(&document) {
                    last = Some(value);
                    self.keys.insert(channel, knot.time, value);
                }
            }
        }
        self.rig.targets[index] = convert(&track.pose(self.clone(), time), None);
    }

    /// Moves the targets and poles that are on joints which `remap` removes to the world, where
    /// they are at time 0.
    pub(super) fn release_targets(&mut self, remap: &JointRemap) {
        let is_removed =
            |space: TargetSpace| space.joint().is_some_and(|it| remap.get(it).is_none());
        for target in self.rig.targets.clone() {
            if is_removed(target.space) {
                self.set_target_space(target.joint, TargetSpace::World, 0.0);
            }
            if target.limb().is_some_and(|limb| is_removed(limb.pole_space)) {
                self.set_pole_space(target.joint, TargetSpace::World, 0.0);
            }
        }
    }
}

/// Columns of the rotation that turns z up into y up: −90° about x. All its numbers are 0 or ±1, so
/// that no number is rounded.
const TURN: Mat3A = Mat3A::from_cols(Vec3A::X, Vec3A::NEG_Z, Vec3A::Y);

/// The axis that points up.
impl Document {
    /// True if the figure stands along the z axis: in its bind pose, unless it stands along the y
    /// axis in more of its motion; or in most of its motion, if the bind pose stands along neither.
    pub fn looks_z_up(&self) -> bool {
        /// Number of times of the motion that are looked at.
        const TIMES: u32 = 9;
        let bind = UpAxis::of(self.skeleton(), &self.skeleton().bind_pose());
        if bind == Some(UpAxis::Y) {
            return false;
        }
        let Timeline { start, end, .. } = self.timeline;
        let parts = (0..TIMES).map(|index| f64::from(index) / f64::from(TIMES - 1));
        let axes = parts.filter_map(|part| {
            let posed = self.at(start + part * (end - start));
            UpAxis::of(posed.skeleton(), &posed.skeleton().pose())
        });
        let (along_z, along_y): (Vec<UpAxis>, Vec<UpAxis>) = axes.partition(|it| *it == UpAxis::Z);
        match bind {
            Some(_) => along_z.len() >= along_y.len(),
            None => 2 * along_z.len() > TIMES as usize,
        }
    }

    /// Turns the skeleton by −90° about the x axis of the world, so that what was up along z is up
    /// along y, with the targets and poles in the world and the keys of all these. The paths of
    /// moving targets keep their planes.
    pub fn turn_y_up(&mut self) {
        let mut transform = self.skeleton().transform();
        transform.matrix3 = TURN * transform.matrix3;
        transform.translation = TURN * transform.translation;
        // A transform that is finite stays so: its numbers only change places and signs.
        if self.skeleton_mut().set_transform(transform).is_err() {
            return;
        }
        self.turn_keys(Channel::Translation);
        for index in 0..self.rig.targets.len() {
            self.turn_target(index);
        }
    }

    /// Turns those parts of a target that are in the world.
    fn turn_target(&mut self, index: usize) {
        let before = self.rig.targets[index];
        let Target { joint, space, .. } = before;
        let frame = Mat3A::from_quat(before.orientation_frame(self.skeleton()));
        let is_in_world = before.present_space() == TargetSpace::World;
        let target = &mut self.rig.targets[index];
        let (mut turned, mut is_oriented) = (Vec::new(), false);
        if space == TargetSpace::World {
            target.home = TURN * target.home;
            turned.push(Channel::Target(joint));
        }
        target.pin = TURN * target.pin;
        if let Some(limb) = target.limb_mut()
            && let (Some(pole), TargetSpace::World) = (&mut limb.pole, limb.pole_space)
        {
            *pole = TURN * *pole;
            turned.push(Channel::TargetPole(joint));
        }
        if let Some(aim) = target.aim.as_mut().filter(|_| is_in_world) {
            aim.point = TURN * aim.point;
            turned.push(Channel::TargetAim(joint));
        }
        if let Some(angles) = target.orientation.as_mut().filter(|_| is_in_world) {
            *angles = turned_angles(frame, *angles, *angles);
            is_oriented = true;
        }
        turned.into_iter().for_each(|channel| self.turn_keys(channel));
        if is_oriented {
            self.turn_keyed_angles(Channel::TargetOrientation(joint), frame);
        }
    }

    /// Turns the keys of a point.
    fn turn_keys(&mut self, channel: Channel) {
        let turned = |knot: &Knot<Vec3>| Knot {
            value: TURN * knot.value,
            slopes: knot.slopes.map(|Slopes { arriving, leaving }| Slopes {
                arriving: TURN * arriving,
                leaving: TURN * leaving,
            }),
            ..*knot
        };
        let track =
            self.keys.track(channel).map(|track| track.knots().iter().map(turned).collect());
        if let Some(track) = track {
            self.keys.set_track(channel, track);
        }
    }

    /// Turns the keys of angles, each to the equivalent angles nearest to those of the key before.
    /// They lose their own slopes, which turned angles do not have.
    fn turn_keyed_angles(&mut self, channel: Channel, frame: Mat3A) {
        let Some(track) = self.keys.track(channel) else { return };
        let mut last = None;
        let turned = |knot: &Knot<Vec3>| {
            let value = turned_angles(frame, knot.value, last.unwrap_or(knot.value));
            last = Some(value);
            Knot { value, slopes: None, ..*knot }
        };
        let track = track.knots().iter().map(turned).collect();
        self.keys.set_track(channel, track);
    }
}

/// The angles of a turned rotation, measured in a frame, that are nearest to `near`, in radians.
fn turned_angles(frame: Mat3A, angles: Vec3, near: Vec3) -> Vec3 {
    let rotation = Mat3A::from_euler(EulerRot::ZYX, angles.z, angles.y, angles.x);
    let turned = TURN * frame * rotation * frame.transpose();
    nearest_angles(frame.transpose() * turned * frame, near)
}
