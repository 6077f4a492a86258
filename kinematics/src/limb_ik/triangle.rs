use glam::{DAffine3, DVec3, Vec3};

use super::elbow::LimbAim;
use super::fk_limb::{FkLimb, bend_of};
use super::{JointSpace, Limb};
use crate::skeleton::Skeleton;

/// The triangle of a limb's base, elbow and tip, in the space of the upper joint's parent; lengths
/// are in units of the skeleton.
///
/// Also skew hinges and fused joints between the bones give a triangle: its sides are the distances
/// of the three points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LimbTriangle {
    /// The Pointer, and the side of the elbow.
    pub aim: LimbAim,
    /// Distances from base to elbow and from elbow to tip.
    pub sides: [f64; 2],
    /// D, the distance from base to tip.
    pub distance: f64,
    /// h_e, the elbow's distance from the base along the Pointer.
    pub along: f64,
    /// o_e, the elbow's distance from the Pointer.
    pub out: f64,
}

/// The closed form of a limb, before limits of the upper joint and before the influence; in the
/// space of the upper joint's parent, in units of the skeleton.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LimbSolution {
    /// The triangle, with its stretch.
    pub triangle: LimbTriangle,
    /// Direction of the elbow at twist 0, perpendicular to the Pointer.
    pub outward: DVec3,
    /// The target, from the limb's base.
    pub target: DVec3,
    /// Pointer and elbow of the FK pose.
    pub fk: LimbAim,
    /// Least and greatest distance of the tip that the limits of the lower joint allow, without soft
    /// limits and stretch.
    pub range: [f64; 2],
    /// Factor by which the bones are lengthened.
    pub stretch: f64,
}

impl LimbTriangle {
    /// The triangle of a limb in the pose that a skeleton has; `None` for missing joints.
    pub fn of(skeleton: &Skeleton, limb: Limb) -> Option<Self> {
        let fk = FkLimb::new(skeleton, limb, None)?;
        let tip = fk.bend.tip(fk.angle);
        let sides = [fk.bend.upper.length(), fk.bend.lower.length()];
        let aim = fk.aim().rotated(fk.above.rotation.transpose());
        let direction = tip.normalize_or_zero();
        let along = fk.bend.upper.dot(direction);
        let out = (fk.bend.upper - along * direction).length();
        Some(Self { aim, sides, distance: tip.length(), along, out })
    }

    /// The triangle with these sides and this distance from base to tip, which the sides allow.
    pub(super) fn of_sides([upper, lower]: [f64; 2], distance: f64, aim: LimbAim) -> Self {
        let (sum, difference) = (upper + lower, upper - lower);
        let along =
            if distance > 0.0 { 0.5 * (distance + difference * (sum / distance)) } else { 0.0 };
        // Heron's formula, factored so that nothing cancels.
        let squared = (sum + distance) * (sum - distance);
        let ratio = if distance > 0.0 {
            ((distance + difference) / distance) * ((distance - difference) / distance)
        } else {
            1.0
        };
        let out = 0.5 * (squared * ratio).max(0.0).sqrt();
        Self { aim, sides: [upper, lower], distance, along, out }
    }
}

impl LimbAim {
    /// Pointer and elbow in the bind pose, in the space of the upper joint's parent; `None` for
    /// missing joints.
    pub fn in_bind_pose(skeleton: &Skeleton, limb: Limb) -> Option<Self> {
        let lower = skeleton.joint(limb.lower)?;
        let below = skeleton.ancestors(limb.lower).take_while(|joint| *joint != limb.upper);
        let origin = below.map(|joint| skeleton[joint].offset.as_dvec3()).sum();
        let mount = JointSpace { origin, ..JointSpace::IDENTITY };
        let (bend, angle, _) = bend_of(lower, Vec3::ZERO, mount);
        Some(Self::of_limb(bend.upper, bend.tip(angle), || bend.bending(angle, angle)))
    }
}

/// Transform from the space at a limb's base, with the axes of the upper joint's parent, to
/// skeleton space.
pub(crate) fn base_space(skeleton: &Skeleton, limb: Limb) -> DAffine3 {
    let upper = &skeleton[limb.upper];
    let JointSpace { rotation, origin } = JointSpace::of(skeleton, upper.parent).at_base_of(upper);
    DAffine3::from_mat3_translation(rotation, origin)
}
