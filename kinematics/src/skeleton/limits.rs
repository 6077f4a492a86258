use core::ops::RangeInclusive;

use glam::{Mat3, Quat, Vec3};

use super::cone::{BoneCone, Cone};
use super::limit::{Limit, RotationAxis, SwingAxis};

/// Limits of a joint's rotation: a range for each Euler angle, a [`Cone`], or none.
///
/// ```
/// use glam::{Vec2, Vec3};
/// use ik_arm_kinematics::skeleton::{Cone, JointLimits, Limit, RotationAxis};
///
/// let mut knee = JointLimits::NONE;
/// knee.set_range(RotationAxis::Z, Some(Limit { min: 0.0, max: 2.5 }));
///
/// assert!(knee.contains(Vec3::new(0.3, 0.0, 1.0)));
/// assert_eq!(knee.project(Vec3::new(0.3, 0.0, 4.0)), Vec3::new(0.3, 0.0, 2.5));
/// assert_eq!(knee.room(Vec3::Z, RotationAxis::Z), Some(-1.0..=1.5));
/// assert_eq!(knee.room(Vec3::Z, RotationAxis::X), None);
///
/// let wide = Limit { min: -1.0, max: 1.0 };
/// let shoulder = JointLimits::cone(Cone { x: 0.5, z: 1.0, twist: wide, middle: Vec2::ZERO });
/// assert!(shoulder.contains(Vec3::new(0.0, 0.0, 0.9)));
/// assert!(shoulder.project(Vec3::X * 0.7).distance(Vec3::X * 0.5) < 1e-6);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(from = "LimitsData", into = "LimitsData")
)]
pub struct JointLimits {
    kind: Kind,
}

/// The kinds of limits.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    /// Range of each angle, in the order x, y, z.
    Angles([Option<Limit>; 3]),
    Cone(BoneCone),
}

/// Limits as they are serialized: the ranges of the angles about x, y and z, or a cone.
#[cfg(feature = "serde")]
#[derive(Clone, Copy, Debug, serde::Serialize, serde::Deserialize)]
#[serde(untagged)]
enum LimitsData {
    Angles([Option<Limit>; 3]),
    Cone(Cone),
}

impl Default for JointLimits {
    /// No limits.
    fn default() -> Self {
        Self::NONE
    }
}

impl JointLimits {
    /// No limits.
    pub const NONE: Self = Self { kind: Kind::Angles([None; 3]) };

    /// Ranges of the angles about x, y and z; `None` for an unlimited angle. A [`Skeleton`] refuses
    /// ranges that are not finite or whose bounds are swapped.
    ///
    /// [`Skeleton`]: super::Skeleton
    pub const fn new(ranges: [Option<Limit>; 3]) -> Self {
        Self { kind: Kind::Angles(ranges) }
    }

    /// A cone. In a [`Skeleton`], it is around the joint's bone; before, around the y-axis of the
    /// joint's frame. A skeleton refuses a cone with angles out of range.
    ///
    /// [`Skeleton`]: super::Skeleton
    pub const fn cone(cone: Cone) -> Self {
        Self { kind: Kind::Cone(BoneCone::new(cone)) }
    }

    /// The cone; `None` for limits of angles.
    pub const fn as_cone(&self) -> Option<Cone> {
        match self.kind {
            Kind::Cone(BoneCone { cone, .. }) => Some(cone),
            Kind::Angles(_) => None,
        }
    }

    /// The same limits around a bone of a joint with this frame, given in the joint's space.
    pub(super) fn along(self, frame: Mat3, bone: Vec3) -> Self {
        match self.kind {
            Kind::Cone(cone) => Self { kind: Kind::Cone(cone.along(frame, bone)) },
            Kind::Angles(_) => self,
        }
    }

    /// Another cone around the same bone, in place of a cone.
    pub(super) fn with_cone(self, cone: Cone) -> Self {
        match self.kind {
            Kind::Cone(of_bone) => Self { kind: Kind::Cone(of_bone.with(cone)) },
            Kind::Angles(_) => Self::cone(cone),
        }
    }

    /// The turn that brings the bone to the middle of a cone, in the joint's frame.
    pub(super) fn turn_to_middle(&self) -> Option<Quat> {
        match self.kind {
            Kind::Cone(cone) => Some(cone.turn_to_middle()),
            Kind::Angles(_) => None,
        }
    }

    /// An axis of a cone, in the joint's frame.
    pub(super) fn swing_axis(&self, axis: SwingAxis) -> Option<Vec3> {
        match self.kind {
            Kind::Cone(cone) => Some(cone.axis(axis)),
            Kind::Angles(_) => None,
        }
    }

    /// Angles of a swing about an axis of the cone with the twist that angles have.
    pub(super) fn swung_about(&self, axis: SwingAxis, by: f32, angles: Vec3) -> Option<Vec3> {
        match self.kind {
            Kind::Cone(cone) => Some(cone.swung_about(axis, by, angles)),
            Kind::Angles(_) => None,
        }
    }

    /// Angles with another twist of a cone.
    pub(super) fn twisted(&self, twist: f32, angles: Vec3) -> Option<Vec3> {
        match self.kind {
            Kind::Cone(cone) => Some(cone.twisted(twist, angles)),
            Kind::Angles(_) => None,
        }
    }

    const fn ranges(&self) -> [Option<Limit>; 3] {
        match self.kind {
            Kind::Angles(ranges) => ranges,
            Kind::Cone(_) => [None; 3],
        }
    }

    /// Range of the angle about an axis; `None` if it is unlimited, or limited by a cone.
    pub const fn range(&self, axis: RotationAxis) -> Option<Limit> {
        self.ranges()[axis.index()]
    }

    /// These limits with another range of the angle about an axis, in place of a cone.
    #[must_use]
    pub const fn with_range(mut self, axis: RotationAxis, range: Option<Limit>) -> Self {
        self.set_range(axis, range);
        self
    }

    /// Replaces the range of the angle about an axis, and a cone by no limits of the other angles.
    pub const fn set_range(&mut self, axis: RotationAxis, range: Option<Limit>) {
        let mut ranges = self.ranges();
        ranges[axis.index()] = range;
        self.kind = Kind::Angles(ranges);
    }

    /// True if anything is limited.
    pub fn is_limited(&self) -> bool {
        match self.kind {
            Kind::Angles(ranges) => ranges.iter().any(Option::is_some),
            Kind::Cone(_) => true,
        }
    }

    /// True if the limits leave the angle about an axis one value.
    pub fn is_fixed(&self, axis: RotationAxis) -> bool {
        self.range(axis).is_some_and(|range| range.min == range.max)
    }

    /// True if Euler angles, in radians, are within the limits. The ends of a cone count as within,
    /// up to rounding.
    pub fn contains(&self, angles: Vec3) -> bool {
        match self.kind {
            Kind::Angles(_) => {
                RotationAxis::ALL.into_iter().all(|axis| self.allows(axis, angles[axis.index()]))
            }
            Kind::Cone(cone) => cone.contains(angles),
        }
    }

    /// The Euler angles within the limits that are nearest to `angles`, radians. Of a cone, the
    /// angles of the nearest swing in its ellipse and of the nearer end of its twist: this jumps
    /// where the swing is half a turn and where the twist is half a turn from its middle.
    pub fn project(&self, angles: Vec3) -> Vec3 {
        let ranges = match self.kind {
            Kind::Angles(ranges) => ranges,
            Kind::Cone(cone) => return cone.project(angles),
        };
        let mut projected = angles;
        for (index, range) in ranges.iter().enumerate() {
            if let Some(Limit { min, max }) = range {
                projected[index] = angles[index].clamp(*min, *max);
            }
        }
        projected
    }

    /// Changes, in radians, of the angle about an axis that stay within its range; `None` if it is
    /// unlimited, or limited by a cone. The range contains 0 if `angles` are within the limits.
    pub fn room(&self, angles: Vec3, axis: RotationAxis) -> Option<RangeInclusive<f32>> {
        let from = angles[axis.index()];
        self.range(axis).map(|range| range.min - from..=range.max - from)
    }

    /// Widens the limits just enough to contain `angles`, a cone up to [`Cone::WIDEST`].
    pub fn widen(&mut self, angles: Vec3) {
        match &mut self.kind {
            Kind::Angles(ranges) => {
                for (range, angle) in ranges.iter_mut().zip(angles.to_array()) {
                    if let Some(Limit { min, max }) = range {
                        (*min, *max) = (min.min(angle), max.max(angle));
                    }
                }
            }
            Kind::Cone(cone) if cone.contains(angles) => {}
            Kind::Cone(cone) => cone.cone = cone.widened(angles),
        }
    }

    /// The least cone, in whole degrees, that contains a cone and angles, and the greatest increase of
    /// its angles; `None` for limits of angles and for a cone that contains the angles.
    pub(crate) fn widened_cone(&self, angles: Vec3) -> Option<(Cone, f32)> {
        let Kind::Cone(cone) = self.kind else { return None };
        (!cone.contains(angles)).then(|| cone.widened_by_degrees(angles))
    }

    /// The twist that Euler angles give the bone of a cone, in radians, within half a turn of the
    /// middle of its range; `None` for limits of angles.
    pub fn twist(&self, angles: Vec3) -> Option<f32> {
        let Kind::Cone(cone) = self.kind else { return None };
        Some(cone.twist_of(angles))
    }

    /// The ends of the limits at which angles are and which a change `by` of them would cross, each
    /// as the unit vector of changes that lead straight out.
    pub(crate) fn crossed(&self, angles: Vec3, by: Vec3) -> [Option<Vec3>; 3] {
        match self.kind {
            Kind::Angles(_) => RotationAxis::ALL.map(|axis| {
                let by = by[axis.index()];
                let out = Vec3::AXES[axis.index()] * by.signum();
                self.stops(angles, axis, by, 0.0).then_some(out)
            }),
            Kind::Cone(cone) => cone.crossed(angles, by),
        }
    }

    /// Takes from a change of angles the parts that lead out of the limits. Returns whether there was
    /// any.
    pub(crate) fn hold(&self, angles: Vec3, by: &mut Vec3) -> bool {
        let mut held: [Vec3; 3] = [Vec3::ZERO; 3];
        for count in 0..held.len() {
            let Some(out) = self.most_crossed(angles, *by, &held[..count]) else {
                return count > 0;
            };
            *by -= out * out.dot(*by);
            held[count] = out;
        }
        true
    }

    /// Of the ends at which angles are, the one that a change `by` of them crosses most: with it
    /// held, the change often crosses no other one. Returns the part of its unit vector, as that of
    /// [`crossed`](Self::crossed), that is new beside the orthonormal `held`, as a unit vector.
    pub(crate) fn most_crossed(&self, angles: Vec3, by: Vec3, held: &[Vec3]) -> Option<Vec3> {
        /// Length of a part that counts as new.
        const NEW: f32 = 1e-3;
        let new_part = |out: Vec3| {
            let new = held.iter().fold(out, |new, held| new - *held * held.dot(new));
            new.try_normalize().filter(|_| new.length() > NEW)
        };
        let crossed = self.crossed(angles, by).into_iter().flatten();
        let crossed = crossed.filter_map(|out| Some((out.dot(by), new_part(out)?)));
        Some(crossed.max_by(|one, other| one.0.total_cmp(&other.0))?.1)
    }

    /// Of a cone, the direction of the bone in the joint's frame and the changes of its twist that
    /// stay in the cone; `None` for limits of angles.
    pub(crate) fn twist_room(&self, angles: Vec3) -> Option<(Vec3, [f32; 2])> {
        match self.kind {
            Kind::Angles(_) => None,
            Kind::Cone(cone) => Some(cone.twist_room(angles)),
        }
    }

    /// True if an angle about an axis is within its range.
    pub(crate) fn allows(&self, axis: RotationAxis, angle: f32) -> bool {
        self.range(axis).is_none_or(|range| range.contains(angle))
    }

    /// Size of the range of the angle about an axis; infinite if it is unlimited. About any axis, a
    /// cone counts as its widest side.
    pub(crate) fn span(&self, axis: RotationAxis) -> f32 {
        match self.kind {
            Kind::Angles(_) => self.range(axis).map_or(f32::INFINITY, |it| it.max - it.min),
            Kind::Cone(BoneCone { cone, .. }) => {
                (2.0 * cone.x).max(2.0 * cone.z).max(cone.twist.max - cone.twist.min)
            }
        }
    }

    /// True if the angle about an axis is at an end of its range, or beyond, or if its change leads
    /// out of a cone at whose end it is.
    pub fn is_at_end(&self, angles: Vec3, axis: RotationAxis) -> bool {
        let angle = angles[axis.index()];
        match self.kind {
            Kind::Angles(_) => {
                self.range(axis).is_some_and(|range| angle <= range.min || angle >= range.max)
            }
            Kind::Cone(_) => {
                [1.0, -1.0].into_iter().any(|push| self.stops(angles, axis, push, 0.0))
            }
        }
    }

    /// True if the angle about an axis is at the end of its range towards which it is pushed: to
    /// greater angles by a positive `push`, to smaller ones by a negative one. An angle within
    /// `margin` of the end counts as at it. Of a cone, true at an end out of which the push leads.
    pub(crate) fn stops(&self, angles: Vec3, axis: RotationAxis, push: f32, margin: f32) -> bool {
        /// Part of a change of the angle that leads out of a cone, below which it leads along its
        /// side.
        const OUT: f32 = 0.1;
        let angle = angles[axis.index()];
        if let Kind::Cone(cone) = self.kind {
            let by = Vec3::AXES[axis.index()] * push;
            let mut outs = cone.crossed(angles, by).into_iter().flatten();
            return outs.any(|out| out.dot(by) > OUT * push.abs());
        }
        self.range(axis).is_some_and(|range| {
            (push > 0.0 && angle >= range.max - margin)
                || (push < 0.0 && angle <= range.min + margin)
        })
    }

    /// Moves angles to a fraction of the way through their ranges or across a cone: those at an end
    /// or, with `all`, all that have limits.
    pub(crate) fn moved_inside(&self, angles: Vec3, fraction: f32, all: bool) -> Vec3 {
        if let Kind::Cone(cone) = self.kind {
            let is_at_end = RotationAxis::ALL.into_iter().any(|it| self.is_at_end(angles, it));
            return if all || is_at_end { cone.inside(fraction, angles) } else { angles };
        }
        let mut inside = angles;
        for axis in RotationAxis::ALL {
            if let Some(Limit { min, max }) = self.range(axis)
                && (all || self.is_at_end(angles, axis))
            {
                inside[axis.index()] = (min + fraction * (max - min)).clamp(min, max);
            }
        }
        inside
    }

    /// Angles inside a cone, others for each number; `angles` for limits of angles.
    pub(crate) fn spread(&self, number: u32, angles: Vec3) -> Vec3 {
        match self.kind {
            Kind::Cone(cone) => cone.spread(number, angles),
            Kind::Angles(_) => angles,
        }
    }

    /// The middle of each range or of the cone, and 0 for angles without limits.
    pub(crate) fn middle(&self) -> Vec3 {
        let ranges = match self.kind {
            Kind::Angles(ranges) => ranges,
            Kind::Cone(cone) => return cone.inside(0.5, Vec3::ZERO),
        };
        let middle = |range: Limit| 0.5 * range.min + 0.5 * range.max;
        Vec3::from_array(ranges.map(|range| range.map_or(0.0, middle)))
    }

    /// The cone if its angles are out of their ranges.
    pub(super) fn invalid_cone(&self) -> Option<Cone> {
        self.as_cone().filter(|cone| !cone.is_valid())
    }

    /// The first range that is not finite or whose bounds are swapped.
    pub(super) fn invalid_range(&self) -> Option<(RotationAxis, Limit)> {
        let is_valid = |it: &Limit| it.min.is_finite() && it.max.is_finite() && it.min <= it.max;
        let ranges = RotationAxis::ALL.into_iter().zip(self.ranges());
        ranges.filter_map(|(axis, range)| Some((axis, range?))).find(|(_, it)| !is_valid(it))
    }
}

impl From<[Option<Limit>; 3]> for JointLimits {
    fn from(ranges: [Option<Limit>; 3]) -> Self {
        Self::new(ranges)
    }
}

#[cfg(feature = "serde")]
impl From<LimitsData> for JointLimits {
    fn from(data: LimitsData) -> Self {
        match data {
            LimitsData::Angles(ranges) => Self::new(ranges),
            LimitsData::Cone(cone) => Self::cone(cone),
        }
    }
}

#[cfg(feature = "serde")]
impl From<JointLimits> for LimitsData {
    fn from(limits: JointLimits) -> Self {
        match limits.kind {
            Kind::Angles(ranges) => Self::Angles(ranges),
            Kind::Cone(BoneCone { cone, .. }) => Self::Cone(cone),
        }
    }
}
