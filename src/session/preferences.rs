use core::time::Duration;

use serde::{Deserialize, Serialize};

use crate::document::{Document, Theme};

/// Settings of the user, kept from one start of the program to the next.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct Preferences {
    /// Dark or light theme.
    pub theme: Theme,
    /// Mouse buttons that move the camera.
    pub navigation: Navigation,
    /// Time for a frame while something moves.
    pub frame_budget: FrameBudget,
    /// True if the panel on the right is open.
    pub explain: bool,
    /// The page of that panel.
    pub tab: PanelTab,
    /// True if the timeline is open above the transport bar; `None`: while the document has keys.
    pub timeline_open: Option<bool>,
    /// True if the timeline shows the graph editor instead of the dope sheet.
    pub curves: bool,
    /// True if solver runs start from the FK pose, false if from the frame before.
    pub runs_from_fk: bool,
    /// True if a target was ever dragged, so that no hint is needed.
    pub has_dragged_hand: bool,
    /// True if the tour is offered at the start.
    pub offers_tour: bool,
}

/// Time for a frame while something moves. A machine that needs longer draws the scene at a smaller
/// size until it rests.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum FrameBudget {
    /// No limit: the scene is always drawn in full.
    Unlimited,
    /// 1/60 s.
    Sixtieth,
    /// 1/30 s.
    #[default]
    Thirtieth,
}

/// Mouse buttons that move the camera, as in other programs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Navigation {
    /// Left or middle button orbits.
    #[default]
    Default,
    /// The middle button orbits.
    Blender,
    /// Alt and the left button orbit.
    Maya,
    /// Scrolling orbits.
    Trackpad,
}

impl Default for Preferences {
    fn default() -> Self {
        Self {
            theme: Theme::default(),
            navigation: Navigation::default(),
            frame_budget: FrameBudget::default(),
            explain: true,
            tab: PanelTab::Triangle,
            timeline_open: None,
            curves: false,
            runs_from_fk: false,
            has_dragged_hand: false,
            offers_tour: true,
        }
    }
}

impl Preferences {
    /// True if the timeline of a document is open above the transport bar: by choice, else if the
    /// document has keys.
    pub fn shows_timeline(&self, document: &Document) -> bool {
        self.timeline_open.unwrap_or_else(|| !document.keys.is_empty())
    }
}

impl FrameBudget {
    /// All budgets, in the order of the menu.
    pub const ALL: [Self; 3] = [Self::Unlimited, Self::Thirtieth, Self::Sixtieth];

    /// Name in the menu.
    pub fn name(self) -> &'static str {
        match self {
            Self::Unlimited => "Draw in full",
            Self::Thirtieth => "33 ms a frame",
            Self::Sixtieth => "16 ms a frame",
        }
    }

    /// A description for the menu.
    pub fn help(self) -> &'static str {
        match self {
            Self::Unlimited => "Keep every frame sharp, even if the picture moves in steps",
            Self::Thirtieth => "Draw smaller if a frame would take longer than 1/30 s",
            Self::Sixtieth => "Draw smaller if a frame would take longer than 1/60 s",
        }
    }

    /// Time for a frame; `None` without a limit.
    pub fn time(self) -> Option<Duration> {
        let per_second = match self {
            Self::Unlimited => return None,
            Self::Thirtieth => 30.0,
            Self::Sixtieth => 60.0,
        };
        Some(Duration::from_secs_f64(1.0 / per_second))
    }
}

impl Navigation {
    /// All kinds of navigation, in the order of the menu.
    pub const ALL: [Self; 4] = [Self::Default, Self::Blender, Self::Maya, Self::Trackpad];

    /// Name in the menu.
    pub fn name(self) -> &'static str {
        match self {
            Self::Default => "Default",
            Self::Blender => "Blender",
            Self::Maya => "Maya",
            Self::Trackpad => "Trackpad",
        }
    }

    /// Instructions for orbiting, panning and zooming, in this order.
    pub fn help(self) -> [&'static str; 3] {
        match self {
            Self::Default => [
                "left drag on empty space, middle drag",
                "right drag, Shift+middle drag",
                "wheel, pinch, Ctrl+middle drag",
            ],
            Self::Blender => ["middle drag", "Shift+middle drag", "wheel, pinch, Ctrl+middle drag"],
            Self::Maya => ["Alt+left drag", "Alt+middle drag", "wheel, pinch, Alt+right drag"],
            Self::Trackpad => ["two-finger scroll", "Shift+scroll", "pinch, Ctrl+scroll"],
        }
    }
}

/// A page of the panel on the right.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum PanelTab {
    /// A limb's triangle with its angles and lengths.
    Triangle,
    /// The twist references compared.
    Twist,
    /// The distances that the hand can have.
    Reach,
    /// The jumps of the elbow, or of a figure's joints, their causes and their fixes.
    Pops,
    /// The solver: its settings and iterations; for a single limb also why it needs none.
    Solver,
    /// All solvers at once, on the same targets.
    Race,
    /// The cross-section of the skin for each way of blending joints.
    Skin,
}

impl PanelTab {
    /// All tabs, in the order of the panel.
    pub const ALL: [Self; 7] = [
        Self::Triangle,
        Self::Twist,
        Self::Reach,
        Self::Pops,
        Self::Solver,
        Self::Race,
        Self::Skin,
    ];

    /// True for a page that is about a limb.
    pub fn is_of_limb(self) -> bool {
        matches!(self, Self::Triangle | Self::Twist | Self::Reach)
    }

    /// Name on the tab.
    pub fn name(self) -> &'static str {
        match self {
            Self::Triangle => "Triangle",
            Self::Twist => "Twist",
            Self::Reach => "Reach",
            Self::Pops => "Jumps",
            Self::Solver => "Solver",
            Self::Race => "Race",
            Self::Skin => "Skin",
        }
    }
}
