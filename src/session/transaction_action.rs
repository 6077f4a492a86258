use glam::Vec3;

use super::drag::Grip;
use super::point_drag::{Constraint, DragInput};
use crate::document::Ray;

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
