//! Reasons why controls of the arm are disabled.

/// Why what the hand leads cannot be set.
pub(in crate::ui) const ANGLES_LEAD: &str = "Switch to IK to set this";
