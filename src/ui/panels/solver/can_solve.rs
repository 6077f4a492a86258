//! Reasons why no solver can run.

use crate::session::Session;

/// Why no solver can run.
pub(in crate::ui) fn why_not(session: &Session) -> Option<&'static str> {
    let rig = session.skeleton_rig();
    if rig.follow_path.is_some() {
        Some("The joints follow the head; there is nothing to solve")
    } else if rig.targets.is_empty() {
        Some("There is no target; add one to a joint")
    } else if !rig.targets.iter().any(|target| target.enabled) {
        Some("Every target is switched off")
    } else {
        None
    }
}
