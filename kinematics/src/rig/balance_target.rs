//! What a balance of a figure asks for, and what comes of it.

use glam::Vec2;

use crate::chain_ik::{HeldLimb, SolveError};

/// A target for the centre of mass of a figure, that is, of its first root and all joints below.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BalanceTarget {
    /// Fraction of the way from the pose without balance, 0, to the balanced one, 1.
    pub influence: f32,
    /// Weight relative to those of targets, above 0.
    pub weight: f32,
    /// What the centre goes over.
    pub over: BalanceOver,
}

/// What the centre of mass goes over.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum BalanceOver {
    /// The middle of what stands on the ground: see [`Balance::middle_of_feet`](crate::skeleton::Balance::middle_of_feet).
    #[default]
    Feet,
    /// x and z of a point, in the world.
    Point(Vec2),
}

impl Default for BalanceTarget {
    /// Full influence, the weight 1, over the feet.
    fn default() -> Self {
        Self { influence: 1.0, weight: 1.0, over: BalanceOver::Feet }
    }
}

impl BalanceTarget {
    /// True if it poses the figure.
    pub fn is_posing(&self) -> bool {
        self.influence > 0.0
    }

    /// True if the influence is from 0 to 1, the weight above 0, and all numbers are finite.
    pub fn is_valid(&self) -> bool {
        let is_over = match self.over {
            BalanceOver::Feet => true,
            BalanceOver::Point(point) => point.is_finite(),
        };
        (0.0..=1.0).contains(&self.influence)
            && self.weight > 0.0
            && self.weight.is_finite()
            && is_over
    }
}

/// What the balance needs to know of the pose that the last limb step has left.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Footing {
    pub limbs: Vec<HeldLimb>,
    /// x and z of the point over which the centre of mass should be, and how firmly the figure
    /// stands, from 0 to 1.
    pub over: Option<(Vec2, f32)>,
    /// True if the balance has full influence.
    pub is_full: bool,
}

impl Footing {
    /// Replaces the point over which the centre of mass should be.
    pub fn aim_at(&mut self, place: Vec2) {
        if let Some((over, _)) = &mut self.over {
            *over = place;
        }
    }
}

/// The way of the centre of mass to where it should be, turn by turn.
///
/// The limb step moves the centre, too, so that a turn leads too far or not far enough. Each turn
/// shows by which factor, and the next one takes that into account (Aitken's relaxation).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct BalanceWay {
    /// Distance that is left.
    pub left: f32,
    /// The vector that is left.
    vector: Vec2,
    /// Part of the way that the last turn was asked for.
    part: f32,
}

impl Default for BalanceWay {
    fn default() -> Self {
        Self { left: f32::INFINITY, vector: Vec2::ZERO, part: 1.0 }
    }
}

impl BalanceWay {
    /// The place that the next turn should ask for after a turn with this result.
    pub fn next_place(&mut self, report: &BalanceReport) -> Option<Vec2> {
        const PARTS: core::ops::RangeInclusive<f32> = 0.2..=1.5;
        let vector = report.over? - report.centre;
        if self.left.is_finite() {
            let gone = (self.vector - vector).dot(self.vector) / self.vector.length_squared();
            let part = self.part / gone;
            self.part = if part.is_finite() && part > 0.0 {
                part.clamp(*PARTS.start(), *PARTS.end())
            } else {
                1.0
            };
        }
        (self.vector, self.left) = (vector, vector.length());
        Some(report.centre + self.part * vector)
    }
}

/// The result of an evaluation for the balance.
#[derive(Clone, Debug, PartialEq)]
pub struct BalanceReport {
    /// x and z of the point over which the centre of mass should be; `None` where no foot is on the
    /// ground.
    pub over: Option<Vec2>,
    /// x and z of the centre of mass in the evaluated pose.
    pub centre: Vec2,
    /// The reason why nothing is balanced.
    pub refused: Option<SolveError>,
}

impl BalanceReport {
    /// Distance in the world from the centre of mass to the vertical line on which it should be; 0
    /// where no foot is on the ground.
    pub fn error(&self) -> f32 {
        self.over.map_or(0.0, |over| self.centre.distance(over))
    }
}
