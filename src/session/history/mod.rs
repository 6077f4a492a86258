//! The document with its open transaction, and the steps to undo and redo.

pub mod editing;
pub mod steps;
pub mod transaction;
