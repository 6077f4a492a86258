use glam::Vec3;

use super::Colour;

/// A label beside a point; [`Scene::text`](super::Scene::text) returns its text.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Label {
    /// Point in the world that is labelled.
    pub at: Vec3,
    /// Radius in world units of a ball around the point that the text does not cover.
    pub clearance: f32,
    /// Side of the ball on which the text is written.
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
        Self { at, clearance, side, colour, text: TextRange::default() }
    }
}
