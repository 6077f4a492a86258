use glam::{DMat3, DVec3, Vec3};

use super::carried::{BendWay, CarriedLimb};
use super::elbow::{Bend, LimbAim, orthonormal};
use super::{JointSpace, Limb};
use crate::skeleton::{AnglesWithin, Joint, RotationAxis, Skeleton};
use crate::soft_reach::SoftReach;
use crate::two_bone::opposite_side;

/// A limb in the pose that the skeleton's angles give it.
pub(super) struct FkLimb {
    /// The space of the upper joint's parent.
    pub above: JointSpace,
    /// Position of the upper joint in skeleton space.
    pub base: DVec3,
    /// Rotation of the upper joint in skeleton space.
    pub upper_rotation: DMat3,
    /// The space in which the lower joint turns, in the upper joint's space.
    pub mount: JointSpace,
    pub bend: Bend,
    /// β in the FK pose.
    pub angle: f64,
    /// The Euler angle, x, y or z, that β is; `None` if the lower joint turns about another axis.
    free_angle: Option<RotationAxis>,
    /// The elbow's direction in the upper joint's space that is kept; `None` for that of the FK
    /// pose.
    kept_outward: Option<DVec3>,
    /// True if the limb bends to the other side than the FK pose.
    pub is_reversed: bool,
}

/// Bend in radians up to which the FK pose has no direction of its own.
const STRAIGHT_FK: f64 = 2.0 * core::f64::consts::PI / 180.0;
/// Bend in radians from which the FK pose has a direction of its own.
const BENT_FK: f64 = 5.0 * core::f64::consts::PI / 180.0;

impl FkLimb {
    /// The limb in the skeleton's pose. While it is straight, and its lower joint is no hinge, it
    /// bends about `bends_about`, which is in the space of the lower joint's base.
    pub fn new(skeleton: &Skeleton, limb: Limb, bends_about: Option<Vec3>) -> Option<Self> {
        let (upper, lower) = (skeleton.joint(limb.upper)?, skeleton.joint(limb.lower)?);
        let above = JointSpace::of(skeleton, upper.parent);
        let between = skeleton.ancestors(limb.lower).skip(1).take_while(|it| *it != limb.upper);
        let mount = JointSpace::from_top(skeleton, between).at_base_of(lower);
        let upper_rotation = above.rotation * upper.rotation_f64(upper.rotation);
        let (bend, angle, free_angle) = bend_of(lower, lower.rotation, mount);
        let base = above.point(upper.offset);
        let of_fk = Self {
            above,
            base,
            upper_rotation,
            mount,
            bend,
            angle,
            free_angle,
            kept_outward: None,
            is_reversed: false,
        };
        let axis = bends_about.and_then(|axis| axis.as_dvec3().try_normalize());
        Some(match axis.filter(|_| !is_hinge(lower)) {
            Some(axis) => of_fk.bending_about(mount.rotation * axis),
            None => of_fk,
        })
    }

    /// The limb with this unit axis, in the upper joint's space, for the one about which it bends,
    /// where the FK pose is nearly straight. A limb that is bent the other way by FK bends back.
    fn bending_about(self, axis: DVec3) -> Self {
        let turned = self.bend.tip(self.angle) - self.bend.upper;
        let Some(outward) = turned.cross(axis).try_normalize() else { return self };
        let (share, of_fk) = (self.own_share(), self.way());
        let is_bent_back = of_fk.axis.dot(axis) < 0.0;
        let of_fk = if is_bent_back { of_fk.reversed() } else { of_fk };
        let way = BendWay { axis, outward }.towards(of_fk, share);
        if share < 1.0 || is_bent_back { self.bending(way) } else { self }
    }

    /// The limb with another way in which it bends.
    fn bending(mut self, way: BendWay) -> Self {
        let turned = self.bend.tip(self.angle) - self.bend.upper;
        let unlimited = (f64::NEG_INFINITY, f64::INFINITY);
        self.bend = Bend::new(way.axis, self.bend.upper, turned, unlimited);
        self.bend.kept_side = Some(1.0);
        (self.angle, self.free_angle) = (0.0, None);
        self.kept_outward = Some(way.outward);
        self
    }

    /// Fraction to which the FK pose has a direction of its own: 0 where it is straight, 1 where it
    /// is bent.
    fn own_share(&self) -> f64 {
        let bent = self.bend.bent_by(self.angle);
        ((bent - STRAIGHT_FK) / (BENT_FK - STRAIGHT_FK)).clamp(0.0, 1.0)
    }

    /// The limb with the way in which it bent before, where the FK pose is nearly straight; carries
    /// on the way in which it bends now.
    pub fn carrying(mut self, lower: &Joint, carried: &mut CarriedLimb) -> Self {
        let of_fk = self.way();
        let Some(before) = carried.way else {
            carried.way = Some(of_fk);
            return self;
        };
        let share = self.own_share();
        let is_hinge = is_hinge(lower);
        self.is_reversed = is_hinge && before.axis.dot(of_fk.axis) < 0.0;
        let goal = if self.is_reversed { of_fk.reversed() } else { of_fk };
        let way = before.towards(goal, share);
        if share >= 1.0 {
            carried.way = Some(way);
        }
        if is_hinge {
            self.bend.kept_side = Some(goal.axis.dot(self.bend.axis).signum());
        } else if share < 1.0 {
            return self.bending(way);
        }
        if share < 1.0 || self.is_reversed {
            self.kept_outward = Some(way.outward);
        }
        self
    }

    /// The limb with bones that were lengthened by a factor, as they are without it.
    pub fn unstretched(mut self, factor: f64) -> Self {
        if factor != 1.0 {
            let Bend { axis, upper, lower, limits, kept_side, .. } = self.bend;
            self.mount.origin /= factor;
            self.bend = Bend::new(axis, upper / factor, lower / factor, limits);
            self.bend.kept_side = kept_side;
        }
        self
    }

    /// The way in which the FK pose bends.
    fn way(&self) -> BendWay {
        let side = self.bend.side(self.angle);
        let of_tip = || self.aim_of(self.bend.tip(self.angle), self.angle).outward;
        let outward = self.kept_outward.unwrap_or_else(of_tip);
        BendWay { axis: side * self.bend.axis, outward }
    }

    /// Position of the tip in the FK pose, in skeleton space.
    pub fn tip(&self) -> DVec3 {
        self.base + self.upper_rotation * self.bend.tip(self.angle)
    }

    /// The Pointer and elbow of the FK pose, in skeleton space.
    pub fn aim(&self) -> LimbAim {
        let aim = self.aim_of(self.bend.tip(self.angle), self.angle);
        let kept = |outward| LimbAim { outward: orthonormal(outward, aim.pointer), ..aim };
        self.kept_outward.map_or(aim, kept).rotated(self.upper_rotation)
    }

    /// The Pointer and elbow for a vector to the tip in the upper joint's space, bent by `angle`.
    pub fn aim_of(&self, tip: DVec3, angle: f64) -> LimbAim {
        LimbAim::of_limb(self.bend.upper, tip, || self.bend.bending(angle, self.angle))
    }

    /// Least and greatest distance of the tip with hard limits but for the smallest elbow angle, in
    /// skeleton space.
    pub fn range(&self, soft_reach: SoftReach) -> [f64; 2] {
        let (least, most) = self.bend.reach();
        let (upper, lower) = (self.bend.upper.length(), self.bend.lower.length());
        let open = opposite_side(upper, lower, f64::from(soft_reach.min_elbow_angle()));
        [least.max(open).min(most), most]
    }
}

/// Distances of a limb's tip from its base, in units of the skeleton.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LimbRange {
    /// The least that the limits of the lower joint and the smallest elbow angle allow.
    pub least: f64,
    /// The greatest that the limits of the lower joint allow, without stretch.
    pub most: f64,
    /// The distance in the pose that the skeleton has.
    pub present: f64,
}

impl LimbRange {
    /// The range of a limb whose bones the skeleton's pose lengthens by `fk_stretch`; `None` for
    /// missing joints.
    pub fn of(
        skeleton: &Skeleton,
        limb: Limb,
        soft_reach: SoftReach,
        fk_stretch: f32,
    ) -> Option<Self> {
        let fk = FkLimb::new(skeleton, limb, None)?;
        let present = fk.bend.tip(fk.angle).length();
        let [least, most] = fk.unstretched(fk_stretch.into()).range(soft_reach);
        Some(Self { least, most, present })
    }
}

/// True if a lower joint can turn about one axis, or not at all.
fn is_hinge(lower: &Joint) -> bool {
    lower.locked || lower.hinge().is_some()
}

/// The bend of a lower joint with these Euler angles, the angle β that they give it, and the Euler
/// angle that β is, if any.
pub(super) fn bend_of(
    lower: &Joint,
    rotation: Vec3,
    mount: JointSpace,
) -> (Bend, f64, Option<RotationAxis>) {
    // Sine of the elbow's angle below which the limb counts as straight.
    const STRAIGHT: f64 = 1e-6;
    const UNLIMITED: (f64, f64) = (f64::NEG_INFINITY, f64::INFINITY);
    let axis = lower.axis.as_dvec3();
    let about = |hinge: RotationAxis| {
        let mut angles = rotation;
        angles[hinge.index()] = 0.0;
        let about = mount.rotation * lower.rotation_axes_f64(rotation).col(hinge.index());
        let unbent = mount.rotation * lower.rotation_f64(angles) * axis;
        let range = lower.limits.range(hinge);
        let limits = range.map_or(UNLIMITED, |it| (f64::from(it.min), f64::from(it.max)));
        let bend = Bend::new(about, mount.origin, unbent, limits);
        (bend, f64::from(rotation[hinge.index()]), Some(hinge))
    };
    if let (Some(hinge), false) = (lower.hinge(), lower.locked) {
        return about(hinge);
    }
    let turned = mount.rotation * lower.rotation_f64(rotation) * axis;
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

/// Angles of a lower joint.
pub(super) struct LowerAngles {
    pub angles: Vec3,
    /// β.
    pub bend: f64,
    /// True if limits changed the angles.
    pub is_limited: bool,
}

impl FkLimb {
    /// The angles of the lower joint for which the tip is at `distance` from the upper joint,
    /// nearest to the FK pose within the limits.
    pub fn lower_angles(&self, lower: &Joint, distance: f64) -> LowerAngles {
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
