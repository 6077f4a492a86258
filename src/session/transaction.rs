use super::drag::Drag;
use super::snapshot::Snapshot;
use crate::document::Document;

/// Edits between press and release that become one undo step.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Transaction {
    /// The state that cancelling restores.
    pub before: Snapshot,
    /// The document from which drags start: as shown before the transaction, with later changes
    /// that a drag does not revert.
    pub shown: Document,
    /// The label of the latest edit; `None` before the first edit.
    pub label: Option<&'static str>,
    pub drag: Option<Drag>,
}
