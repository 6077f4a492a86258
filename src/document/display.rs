use serde::{Deserialize, Serialize};

/// Whether the picture is bright or dark.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Theme {
    #[default]
    Dark,
    Light,
}

/// One thing in the picture that can be switched on and off.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Layer {
    Cursor,
    Pointer,
    InnerLimit,
    OuterLimit,
    GridXy,
    GridXz,
    GridYz,
    Ground,
    Axes,
    Labels,
    Shadow,
}

impl Layer {
    /// The four guides of the paper.
    pub const GUIDES: [Self; 4] = [Self::Cursor, Self::Pointer, Self::InnerLimit, Self::OuterLimit];

    /// What surrounds the arm.
    pub const SURROUNDINGS: [Self; 7] = [
        Self::GridXy,
        Self::GridXz,
        Self::GridYz,
        Self::Ground,
        Self::Axes,
        Self::Labels,
        Self::Shadow,
    ];
}

/// Which layers are shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Display {
    shown: u16,
}

impl Display {
    pub fn shows(self, layer: Layer) -> bool {
        self.shown & bit(layer) != 0
    }

    #[must_use]
    pub fn with(mut self, layer: Layer, shown: bool) -> Self {
        if shown {
            self.shown |= bit(layer);
        } else {
            self.shown &= !bit(layer);
        }
        self
    }

    /// What is shown.
    pub fn layers(self) -> impl Iterator<Item = Layer> {
        let all = Layer::GUIDES.into_iter().chain(Layer::SURROUNDINGS);
        all.filter(move |layer| self.shows(*layer))
    }
}

/// Shows these and nothing else.
impl FromIterator<Layer> for Display {
    fn from_iter<T: IntoIterator<Item = Layer>>(layers: T) -> Self {
        layers.into_iter().fold(Self { shown: 0 }, |display, layer| display.with(layer, true))
    }
}

impl Default for Display {
    /// The whole scene, with Cursor and Pointer; the limits would veil the arm.
    fn default() -> Self {
        Layer::SURROUNDINGS.into_iter().chain([Layer::Cursor, Layer::Pointer]).collect()
    }
}

fn bit(layer: Layer) -> u16 {
    1 << layer as u16
}
