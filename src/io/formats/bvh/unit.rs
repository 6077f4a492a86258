use crate::document::Document;

/// The unit of lengths in an exported BVH file. The file itself does not name its unit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum BvhUnit {
    /// The usual unit of BVH.
    #[default]
    Centimetres,
    /// Metres.
    Metres,
    /// The unit of the document.
    Scene,
}

/// Assumed length of the unit of an imported BVH file, in metres: one centimetre.
pub const METRES_PER_UNIT: f32 = 0.01;

impl BvhUnit {
    /// Length of one unit of the document, measured in this unit.
    pub fn per_unit(self, document: &Document) -> f64 {
        let per_metre = match self {
            Self::Centimetres => METRES_PER_UNIT.recip(),
            Self::Metres => 1.0,
            Self::Scene => return 1.0,
        };
        f64::from(document.metres_per_unit() * per_metre)
    }
}
