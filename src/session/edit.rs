use super::arm::edits::ArmEdit;
use super::display::DisplayEdit;
use super::keys::KeysEdit;
use super::outcome::Outcome;
use super::session::Session;
use super::skeleton::joints::JointEdit;
use super::skeleton::path::PathEdit;
use super::skeleton::targets::TargetEdit;
use super::skin::SkinEdit;
use super::solver::edits::SolverEdit;

macro_rules! edits {
    ($($(#[doc = $doc:literal])+ $part:ident($edit:ident)),* $(,)?) => {
        /// A change of the document. Outside a transaction, each change is one undo step with its own
        /// label.
        #[derive(Clone, Debug, PartialEq)]
        pub enum Edit {
            $($(#[doc = $doc])+ $part($edit),)*
        }

        impl Edit {
            /// Label of the edit's undo step, as in "Undo Move hand".
            pub fn label(&self) -> &'static str {
                match self {
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
    /// Of the arm.
    Arm(ArmEdit),
    /// Of the skeleton's joints.
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
    /// Of the display and of both rigs alike.
    Display(DisplayEdit),
}
