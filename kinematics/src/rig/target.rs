use core::f32::consts::TAU;

use glam::{Affine3A, EulerRot, Mat3A, Quat, Vec3};

use crate::chain_ik::Root;
use crate::limb_ik::{ElbowReference, Limb};
use crate::skeleton::{JointId, JointRemap, Skeleton, nearest_angles};
use crate::soft_reach::SoftReach;

/// A target of a skeleton: a point that the tip of a joint's bone should reach.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Target {
    /// Joint whose tip should reach the target.
    pub joint: JointId,
    /// Position at time 0, in [`Target::space`].
    pub home: Vec3,
    /// The space of the position and of the hand's orientation.
    pub space: TargetSpace,
    /// The joints that the target moves, and how.
    pub kind: TargetKind,
    /// Fraction of the way from the FK pose, 0, to the solved pose, 1.
    pub influence: f32,
    /// Weight relative to the other whole-body targets, above 0.
    pub weight: f32,
    /// How a whole-body target slows its tip before the chain is straight, from 0, not at all, to
    /// less than 1; see [`SkeletonRig::softened`](super::SkeletonRig::softened).
    pub softness: f32,
    /// True if the target has any effect.
    pub enabled: bool,
    /// Motion in time, in the target's space.
    pub motion: TargetMotion,
}

/// The joints that a target moves, and how.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum TargetKind {
    /// All joints from the root to the target's joint, together with those of the other whole-body
    /// targets, by the rig's solver.
    #[default]
    WholeBody,
    /// The two bones of the [`Limb`](crate::limb_ik::Limb) that ends at the tip of the
    /// target's joint, in closed form.
    Limb(LimbSettings),
}

impl Target {
    /// An enabled whole-body target in the world, without influence, that stays at its home.
    /// `radius` is the radius of the path that it will have once it moves.
    pub fn new(joint: JointId, home: Vec3, radius: f32) -> Self {
        let motion = TargetMotion { path: TargetPath::Still, radius, period: 4.0 };
        Self {
            joint,
            home,
            space: TargetSpace::World,
            kind: TargetKind::WholeBody,
            influence: 0.0,
            weight: 1.0,
            softness: 0.0,
            enabled: true,
            motion,
        }
    }

    /// Settings of a limb target; `None` for a whole-body target.
    pub fn limb(&self) -> Option<&LimbSettings> {
        match &self.kind {
            TargetKind::WholeBody => None,
            TargetKind::Limb(settings) => Some(settings),
        }
    }

    /// Settings of a limb target; `None` for a whole-body target.
    pub fn limb_mut(&mut self) -> Option<&mut LimbSettings> {
        match &mut self.kind {
            TargetKind::WholeBody => None,
            TargetKind::Limb(settings) => Some(settings),
        }
    }

    /// True if the settings of a limb target are finite.
    pub fn has_finite_kind(&self) -> bool {
        self.limb().is_none_or(LimbSettings::is_finite)
    }

    /// True if the target poses the skeleton.
    pub fn is_posing(&self) -> bool {
        self.enabled && self.influence > 0.0
    }

    /// True if the target poses the skeleton between its FK pose and the solved one.
    pub fn is_blended(&self) -> bool {
        self.is_posing() && self.influence < 1.0
    }

    /// True if the target moves over time without keys.
    pub fn is_moving(&self) -> bool {
        self.motion.path != TargetPath::Still
    }

    /// Position at a time in seconds, in the target's space.
    pub fn at(&self, time: f64) -> Vec3 {
        self.home + self.motion.offset(time)
    }

    /// Position at a time in seconds, in the world, for a pose of the skeleton.
    pub fn in_world(&self, pose: &Skeleton, time: f64) -> Vec3 {
        self.space.to_world(pose).transform_point3(self.at(time))
    }

    /// The target with its position at `time`, in seconds, at `point` in the world.
    #[must_use]
    pub fn placed(self, pose: &Skeleton, time: f64, point: Vec3) -> Self {
        let home = self.space.point_from_world(pose, point) - self.motion.offset(time);
        Self { home, ..self }
    }

    /// The target in another space, where it is in the world at `time`, in seconds; the hand keeps
    /// its orientation. Its angles are the equivalent ones nearest to `near`, or to those that it
    /// has.
    #[must_use]
    pub fn in_space(
        self,
        space: TargetSpace,
        pose: &Skeleton,
        time: f64,
        near: Option<Vec3>,
    ) -> Self {
        if space == self.space {
            return self;
        }
        let mut after = Self { space, ..self }.placed(pose, time, self.in_world(pose, time));
        if let Some(limb) = after.limb_mut()
            && let Some(rotation) = limb.hand_in_world(pose, self.space)
        {
            let near = near.or(limb.orientation).unwrap_or_default();
            limb.orientation = Some(space.angles_from_world(pose, rotation, near));
        }
        after
    }

    /// The target with its limb's pole in another space, where it is in the world.
    #[must_use]
    pub fn with_pole_in_space(mut self, space: TargetSpace, pose: &Skeleton) -> Self {
        if let Some(limb) = self.limb_mut() {
            let place = limb.pole_in_world(pose);
            if let Some(place) = place.filter(|_| space != limb.pole_space) {
                limb.reference = ElbowReference::Pole(space.point_from_world(pose, place));
            }
            limb.pole_space = space;
        }
        self
    }

    /// The spaces that the target's position, orientation and pole depend on.
    pub(super) fn spaces(&self) -> impl Iterator<Item = TargetSpace> {
        [self.space].into_iter().chain(self.limb().and_then(LimbSettings::pole).map(|pole| pole.0))
    }

    /// The same target after joints were renumbered; `None` if its joint was removed.
    #[must_use]
    pub(super) fn remapped(mut self, remap: &JointRemap) -> Option<Self> {
        self.joint = remap.get(self.joint)?;
        self.space = self.space.remapped(remap);
        if let Some(settings) = self.limb_mut() {
            settings.pole_space = settings.pole_space.remapped(remap);
        }
        Some(self)
    }
}

/// Motion of a target along a closed curve through its home, in a plane perpendicular to z.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TargetMotion {
    /// Shape of the curve.
    pub path: TargetPath,
    /// Radius of the curve, in units of the world.
    pub radius: f32,
    /// Duration of one revolution in seconds.
    pub period: f32,
}

/// The shape of a target's path.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(rename_all = "snake_case")
)]
pub enum TargetPath {
    /// The target stays at its home.
    #[default]
    Still,
    /// A circle.
    Circle,
    /// An eight: the lemniscate of Gerono.
    FigureEight,
}

impl TargetMotion {
    /// Vector in the world from the target's home to its position at a time in seconds; zero at
    /// time 0.
    pub fn offset(&self, time: f64) -> Vec3 {
        let angle = (time / f64::from(self.period)).fract() as f32 * TAU;
        let (sin, cos) = angle.sin_cos();
        self.radius
            * match self.path {
                TargetPath::Still => Vec3::ZERO,
                TargetPath::Circle => Vec3::new(sin, cos - 1.0, 0.0),
                TargetPath::FigureEight => Vec3::new(sin, sin * cos, 0.0),
            }
    }
}

/// Settings of a limb target.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LimbSettings {
    /// Direction of the elbow at twist 0.
    pub reference: ElbowReference,
    /// Angle in radians by which the elbow is turned about the axis from the limb's base to the
    /// target.
    pub twist: f32,
    /// Behaviour near the limits of the reach.
    pub soft_reach: SoftReach,
    /// Euler angles in radians of the hand or foot in the target's space, R_z · R_y · R_x; `None`
    /// for a hand that follows the lower bone.
    pub orientation: Option<Vec3>,
    /// The space of the point of [`ElbowReference::Pole`].
    pub pole_space: TargetSpace,
}

impl LimbSettings {
    /// The space and the position of the pole; `None` for another reference.
    pub fn pole(&self) -> Option<(TargetSpace, Vec3)> {
        match self.reference {
            ElbowReference::Pole(pole) => Some((self.pole_space, pole)),
            _ => None,
        }
    }

    /// Position of the pole in the world, for a pose of the skeleton; `None` for another reference.
    pub fn pole_in_world(&self, pose: &Skeleton) -> Option<Vec3> {
        self.pole().map(|(space, pole)| space.to_world(pose).transform_point3(pole))
    }

    /// The reference with its pole in the world, for a pose of the skeleton.
    pub(super) fn reference_in_world(&self, pose: &Skeleton) -> ElbowReference {
        self.pole_in_world(pose).map_or(self.reference, ElbowReference::Pole)
    }

    /// Rotation of the hand in the world, for a pose of the skeleton and the space of the target;
    /// `None` for a hand that follows the lower bone.
    pub fn hand_in_world(&self, pose: &Skeleton, space: TargetSpace) -> Option<Quat> {
        let turned = |Vec3 { x, y, z }| Quat::from_euler(EulerRot::ZYX, z, y, x);
        self.orientation.map(|angles| space.rotation(pose) * turned(angles))
    }

    /// True if all numbers are finite.
    pub(super) fn is_finite(&self) -> bool {
        self.pole().is_none_or(|(_, pole)| pole.is_finite())
            && self.twist.is_finite()
            && self.orientation.is_none_or(Vec3::is_finite)
    }
}

/// The space in which a target, or the pole of a limb, is fixed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum TargetSpace {
    /// The world.
    #[default]
    World,
    /// The space of a joint: it moves and turns with the joint's bone, with the origin at the base.
    Joint(JointId),
}

impl TargetSpace {
    /// The joint; `None` for the world.
    pub fn joint(self) -> Option<JointId> {
        match self {
            Self::World => None,
            Self::Joint(joint) => Some(joint),
        }
    }

    /// Transform from this space to the world, for a pose of the skeleton. A joint that the
    /// skeleton does not have counts as the world.
    pub fn to_world(self, pose: &Skeleton) -> Affine3A {
        let joint = self.joint().filter(|joint| pose.joint(*joint).is_some());
        joint.map_or(Affine3A::IDENTITY, |joint| pose.full_transform(joint))
    }

    /// Transform from this space to skeleton space, for a pose of the skeleton. That of the world
    /// is not finite if the skeleton's own transform is singular.
    pub(super) fn to_skeleton(self, pose: &Skeleton) -> Affine3A {
        let Some(joint) = self.joint().filter(|joint| pose.joint(*joint).is_some()) else {
            return pose.transform().inverse();
        };
        let below = |above: Affine3A, joint: JointId| pose[joint].local() * above;
        pose.ancestors(joint).fold(Affine3A::IDENTITY, below)
    }

    /// Rotation from this space to the world, for a pose of the skeleton.
    pub fn rotation(self, pose: &Skeleton) -> Quat {
        let joint = self.joint().filter(|joint| pose.joint(*joint).is_some());
        joint.map_or(Quat::IDENTITY, |joint| pose.rotation_in_world(joint).as_quat())
    }

    /// Point in this space that is at `point`, in the world. Where the space is singular (a scale
    /// of 0) or the result overflows, returns `point`.
    pub fn point_from_world(self, pose: &Skeleton, point: Vec3) -> Vec3 {
        if self == Self::World {
            return point;
        }
        let local = self.to_world(pose).inverse().transform_point3(point);
        if local.is_finite() { local } else { point }
    }

    /// Euler angles in this space, in radians, of a rotation in the world: of all equivalent angles
    /// those nearest to `near`.
    pub fn angles_from_world(self, pose: &Skeleton, rotation: Quat, near: Vec3) -> Vec3 {
        let local = self.rotation(pose).inverse() * rotation;
        nearest_angles(Mat3A::from_quat(local.normalize()), near)
    }

    /// The same space after its joint was renumbered; the world if the joint was removed.
    #[must_use]
    pub(super) fn remapped(self, remap: &JointRemap) -> Self {
        self.joint().and_then(|joint| remap.get(joint)).map_or(Self::World, Self::Joint)
    }
}

/// The joints that a target turns.
pub(super) struct MovedJoints {
    pub turned: Vec<JointId>,
    /// The upper joint of a limb.
    upper: Option<JointId>,
}

impl MovedJoints {
    /// The joints that `target` turns if it poses a skeleton whose solver has this mode of roots.
    pub fn new(skeleton: &Skeleton, root: Root, target: &Target) -> Self {
        let is_free = root == Root::Free;
        let can_turn = |joint: &JointId| {
            let joint = &skeleton[*joint];
            !joint.locked || (is_free && joint.parent.is_none())
        };
        match target.kind {
            TargetKind::WholeBody => Self {
                turned: skeleton.ancestors(target.joint).filter(can_turn).collect(),
                upper: None,
            },
            TargetKind::Limb(_) => match Limb::ending_at(skeleton, target.joint) {
                Ok(limb) => Self { turned: limb.joints().collect(), upper: Some(limb.upper) },
                Err(_) => Self { turned: Vec::new(), upper: None },
            },
        }
    }

    /// True if the target moves `joint`: turns it or a joint above it.
    pub fn moves(&self, skeleton: &Skeleton, joint: JointId) -> bool {
        skeleton.ancestors(joint).any(|above| self.turned.contains(&above))
    }

    /// True if `target`, which moves these joints, must be solved after a target that moves the
    /// joints of `other`: because it is on one of them, or because its limb is attached to one.
    pub fn depends_on(&self, skeleton: &Skeleton, target: &Target, other: &Self) -> bool {
        let base = self.upper.and_then(|upper| skeleton[upper].parent);
        let spaces = target.spaces().filter_map(TargetSpace::joint);
        spaces.chain(base).any(|joint| other.moves(skeleton, joint))
    }
}
