use serde::{Deserialize, Serialize};

/// The colours of the window and the scene.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Theme {
    /// Light on dark.
    #[default]
    Dark,
    /// Dark on light.
    Light,
}

/// A part of the scene that is shown or hidden.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Overlay {
    /// The Cursor of the arm, or the targets of the skeleton.
    Cursor,
    /// The Pointer, the axis from the shoulder through the Cursor, or the path that the skeleton follows.
    Pointer,
    /// The sphere that the hand cannot enter.
    InnerLimit,
    /// The sphere that the hand cannot leave.
    OuterLimit,
    /// The grid on the plane z = 0.
    GridXy,
    /// The grid on the plane y = 0.
    GridXz,
    /// The grid on the plane x = 0.
    GridYz,
    /// The ground.
    Ground,
    /// The axes of the world.
    Axes,
    /// The names of the parts.
    Labels,
    /// The shadow on the ground.
    Shadow,
    /// The path of the hand or of the selected joint in time.
    Trail,
    /// The rig at some frames before and after.
    OnionSkins,
    /// The Outer Limit, coloured by the speed of the elbow there.
    SingularityGlobe,
    /// The elbow by every kind of twist reference.
    TwistReferences,
    /// The hand of the arm, and stripes along its forearm.
    Hand,
}

impl Overlay {
    /// All overlays, in the order in which panels list them.
    pub fn all() -> impl Iterator<Item = Self> {
        let of_arm = Self::GUIDES.into_iter().chain(Self::ARM);
        of_arm.chain(Self::MOTION).chain(Self::SURROUNDINGS)
    }

    /// The guides of the arm.
    pub const GUIDES: [Self; 4] = [Self::Cursor, Self::Pointer, Self::InnerLimit, Self::OuterLimit];

    /// The other overlays of the arm.
    pub const ARM: [Self; 3] = [Self::Hand, Self::SingularityGlobe, Self::TwistReferences];

    /// Overlays of motion in time.
    pub const MOTION: [Self; 2] = [Self::Trail, Self::OnionSkins];

    /// Overlays around the rig.
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

/// The set of overlays that are shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Display {
    shown: u32,
}

impl Display {
    /// Whether an overlay is shown.
    pub fn shows(self, overlay: Overlay) -> bool {
        self.shown & bit(overlay) != 0
    }

    /// Shows or hides an overlay.
    #[must_use]
    pub fn with(mut self, overlay: Overlay, shown: bool) -> Self {
        if shown {
            self.shown |= bit(overlay);
        } else {
            self.shown &= !bit(overlay);
        }
        self
    }

    /// The overlays that are shown.
    pub fn overlays(self) -> impl Iterator<Item = Overlay> {
        Overlay::all().filter(move |overlay| self.shows(*overlay))
    }
}

/// Shows these overlays alone.
impl FromIterator<Overlay> for Display {
    fn from_iter<T: IntoIterator<Item = Overlay>>(overlays: T) -> Self {
        overlays.into_iter().fold(Self { shown: 0 }, |display, overlay| display.with(overlay, true))
    }
}

impl Default for Display {
    /// The surroundings, Cursor, Pointer, hand and trail; the limits would hide the arm.
    fn default() -> Self {
        let guides = [Overlay::Cursor, Overlay::Pointer, Overlay::Hand, Overlay::Trail];
        Overlay::SURROUNDINGS.into_iter().chain(guides).collect()
    }
}

fn bit(overlay: Overlay) -> u32 {
    1 << overlay as u16
}
