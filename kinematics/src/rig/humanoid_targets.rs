use core::num::NonZeroU32;

use glam::{Quat, Vec3};

use super::skeleton_rig::SkeletonRig;
use super::target::{Aim, LimbSettings, Target, TargetKind};
use crate::chain_ik::{Method, Root};
use crate::humanoid::{Humanoid, HumanoidDirections, HumanoidLimb, NotHumanoid};
use crate::skeleton::{JointId, Skeleton, SkeletonPose};

/// Weight of feet, which stay on the ground while the body follows the hands.
const FEET: f32 = 100.0;

/// Most joints that turn the head towards what it looks at.
const NECK: usize = 3;

impl SkeletonRig {
    /// Adds targets for the hands, feet and head of a human-like figure at their places in `pose`.
    /// The pose does not change, except that elbows and knees that are bent the wrong way bend the
    /// right way. Returns the joints of the new targets; parts that have a target keep it.
    ///
    /// Hands and feet are ends of [limbs](TargetKind::Limb): forearms swing to the front, and shins
    /// to the back. Feet keep the rotation that they have in the world, and the
    /// head looks at a point in front of it. If these are the first targets, the body
    /// follows, with a free root, by damped least squares.
    ///
    /// The bones of elbows and knees are made to end at the hands and feet. Joints within the bones
    /// of a limb, such as those that distribute its twist, are locked.
    ///
    /// # Errors
    ///
    /// [`NotHumanoid`] where `pose` is not [recognised](Humanoid::of); then nothing changes.
    pub fn add_humanoid_targets(&mut self, pose: &Skeleton) -> Result<Vec<JointId>, NotHumanoid> {
        let humanoid = &Humanoid::of(pose)?;
        let (directions, reference) = humanoid.directions(pose).ok_or(NotHumanoid::NotUpright)?;
        let is_first = self.targets.is_empty();
        let mut added = Vec::new();
        for (part, limb) in humanoid.limbs() {
            let present = self.target(limb.lower).or_else(|| self.target_of_end(limb.end));
            if present.is_none() {
                let bends_about = self.bends_about(&reference, limb, part.is_leg(), directions);
                let lower = pose.full_transform(limb.lower);
                let end = lower.inverse().transform_point3(pose.base(limb.end));
                self.make_limb(limb, end);
                let target = self.limb_of_humanoid(limb, part.is_leg(), bends_about, pose);
                added.push(target.joint);
                self.targets.push(target);
            }
        }
        if let Some(head) = humanoid.head.filter(|head| self.target(*head).is_none()) {
            let facing = reference.full(head).matrix3.inverse() * directions.forward;
            self.targets.push(self.looking_ahead(head, facing, humanoid, pose));
            added.push(head);
        }
        if is_first && !added.is_empty() {
            // FABRIK, the default, turns no joint to what it looks at.
            self.solver.method = Method::DampedLeastSquares;
            self.solver.root = Root::Free;
            self.body_follows = true;
        }
        Ok(added)
    }

    /// Makes the bone of the lower joint end at `end`, in the lower joint's own space, and locks the
    /// joints within the bones.
    fn make_limb(&mut self, limb: HumanoidLimb, end: Vec3) {
        let skeleton = self.skeleton.make_mut();
        let within = |from: JointId, to: JointId, skeleton: &Skeleton| -> Vec<JointId> {
            skeleton.ancestors(from).skip(1).take_while(|joint| *joint != to).collect()
        };
        let of_lower = within(limb.end, limb.lower, skeleton);
        let is_child = of_lower.is_empty();
        let end = if is_child { skeleton[limb.end].offset } else { end };
        // Not by `set_axis`, with which children at the tip move.
        skeleton.write_local(limb.lower, |lower| lower.axis = end);
        if is_child {
            skeleton.write_local(limb.end, |end| end.connected = true);
        }
        for joint in of_lower.into_iter().chain(within(limb.lower, limb.upper, skeleton)) {
            skeleton.write_local(joint, |joint| joint.locked = true);
        }
    }

    /// The axis about which a limb bends, in the space of the lower joint's base. If the limb is bent
    /// the right way in the reference pose, it is the axis of that bend; otherwise the axis that
    /// swings the forearm to the front or the shin to the back.
    fn bends_about(
        &self,
        reference: &SkeletonPose,
        limb: HumanoidLimb,
        is_leg: bool,
        HumanoidDirections { up, forward }: HumanoidDirections,
    ) -> Vec3 {
        /// Bend in radians from which a limb of the reference pose has a direction of its own: 5°.
        const BENT: f32 = 0.087;
        /// Cosine of the angle to the front or back within which the upper bone is parallel to it.
        const AHEAD: f32 = 0.95;
        let [from, elbow, to] =
            [limb.upper, limb.lower, limb.end].map(|joint| reference.base(joint));
        let (upper, lower) = ((elbow - from).normalize_or_zero(), (to - elbow).normalize_or_zero());
        let (front, up) = if is_leg { (-forward, -up) } else { (forward, up) };
        let ahead = if upper.dot(front).abs() > AHEAD { up } else { front };
        let expected = upper.cross(ahead).normalize_or_zero();
        let own = upper.cross(lower);
        let is_own = upper.angle_between(lower) > BENT && own.dot(expected) > 0.5 * own.length();
        let axis = if is_own { own.normalize_or_zero() } else { expected };
        let above = self.skeleton[limb.lower].parent.map(|parent| reference.full(parent).matrix3);
        above.map_or(axis, |above| above.inverse() * axis)
    }

    fn limb_of_humanoid(
        &self,
        limb: HumanoidLimb,
        is_leg: bool,
        bends_about: Vec3,
        pose: &Skeleton,
    ) -> Target {
        let settings = LimbSettings { bends_about: Some(bends_about), ..LimbSettings::default() };
        let end = pose.base(limb.end);
        let target = Target {
            kind: TargetKind::Limb(settings),
            influence: 1.0,
            ..Target::new(limb.lower, end, self.default_path_radius())
        };
        if !is_leg {
            return target;
        }
        let has_foot = target.oriented_joint(&self.skeleton) == Some(limb.end);
        let rotation: Quat = pose.rotation_in_world(limb.end).as_quat();
        let near = pose[limb.end].rotation;
        let orientation =
            has_foot.then(|| target.orientation_angles(&self.skeleton, rotation, near));
        Target { orientation, weight: FEET, ..target }
    }

    /// A target that lets the head look at a point in front of it, by turning the neck with it.
    fn looking_ahead(
        &self,
        head: JointId,
        facing: Vec3,
        humanoid: &Humanoid,
        pose: &Skeleton,
    ) -> Target {
        let shoulder = humanoid.arms[0].upper;
        let is_neck = |joint: &JointId| !self.skeleton.is_in_subtree(shoulder, *joint);
        let neck = self.skeleton.ancestors(head).take_while(is_neck).take(NECK).count();
        let length = NonZeroU32::new(neck as u32).unwrap_or(NonZeroU32::MIN);
        let space = pose.full_transform(head);
        let distance = 0.5 * self.reach() / space.transform_vector3(facing).length();
        let aim = Aim { axis: facing, point: space.transform_point3(facing * distance) };
        Target {
            kind: TargetKind::Chain(length),
            aim: Some(aim),
            weight: 0.0,
            influence: 1.0,
            ..Target::new(head, pose.tip(head), self.default_path_radius())
        }
    }
}
