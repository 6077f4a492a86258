/// An animation of a file.
#[derive(Clone, Debug, PartialEq)]
pub struct FileAnimation {
    /// Name, unique in the file.
    pub name: String,
    /// Time of the first key, in seconds.
    pub start: f64,
    /// Time of the last key, in seconds.
    pub end: f64,
    /// Number of joints of the skeleton that the animation moves against their parents.
    pub moving_joints: usize,
}

impl FileAnimation {
    /// Whether the animation moves the skeleton.
    pub fn moves(&self) -> bool {
        self.moving_joints > 0 && self.start < self.end
    }
}
