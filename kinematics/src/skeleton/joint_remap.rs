use super::JointId;

/// New indices of joints after an edit, by old index.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct JointRemap(pub(super) Vec<Option<JointId>>);

impl JointRemap {
    /// The new index of `joint`; `None` if it was removed.
    pub fn get(&self, joint: JointId) -> Option<JointId> {
        self.0.get(joint.index()).copied().flatten()
    }
}
