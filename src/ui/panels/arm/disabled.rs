//! Reasons why controls of the arm are disabled.

/// Shown on controls that only act in IK.
pub(in crate::ui) const ANGLES_LEAD: &str = "Switch to IK to set this";
