//! The timeline by the keyboard.
