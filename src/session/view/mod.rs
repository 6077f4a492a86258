//! The camera with its drags and glides, the crowd, and what the view shows of a solver.

pub mod drag;
pub mod framing;
#[expect(clippy::module_inception, reason = "the type that names the module has a file of its own")]
pub mod view;
