//! Reasons why controls of the arm are disabled.

/// Reason shown on controls that act only in IK.
pub(in crate::ui) const ANGLES_LEAD: &str = "Switch to IK to set this";
