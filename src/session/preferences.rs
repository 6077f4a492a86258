use serde::{Deserialize, Serialize};

use crate::document::Theme;

/// What the user likes: not part of the document, and kept from one start to the next.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct Preferences {
    pub theme: Theme,
    pub navigation: Navigation,
    /// Whether the panel on the right is open.
    pub explain: bool,
    /// Whether the panel with the keys is open.
    pub timeline: bool,
    /// Whether it shows the keys as curves.
    pub curves: bool,
    /// Whether a skeleton follows its target while that is dragged.
    pub follow: bool,
}

/// Which mouse buttons turn the view, as other programs have it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Navigation {
    #[default]
    Default,
    Blender,
    Maya,
    Trackpad,
}

impl Default for Preferences {
    fn default() -> Self {
        Self {
            theme: Theme::default(),
            navigation: Navigation::default(),
            explain: true,
            timeline: true,
            curves: false,
            follow: true,
        }
    }
}

impl Navigation {
    pub const ALL: [Self; 4] = [Self::Default, Self::Blender, Self::Maya, Self::Trackpad];

    pub fn name(self) -> &'static str {
        match self {
            Self::Default => "Default",
            Self::Blender => "Blender",
            Self::Maya => "Maya",
            Self::Trackpad => "Trackpad",
        }
    }

    /// How to turn, move and zoom with it.
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
