use glam::Vec3;

use super::Colour;

/// A label beside a point; [`Scene::text`](super::Scene::text) returns its text.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Label {
    /// Point in the world.
    pub at: Vec3,
    /// Radius of a ball around the point that the text does not cover.
    pub clearance: f32,
    /// Side of the ball on which the text is.
    pub side: LabelSide,
    /// Colour of the text.
    pub colour: Colour,
    pub(super) text: TextRange,
}

/// Position of a label's text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LabelSide {
    /// Above and to the right.
    Above,
    /// Below and to the right.
    Below,
}

/// Byte range of a label's text in the text of its scene, which holds all labels' texts in one string so
/// that refilling a scene allocates nothing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct TextRange {
    pub from: usize,
    pub to: usize,
}

impl Label {
    pub(super) fn new(at: Vec3, clearance: f32, side: LabelSide, colour: Colour) -> Self {
        Self { at, clearance, side, colour, text: TextRange::default() }
    }
}
