//! The document's file, recent files, exports and what waits for them.

pub mod action;
#[expect(clippy::module_inception, reason = "the type that names the module has a file of its own")]
pub mod files;
pub mod link;
