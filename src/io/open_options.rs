use super::turn_up::Upwards;

/// What to read of a file that has several skeletons or animations, and which axis points up in it.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct OpenOptions {
    /// Name of the skeleton; `None` for the first.
    pub skeleton: Option<String>,
    /// Name of the animation, or its number in the file, from 0; `None` for the first that moves
    /// the skeleton.
    pub animation: Option<String>,
    /// The axis that points up; `None` for y, with a remark if it seems to be z.
    pub up: Option<Upwards>,
    /// Whether a document that has no camera gets the default one, instead of one that frames the
    /// skeleton: to frame it, its targets are solved for.
    pub without_camera: bool,
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

    /// Options that tell which axis points up.
    pub fn of_up(up: Upwards) -> Self {
        Self { up: Some(up), ..Self::default() }
    }
}
