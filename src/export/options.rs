use crate::document::Theme;
use crate::io::BvhUnit;
use crate::kinematics::skin::Skinning;

/// Options of an export. Each format uses only the options that apply to it.
#[derive(Clone, Debug, PartialEq)]
pub struct ExportOptions {
    /// Frames per second; `None` for the timeline's frame rate.
    pub fps: Option<f64>,
    /// Width and height of a picture in pixels.
    pub size: (u32, u32),
    /// Theme of a picture.
    pub theme: Theme,
    /// Time of a single picture or mesh in seconds; `None` for the timeline's start.
    pub time: Option<f64>,
    /// Unit of lengths in a BVH file.
    pub unit: BvhUnit,
    /// How the joints of an OBJ file's mesh are blended; `None` for the document's way.
    pub skinning: Option<Skinning>,
}

impl ExportOptions {
    /// Maximum width and height that the program offers for a picture. A graphics device may have a
    /// lower limit.
    pub const MAX_SIDE: u32 = 8192;
}

impl Default for ExportOptions {
    fn default() -> Self {
        Self {
            fps: None,
            size: (1280, 800),
            theme: Theme::Dark,
            time: None,
            unit: BvhUnit::default(),
            skinning: None,
        }
    }
}
