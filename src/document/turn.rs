use glam::{EulerRot, Mat3A, Vec3, Vec3A};

use super::channel::Channel;
use super::document::Document;
use super::rig_kind::RigKind;
use crate::kinematics::limb_ik::ElbowReference;
use crate::kinematics::skeleton::nearest_angles;
use crate::kinematics::spline::{Knot, Slopes};
use crate::rig::{Target, TargetSpace, UpAxis};

/// Columns of the rotation that turns z up into y up: −90° about x. All its numbers are 0 or ±1, so
/// that no number is rounded.
const TURN: Mat3A = Mat3A::from_cols(Vec3A::X, Vec3A::NEG_Z, Vec3A::Y);

/// Which axis points up.
impl Document {
    /// True if the figure stands along the z axis in its bind pose, and not along the y axis at the
    /// start of its motion.
    pub fn looks_z_up(&self) -> bool {
        if self.rig != RigKind::Skeleton {
            return false;
        }
        let bind = UpAxis::of(self.skeleton(), &self.skeleton().bind_pose());
        bind == Some(UpAxis::Z) && {
            let start = self.at(self.timeline.start);
            UpAxis::of(start.skeleton(), &start.skeleton().pose()) != Some(UpAxis::Y)
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
        for index in 0..self.skeleton_rig.targets.len() {
            self.turn_target(index);
        }
    }

    /// Turns those parts of a target that are in the world.
    fn turn_target(&mut self, index: usize) {
        let Target { joint, space, .. } = self.skeleton_rig.targets[index];
        let target = &mut self.skeleton_rig.targets[index];
        let (mut turned, mut is_oriented) = (Vec::new(), false);
        if space == TargetSpace::World {
            target.home = TURN * target.home;
            turned.push(Channel::Target(joint));
        }
        if let Some(limb) = target.limb_mut() {
            if let Some((TargetSpace::World, pole)) = limb.pole() {
                limb.reference = ElbowReference::Pole(TURN * pole);
                turned.push(Channel::TargetPole(joint));
            }
            if let Some(angles) = limb.orientation.as_mut().filter(|_| space == TargetSpace::World)
            {
                *angles = turned_angles(*angles, *angles);
                is_oriented = true;
            }
        }
        turned.into_iter().for_each(|channel| self.turn_keys(channel));
        if is_oriented {
            self.turn_keyed_angles(Channel::TargetOrientation(joint));
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
    fn turn_keyed_angles(&mut self, channel: Channel) {
        let Some(track) = self.keys.track(channel) else { return };
        let mut last = None;
        let turned = |knot: &Knot<Vec3>| {
            let value = turned_angles(knot.value, last.unwrap_or(knot.value));
            last = Some(value);
            Knot { value, slopes: None, ..*knot }
        };
        let track = track.knots().iter().map(turned).collect();
        self.keys.set_track(channel, track);
    }
}

/// The angles of a turned rotation that are nearest to `near`, in radians.
fn turned_angles(angles: Vec3, near: Vec3) -> Vec3 {
    let rotation = Mat3A::from_euler(EulerRot::ZYX, angles.z, angles.y, angles.x);
    nearest_angles(TURN * rotation, near)
}
