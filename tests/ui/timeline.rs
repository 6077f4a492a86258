//! The timeline by the pointer.
