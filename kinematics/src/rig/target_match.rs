use glam::{DQuat, Vec3};

use super::carried::Carried;
use super::evaluate::{EvaluatedSkeleton, TargetOutcome};
use super::skeleton_rig::SkeletonRig;
use super::target::{LimbSettings, TargetKind};
use crate::angle;
use crate::limb_ik::{self, Limb};
use crate::skeleton::Skeleton;

/// Matches between the FK pose and the pose that a target solves for.
impl SkeletonRig {
    /// Moves a target to where the skeleton at `time`, in seconds, has the tip without it. A limb's
    /// target also takes over the hand's orientation, if it keeps one, and the elbow's side: by
    /// moving the pole, or by its twist. At any influence the skeleton is then posed as without the
    /// target. `before` is the state from which the poses continue.
    pub fn match_target_to_fk(&mut self, index: usize, time: f64, before: &Carried) {
        let without = self.without(index);
        let evaluated = without.step(time, before).0;
        let pose = &evaluated.solved;
        let target = self.targets[index];
        if pose.joint(target.joint).is_none() {
            return;
        }
        // Soft limits keep a limb's tip from its target, and the target is as far beyond the tip.
        let place = match without.limb_frames(&evaluated, index) {
            Some(frames) if !frames.posed.ik.soft_reach.is_hard() => {
                let (soft, pose) = (frames.posed.ik.soft_reach, frames.pose());
                let distance = soft.cursor_distance_within(frames.range, pose.distance);
                frames.in_world(pose.pointer.direction * distance)
            }
            _ => pose.tip(target.joint),
        };
        let mut target = target.placed(pose, time, place);
        if let (Some(angles), Some(joint)) = (target.orientation, target.oriented_joint(pose)) {
            let rotation = pose.rotation_in_world(joint).as_quat();
            target.orientation = Some(target.orientation_angles(pose, rotation, angles));
        }
        let aimed = target.aimed_ahead(pose);
        if let (Some(aim), Some(point)) = (&mut target.aim, aimed) {
            aim.point = point;
        }
        let limb = Limb::ending_at(pose, target.joint);
        if let (Some(settings), Ok(limb)) = (target.limb_mut(), limb) {
            settings.match_elbow(pose, limb);
        }
        self.targets[index] = target;
    }

    /// Writes the pose at `time`, in seconds, to the FK angles of the joints that a target moves.
    /// With an influence between 0 and 1, the target then moves to the tip, where FK and IK agree.
    /// The skeleton does not move.
    /// `before` is the state from which the poses continue; afterwards they continue from nothing.
    pub fn match_fk_to_pose(&mut self, index: usize, time: f64, before: &Carried) {
        let EvaluatedSkeleton { solved, targets, .. } = self.step(time, before).0;
        let target = self.targets[index];
        let is_whole_body = target.kind == TargetKind::WholeBody;
        for joint in self.moved_by(&target).turned {
            // A limb changes offsets only by its stretch.
            let offset =
                if is_whole_body { solved[joint].offset } else { self.skeleton[joint].offset };
            let rotation = solved[joint].rotation;
            self.skeleton_mut()
                .write_local(joint, |joint| (joint.rotation, joint.offset) = (rotation, offset));
        }
        if let TargetOutcome::Limb(report) = &targets[index].outcome
            && let Some(limb) = self.targets[index].limb_mut()
        {
            limb.fk_stretch += (report.stretch - limb.fk_stretch) * target.influence;
        }
        let pose = self.without(index).step(time, &Carried::default()).0.solved;
        if let Some(settings) = self.targets[index].limb_mut()
            && let Ok(limb) = Limb::ending_at(&pose, target.joint)
        {
            settings.match_elbow(&pose, limb);
        }
        if target.influence < 1.0 {
            self.match_target_to_fk(index, time, &Carried::default());
        }
    }
}

impl SkeletonRig {
    /// A pole in front of the elbow of a target's limb as it is posed, in the pole's space; `None`
    /// for a target without a limb.
    pub fn new_pole(&self, evaluated: &EvaluatedSkeleton, index: usize) -> Option<Vec3> {
        let frames = self.limb_frames(evaluated, index)?;
        let pose = frames.pose();
        let pole = frames.in_world(pose.elbow + pose.outward() * frames.bones().upper());
        let space = self.targets[index].limb()?.pole_space;
        Some(space.point_from_world(&evaluated.solved, pole))
    }

    /// The rig without one of its targets.
    fn without(&self, index: usize) -> Self {
        let mut without = self.clone();
        without.targets[index].enabled = false;
        without
    }
}

impl LimbSettings {
    /// Turns the pole about the limb, or sets the twist, so that the elbow stays where a pose has
    /// it.
    fn match_elbow(&mut self, pose: &Skeleton, limb: Limb) {
        // Radians; rounding turns no pole and no twist.
        const SAME: f32 = 1e-5;
        let reference = self.reference_in_world(pose);
        let Some(twist) = limb_ik::fk_twist(pose, limb, reference, self.bends_about) else {
            return;
        };
        let twist = angle::nearest(twist, self.twist);
        if (twist - self.twist).abs() <= SAME {
            return;
        }
        match self.turned_pole(pose, limb, twist - self.twist) {
            Some(pole) => self.pole = Some(pole),
            None => self.twist = twist,
        }
    }

    /// The pole, in its space, turned by an angle in radians about the line from the limb's base to
    /// its tip. `None` without a pole, and for one so near to that line that it gives no direction.
    fn turned_pole(&self, pose: &Skeleton, limb: Limb, angle: f32) -> Option<Vec3> {
        // Sine of the angle between the line and the pole.
        const NEAR: f64 = 1e-2;
        let transform = pose.transform().as_daffine3();
        let to_skeleton = transform.inverse();
        let place = |point: Vec3| to_skeleton.transform_point3(point.as_dvec3());
        let base = place(pose.base(limb.upper));
        let axis = (place(pose.tip(limb.lower)) - base).try_normalize()?;
        let pole = place(self.pole_in_world(pose)?) - base;
        if axis.cross(pole).length() <= NEAR * pole.length() {
            return None;
        }
        let turned = base + DQuat::from_axis_angle(axis, f64::from(angle)) * pole;
        let turned = transform.transform_point3(turned).as_vec3();
        turned.is_finite().then(|| self.pole_space.point_from_world(pose, turned))
    }
}
