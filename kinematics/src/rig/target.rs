use core::f32::consts::TAU;
use core::num::NonZeroU32;

use glam::{Affine3A, EulerRot, Mat3, Mat3A, Quat, Vec3};

use crate::chain_ik::Root;
use crate::limb_ik::{ElbowReference, Limb};
use crate::skeleton::{JointId, JointRemap, Skeleton, nearest_angles};
use crate::soft_reach::SoftReach;
use crate::twist::{Stereographic, TwistReferenceKind};

/// A target of a skeleton: a point that the tip of a joint's bone should reach, and an orientation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Target {
    /// Joint whose tip should reach the target.
    pub joint: JointId,
    /// Position at time 0, in [`Target::space`], while the target is not pinned.
    pub home: Vec3,
    /// The space of the position and of the orientation while the target is not pinned.
    pub space: TargetSpace,
    /// Position at time 0, in the world, while the target is pinned.
    pub pin: Vec3,
    /// True if the target is pinned to the world: it stays when its space moves.
    pub is_pinned: bool,
    /// The joints that the target moves, and how.
    pub kind: TargetKind,
    /// Euler angles in radians of the joint that the target turns, in the target's space, R_z · R_y
    /// · R_x in the frame of that joint: the hand or foot at the end of a limb, or the joint of a
    /// target that is no limb's. `None` for a hand that follows the lower bone, and for any rotation.
    pub orientation: Option<Vec3>,
    /// An axis of the joint that is aimed at a point; not together with an orientation, and not of a
    /// limb target.
    pub aim: Option<Aim>,
    /// Weight of the orientation or aim of a target that is no limb's, relative to weights of
    /// places: a turn by 1 radian counts like a distance of a quarter of the chain's length. 0 or
    /// more.
    pub orientation_weight: f32,
    /// Fraction of the way from the FK pose, 0, to the solved pose, 1.
    pub influence: f32,
    /// Weight of the place relative to the other targets of the body, above 0; 0 leaves the place
    /// free, for a whole-body target that asks for a rotation or an aim.
    pub weight: f32,
    /// How a whole-body target slows its tip before the chain is straight, from 0, not at all, to
    /// less than 1; see [`SkeletonRig::softened`](super::SkeletonRig::softened).
    pub softness: f32,
    /// True if the target has any effect.
    pub enabled: bool,
    /// Motion in time, in the target's space.
    pub motion: TargetMotion,
}

/// The line from a joint's base along one of its axes goes through a point, as eyes look at something.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aim {
    /// The axis in the joint's own space, of any length above 0.
    pub axis: Vec3,
    /// The point, in [`Target::present_space`].
    pub point: Vec3,
}

/// The joints that a target moves, and how.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum TargetKind {
    /// All joints from the root to the target's joint, together with those of the other whole-body
    /// targets, by the rig's solver.
    #[default]
    WholeBody,
    /// This number of joints, from the target's joint upwards, after the body: by the rig's solver,
    /// together with the targets of chains that have one of the joints, too.
    Chain(NonZeroU32),
    /// The two bones of the [`Limb`](crate::limb_ik::Limb) that ends at the tip of the
    /// target's joint, in closed form.
    Limb(LimbSettings),
}

impl TargetKind {
    /// True for the kind of a chain, of any length.
    pub fn is_chain(&self) -> bool {
        matches!(self, Self::Chain(_))
    }
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
            pin: home,
            is_pinned: false,
            kind: TargetKind::WholeBody,
            orientation: None,
            aim: None,
            orientation_weight: 1.0,
            influence: 0.0,
            weight: 1.0,
            softness: 0.0,
            enabled: true,
            motion,
        }
    }

    /// The limb that the target poses; `None` for another target and a joint that ends none.
    pub fn limb_in(&self, skeleton: &Skeleton) -> Option<Limb> {
        self.limb().and_then(|_| Limb::ending_at(skeleton, self.joint).ok())
    }

    /// Settings of a limb target; `None` for another target.
    pub fn limb(&self) -> Option<&LimbSettings> {
        match &self.kind {
            TargetKind::WholeBody | TargetKind::Chain(_) => None,
            TargetKind::Limb(settings) => Some(settings),
        }
    }

    /// Settings of a limb target; `None` for another target.
    pub fn limb_mut(&mut self) -> Option<&mut LimbSettings> {
        match &mut self.kind {
            TargetKind::WholeBody | TargetKind::Chain(_) => None,
            TargetKind::Limb(settings) => Some(settings),
        }
    }

    /// The target as one of another kind. A limb's orientation is about another joint than that of
    /// other targets, so that it is not kept from one to the other, and a limb aims at nothing.
    #[must_use]
    pub fn with_kind(self, kind: TargetKind) -> Self {
        let changed = Self { kind, ..self };
        if changed.limb().is_some() == self.limb().is_some() {
            return changed;
        }
        let weight = if self.has_free_place() { 1.0 } else { self.weight };
        Self { orientation: None, aim: None, weight, ..changed }
    }

    /// True if the orientation, the aim and the settings of a limb target are finite.
    pub fn has_finite_kind(&self) -> bool {
        let is_aim =
            |Aim { axis, point }: Aim| axis.is_finite() && axis != Vec3::ZERO && point.is_finite();
        self.orientation.is_none_or(Vec3::is_finite)
            && self.aim.is_none_or(is_aim)
            && self.limb().is_none_or(LimbSettings::is_finite)
    }

    /// The joint that the target's orientation is about: the hand or foot at the end of a limb, or
    /// the target's joint; `None` for a limb without a hand.
    pub fn oriented_joint(&self, skeleton: &Skeleton) -> Option<JointId> {
        match self.kind {
            TargetKind::WholeBody | TargetKind::Chain(_) => Some(self.joint),
            TargetKind::Limb(_) => Limb::ending_at(skeleton, self.joint).ok()?.hand,
        }
    }

    /// The uppermost joint of the target's chain, locked or not; `None` for another target.
    pub(super) fn top_of_chain(&self, skeleton: &Skeleton) -> Option<JointId> {
        let TargetKind::Chain(length) = self.kind else { return None };
        skeleton.ancestors(self.joint).take(length.get() as usize).last()
    }

    /// True if the target poses the skeleton.
    pub fn is_posing(&self) -> bool {
        self.enabled && self.influence > 0.0
    }

    /// True if the target asks for no place: for a rotation or an aim alone.
    pub fn has_free_place(&self) -> bool {
        self.weight == 0.0
    }

    /// True if the target asks for a rotation or an aim of its joint, other than of a limb's hand.
    pub fn turns_joint(&self) -> bool {
        self.limb().is_none() && (self.orientation.is_some() || self.aim.is_some())
    }

    /// True if the target poses the skeleton between its FK pose and the solved one.
    pub fn is_blended(&self) -> bool {
        self.is_posing() && self.influence < 1.0
    }

    /// True if the target moves over time without keys.
    pub fn is_moving(&self) -> bool {
        self.motion.path != TargetPath::Still
    }

    /// The space in which the target is at present: the world while it is pinned.
    pub fn present_space(&self) -> TargetSpace {
        if self.is_pinned { TargetSpace::World } else { self.space }
    }

    /// Position at time 0, in [`Target::present_space`].
    pub fn present_home(&self) -> Vec3 {
        if self.is_pinned { self.pin } else { self.home }
    }

    /// Position at a time in seconds, in [`Target::present_space`].
    pub fn at(&self, time: f64) -> Vec3 {
        self.present_home() + self.motion.offset(time)
    }

    /// Position at a time in seconds, in the world, for a pose of the skeleton.
    pub fn in_world(&self, pose: &Skeleton, time: f64) -> Vec3 {
        self.present_space().to_world(pose).transform_point3(self.at(time))
    }

    /// The target with its position at `time`, in seconds, at `point` in the world.
    #[must_use]
    pub fn placed(self, pose: &Skeleton, time: f64, point: Vec3) -> Self {
        let space = self.present_space();
        self.with_home(space.point_from_world(pose, point) - self.motion.offset(time))
    }

    /// The target with another position at time 0, in [`Target::present_space`].
    #[must_use]
    pub fn with_home(self, home: Vec3) -> Self {
        if self.is_pinned { Self { pin: home, ..self } } else { Self { home, ..self } }
    }

    /// The target pinned to the world, or not pinned, where it is in the world at `time`, in
    /// seconds; the orientation stays in the world, too.
    #[must_use]
    pub fn with_pinned(self, is_pinned: bool, pose: &Skeleton, time: f64) -> Self {
        let after = Self { is_pinned, ..self };
        if is_pinned == self.is_pinned {
            return self;
        }
        // Where both spaces are the world, no point is computed, so that none is rounded.
        if self.space == TargetSpace::World {
            return after.with_home(self.present_home());
        }
        let placed = after.placed(pose, time, self.in_world(pose, time));
        placed.with_orientation_of(&self, pose, None)
    }

    /// The target with the orientation and aim in the world that `other` has; its angles are the equivalent
    /// ones nearest to `near`, or to those that it has.
    #[must_use]
    fn with_orientation_of(mut self, other: &Self, pose: &Skeleton, near: Option<Vec3>) -> Self {
        let rotation = other.orientation_in_world(pose);
        let near = near.or(self.orientation).unwrap_or_default();
        self.orientation = rotation.map(|rotation| self.orientation_angles(pose, rotation, near));
        let space = self.present_space();
        if let (Some(aim), Some(point)) = (&mut self.aim, other.aim_point_in_world(pose)) {
            aim.point = space.point_from_world(pose, point);
        }
        self
    }

    /// The point of the aim in the world, for a pose of the skeleton; `None` without an aim.
    pub fn aim_point_in_world(&self, pose: &Skeleton) -> Option<Vec3> {
        Some(self.present_space().to_world(pose).transform_point3(self.aim?.point))
    }

    /// The ends of the line along which the joint aims, in the world, for a pose of the skeleton; `None`
    /// without an aim. It starts in front of two thirds of the bone: the base of a head is its neck, and
    /// its eyes are there.
    pub fn aim_line_in_world(&self, pose: &Skeleton) -> Option<[Vec3; 2]> {
        const EYES: f32 = 0.65;
        /// Distance of the eyes from the bone, as a fraction of its length.
        const IN_FRONT: f32 = 0.5;
        let point = self.aim_point_in_world(pose)?;
        let joint = pose.joint(self.joint).map(|_| self.joint)?;
        let (base, tip) = (pose.base(joint), pose.tip(joint));
        let middle = base.lerp(tip, EYES);
        let out = (point - middle).clamp_length_max(IN_FRONT * base.distance(tip));
        Some([middle + out, point])
    }

    /// The point, in [`Target::present_space`], that is as far from the joint as the point of the aim
    /// and at which the joint aims in a pose of the skeleton; `None` without an aim.
    pub(super) fn aimed_ahead(&self, pose: &Skeleton) -> Option<Vec3> {
        let (aim, joint) = (self.aim?, pose.joint(self.joint).map(|_| self.joint)?);
        let base = pose.base(joint);
        let distance = self.aim_point_in_world(pose)?.distance(base);
        let axis = pose.full_transform(joint).transform_vector3(aim.axis).try_normalize()?;
        Some(self.present_space().point_from_world(pose, base + axis * distance))
    }

    /// The orientation in the world, for a pose of the skeleton; `None` without one.
    pub fn orientation_in_world(&self, pose: &Skeleton) -> Option<Quat> {
        let Vec3 { x, y, z } = self.orientation?;
        let frame = self.orientation_frame(pose);
        let turned = Quat::from_euler(EulerRot::ZYX, z, y, x);
        Some(self.present_space().rotation(pose) * (frame * turned * frame.conjugate()))
    }

    /// Angles of the orientation, in radians, for a rotation in the world: of all equivalent angles
    /// those nearest to `near`.
    pub fn orientation_angles(&self, pose: &Skeleton, rotation: Quat, near: Vec3) -> Vec3 {
        let frame = self.orientation_frame(pose);
        let local = self.present_space().rotation(pose).inverse() * rotation;
        let local = frame.conjugate() * local * frame;
        nearest_angles(Mat3A::from_quat(local.normalize()), near)
    }

    /// The frame in which the angles of the orientation are measured, that of the joint that it
    /// turns.
    pub fn orientation_frame(&self, pose: &Skeleton) -> Quat {
        let joint = self.oriented_joint(pose).and_then(|joint| pose.joint(joint));
        let frame = joint.map_or(Mat3::IDENTITY, |joint| joint.frame);
        if frame == Mat3::IDENTITY { Quat::IDENTITY } else { Quat::from_mat3(&frame) }
    }

    /// The target in another space, where it is in the world at `time`, in seconds, with its
    /// orientation. Its angles are the equivalent ones nearest to `near`, or to those that it has.
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
        // The place that it does not have at present keeps its place in the world, too.
        let unpinned = Self { is_pinned: false, ..self };
        let moved = Self { space, ..unpinned }.placed(pose, time, unpinned.in_world(pose, time));
        let after = Self { is_pinned: self.is_pinned, ..moved };
        after.with_orientation_of(&self, pose, near)
    }

    /// The target with its limb's pole in another space, where it is in the world.
    #[must_use]
    pub fn with_pole_in_space(mut self, space: TargetSpace, pose: &Skeleton) -> Self {
        if let Some(limb) = self.limb_mut() {
            if let Some(pole) = limb.pole.filter(|_| space != limb.pole_space) {
                let place = limb.pole_space.to_world(pose).transform_point3(pole);
                limb.pole = Some(space.point_from_world(pose, place));
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
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LimbSettings {
    /// Kind of the direction of the elbow at twist 0.
    pub reference: TwistReferenceKind,
    /// The point of [`TwistReferenceKind::Pole`], in [`LimbSettings::pole_space`]; other references
    /// keep it.
    pub pole: Option<Vec3>,
    /// The space of the pole.
    pub pole_space: TargetSpace,
    /// The map of [`TwistReferenceKind::Stereographic`], in Root space; other references keep it.
    pub map: Stereographic,
    /// Angle in radians by which the elbow is turned about the axis from the limb's base to the
    /// target.
    pub twist: f32,
    /// Behaviour near the limits of the reach.
    pub soft_reach: SoftReach,
    /// Factor by which the bones are lengthened in the FK pose, above 0.
    pub fk_stretch: f32,
    /// Axis in the space of the lower joint's base, of any length above 0, about which a positive
    /// rotation bends the limb while its FK pose is straight, by less than 2°; up to 5° it is
    /// blended into the axis of the FK pose. `None` for the axis about which the limits of the
    /// lower joint allow most. Hinges bend about their own axis.
    pub bends_about: Option<Vec3>,
}

impl Default for LimbSettings {
    /// An elbow on the side that it has by FK, and hard limits.
    fn default() -> Self {
        Self {
            reference: TwistReferenceKind::Fk,
            pole: None,
            pole_space: TargetSpace::World,
            map: Stereographic::default(),
            twist: 0.0,
            soft_reach: SoftReach::default(),
            fk_stretch: 1.0,
            bends_about: None,
        }
    }
}

impl LimbSettings {
    /// True if the twist is measured from a pole that is not there.
    pub fn lacks_pole(&self) -> bool {
        self.reference == TwistReferenceKind::Pole && self.pole.is_none()
    }

    /// True if the bones are stretched by FK, or can be by IK.
    pub fn is_stretching(&self) -> bool {
        self.soft_reach.max_stretch() > 1.0 || self.fk_stretch != 1.0
    }

    /// The space and the position of the pole that is in use; `None` for another reference.
    pub fn pole(&self) -> Option<(TargetSpace, Vec3)> {
        let pole = self.pole.filter(|_| self.reference == TwistReferenceKind::Pole);
        pole.map(|pole| (self.pole_space, pole))
    }

    /// Position in the world of the pole that is in use, for a pose of the skeleton; `None` for
    /// another reference.
    pub fn pole_in_world(&self, pose: &Skeleton) -> Option<Vec3> {
        self.pole().map(|(space, pole)| space.to_world(pose).transform_point3(pole))
    }

    /// The direction of the elbow at twist 0, for a pose of the skeleton. A pole without a place is
    /// the side of FK.
    pub(super) fn reference_in_world(&self, pose: &Skeleton) -> ElbowReference {
        match self.reference {
            TwistReferenceKind::Up => ElbowReference::Up,
            TwistReferenceKind::Pole => {
                self.pole_in_world(pose).map_or(ElbowReference::Fk, ElbowReference::Pole)
            }
            TwistReferenceKind::Stereographic => ElbowReference::Stereographic(self.map),
            TwistReferenceKind::Transport => ElbowReference::Transport,
            TwistReferenceKind::Fk => ElbowReference::Fk,
        }
    }

    /// True if all numbers are finite and the FK stretch is above 0.
    pub(super) fn is_finite(&self) -> bool {
        self.pole.is_none_or(Vec3::is_finite)
            && self.twist.is_finite()
            && self.fk_stretch.is_finite()
            && self.fk_stretch > 0.0
            && self.bends_about.is_none_or(|axis| axis.is_finite() && axis != Vec3::ZERO)
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

    /// The same space after its joint was renumbered; the world if the joint was removed.
    #[must_use]
    pub(super) fn remapped(self, remap: &JointRemap) -> Self {
        self.joint().and_then(|joint| remap.get(joint)).map_or(Self::World, Self::Joint)
    }
}

/// The joints that a target turns.
pub(super) struct MovedJoints {
    pub turned: Vec<JointId>,
    /// The uppermost joint of a limb or chain.
    upper: Option<JointId>,
}

impl MovedJoints {
    /// The joints that `target` turns if it poses a skeleton whose solver has this mode of roots.
    pub fn new(skeleton: &Skeleton, root: Root, target: &Target) -> Self {
        let turned: Vec<JointId> = Self::turned(skeleton, root, target).collect();
        let upper = match target.kind {
            TargetKind::WholeBody => None,
            TargetKind::Chain(_) => turned.last().copied(),
            TargetKind::Limb(_) => target.limb_in(skeleton).map(|limb| limb.upper),
        };
        Self { turned, upper }
    }

    /// The joints that are turned, one after the other.
    pub fn turned(
        skeleton: &Skeleton,
        root: Root,
        target: &Target,
    ) -> impl Iterator<Item = JointId> {
        let most = match target.kind {
            TargetKind::WholeBody => Some(usize::MAX),
            TargetKind::Chain(length) => Some(length.get() as usize),
            TargetKind::Limb(_) => None,
        };
        let is_moved = root == Root::Free && target.kind == TargetKind::WholeBody;
        let can_turn = move |joint: &JointId| {
            let joint = &skeleton[*joint];
            !joint.locked || (is_moved && joint.parent.is_none())
        };
        let body = most.map(|most| skeleton.ancestors(target.joint).take(most).filter(can_turn));
        let limb = target.limb_in(skeleton).map(Limb::joints);
        body.into_iter().flatten().chain(limb.into_iter().flatten())
    }

    /// True if the target moves `joint`: turns it or a joint above it.
    pub fn moves(&self, skeleton: &Skeleton, joint: JointId) -> bool {
        skeleton.ancestors(joint).any(|above| self.turned.contains(&above))
    }

    /// True if `target`, which moves these joints, must be solved after a target that moves the
    /// joints of `other`: because it is on one of them, or because its limb or chain is attached to
    /// one.
    pub fn depends_on(&self, skeleton: &Skeleton, target: &Target, other: &Self) -> bool {
        let base = self.upper.and_then(|upper| skeleton[upper].parent);
        let spaces = target.spaces().filter_map(TargetSpace::joint);
        spaces.chain(base).any(|joint| other.moves(skeleton, joint))
    }
}
