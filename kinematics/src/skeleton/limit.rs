use core::fmt;

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

/// An end of a joint's limits, at one angle about one axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LimitEnd {
    /// Of the range of the Euler angle about an axis.
    Range(RotationAxis, Extreme),
    /// Of a cone's swing about x or z of the [`Cone`](super::Cone); both ends of an axis move
    /// together.
    Swing(SwingAxis, Extreme),
    /// Of the range of a cone's twist.
    Twist(Extreme),
}

/// The least or the greatest of a range of angles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Extreme {
    /// The least angle.
    Least,
    /// The greatest angle.
    Greatest,
}

/// An axis about which a bone swings within a [`Cone`](super::Cone).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SwingAxis {
    /// The cone's x.
    X,
    /// The cone's z.
    Z,
}

impl Extreme {
    pub(super) const BOTH: [Self; 2] = [Self::Least, Self::Greatest];

    pub(super) fn of(self, range: Limit) -> f32 {
        match self {
            Self::Least => range.min,
            Self::Greatest => range.max,
        }
    }

    /// A range with this end at an angle, but not beyond its other end, nor farther from it than
    /// `widest`.
    pub(super) fn moved_to(self, Limit { min, max }: Limit, angle: f32, widest: f32) -> Limit {
        match self {
            Self::Least => Limit { min: angle.clamp(max - widest, max), max },
            Self::Greatest => Limit { min, max: angle.clamp(min, min + widest) },
        }
    }
}
