use crate::session::display::DisplayEdit;
use crate::session::files::action::FileAction;
use crate::session::history::transaction::TransactionAction;
use crate::session::inspections::InspectAction;
use crate::session::keys::{BakeAction, KeysEdit};
use crate::session::outcome::Outcome;
use crate::session::playback::PlaybackAction;
use crate::session::reach_regions::ReachAction;
use crate::session::selection::SelectAction;
use crate::session::session::Session;
use crate::session::shell::ShellAction;
use crate::session::skeleton::joints::JointEdit;
use crate::session::skeleton::targets::{PathEdit, TargetEdit, changed_label};
use crate::session::skin::SkinEdit;
use crate::session::solver::edits::SolverEdit;
use crate::session::solver::solvers::SolverAction;
use crate::session::tour::state::TourAction;
use crate::session::view::ViewAction;

/// A change of a [`Session`](super::Session), grouped by the part of the session that it changes.
/// Values are absolute, so that setting the same value twice is harmless.
#[derive(Clone, Debug, PartialEq)]
pub enum Action {
    /// Changes the document. An undo step of its own, unless a transaction is open.
    Edit(Edit),
    /// Opens, drags and closes transactions, and moves through the undo history. These actions have
    /// no label of their own: an undo step is labelled by the edits in it.
    Transaction(TransactionAction),
    /// Changes the selection.
    Select(SelectAction),
    /// Changes the camera, the crowd or the open panels.
    View(ViewAction),
    /// Moves through time.
    Playback(PlaybackAction),
    /// Runs and compares solvers.
    Solver(SolverAction),
    /// Bakes on a thread of their own.
    Bake(BakeAction),
    /// Starts and ends inspections of the motion.
    Inspect(InspectAction),
    /// Starts and ends searches for reach regions.
    Reach(ReachAction),
    /// Opens, saves and exports.
    File(FileAction),
    /// Changes dialogs, messages or preferences.
    Shell(ShellAction),
    /// Moves through the tour.
    Tour(TourAction),
}

macro_rules! from_payload {
    ($($group:ident($payload:ident)),* $(,)?) => {
        $(impl From<$payload> for Action {
            fn from(action: $payload) -> Self {
                Self::$group(action)
            }
        })*
    };
}

from_payload! {
    Edit(Edit),
    Transaction(TransactionAction),
    Select(SelectAction),
    View(ViewAction),
    Playback(PlaybackAction),
    Solver(SolverAction),
    Bake(BakeAction),
    Inspect(InspectAction),
    Reach(ReachAction),
    File(FileAction),
    Shell(ShellAction),
    Tour(TourAction),
}

macro_rules! from_edit {
    ($($edit:ident),*) => {
        $(impl From<$edit> for Action {
            fn from(edit: $edit) -> Self {
                Self::Edit(edit.into())
            }
        })*
    };
}

from_edit!(JointEdit, PathEdit, TargetEdit, SolverEdit, SkinEdit, KeysEdit, DisplayEdit);

/// Actions in the order in which they are applied.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Actions(Vec<Action>);

impl Actions {
    /// An empty list.
    pub fn new() -> Self {
        Self::default()
    }

    /// Appends an action.
    pub fn push(&mut self, action: impl Into<Action>) {
        self.0.push(action.into());
    }

    /// True if the list is empty.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Removes and returns all actions.
    pub fn drain(&mut self) -> impl Iterator<Item = Action> + '_ {
        self.0.drain(..)
    }

    /// Removes the actions for which `keep` is false.
    pub fn retain(&mut self, keep: impl FnMut(&Action) -> bool) {
        self.0.retain(keep);
    }
}

impl<A: Into<Action>> Extend<A> for Actions {
    fn extend<I: IntoIterator<Item = A>>(&mut self, actions: I) {
        self.0.extend(actions.into_iter().map(Into::into));
    }
}

impl IntoIterator for Actions {
    type Item = Action;
    type IntoIter = std::vec::IntoIter<Action>;

    fn into_iter(self) -> Self::IntoIter {
        self.0.into_iter()
    }
}

macro_rules! edits {
    ($($(#[doc = $doc:literal])+ $part:ident($edit:ident)),* $(,)?) => {
        /// A change of the document. Outside a transaction, each change is one undo step with its
        /// own label.
        #[derive(Clone, Debug, PartialEq)]
        pub enum Edit {
            $($(#[doc = $doc])+ $part($edit),)*
        }

        impl Edit {
            /// Label of the edit's undo step, as in "Undo Move target", if it is made now.
            pub fn label(&self, session: &Session) -> &'static str {
                match self {
                    Self::Target(TargetEdit::SetTarget(target)) => changed_label(session, target),
                    $(Self::$part(edit) => edit.label(),)*
                }
            }

            pub(super) fn apply(self, session: &mut Session) -> Outcome {
                match self {
                    $(Self::$part(edit) => edit.apply(session),)*
                }
            }
        }

        $(impl From<$edit> for Edit {
            fn from(edit: $edit) -> Self {
                Self::$part(edit)
            }
        })*
    };
}

edits! {
    /// Of the joints.
    Joint(JointEdit),
    /// Of the path that a chain follows.
    Path(PathEdit),
    /// Of targets.
    Target(TargetEdit),
    /// Of the solver.
    Solver(SolverEdit),
    /// Of the skin.
    Skin(SkinEdit),
    /// Of keys and timeline.
    Keys(KeysEdit),
    /// Of the display, and resets.
    Display(DisplayEdit),
}
