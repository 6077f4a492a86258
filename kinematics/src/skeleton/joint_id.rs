use core::fmt;

/// Maximum number of joints of a skeleton.
pub(super) const MOST_JOINTS: usize = 10_000;

/// The index of a joint in its skeleton.
///
/// An index is valid only for its own skeleton, and only until an edit moves joints; such an edit
/// returns a [`JointRemap`](super::JointRemap). For an index that a skeleton does not have,
///
/// - lookups return `None`, and tree queries find nothing,
/// - edits and solvers return an error and change nothing,
/// - indexing and transforms panic, as indexing a slice does.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(transparent))]
pub struct JointId(usize);

impl JointId {
    /// The joint at a position of [`Skeleton::joints`](super::Skeleton::joints).
    pub const fn new(index: usize) -> Self {
        Self(index)
    }

    /// The position in [`Skeleton::joints`](super::Skeleton::joints).
    pub const fn index(self) -> usize {
        self.0
    }
}

impl From<usize> for JointId {
    fn from(index: usize) -> Self {
        Self(index)
    }
}

impl From<JointId> for usize {
    fn from(joint: JointId) -> Self {
        joint.0
    }
}

/// Writes the index as a plain number.
impl fmt::Display for JointId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

/// New indices of joints after an edit, by old index.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct JointRemap(pub(super) Vec<Option<JointId>>);

impl JointRemap {
    /// The new index of `joint`; `None` if it was removed.
    pub fn get(&self, joint: JointId) -> Option<JointId> {
        self.0.get(joint.index()).copied().flatten()
    }
}
