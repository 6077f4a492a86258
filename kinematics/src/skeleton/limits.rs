use core::fmt;
use core::ops::RangeInclusive;

use glam::Vec3;

/// The axis of an Euler angle.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum RotationAxis {
    /// The frame's x-axis.
    X,
    /// The frame's y-axis.
    Y,
    /// The frame's z-axis.
    Z,
}

impl RotationAxis {
    /// All axes, in the order of the components of [`Joint::rotation`](super::Joint::rotation).
    pub const ALL: [Self; 3] = [Self::X, Self::Y, Self::Z];

    /// Position in [`Self::ALL`], and of the angle in a vector of angles.
    pub const fn index(self) -> usize {
        self as usize
    }

    /// "x", "y" or "z".
    pub const fn name(self) -> &'static str {
        match self {
            Self::X => "x",
            Self::Y => "y",
            Self::Z => "z",
        }
    }
}

/// Writes the [name](RotationAxis::name).
impl fmt::Display for RotationAxis {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

/// A closed range of an angle, radians.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Limit {
    /// Lower bound.
    pub min: f32,
    /// Upper bound, not below `min`.
    pub max: f32,
}

impl Limit {
    /// True if the angle is in the range.
    pub fn contains(self, angle: f32) -> bool {
        (self.min..=self.max).contains(&angle)
    }

    /// The range widened by whole degrees to contain an angle or the same angle after a full turn,
    /// whichever is nearer; `None` if it contains the angle.
    pub(crate) fn widened_to(self, angle: f32) -> Option<Self> {
        use core::f32::consts::TAU;
        let degrees = |by: f32| by.to_degrees().ceil().to_radians();
        let excess = |angle: f32| (self.min - angle).max(angle - self.max);
        let nearest = [angle, angle - TAU, angle + TAU]
            .into_iter()
            .min_by(|one, other| excess(*one).total_cmp(&excess(*other)))?;
        if nearest < self.min {
            Some(Self { min: self.min - degrees(self.min - nearest), ..self })
        } else if nearest > self.max {
            Some(Self { max: self.max + degrees(nearest - self.max), ..self })
        } else {
            None
        }
    }
}

/// Limits of a joint's rotation: a range for each Euler angle, or none.
///
/// ```
/// use glam::Vec3;
/// use ik_arm_kinematics::skeleton::{JointLimits, Limit, RotationAxis};
///
/// let mut knee = JointLimits::NONE;
/// knee.set_range(RotationAxis::Z, Some(Limit { min: 0.0, max: 2.5 }));
///
/// assert!(knee.contains(Vec3::new(0.3, 0.0, 1.0)));
/// assert_eq!(knee.project(Vec3::new(0.3, 0.0, 4.0)), Vec3::new(0.3, 0.0, 2.5));
/// assert_eq!(knee.room(Vec3::Z, RotationAxis::Z), Some(-1.0..=1.5));
/// assert_eq!(knee.room(Vec3::Z, RotationAxis::X), None);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(transparent))]
pub struct JointLimits {
    /// Range of each angle, in the order x, y, z.
    ranges: [Option<Limit>; 3],
}

impl JointLimits {
    /// No limits.
    pub const NONE: Self = Self { ranges: [None; 3] };

    /// Ranges of the angles about x, y and z; `None` for an unlimited angle. A [`Skeleton`] refuses
    /// ranges that are not finite or whose bounds are swapped.
    ///
    /// [`Skeleton`]: super::Skeleton
    pub const fn new(ranges: [Option<Limit>; 3]) -> Self {
        Self { ranges }
    }

    /// Range of the angle about an axis; `None` if it is unlimited.
    pub const fn range(&self, axis: RotationAxis) -> Option<Limit> {
        self.ranges[axis.index()]
    }

    /// These limits with another range of the angle about an axis.
    #[must_use]
    pub const fn with_range(mut self, axis: RotationAxis, range: Option<Limit>) -> Self {
        self.set_range(axis, range);
        self
    }

    /// Replaces the range of the angle about an axis.
    pub const fn set_range(&mut self, axis: RotationAxis, range: Option<Limit>) {
        self.ranges[axis.index()] = range;
    }

    /// True if anything is limited.
    pub fn is_limited(&self) -> bool {
        self.ranges.iter().any(Option::is_some)
    }

    /// True if the limits leave the angle about an axis one value.
    pub fn is_fixed(&self, axis: RotationAxis) -> bool {
        self.range(axis).is_some_and(|range| range.min == range.max)
    }

    /// True if Euler angles, in radians, are within the limits.
    pub fn contains(&self, angles: Vec3) -> bool {
        RotationAxis::ALL.into_iter().all(|axis| self.allows(axis, angles[axis.index()]))
    }

    /// The Euler angles within the limits that are nearest to `angles`, radians.
    pub fn project(&self, angles: Vec3) -> Vec3 {
        let mut projected = angles;
        for (index, range) in self.ranges.iter().enumerate() {
            if let Some(Limit { min, max }) = range {
                projected[index] = angles[index].clamp(*min, *max);
            }
        }
        projected
    }

    /// Changes, in radians, of the angle about an axis that stay within the limits; `None` if it is
    /// unlimited. The range contains 0 if `angles` are within the limits.
    pub fn room(&self, angles: Vec3, axis: RotationAxis) -> Option<RangeInclusive<f32>> {
        let from = angles[axis.index()];
        self.range(axis).map(|range| range.min - from..=range.max - from)
    }

    /// Widens the limits just enough to contain `angles`.
    pub fn widen(&mut self, angles: Vec3) {
        for (range, angle) in self.ranges.iter_mut().zip(angles.to_array()) {
            if let Some(Limit { min, max }) = range {
                (*min, *max) = (min.min(angle), max.max(angle));
            }
        }
    }

    /// True if an angle about an axis is within its limits.
    pub(crate) fn allows(&self, axis: RotationAxis, angle: f32) -> bool {
        self.range(axis).is_none_or(|range| range.contains(angle))
    }

    /// Size of the range of the angle about an axis; infinite if it is unlimited.
    pub(crate) fn span(&self, axis: RotationAxis) -> f32 {
        self.range(axis).map_or(f32::INFINITY, |range| range.max - range.min)
    }

    /// True if the angle about an axis is at an end of its range, or beyond.
    pub(crate) fn is_at_end(&self, angles: Vec3, axis: RotationAxis) -> bool {
        let angle = angles[axis.index()];
        self.range(axis).is_some_and(|range| angle <= range.min || angle >= range.max)
    }

    /// True if the angle about an axis is at the end of its range towards which it is pushed: to
    /// greater angles by a positive `push`, to smaller ones by a negative one. An angle within
    /// `margin` of the end counts as at it.
    pub(crate) fn stops(&self, angles: Vec3, axis: RotationAxis, push: f32, margin: f32) -> bool {
        let angle = angles[axis.index()];
        self.range(axis).is_some_and(|range| {
            (push > 0.0 && angle >= range.max - margin)
                || (push < 0.0 && angle <= range.min + margin)
        })
    }

    /// Moves angles to a fraction of the way through their ranges: those at an end or, with `all`,
    /// all that have limits.
    pub(crate) fn moved_inside(&self, angles: Vec3, fraction: f32, all: bool) -> Vec3 {
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

    /// The middle of each range, and 0 for angles without limits.
    pub(crate) fn middle(&self) -> Vec3 {
        let middle = |range: Limit| 0.5 * range.min + 0.5 * range.max;
        Vec3::from_array(self.ranges.map(|range| range.map_or(0.0, middle)))
    }

    /// The first range that is not finite or whose bounds are swapped.
    pub(super) fn invalid_range(&self) -> Option<(RotationAxis, Limit)> {
        let is_valid = |it: &Limit| it.min.is_finite() && it.max.is_finite() && it.min <= it.max;
        let ranges = RotationAxis::ALL.into_iter().zip(self.ranges);
        ranges.filter_map(|(axis, range)| Some((axis, range?))).find(|(_, it)| !is_valid(it))
    }
}

impl From<[Option<Limit>; 3]> for JointLimits {
    fn from(ranges: [Option<Limit>; 3]) -> Self {
        Self::new(ranges)
    }
}
