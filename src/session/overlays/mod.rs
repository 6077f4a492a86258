//! What the viewport shows beside the document.

pub mod onion_skins;
#[expect(clippy::module_inception, reason = "the type that names the module has a file of its own")]
pub mod overlays;
pub mod session_overlays;
pub mod trail;
