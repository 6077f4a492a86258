use glam::{DMat3, DQuat, DVec3, Quat, Vec3};

use super::carried::CarriedLimb;
use super::elbow::{Aim, Bend, BendWay, orthonormal};
use super::{JointSpace, Limb};
use crate::skeleton::{AnglesWithin, Joint, JointId, RotationAxis, Skeleton};
use crate::soft_reach::SoftReach;
use crate::twist::Stereographic;
use crate::two_bone::opposite_side;
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
    /// A stereographic map in the space of the upper joint's parent.
    Stereographic(Stereographic),
    /// The direction of the step before, carried to the Pointer by the least rotation, in the space
    /// of the upper joint's parent. Without a step before, it is that of the FK pose.
    Transport,
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
    let fk = FkLimb::new(skeleton, limb)?.carrying(&skeleton[limb.lower], carried);
    let local = LocalTarget::new(skeleton, target, &fk)?;
    let solved = SolvedLimb::new(skeleton, limb, &fk, &local, carried);
    if target.influence > 0.0 {
        solved.write(skeleton, limb, target.influence, &mut carried.turns);
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
    Some(LimbReport { error, reach: solved.reach, stretch: solved.stretch as f32 })
}

/// The twist at which the limb keeps the elbow that it has by FK, radians.
pub fn fk_twist(skeleton: &Skeleton, limb: Limb, reference: ElbowReference) -> Option<f32> {
    let fk = FkLimb::new(skeleton, limb)?;
    let aim = fk.aim();
    let target = LimbTarget { reference, ..LimbTarget::new(Vec3::ZERO) };
    let local = LocalTarget::new(skeleton, &target, &fk)?;
    Some(aim.twist_from(local.aim(&fk, aim.pointer, None)) as f32)
}

/// True if the lower joint of a limb is no hinge, or a hinge whose limits let the limb bend to both
/// sides of straight.
pub fn bends_to_several_sides(skeleton: &Skeleton, limb: Limb) -> bool {
    let Some(fk) = FkLimb::new(skeleton, limb) else { return false };
    let lower = &skeleton[limb.lower];
    let is_fixed = lower.locked || lower.movable_axes().next().is_none();
    !is_fixed && (lower.hinge().is_none() || fk.bend.has_both_sides(fk.angle))
}

/// A target in skeleton space.
struct LocalTarget<'a> {
    point: DVec3,
    /// The pole of [`ElbowReference::Pole`].
    pole: DVec3,
    /// Rotation of the hand.
    hand: Option<DQuat>,
    target: &'a LimbTarget,
}

impl<'a> LocalTarget<'a> {
    fn new(skeleton: &Skeleton, target: &'a LimbTarget, fk: &FkLimb) -> Option<Self> {
        let transform = skeleton.transform().as_daffine3();
        let to_skeleton = transform.inverse();
        let in_world = |point: DVec3| transform.transform_point3(point);
        let pole = match target.reference {
            ElbowReference::Pole(pole) => to_skeleton.transform_point3(pole.as_dvec3()),
            _ => DVec3::ZERO,
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
        is_valid.then_some(Self { point, pole, hand, target })
    }

    /// The Pointer with the elbow at twist 0; `before` are those of the step before, in the space
    /// of the upper joint's parent.
    fn aim(&self, fk: &FkLimb, pointer: DVec3, before: Option<Aim>) -> Aim {
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
                map.outward(above.transpose() * pointer).map(|outward| above * outward)
            }
        };
        let outward = outward.map(|outward| outward.reject_from_normalized(pointer));
        match outward.filter(|outward| outward.length() > PARALLEL) {
            Some(outward) => Aim { pointer, outward: outward.normalize() },
            None => fk.aim().carried_to(pointer),
        }
    }
}

/// True if a target is the tip of a limb, computed in f32. Rounding of a target would turn the
/// elbow of a straight limb by its square root.
fn is_rounded([tip, base]: [DVec3; 2], target: Vec3) -> bool {
    const ROUNDING: f64 = 4.0 * f32::EPSILON as f64;
    tip.distance(target.as_dvec3()) <= ROUNDING * tip.abs().max(base.abs()).max_element()
}

/// A limb in the pose that the skeleton's angles give it.
struct FkLimb {
    /// The space of the upper joint's parent.
    above: JointSpace,
    /// Position of the upper joint in skeleton space.
    base: DVec3,
    /// Rotation of the upper joint in skeleton space.
    upper_rotation: DMat3,
    /// The space in which the lower joint turns, in the upper joint's space.
    mount: JointSpace,
    bend: Bend,
    /// β in the FK pose.
    angle: f64,
    /// The Euler angle, x, y or z, that β is; `None` if the lower joint turns about another axis.
    free_angle: Option<RotationAxis>,
    /// The elbow's direction in the upper joint's space that is kept; `None` for that of the FK
    /// pose.
    kept_outward: Option<DVec3>,
    /// True if the limb bends to the other side than the FK pose.
    is_reversed: bool,
}

/// Bend in radians up to which the FK pose has no direction of its own.
const STRAIGHT_FK: f64 = 2.0 * core::f64::consts::PI / 180.0;
/// Bend in radians from which the FK pose has a direction of its own.
const BENT_FK: f64 = 5.0 * core::f64::consts::PI / 180.0;

impl FkLimb {
    fn new(skeleton: &Skeleton, limb: Limb) -> Option<Self> {
        let (upper, lower) = (skeleton.joint(limb.upper)?, skeleton.joint(limb.lower)?);
        let above = JointSpace::of(skeleton, upper.parent);
        let between = skeleton.ancestors(limb.lower).skip(1).take_while(|it| *it != limb.upper);
        let mount = JointSpace::from_top(skeleton, between).at_base_of(lower);
        let upper_rotation = above.rotation * upper.rotation_f64(upper.rotation);
        let (bend, angle, free_angle) = bend_of(lower, mount);
        let base = above.point(upper.offset);
        Some(Self {
            above,
            base,
            upper_rotation,
            mount,
            bend,
            angle,
            free_angle,
            kept_outward: None,
            is_reversed: false,
        })
    }

    /// The limb with the way in which it bent before, where the FK pose is nearly straight; carries
    /// on the way in which it bends now.
    fn carrying(mut self, lower: &Joint, carried: &mut CarriedLimb) -> Self {
        let of_fk = self.way();
        let Some(before) = carried.way else {
            carried.way = Some(of_fk);
            return self;
        };
        let bent = self.bend.bent_by(self.angle);
        let share = ((bent - STRAIGHT_FK) / (BENT_FK - STRAIGHT_FK)).clamp(0.0, 1.0);
        let is_hinge = lower.hinge().is_some() || lower.locked;
        self.is_reversed = is_hinge && before.axis.dot(of_fk.axis) < 0.0;
        let goal = if self.is_reversed { of_fk.reversed() } else { of_fk };
        let way = before.towards(goal, share);
        if share >= 1.0 {
            carried.way = Some(way);
        }
        if is_hinge {
            self.bend.kept_side = Some(goal.axis.dot(self.bend.axis).signum());
        } else if share < 1.0 {
            let turned = self.bend.tip(self.angle) - self.bend.upper;
            let unlimited = (f64::NEG_INFINITY, f64::INFINITY);
            self.bend = Bend::new(way.axis, self.bend.upper, turned, unlimited);
            self.bend.kept_side = Some(1.0);
            (self.angle, self.free_angle) = (0.0, None);
        }
        self.kept_outward = (share < 1.0 || self.is_reversed).then_some(way.outward);
        self
    }

    /// The way in which the FK pose bends.
    fn way(&self) -> BendWay {
        let side = self.bend.side(self.angle);
        let outward = self.aim_of(self.bend.tip(self.angle), self.angle).outward;
        BendWay { axis: side * self.bend.axis, outward }
    }

    /// Position of the tip in the FK pose, in skeleton space.
    fn tip(&self) -> DVec3 {
        self.base + self.upper_rotation * self.bend.tip(self.angle)
    }

    /// The Pointer and elbow of the FK pose, in skeleton space.
    fn aim(&self) -> Aim {
        let aim = self.aim_of(self.bend.tip(self.angle), self.angle);
        let kept = |outward| Aim { outward: orthonormal(outward, aim.pointer), ..aim };
        self.kept_outward.map_or(aim, kept).rotated(self.upper_rotation)
    }

    /// The Pointer and elbow for a vector to the tip in the upper joint's space, bent by `angle`.
    fn aim_of(&self, tip: DVec3, angle: f64) -> Aim {
        Aim::of_limb(self.bend.upper, tip, || self.bend.bending(angle, self.angle))
    }

    /// Distance of the tip before the bones are lengthened, and the factor by which they are, for a
    /// target at `distance` in skeleton space.
    fn distance_for(&self, distance: f64, soft_reach: SoftReach) -> (f64, f64) {
        let (least, most) = self.bend.reach();
        let (upper, lower) = (self.bend.upper.length(), self.bend.lower.length());
        let open = opposite_side(upper, lower, f64::from(soft_reach.min_elbow_angle()));
        soft_reach.between(least.max(open).min(most), most, distance)
    }
}

/// The bend of a lower joint, its angle β in the FK pose, and the Euler angle that β is, if any.
fn bend_of(lower: &Joint, mount: JointSpace) -> (Bend, f64, Option<RotationAxis>) {
    // Sine of the elbow's angle below which the limb counts as straight.
    const STRAIGHT: f64 = 1e-6;
    const UNLIMITED: (f64, f64) = (f64::NEG_INFINITY, f64::INFINITY);
    let axis = lower.axis.as_dvec3();
    let about = |hinge: RotationAxis| {
        let mut angles = lower.rotation;
        angles[hinge.index()] = 0.0;
        let about = mount.rotation * lower.rotation_axes_f64(lower.rotation).col(hinge.index());
        let unbent = mount.rotation * lower.rotation_f64(angles) * axis;
        let range = lower.limits.range(hinge);
        let limits = range.map_or(UNLIMITED, |it| (f64::from(it.min), f64::from(it.max)));
        let bend = Bend::new(about, mount.origin, unbent, limits);
        (bend, f64::from(lower.rotation[hinge.index()]), Some(hinge))
    };
    if let (Some(hinge), false) = (lower.hinge(), lower.locked) {
        return about(hinge);
    }
    let turned = mount.rotation * lower.rotation_f64(lower.rotation) * axis;
    let free = |axis: DVec3, limits: (f64, f64)| {
        (Bend::new(axis, mount.origin, turned, limits), 0.0, None)
    };
    if lower.locked || lower.movable_axes().next().is_none() {
        return free(DVec3::X, (0.0, 0.0));
    }
    let normal = mount.origin.cross(turned);
    if normal.length() > STRAIGHT * mount.origin.length() * turned.length() {
        return free(normal.normalize(), UNLIMITED);
    }
    // Straight: the angle by which the limb may bend most, weighted by how far it swings the bone.
    let swing = |hinge: RotationAxis| {
        let (bend, angle, _) = about(hinge);
        let room = f64::max(bend.limits.1 - angle, angle - bend.limits.0);
        room.min(core::f64::consts::PI) * bend.axis.cross(turned.normalize_or_zero()).length()
    };
    let rank = |one, other| swing(one).total_cmp(&(swing(other) + 1e-6));
    let widest = lower
        .movable_axes()
        .reduce(|best, hinge| if rank(hinge, best).is_gt() { hinge } else { best });
    widest.map_or_else(|| free(DVec3::X, (0.0, 0.0)), about)
}

/// The angles of a limb that reaches for its target.
struct SolvedLimb {
    upper: Vec3,
    lower: Vec3,
    hand: Option<Vec3>,
    /// Position of the tip in skeleton space at full influence.
    tip: DVec3,
    stretch: f64,
    reach: LimbReach,
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
        let pointer = to_target.try_normalize().unwrap_or_else(|| fk.aim().pointer);
        let (distance, stretch) = fk.distance_for(wanted, target.soft_reach);

        let lower = fk.lower_angles(&skeleton[limb.lower], distance);
        let lower_rotation = fk.mount.rotation * skeleton[limb.lower].rotation_f64(lower.angles);
        let tip = fk.mount.origin + lower_rotation * skeleton[limb.lower].axis.as_dvec3();

        let aim = local.aim(fk, pointer, carried.aim);
        carried.aim = Some(aim.rotated(fk.above.rotation.transpose()));
        if fk.is_reversed && fk.bend.is_straight_at(lower.bend) {
            carried.way = carried.way.map(BendWay::reversed);
        }
        let aim = aim.twisted(f64::from(target.twist));
        let upper_rotation = fk.aim_of(tip, lower.bend).rotation_to(aim);
        let upper =
            skeleton[limb.upper].angles_within(fk.above.rotation.transpose() * upper_rotation);

        let upper_rotation = fk.above.rotation * skeleton[limb.upper].rotation_f64(upper.angles);
        let hand = limb.hand.zip(local.hand).map(|(hand, turned)| {
            let above_hand = upper_rotation * lower_rotation;
            let turned = above_hand.transpose() * DMat3::from_quat(turned);
            skeleton[hand].angles_within(turned).angles
        });
        let tip = fk.base + upper_rotation * tip * stretch;

        let distance = distance * stretch;
        let is_reached = (distance - wanted).abs() <= 1e-5 * distance.max(wanted);
        let reach = if upper.is_limited {
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
        Self { upper: upper.angles, lower: lower.angles, hand, tip, stretch, reach }
    }

    /// Writes the angles, blended with those of the FK pose by the influence.
    fn write(
        &self,
        skeleton: &mut Skeleton,
        limb: Limb,
        influence: f32,
        turns: &mut [Option<DQuat>; 3],
    ) {
        let joints = [Some(limb.upper), Some(limb.lower), limb.hand];
        let angles = [Some(self.upper), Some(self.lower), self.hand];
        for ((joint, angles), turn) in joints.into_iter().zip(angles).zip(turns) {
            let Some((joint, angles)) = joint.zip(angles) else { continue };
            let angles = skeleton[joint].angles_towards(angles, influence, turn);
            skeleton.write_local(joint, |joint| joint.rotation = angles);
        }
        let stretch = 1.0 + (self.stretch as f32 - 1.0) * influence;
        if stretch != 1.0 {
            lengthen(skeleton, limb, stretch);
        }
    }
}

/// Angles of a lower joint.
struct LowerAngles {
    angles: Vec3,
    /// β.
    bend: f64,
    /// True if limits changed the angles.
    is_limited: bool,
}

impl FkLimb {
    /// The angles of the lower joint for which the tip is at `distance` from the upper joint,
    /// nearest to the FK pose within the limits.
    fn lower_angles(&self, lower: &Joint, distance: f64) -> LowerAngles {
        let angles_at = |bend: f64| {
            if let Some(angle) = self.free_angle {
                let mut angles = lower.rotation;
                angles[angle.index()] = bend as f32;
                let angles = lower.limits.project(angles);
                return LowerAngles { angles, bend, is_limited: false };
            }
            let turn = DMat3::from_axis_angle(self.bend.axis, bend);
            let turned = self.mount.rotation.transpose()
                * turn
                * self.mount.rotation
                * lower.rotation_f64(lower.rotation);
            let AnglesWithin { angles, is_limited } = lower.angles_within(turned);
            LowerAngles { angles, bend, is_limited }
        };
        let [first, second] = self.bend.angles_at(distance, self.angle);
        let first = angles_at(first);
        if !first.is_limited {
            return first;
        }
        let second = angles_at(second);
        if second.is_limited { first } else { second }
    }
}

/// Multiplies the lengths of a limb's bones.
fn lengthen(skeleton: &mut Skeleton, limb: Limb, factor: f32) {
    let between = skeleton.ancestors(limb.lower).take_while(|joint| *joint != limb.upper);
    for joint in between.chain(limb.hand).collect::<Vec<_>>() {
        skeleton.write_local(joint, |joint| joint.offset *= factor);
    }
    for joint in [limb.upper, limb.lower] {
        skeleton.write_local(joint, |joint| joint.axis *= factor);
    }
}
