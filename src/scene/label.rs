use core::fmt::{Arguments, Write as _};

use glam::Vec3;

use super::{Colour, Scene};

/// Words beside a point; [`Scene::text`] has their letters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Label {
    pub at: Vec3,
    /// What the words must not cover: a ball of this radius around the point.
    pub clearance: f32,
    /// Whether the words stand above the ball's right side or below it.
    pub side: Side,
    pub words: Words,
    pub colour: Colour,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    Above,
    Below,
}

/// Where the words of a label are among the letters of its scene, which has them in one piece so that
/// a label owns nothing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Words {
    from: usize,
    to: usize,
}

impl Scene {
    /// What a label of this scene says; nothing for one of another scene.
    pub fn text(&self, label: &Label) -> &str {
        self.letters.get(label.words.from..label.words.to).unwrap_or_default()
    }

    /// Adds a label that says `text`, whatever its words are.
    pub(super) fn add_label(&mut self, label: Label, text: Arguments<'_>) {
        let from = self.letters.len();
        // A string takes all that is written.
        let _ = self.letters.write_fmt(text);
        let words = Words { from, to: self.letters.len() };
        self.labels.push(Label { words, ..label });
    }
}
