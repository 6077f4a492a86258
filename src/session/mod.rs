//! The document with what is not saved: what is being dragged, what the view glides to, what
//! happened last. Everything that can happen to it is an [`Action`].

mod action;
mod hand_drag;
mod preferences;
mod view_drag;

pub use action::{Action, Effect};
pub use hand_drag::{Constraint, DragInput, HandDrag, Handle};
pub use preferences::{Navigation, Preferences};
pub use view_drag::{Motion, ViewDrag};

use crate::document::{Arm, Camera, Document};
use crate::kinematics::two_bone::Pose;
use view_drag::Glide;

/// An open document and what is going on with it.
#[derive(Clone, Debug, PartialEq)]
pub struct Session {
    document: Document,
    pose: Pose,
    preferences: Preferences,
    edit: Option<Edit>,
    view_drag: Option<ViewDrag>,
    glide: Option<Glide>,
    dialog: Option<Dialog>,
    message: Option<String>,
}

/// A change that is not finished: it can still be taken back.
#[derive(Clone, Debug, PartialEq)]
struct Edit {
    before: Arm,
    hand: Option<HandDrag>,
}

/// A window over the others.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Dialog {
    About,
    Shortcuts,
    /// Asks for a path, which is shown as it is typed.
    SavePicture {
        path: String,
    },
}

impl Default for Session {
    fn default() -> Self {
        Self::new(Preferences::default())
    }
}

impl Session {
    /// The seed's arm.
    pub fn new(preferences: Preferences) -> Self {
        let document = Document::default();
        Self {
            pose: document.arm.pose(),
            document,
            preferences,
            edit: None,
            view_drag: None,
            glide: None,
            dialog: None,
            message: None,
        }
    }

    pub fn document(&self) -> &Document {
        &self.document
    }

    pub fn arm(&self) -> &Arm {
        &self.document.arm
    }

    pub fn camera(&self) -> &Camera {
        &self.document.camera
    }

    /// The document's arm, solved.
    pub fn pose(&self) -> &Pose {
        &self.pose
    }

    pub fn preferences(&self) -> &Preferences {
        &self.preferences
    }

    /// Whether a change is under way that can be taken back.
    pub fn is_editing(&self) -> bool {
        self.edit.is_some()
    }

    /// The hand that is being dragged in the viewport.
    pub fn hand_drag(&self) -> Option<&HandDrag> {
        self.edit.as_ref()?.hand.as_ref()
    }

    pub fn view_drag(&self) -> Option<&ViewDrag> {
        self.view_drag.as_ref()
    }

    /// Whether the view is on its way.
    pub fn is_gliding(&self) -> bool {
        self.glide.is_some()
    }

    pub fn dialog(&self) -> Option<&Dialog> {
        self.dialog.as_ref()
    }

    /// What just happened, if it is worth a word.
    pub fn message(&self) -> Option<&str> {
        self.message.as_deref()
    }
}
