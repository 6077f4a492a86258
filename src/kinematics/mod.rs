//! Pure numbers: solvers that know nothing of files, windows or GPUs.

pub mod two_bone;
