use crate::kinematics::skeleton::{JointId, Skeleton};

/// Change of a skeleton's tree of joints, as far as indices of joints depend on it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum TreeChange {
    /// All joints have kept their indices; others may have been appended.
    Kept,
    /// The joints from an index on were removed; `parent` is that of the first of them.
    Shortened { parent: Option<JointId> },
    /// Joints were renumbered or attached to other parents.
    Rebuilt,
}

impl TreeChange {
    pub fn between(before: &Skeleton, after: &Skeleton) -> Self {
        let [before, after] = [before, after].map(Skeleton::joints);
        let keep_their_parents = before.iter().zip(after).all(|(a, b)| a.parent == b.parent);
        let keep_their_names = || before.iter().zip(after).all(|(a, b)| a.name == b.name);
        match before.get(after.len()) {
            None if keep_their_parents => Self::Kept,
            Some(removed) if keep_their_parents && keep_their_names() => {
                Self::Shortened { parent: removed.parent }
            }
            _ => Self::Rebuilt,
        }
    }
}
