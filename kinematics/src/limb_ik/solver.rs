use glam::{DMat3, DQuat, DVec3, Quat, Vec3};

use super::carried::{BendWay, CarriedLimb};
use super::elbow::LimbAim;
use super::fk_limb::FkLimb;
use super::shoulder::Shoulder;
use super::triangle::{LimbSolution, LimbTriangle};
use super::{JointSpace, Limb};
use crate::skeleton::{JointId, Skeleton};
use crate::soft_reach::SoftReach;
use crate::twist::{Stereographic, TwistReferenceKind};
use crate::vector::saturate;

/// A target for the tip of a limb's lower bone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LimbTarget {
    /// Position in the world, finite.
    pub point: Vec3,
    /// Direction of the elbow at twist 0.
    pub reference: ElbowReference,
    /// Angle in radians by which the elbow is turned about the Pointer.
    pub twist: f32,
    /// Behaviour near the limits of the reach.
    pub soft_reach: SoftReach,
    /// Rotation of the hand in the world; `None` for a hand that keeps its own angles.
    pub hand: Option<Quat>,
    /// Fraction of the way from the FK pose, 0, to the solved pose, 1.
    pub influence: f32,
    /// Factor by which the FK pose that the skeleton has lengthens the bones, above 0.
    pub fk_stretch: f32,
    /// Axis in the space of the lower joint's base about which a limb bends that is straight by
    /// FK; see [`bends_about`](crate::rig::LimbSettings::bends_about).
    pub bends_about: Option<Vec3>,
}

impl LimbTarget {
    /// A target that the limb reaches with hard limits, the elbow on the side that it has by FK.
    pub fn new(point: Vec3) -> Self {
        Self {
            point,
            reference: ElbowReference::Fk,
            twist: 0.0,
            soft_reach: SoftReach::default(),
            hand: None,
            influence: 1.0,
            fk_stretch: 1.0,
            bends_about: None,
        }
    }
}

/// The direction of the elbow at twist 0, perpendicular to the Pointer.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum ElbowReference {
    /// The elbow's direction in the FK pose, carried to the Pointer by the least rotation.
    #[default]
    Fk,
    /// Up, +y of the space of the upper joint's parent.
    Up,
    /// The direction to a point in the world.
    Pole(Vec3),
    /// A stereographic map in Root space: in the bind pose, the Pointer is +x and the elbow's
    /// direction is +y.
    Stereographic(Stereographic),
    /// The direction of the step before, carried to the Pointer by the least rotation, in the space
    /// of the upper joint's parent. Without a step before, it is that of the FK pose.
    Transport,
}

impl ElbowReference {
    /// The kind of the reference, without its pole or map.
    pub fn kind(self) -> TwistReferenceKind {
        match self {
            Self::Fk => TwistReferenceKind::Fk,
            Self::Up => TwistReferenceKind::Up,
            Self::Pole(_) => TwistReferenceKind::Pole,
            Self::Stereographic(_) => TwistReferenceKind::Stereographic,
            Self::Transport => TwistReferenceKind::Transport,
        }
    }
}

/// The result of a solve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LimbReport {
    /// Distance from the tip to the target, in the world.
    pub error: f32,
    /// True if the tip is at the target and, if not, why.
    pub reach: LimbReach,
    /// Factor by which the bones are lengthened.
    pub stretch: f32,
    /// Angle in radians about the Pointer by which the limits of the upper joint turn the elbow from
    /// where the reference and the twist want it, so that the tip comes to the target; 0 where they
    /// allow the wanted place.
    pub turned_aside: f32,
    /// The closed form, before limits of the upper joint and before the influence.
    pub solution: LimbSolution,
}

/// True if a limb reaches its target at full influence and, if not, what prevents it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(rename_all = "snake_case")
)]
pub enum LimbReach {
    /// The tip is within 1e-5 of the limb's length of the target.
    Reached,
    /// The target is too far away, or in the soft zone of the outer limit.
    TooFar,
    /// The target is too close to the upper joint.
    TooClose,
    /// The limits of this joint prevent it.
    Limited(JointId),
}

/// Poses a limb for its target: writes the angles of its joints and, with stretch, the lengths of
/// its bones. The angles that the skeleton has are the FK pose. With an influence of 0 nothing
/// changes.
///
/// Returns `None`, and changes nothing, if the skeleton's transform is singular or the skeleton has
/// no such joints.
pub fn solve(skeleton: &mut Skeleton, limb: Limb, target: &LimbTarget) -> Option<LimbReport> {
    step(skeleton, limb, target, &mut CarriedLimb::default())
}

/// [`solve`] as a step of a motion: continues from what the step before has carried.
///
/// While the FK pose is bent by less than 2°, the limb bends the way it did before; up to 5°, that
/// way is blended into the way of the FK pose. A hinge that can bend to both sides keeps its side
/// until the solved limb is straight.
pub fn step(
    skeleton: &mut Skeleton,
    limb: Limb,
    target: &LimbTarget,
    carried: &mut CarriedLimb,
) -> Option<LimbReport> {
    let fk = FkLimb::new(skeleton, limb, target.bends_about)?;
    let fk = fk.carrying(&skeleton[limb.lower], carried);
    let local = LocalTarget::new(skeleton, limb, target, &fk)?;
    let fk = fk.unstretched(target.fk_stretch.into());
    let solved = SolvedLimb::new(skeleton, limb, &fk, &local, carried);
    if target.influence > 0.0 {
        solved.write(skeleton, limb, target, &mut carried.turns);
    }
    let tip = if target.influence < 1.0 {
        let above = skeleton[limb.upper].parent;
        let joints = skeleton.ancestors(limb.lower).take_while(|joint| Some(*joint) != above);
        let lower = fk.above.of_inner(JointSpace::from_top(skeleton, joints));
        lower.point(skeleton[limb.lower].axis)
    } else {
        solved.tip
    };
    let tip = skeleton.transform().as_daffine3().transform_point3(tip);
    let error = saturate(tip.distance(target.point.as_dvec3()));
    let SolvedLimb { reach, solution, turned_aside, .. } = solved;
    let (stretch, turned_aside) = (solution.stretch as f32, turned_aside as f32);
    Some(LimbReport { error, reach, stretch, turned_aside, solution })
}

/// The twist at which the limb keeps the elbow that it has by FK, radians. `bends_about` is as in
/// [`LimbTarget`].
pub fn fk_twist(
    skeleton: &Skeleton,
    limb: Limb,
    reference: ElbowReference,
    bends_about: Option<Vec3>,
) -> Option<f32> {
    let fk = FkLimb::new(skeleton, limb, bends_about)?;
    let aim = fk.aim();
    let target = LimbTarget { reference, ..LimbTarget::new(Vec3::ZERO) };
    let local = LocalTarget::new(skeleton, limb, &target, &fk)?;
    Some(aim.twist_from(local.aim(&fk, aim.pointer, None)) as f32)
}

/// True if the lower joint of a limb is no hinge, or a hinge whose limits let the limb bend to both
/// sides of straight.
pub fn bends_to_several_sides(skeleton: &Skeleton, limb: Limb) -> bool {
    let Some(fk) = FkLimb::new(skeleton, limb, None) else { return false };
    let lower = &skeleton[limb.lower];
    let is_fixed = lower.locked || lower.movable_axes().next().is_none();
    !is_fixed && (lower.hinge().is_none() || fk.bend.has_both_sides(fk.angle))
}

/// A target in skeleton space.
struct LocalTarget<'a> {
    point: DVec3,
    /// The pole of [`ElbowReference::Pole`].
    pole: DVec3,
    /// Axes of Root space in the space of the upper joint's parent, for
    /// [`ElbowReference::Stereographic`].
    root: DMat3,
    /// Rotation of the hand.
    hand: Option<DQuat>,
    target: &'a LimbTarget,
}

impl<'a> LocalTarget<'a> {
    fn new(skeleton: &Skeleton, limb: Limb, target: &'a LimbTarget, fk: &FkLimb) -> Option<Self> {
        let transform = skeleton.transform().as_daffine3();
        let to_skeleton = transform.inverse();
        let in_world = |point: DVec3| transform.transform_point3(point);
        let pole = match target.reference {
            ElbowReference::Pole(pole) => to_skeleton.transform_point3(pole.as_dvec3()),
            _ => DVec3::ZERO,
        };
        let root = match target.reference {
            ElbowReference::Stereographic(_) => LimbAim::in_bind_pose(skeleton, limb)?.frame(),
            _ => DMat3::IDENTITY,
        };
        let is_fk_tip = is_rounded([fk.tip(), fk.base].map(in_world), target.point);
        let point = if is_fk_tip {
            fk.tip()
        } else {
            to_skeleton.transform_point3(target.point.as_dvec3())
        };
        let hand = target.hand.map(|hand| {
            let (_, turned, _) = transform.to_scale_rotation_translation();
            (turned.inverse() * hand.as_dquat()).normalize()
        });
        let is_valid = point.is_finite() && pole.is_finite();
        is_valid.then_some(Self { point, pole, root, hand, target })
    }

    /// The Pointer with the elbow at twist 0; `before` are those of the step before, in the space
    /// of the upper joint's parent.
    fn aim(&self, fk: &FkLimb, pointer: DVec3, before: Option<LimbAim>) -> LimbAim {
        // Sine of the angle to the Pointer below which a direction gives no elbow.
        const PARALLEL: f64 = 1e-6;
        let above = fk.above.rotation;
        let outward = match self.target.reference {
            ElbowReference::Fk => None,
            ElbowReference::Transport => {
                let before = before.map_or_else(|| fk.aim(), |aim| aim.rotated(above));
                return before.carried_to(pointer);
            }
            ElbowReference::Up => Some(above.y_axis),
            ElbowReference::Pole(_) => Some((self.pole - fk.base).normalize_or_zero()),
            ElbowReference::Stereographic(map) => {
                let root = above * self.root;
                map.outward(root.transpose() * pointer).map(|outward| root * outward)
            }
        };
        let outward = outward.map(|outward| outward.reject_from_normalized(pointer));
        match outward.filter(|outward| outward.length() > PARALLEL) {
            Some(outward) => LimbAim { pointer, outward: outward.normalize() },
            // Singular: the direction of the step before, without one that of the FK pose.
            None => {
                let before = before.map_or_else(|| fk.aim(), |aim| aim.rotated(above));
                before.carried_to(pointer)
            }
        }
    }
}

/// True if a target is the tip of a limb, computed in f32. Rounding of a target would turn the
/// elbow of a straight limb by its square root.
fn is_rounded([tip, base]: [DVec3; 2], target: Vec3) -> bool {
    const ROUNDING: f64 = 4.0 * f32::EPSILON as f64;
    tip.distance(target.as_dvec3()) <= ROUNDING * tip.abs().max(base.abs()).max_element()
}

/// The angles of a limb that reaches for its target.
struct SolvedLimb {
    upper: Vec3,
    lower: Vec3,
    hand: Option<Vec3>,
    /// Position of the tip in skeleton space at full influence.
    tip: DVec3,
    reach: LimbReach,
    turned_aside: f64,
    solution: LimbSolution,
}

impl SolvedLimb {
    fn new(
        skeleton: &Skeleton,
        limb: Limb,
        fk: &FkLimb,
        local: &LocalTarget<'_>,
        carried: &mut CarriedLimb,
    ) -> Self {
        let target = local.target;
        let to_target = local.point - fk.base;
        let wanted = to_target.length();
        let pointer = to_target.try_normalize().unwrap_or_else(|| {
            carried.aim.map_or(fk.aim().pointer, |aim| fk.above.rotation * aim.pointer)
        });
        let range = fk.range(target.soft_reach);
        let (distance, stretch) = target.soft_reach.between(range[0], range[1], wanted);

        let lower = fk.lower_angles(&skeleton[limb.lower], distance);
        let lower_rotation = fk.mount.rotation * skeleton[limb.lower].rotation_f64(lower.angles);
        let bone = skeleton[limb.lower].axis.as_dvec3() / f64::from(target.fk_stretch);
        let tip = fk.mount.origin + lower_rotation * bone;

        let aim = local.aim(fk, pointer, carried.aim);
        let to_above = fk.above.rotation.transpose();
        let untwisted = aim.rotated(to_above);
        carried.aim = Some(untwisted);
        if fk.is_reversed && fk.bend.is_straight_at(lower.bend) {
            carried.way = carried.way.map(BendWay::reversed);
        }
        let aim = aim.twisted(f64::from(target.twist));
        let own = fk.aim_of(tip, lower.bend);
        let turned = |aside: f64| to_above * own.rotation_to(aim.twisted(aside));
        let shoulder = Shoulder { joint: &skeleton[limb.upper], tip, turned: &turned };
        let turned_aside = shoulder.way_aside(carried.aside);
        carried.aside = turned_aside;
        let upper = skeleton[limb.upper].angles_within(turned(turned_aside));

        let upper_rotation = fk.above.rotation * skeleton[limb.upper].rotation_f64(upper.angles);
        let hand = limb.hand.zip(local.hand).map(|(hand, turned)| {
            let above_hand = upper_rotation * lower_rotation;
            let turned = above_hand.transpose() * DMat3::from_quat(turned);
            let near = carried.hand.unwrap_or(skeleton[hand].rotation);
            skeleton[hand].angles_within_near(turned, near).angles
        });
        carried.hand = hand;
        let tip = fk.base + upper_rotation * tip * stretch;

        let distance = distance * stretch;
        let is_reached = (distance - wanted).abs() <= 1e-5 * distance.max(wanted);
        let reach = if upper.is_limited && shoulder.miss(turned_aside) > shoulder.rounding() {
            LimbReach::Limited(limb.upper)
        } else if lower.is_limited {
            LimbReach::Limited(limb.lower)
        } else if is_reached {
            LimbReach::Reached
        } else if wanted > distance {
            LimbReach::TooFar
        } else {
            LimbReach::TooClose
        };
        let sides = [fk.bend.upper.length(), fk.bend.lower.length()].map(|side| side * stretch);
        let solution = LimbSolution {
            triangle: LimbTriangle::of_sides(sides, distance, aim.rotated(to_above)),
            outward: untwisted.outward,
            target: to_above * to_target,
            fk: fk.aim().rotated(to_above),
            range: fk.bend.reach().into(),
            stretch,
        };
        let (upper, lower) = (upper.angles, lower.angles);
        Self { upper, lower, hand, tip, reach, turned_aside, solution }
    }

    /// Writes the angles, blended with those of the FK pose by the influence.
    fn write(
        &self,
        skeleton: &mut Skeleton,
        limb: Limb,
        target: &LimbTarget,
        turns: &mut [Option<DQuat>; 3],
    ) {
        let joints = [Some(limb.upper), Some(limb.lower), limb.hand];
        let angles = [Some(self.upper), Some(self.lower), self.hand];
        for ((joint, angles), turn) in joints.into_iter().zip(angles).zip(turns) {
            let Some((joint, angles)) = joint.zip(angles) else { continue };
            let angles = skeleton[joint].angles_towards(angles, target.influence, turn);
            skeleton.write_local(joint, |joint| joint.rotation = angles);
        }
        let LimbTarget { influence, fk_stretch, .. } = *target;
        let stretch = fk_stretch + (self.solution.stretch as f32 - fk_stretch) * influence;
        if stretch != fk_stretch {
            lengthen(skeleton, limb, stretch / fk_stretch);
        }
    }
}

/// Multiplies the lengths of a limb's bones.
pub(crate) fn lengthen(skeleton: &mut Skeleton, limb: Limb, factor: f32) {
    let between = skeleton.ancestors(limb.lower).take_while(|joint| *joint != limb.upper);
    for joint in between.chain(limb.hand).collect::<Vec<_>>() {
        skeleton.write_local(joint, |joint| joint.offset *= factor);
    }
    for joint in [limb.upper, limb.lower] {
        skeleton.write_local(joint, |joint| joint.axis *= factor);
    }
}
