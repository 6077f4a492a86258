use glam::Vec3;

use crate::document::Ray;
use crate::session::drag::grip::{Drag, Grip};
use crate::session::drag::joints;
use crate::session::drag::point::{Constraint, DragInput};
use crate::session::outcome::{Consequence, Outcome};
use crate::session::preferences::Preferences;
use crate::session::session::Session;

/// Groups edits into one undo step, or moves through the undo steps.
#[derive(Clone, Debug, PartialEq)]
pub enum TransactionAction {
    /// Opens a transaction, such as a slider's drag.
    Begin,
    /// Makes one undo step of all edits since the transaction was opened.
    Commit,
    /// Discards all edits since the transaction was opened.
    Cancel,
    /// Undoes the latest step; if a transaction is open, cancels it instead.
    Undo,
    /// Redoes the step that was undone most recently.
    Redo,
    /// Opens a transaction that drags a point or a ring in the viewport.
    Grab {
        /// The dragged point or ring.
        grip: Grip,
        /// The ray through the mouse, in world space.
        ray: Ray,
        /// Normal of the picture, in the direction in which the camera looks.
        forward: Vec3,
    },
    /// Moves the dragged point or ring.
    Drag(DragInput),
    /// Constrains the drag to an axis or a plane; `None` frees it.
    Constrain(Option<Constraint>),
    /// Lets the heads that targets move follow the mouse, as a drag without a button that plays and
    /// records keys; or ends it with an undo step.
    FollowMouse(bool),
    /// Moves the mouse that heads follow to a ray in world space.
    Lead(Ray),
    /// Sets the typed offset, which replaces the offset by the mouse unless the text is empty.
    TypeOffset(String),
}

impl TransactionAction {
    pub(in crate::session) fn apply(self, session: &mut Session) -> Outcome {
        match self {
            Self::Begin => Consequence::Begin(None).into(),
            Self::Commit => commit(session),
            Self::Cancel => Consequence::Cancel.into(),
            Self::Undo => Consequence::Undo.into(),
            Self::Redo => Consequence::Redo.into(),
            Self::Grab { grip, ray, forward } => grab(session, grip, ray, forward),
            Self::Drag(input) => drag(session, |drag| drag.set_input(input)),
            Self::Constrain(constraint) if constraint.is_none_or(Constraint::has_valid_axis) => {
                drag(session, |drag| drag.set_constraint(constraint))
            }
            Self::Constrain(_) => Outcome::default(),
            Self::TypeOffset(typed) => drag(session, |drag| drag.set_typed(typed)),
            Self::FollowMouse(follows) => Consequence::FollowMouse(follows).into(),
            Self::Lead(ray) => Consequence::Lead(ray).into(),
        }
    }
}

fn commit(session: &Session) -> Outcome {
    let has_dragged_hand = session.history().drag().is_some_and(moves_target);
    let known = Preferences { has_dragged_hand: true, ..*session.preferences() };
    Outcome::from(has_dragged_hand.then_some(Consequence::Prefer(known))).and(Consequence::Commit)
}

/// True if a drag has moved a target.
fn moves_target(drag: &Drag) -> bool {
    let is_target = matches!(drag.grip(), Grip::Target(..));
    is_target && drag.point().is_some_and(|point| point.moved() != Vec3::ZERO)
}

/// Presses a grip: opens a transaction that drags it, if it can be dragged.
fn grab(session: &mut Session, grip: Grip, ray: Ray, forward: Vec3) -> Outcome {
    if !grip.has_valid_axis() {
        return Outcome::default();
    }
    session.act(Consequence::Press);
    let drag = joints::grab(session, grip, ray, forward);
    drag.map(|drag| Consequence::Begin(Some(Box::new(drag)))).into()
}

/// Changes the open drag and edits what it drags.
fn drag(session: &mut Session, change: impl FnOnce(&mut Drag)) -> Outcome {
    let Some((grip, dragged)) = session.change_drag(change) else { return Outcome::default() };
    joints::drag(session, grip, dragged)
}
