use glam::{Affine3A, DAffine3, DMat3, DVec3, Mat3, Mat3A, Vec2, Vec3};

use super::evaluate::{EvaluatedSkeleton, TargetOutcome, TargetReport};
use super::skeleton_rig::SkeletonRig;
use super::tapered_cylinder::TaperedCylinder;
use super::target::{LimbSettings, Target};
use crate::angle;
use crate::fk::Fk;
use crate::ik::{self, Ik, IkSolution};
use crate::limb_ik::{
    self, Limb, LimbAim, LimbReach, LimbReport, LimbSolution, LimbTarget, LimbTriangle,
};
use crate::pop::PosedLimb;
use crate::skeleton::{JointId, Skeleton};
use crate::soft_reach::{ReachLimits, SoftReach};
use crate::twist::{
    Stereographic, TransportedFrame, TwistReference, TwistReferenceKind, angle_from_limb,
};
use crate::two_bone::{Pointer, Reach, TwoBone, TwoBonePose};
use crate::vector::{saturate, saturate_vector};

/// A part of a limb. Parents come before their children in the order of the variants.
///
/// Symbols are those of [`two_bone`](crate::two_bone) and
/// [`twist`](crate::twist).
///
/// ```text
/// Root                 translation = shoulder in the world
///  ├ Limb              rotation = R_y(−θ_z)·R_z(θ_y): points +x, the Pointer, at the hand
///  │  ├ Socket         rotation = R_x(ψ_ref + ψ): rotates the elbow about the Pointer
///  │  │  ├ UpperLimb   from the origin to (h_e, o_e, 0)
///  │  │  ├ LowerLimb   from (h_e, o_e, 0) to (D, 0, 0)
///  │  │  ├ Elbow       at (h_e, o_e, 0)
///  │  │  └ Hand        at (D, 0, 0)
///  │  └ Pointer        along +x, as far as the hand can reach
///  ├ Cursor            the hand's target
///  ├ InnerLimit        sphere of radius ReachLimits::inner, |d₁ − d₂| with hard limits
///  └ OuterLimit        sphere of radius ReachLimits::outer, d₁ + d₂ with hard limits
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LimbPart {
    /// The shoulder; the root of the hierarchy.
    Root,
    /// Frame whose +x points at the hand.
    Limb,
    /// Frame of the Limb, rotated about the Pointer by the twist.
    Socket,
    /// Upper limb, from shoulder to elbow.
    UpperLimb,
    /// Lower limb, from elbow to hand.
    LowerLimb,
    /// Elbow joint.
    Elbow,
    /// Hand.
    Hand,
    /// Axis from the shoulder through the hand.
    Pointer,
    /// Target of the hand.
    Cursor,
    /// Sphere that the hand cannot enter.
    InnerLimit,
    /// Sphere that the hand cannot leave.
    OuterLimit,
}

impl LimbPart {
    /// All parts, parents before children.
    pub const ALL: [Self; 11] = [
        Self::Root,
        Self::Limb,
        Self::Socket,
        Self::UpperLimb,
        Self::LowerLimb,
        Self::Elbow,
        Self::Hand,
        Self::Pointer,
        Self::Cursor,
        Self::InnerLimit,
        Self::OuterLimit,
    ];

    /// The parent in the hierarchy; `None` for the Root.
    pub fn parent(self) -> Option<Self> {
        match self {
            Self::Root => None,
            Self::Limb | Self::Cursor | Self::InnerLimit | Self::OuterLimit => Some(Self::Root),
            Self::Socket | Self::Pointer => Some(Self::Limb),
            Self::UpperLimb | Self::LowerLimb | Self::Elbow | Self::Hand => Some(Self::Socket),
        }
    }
}

/// A limb at a time, in its own frames.
///
/// Root space has its origin at the limb's base. Its axes are those of the parent of the upper
/// joint, turned so that in the bind pose the Pointer is +x and the elbow's direction is +y; its
/// unit is that of the world, by the mean scale of the skeleton's transform. A mirrored skeleton
/// mirrors it.
///
/// World transforms of parts are products of the local transforms down the hierarchy. They do not
/// use the positions of elbow and hand in the pose.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LimbFrames {
    /// Transform from Root space to the world.
    pub root: Affine3A,
    /// The pose with its inputs, in Root space.
    pub posed: PosedLimb,
    /// The pose by IK alone, before limits of the upper joint.
    pub solution: IkSolution,
    /// Distances from the base that the hand can have, with stretch.
    pub limits: ReachLimits,
    /// Distances from the base that the hand can have without softness and stretch.
    pub range: ReachLimits,
    /// The joint whose limits keep the hand from the target.
    pub limited_by: Option<JointId>,
    /// Angle in radians about the Pointer by which limits of the upper joint turn the elbow from
    /// where the reference and the twist want it.
    pub turned_aside: f32,
    /// The references that the limb could have, by [`TwistReferenceKind::ALL`]; `None` for a pole
    /// without a place.
    pub references: [Option<TwistReference>; TwistReferenceKind::ALL.len()],
}

impl LimbFrames {
    /// True if limits keep the hand from its target or the elbow from its place.
    pub fn is_limited(&self) -> bool {
        self.limited_by.is_some() || self.turned_aside != 0.0
    }

    /// Radius of a limb at its base for a limb of length [`Self::SEED_LENGTH`], as in Palmieri's
    /// report; [`Self::TIP_RADIUS`] is the radius at its tip. [`Self::thickness`] scales both to
    /// other limbs.
    const BASE_RADIUS: f32 = 30.0;
    const TIP_RADIUS: f32 = 20.0;
    /// Radius of the balls of base and elbow: as large as the ends of the limbs, so that no gap shows
    /// when the elbow bends. This and the next two are for a limb of length 500.
    pub const JOINT_BALL: f32 = 33.0;
    /// Radius of the ball of the wrist.
    pub const WRIST_BALL: f32 = 22.0;
    /// Distance from the wrist to the tip of the middle finger.
    pub const HAND: f32 = 105.0;
    const POINTER_RADIUS: f32 = 1.0;
    const SEED_LENGTH: f32 = 500.0;

    /// The pose.
    pub fn pose(&self) -> &TwoBonePose {
        &self.posed.pose
    }

    /// The lengths of the two limbs without stretch.
    pub fn bones(&self) -> TwoBone {
        self.posed.ik.bones
    }

    /// The point of Root space that the Pointer goes through: the target, or the hand where FK has
    /// a part in the pose.
    pub fn pointed_at(&self) -> Vec3 {
        if self.posed.influence == 1.0 { self.posed.cursor } else { self.posed.pose.hand }
    }

    /// True if IK poses the limb, alone or blended with FK.
    pub fn uses_ik(&self) -> bool {
        self.posed.influence > 0.0
    }

    /// The reference of a kind; `None` for a pole without a place.
    pub fn reference_of(&self, kind: TwistReferenceKind) -> Option<TwistReference> {
        self.references[kind as usize]
    }

    /// Pose by IK alone with the same twist, measured from a reference of the given kind; `None`
    /// for a pole without a place. [`TwistReferenceKind::Transport`] continues from `transported`.
    pub fn pose_with_reference(
        &self,
        kind: TwistReferenceKind,
        transported: Option<TransportedFrame>,
    ) -> Option<TwoBonePose> {
        let pose = self.solution.pose;
        if kind == self.posed.kind {
            return Some(pose);
        }
        let outward = self.reference_of(kind)?.outward(pose.pointer, transported);
        let twist = self.posed.twist + angle_from_limb(pose.pointer, outward);
        let elbow = TwoBonePose { twist, ..pose }.outward() * pose.out;
        Some(TwoBonePose { twist, elbow: elbow + pose.pointer.direction * pose.along, ..pose })
    }

    /// Ratio of the limbs' radii to the radii for a limb of length 500. It grows with the limb's
    /// length; the base radius never exceeds the length of the shorter bone.
    pub fn thickness(&self) -> f32 {
        let bones = self.bones();
        let shorter = bones.upper().min(bones.lower());
        (bones.outer_limit() / Self::SEED_LENGTH).min(shorter / Self::BASE_RADIUS)
    }
}

/// Parts of the hierarchy.
impl LimbFrames {
    /// Transform from the part's space to its parent's; for the Root, to the world.
    pub fn local(&self, part: LimbPart) -> Affine3A {
        let pose = self.pose();
        match part {
            LimbPart::Root => self.root,
            LimbPart::Limb => Affine3A::from_mat3(pose.pointer.limb_frame()),
            LimbPart::Socket => Affine3A::from_mat3(Mat3A::from_rotation_x(pose.twist).into()),
            LimbPart::UpperLimb => self.upper_limb().0,
            LimbPart::LowerLimb => self.lower_limb().0,
            LimbPart::Elbow => Affine3A::from_translation(self.elbow_in_socket()),
            LimbPart::Hand => Affine3A::from_translation(self.hand_in_socket()),
            LimbPart::Cursor => Affine3A::from_translation(self.posed.cursor),
            LimbPart::Pointer | LimbPart::InnerLimit | LimbPart::OuterLimit => Affine3A::IDENTITY,
        }
    }

    /// Transform from the part's space to the world.
    pub fn world(&self, part: LimbPart) -> Affine3A {
        match part.parent() {
            Some(parent) => self.world(parent) * self.local(part),
            None => self.local(part),
        }
    }

    /// Position of the part's origin in the world.
    pub fn origin(&self, part: LimbPart) -> Vec3 {
        self.world(part).translation.into()
    }

    /// A point of Root space in the world. Overflow is clamped to ±`f32::MAX`.
    pub fn in_world(&self, point: Vec3) -> Vec3 {
        self.root.transform_point3(point).clamp(Vec3::MIN, Vec3::MAX)
    }

    /// Shape of the upper limb, along +x of [`LimbPart::UpperLimb`].
    pub fn upper(&self) -> TaperedCylinder {
        self.upper_limb().1
    }

    /// Shape of the lower limb, along +x of [`LimbPart::LowerLimb`].
    pub fn lower(&self) -> TaperedCylinder {
        self.lower_limb().1
    }

    /// Shape of the Pointer, along +x of [`LimbPart::Limb`].
    pub fn pointer(&self) -> TaperedCylinder {
        let radius = Self::POINTER_RADIUS * self.thickness();
        TaperedCylinder { length: self.limits.outer, base_radius: radius, tip_radius: radius }
    }

    fn elbow_in_socket(&self) -> Vec3 {
        Vec3::new(self.pose().along, self.pose().out, 0.0)
    }

    fn hand_in_socket(&self) -> Vec3 {
        Vec3::new(self.pose().distance, 0.0, 0.0)
    }

    fn upper_limb(&self) -> (Affine3A, TaperedCylinder) {
        let [base, tip] = self.radii();
        TaperedCylinder::in_xy_plane(Vec3::ZERO, self.elbow_in_socket(), base, tip)
    }

    fn lower_limb(&self) -> (Affine3A, TaperedCylinder) {
        let [base, tip] = self.radii();
        TaperedCylinder::in_xy_plane(self.elbow_in_socket(), self.hand_in_socket(), base, tip)
    }

    /// Radii of a limb at its base and at its tip.
    fn radii(&self) -> [f32; 2] {
        [Self::BASE_RADIUS, Self::TIP_RADIUS].map(|radius| radius * self.thickness())
    }
}

impl SkeletonRig {
    /// Axes of the Root of the limb that ends at a joint, in the space of the parent of the limb's
    /// upper joint; `None` without such a limb.
    pub fn limb_axes(&self, joint: JointId) -> Option<Mat3> {
        let limb = Limb::ending_at(&self.skeleton, joint).ok()?;
        Some(LimbAim::in_bind_pose(&self.skeleton, limb)?.frame().as_mat3())
    }

    /// Rotation in the world of the hand of the limb that ends at a joint, or of its lower bone if it
    /// has none, in a pose: +x points out of the lower bone in the bind pose, +y to the side of the
    /// elbow there. `None` without such a limb.
    pub fn hand_rotation(&self, pose: &Skeleton, joint: JointId) -> Option<DMat3> {
        let hand = Limb::ending_at(&self.skeleton, joint).ok()?.hand.unwrap_or(joint);
        Some(DMat3::from_quat(pose.rotation_in_world(hand)) * self.end_axes(joint)?)
    }

    /// Roll of the hand about the lower bone of the limb that ends at a joint, in a pose, in
    /// radians, whole turns included; `None` without a hand.
    pub fn hand_roll(&self, pose: &Skeleton, joint: JointId) -> Option<f32> {
        let hand = Limb::ending_at(&self.skeleton, joint).ok()?.hand?;
        let axes = self.end_axes(joint)?;
        let lower = DMat3::from_quat(pose.rotation_in_world(joint)) * axes;
        let own = lower.transpose() * (DMat3::from_quat(pose.rotation_in_world(hand)) * axes);
        // The angle about x includes the whole turns if x is along the bone.
        let is_along = pose[hand].frame.x_axis.as_dvec3().dot(axes.x_axis) > 1.0 - 1e-6;
        Some(angle::roll(own, if is_along { pose[hand].rotation.x } else { 0.0 }))
    }

    /// Axes of the end of the limb of a joint in the bind pose: along the lower bone, and to the
    /// elbow's side.
    fn end_axes(&self, joint: JointId) -> Option<DMat3> {
        let along = self.skeleton.joint(joint)?.axis.as_dvec3().try_normalize()?;
        let side = self.limb_axes(joint)?.as_dmat3().y_axis;
        let side = side.reject_from_normalized(along).try_normalize()?;
        Some(DMat3::from_cols(along, side, along.cross(side)))
    }

    /// The frames of the limb of the target with an index, in an evaluated pose of this rig; `None`
    /// for a whole-body target, a joint that ends no limb, bones without length, and a singular
    /// transform of the skeleton.
    pub fn limb_frames(&self, evaluated: &EvaluatedSkeleton, index: usize) -> Option<LimbFrames> {
        let target = self.targets.get(index)?;
        let (settings, report) = (target.limb()?, evaluated.targets.get(index)?);
        let limb = Limb::ending_at(&evaluated.solved, target.joint).ok()?;
        let root = RootSpace::new(&evaluated.solved, limb)?;
        let solved = solution(evaluated, limb, target, report)?;
        let LimbReport { solution, reach, turned_aside, .. } = solved;
        let posing = if target.enabled { target.influence } else { 0.0 };
        let fk_stretch = settings.fk_stretch;
        let limited_by = match reach {
            LimbReach::Limited(joint) if posing > 0.0 => Some(joint),
            _ => None,
        };
        let soft_reach = settings.soft_reach;
        let [upper, lower] =
            solution.triangle.sides.map(|side| saturate(side / solution.stretch * root.scale));
        let bones = TwoBone::new(upper, lower).ok()?;
        let cursor = saturate_vector(root.vector(solution.target));
        let by_ik = root.ik_pose(&solution, cursor, soft_reach, bones);
        let fk = root.pose(LimbTriangle::of(&evaluated.fk, limb)?, fk_stretch);
        let turned_aside = if posing > 0.0 { turned_aside } else { 0.0 };
        let is_as_wanted = limited_by.is_none() && turned_aside == 0.0;
        let pose = if posing >= 1.0 && is_as_wanted {
            by_ik
        } else {
            let stretch = fk_stretch + (by_ik.stretch - fk_stretch) * posing;
            let pose = root.pose(LimbTriangle::of(&evaluated.solved, limb)?, stretch);
            let reach = (posing > 0.0).then(|| blended_reach(&pose, cursor, bones));
            TwoBonePose { reach, ..pose }
        };
        let references = root.references(&solution, settings, &evaluated.solved);
        let kind = settings.reference;
        let reference = references[kind as usize].unwrap_or_default();
        let [inner, outer] = solution.range.map(|distance| saturate(distance * root.scale));
        let hard = ReachLimits { inner, outer };
        let range = hard.opened(bones, soft_reach.min_elbow_angle());
        let wanted = ik::length(cursor).min(f32::MAX);
        Some(LimbFrames {
            root: root.to_world.as_affine3a(),
            posed: PosedLimb {
                pose,
                cursor,
                ik: Ik { bones, reference, soft_reach },
                kind,
                twist: settings.twist,
                pinned_root: target.is_pinned.then(|| root.to_world.translation.as_vec3()),
                influence: posing,
                fk: Fk::matching(&fk, Fk::default()),
            },
            solution: IkSolution {
                pose: by_ik,
                transported: TransportedFrame {
                    direction: by_ik.pointer.direction,
                    outward: root.direction(solution.outward).as_vec3(),
                },
                slope: soft_reach.hand_distance_within(range, wanted).slope,
            },
            limits: hard.blended(bones, soft_reach, posing, fk_stretch),
            range,
            limited_by,
            turned_aside,
            references,
        })
    }
}

/// The closed form of a limb, solved again if its target does not pose it.
fn solution(
    evaluated: &EvaluatedSkeleton,
    limb: Limb,
    target: &Target,
    report: &TargetReport,
) -> Option<LimbReport> {
    match &report.outcome {
        TargetOutcome::Limb(report) => Some(**report),
        TargetOutcome::Off => {
            let settings = target.limb()?;
            let point = report.position;
            let target = LimbTarget {
                influence: 0.0,
                ..target.limb_target_at(settings, &evaluated.solved, point)
            };
            limb_ik::solve(&mut Skeleton::clone(&evaluated.solved), limb, &target)
        }
        _ => None,
    }
}

/// The space of a limb's Root.
struct RootSpace {
    /// Axes of the Root in the space of the upper joint's parent.
    turn: DMat3,
    /// Units of the world in a unit of the skeleton.
    scale: f64,
    to_world: DAffine3,
}

impl RootSpace {
    fn new(skeleton: &Skeleton, limb: Limb) -> Option<Self> {
        let turn = LimbAim::in_bind_pose(skeleton, limb)?.frame();
        let transform = skeleton.transform().as_daffine3();
        let scale = transform.matrix3.determinant().abs().cbrt();
        let own = DAffine3::from_mat3(turn * (1.0 / scale));
        let to_world = transform * limb_ik::base_space(skeleton, limb) * own;
        (scale > 0.0 && to_world.is_finite()).then_some(Self { turn, scale, to_world })
    }

    /// A direction of the parent's space.
    fn direction(&self, direction: DVec3) -> DVec3 {
        self.turn.transpose() * direction
    }

    /// A vector of the parent's space, in the unit of the world.
    fn vector(&self, vector: DVec3) -> DVec3 {
        self.direction(vector) * self.scale
    }

    /// The pose with a triangle; its reach is `None`.
    fn pose(&self, triangle: LimbTriangle, stretch: f32) -> TwoBonePose {
        let LimbTriangle { aim, distance, along, out, .. } = triangle;
        // Frames of joints are rounded to f32, which leaves directions a little off the length 1.
        let unit = |direction| self.direction(direction).normalize_or_zero();
        let [direction, outward] = [aim.pointer, aim.outward].map(unit);
        let pointer = pointer(direction);
        let [distance, along, out] = [distance, along, out].map(|length| length * self.scale);
        TwoBonePose {
            elbow: saturate_vector(direction * along + outward * out),
            hand: saturate_vector(direction * distance),
            reach: None,
            distance: saturate(distance),
            along: saturate(along),
            out: saturate(out),
            twist: angle_from_limb(pointer, outward.as_vec3()),
            stretch,
            pointer,
        }
    }

    /// The pose of the closed form for a target at `cursor`, in Root space.
    fn ik_pose(
        &self,
        solution: &LimbSolution,
        cursor: Vec3,
        soft_reach: SoftReach,
        bones: TwoBone,
    ) -> TwoBonePose {
        // The distance is clamped in f64, but a target at a limit is rounded to f32 in the world;
        // by less than what lengths may be off.
        const ROUNDING: f64 = f32::EPSILON as f64;
        let (distance, wanted) = (solution.triangle.distance, solution.target.length());
        let length: f64 = solution.triangle.sides.iter().sum();
        const MOST: f64 = 4.0;
        let coordinates = length + self.to_world.translation.length() / self.scale;
        let rounding = ROUNDING * coordinates.min(MOST * length);
        let is_at_target = (distance - wanted).abs() <= rounding;
        let reach = match ik::reach(
            saturate(distance * self.scale),
            saturate(wanted * self.scale),
            bones,
        ) {
            _ if is_at_target => Reach::Reached,
            Reach::Reached if soft_reach.is_hard() && distance < wanted => Reach::TooFar,
            Reach::Reached if soft_reach.is_hard() => Reach::TooClose,
            reach => reach,
        };
        let pose = self.pose(solution.triangle, solution.stretch as f32);
        let hand = if is_at_target { cursor } else { pose.hand };
        TwoBonePose { hand, reach: Some(reach), ..pose }
    }

    /// The references that a limb could have, by [`TwistReferenceKind::ALL`].
    fn references(
        &self,
        solution: &LimbSolution,
        settings: &LimbSettings,
        pose: &Skeleton,
    ) -> [Option<TwistReference>; TwistReferenceKind::ALL.len()] {
        TwistReferenceKind::ALL.map(|kind| match kind {
            TwistReferenceKind::Up => {
                let up = self.direction(DVec3::Y).as_vec3();
                // Up is the pole at infinity; in Root space it need not be +y.
                Some(if up == Vec3::Y { TwistReference::Up } else { TwistReference::Pole(up) })
            }
            TwistReferenceKind::Pole => {
                let pole = settings.pole_space.to_world(pose).transform_point3(settings.pole?);
                let pole = self.to_world.inverse().transform_point3(pole.as_dvec3());
                Some(TwistReference::Pole(saturate_vector(pole)))
            }
            TwistReferenceKind::Stereographic => Some(TwistReference::Stereographic(settings.map)),
            TwistReferenceKind::Transport => Some(TwistReference::Transport),
            // Least rotations from one direction are the stereographic map opposite to it.
            TwistReferenceKind::Fk => {
                let LimbAim { pointer, outward } = solution.fk;
                let [away, up] = [-pointer, outward].map(|it| self.direction(it).as_vec3());
                Stereographic::new(away, up).map(TwistReference::Stereographic)
            }
        })
    }
}

/// The Pointer in a direction; straight up or down it has no yaw.
fn pointer(direction: DVec3) -> Pointer {
    const VERTICAL: f64 = 1e-12;
    let flat = Vec2::new(direction.x as f32, direction.z as f32);
    let level = direction.x.hypot(direction.z);
    let heading = if level > VERTICAL { (flat.as_dvec2() / level).as_vec2() } else { Vec2::X };
    Pointer { direction: direction.as_vec3(), heading }
}

/// Reach of a pose that is not that of the closed form.
fn blended_reach(pose: &TwoBonePose, cursor: Vec3, bones: TwoBone) -> Reach {
    match ik::reach(0.0, ik::length(pose.hand - cursor), bones) {
        Reach::Reached => Reach::Reached,
        _ if pose.distance > ik::length(cursor) => Reach::TooClose,
        _ => Reach::TooFar,
    }
}
