//! The reason why solvers are disabled.

use crate::session::Session;
use crate::ui::labels;

/// The reason why solvers are disabled; `None` if they can run.
pub(in crate::ui) fn why_not(session: &Session) -> Option<&'static str> {
    let rig = session.skeleton_rig();
    let enabled = rig.targets.iter().filter(|target| target.enabled);
    if let Some(reason) = enabled.filter_map(|it| labels::why_on_path(session, it.joint)).next() {
        Some(reason)
    } else if rig.targets.is_empty() {
        Some("Add a target to a joint first")
    } else if !rig.targets.iter().any(|target| target.enabled) {
        Some("Enable a target first")
    } else {
        None
    }
}
