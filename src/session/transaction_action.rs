use glam::Vec3;

use super::drag::Grip;
use super::point_drag::{Constraint, DragInput};
use crate::document::Ray;

/// Groups edits into one undo step, and moves through the steps.
#[derive(Clone, Debug, PartialEq)]
pub enum TransactionAction {
    /// Opens a transaction, such as a slider's drag.
    Begin,
    /// Makes one undo step of all edits since the transaction was opened.
    Commit,
    /// Discards all edits since the transaction was opened.
    Cancel,
    /// Undoes the last step; cancels the transaction if one is open.
    Undo,
    /// Redoes the step that was undone last.
    Redo,
    /// Opens a transaction that drags something in the viewport.
    Grab {
        /// The dragged point or ring.
        grip: Grip,
        /// The ray under the mouse.
        ray: Ray,
        /// Normal of the picture.
        forward: Vec3,
    },
    /// Moves the dragged point or ring.
    Drag(DragInput),
    /// Constrains the drag to an axis or a plane, or frees it.
    Constrain(Option<Constraint>),
    /// Sets the typed offset, which replaces that of the mouse.
    TypeOffset(String),
}
