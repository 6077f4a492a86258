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
pub enum Overlay {
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
    /// The way of the hand or of the selected joint through the keys.
    Trail,
    /// The rig as it stands somewhat before and after.
    OnionSkins,
    /// The Outer Limit coloured by how fast the elbow turns there.
    #[serde(rename = "singularity_globe")]
    Globe,
    /// The arm as every swivel reference would have it.
    #[serde(rename = "twist_references")]
    References,
    /// The arm's hand, and stripes along its forearm.
    Hand,
}

impl Overlay {
    /// Everything, in the order in which it is offered.
    pub fn all() -> impl Iterator<Item = Self> {
        let of_arm = Self::GUIDES.into_iter().chain(Self::OF_ARM);
        of_arm.chain(Self::MOTION).chain(Self::SURROUNDINGS)
    }

    /// The four guides of the paper.
    pub const GUIDES: [Self; 4] = [Self::Cursor, Self::Pointer, Self::InnerLimit, Self::OuterLimit];

    /// What else shows how the arm is posed.
    pub const OF_ARM: [Self; 3] = [Self::Hand, Self::Globe, Self::References];

    /// What shows how the rig moves.
    pub const MOTION: [Self; 2] = [Self::Trail, Self::OnionSkins];

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
    shown: u32,
}

impl Display {
    pub fn shows(self, layer: Overlay) -> bool {
        self.shown & bit(layer) != 0
    }

    #[must_use]
    pub fn with(mut self, layer: Overlay, shown: bool) -> Self {
        if shown {
            self.shown |= bit(layer);
        } else {
            self.shown &= !bit(layer);
        }
        self
    }

    /// What is shown.
    pub fn layers(self) -> impl Iterator<Item = Overlay> {
        Overlay::all().filter(move |layer| self.shows(*layer))
    }
}

/// Shows these and nothing else.
impl FromIterator<Overlay> for Display {
    fn from_iter<T: IntoIterator<Item = Overlay>>(layers: T) -> Self {
        layers.into_iter().fold(Self { shown: 0 }, |display, layer| display.with(layer, true))
    }
}

impl Default for Display {
    /// The whole scene, with Cursor, Pointer, hand and trail; the limits would veil the arm.
    fn default() -> Self {
        let guides = [Overlay::Cursor, Overlay::Pointer, Overlay::Hand, Overlay::Trail];
        Overlay::SURROUNDINGS.into_iter().chain(guides).collect()
    }
}

fn bit(layer: Overlay) -> u32 {
    1 << layer as u16
}
