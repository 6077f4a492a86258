/// What to read of a file that has several skeletons or animations.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct OpenOptions {
    /// Name of the skeleton; `None` for the first.
    pub skeleton: Option<String>,
    /// Name of the animation, or its number in the file, from 0; `None` for the first that moves
    /// the skeleton.
    pub animation: Option<String>,
}

impl OpenOptions {
    /// Options that choose the skeleton with this name.
    pub fn of_skeleton(name: &str) -> Self {
        Self { skeleton: Some(name.to_owned()), ..Self::default() }
    }

    /// Options that choose the animation with this name or number.
    pub fn of_animation(name: &str) -> Self {
        Self { animation: Some(name.to_owned()), ..Self::default() }
    }
}
