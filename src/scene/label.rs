use glam::{Vec2, Vec3};

use super::Colour;
use crate::document::Camera;

/// Distance of a text from its ball, in points.
const GAP: f32 = 3.0;
/// Distance from a point along both axes of the picture at which a text is clear of the squares and
/// the free handle around the point, in points.
const HANDLES: f32 = 46.0;

/// A label beside a point; [`Scene::text`](super::Scene::text) returns its text.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Label {
    /// Point in the world that is labelled.
    pub at: Vec3,
    /// Radius in world units of a ball around the point that the text does not cover.
    pub clearance: f32,
    /// Distance of the text from the ball, in points.
    pub gap: f32,
    /// Side of the ball on which the text is written, if there is room.
    pub side: LabelSide,
    /// Colour of the text.
    pub colour: Colour,
    pub(super) text: TextRange,
}

/// Position of a label's text relative to the labelled point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LabelSide {
    /// Above and to the right.
    Above,
    /// Below and to the right.
    Below,
    /// Above and to the left.
    AboveLeft,
    /// Below and to the left.
    BelowLeft,
}

impl LabelSide {
    /// All sides.
    pub const ALL: [Self; 4] = [Self::Above, Self::Below, Self::AboveLeft, Self::BelowLeft];

    /// True if the text is to the left of the point.
    pub fn is_left(self) -> bool {
        matches!(self, Self::AboveLeft | Self::BelowLeft)
    }

    /// True if the text is above the point.
    pub fn is_above(self) -> bool {
        matches!(self, Self::Above | Self::AboveLeft)
    }

    /// The side of the point `at` that is farthest from the directions in which `others` are seen.
    pub(super) fn clear_of(others: &[Vec3], at: Vec3, camera: &Camera) -> Self {
        let projection = camera.projection(1.0);
        let [right, up] = [projection.right, projection.up].map(Vec3::normalize_or_zero);
        let seen = |other: &Vec3| {
            let away = *other - at;
            Vec2::new(away.dot(right), away.dot(up)).normalize_or_zero()
        };
        let nearness = |side: Self| {
            let x = if side.is_left() { -1.0 } else { 1.0 };
            let y = if side.is_above() { 1.0 } else { -1.0 };
            others.iter().map(|other| seen(other).dot(Vec2::new(x, y))).fold(f32::MIN, f32::max)
        };
        let sides = Self::ALL.into_iter();
        sides
            .min_by(|one, other| nearness(*one).total_cmp(&nearness(*other)))
            .unwrap_or(Self::Above)
    }
}

/// Byte range of a label's text in the string of its scene. One string holds the texts of all
/// labels, so that refilling a scene allocates nothing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct TextRange {
    pub from: usize,
    pub to: usize,
}

impl Label {
    pub(super) fn new(at: Vec3, clearance: f32, side: LabelSide, colour: Colour) -> Self {
        Self { at, clearance, gap: GAP, side, colour, text: TextRange::default() }
    }

    /// A label that is clear of the handles around its point.
    pub(super) fn clear_of_handles(self) -> Self {
        Self { gap: HANDLES, ..self }
    }
}
