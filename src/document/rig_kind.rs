use serde::{Deserialize, Serialize};

/// One of the two rigs of a document.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum RigKind {
    /// The two-bone arm.
    #[default]
    Arm,
    /// The skeleton with its targets.
    Skeleton,
}
