use crate::document::Document;

/// The unit of lengths in a BVH file, which the file itself does not have.
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

/// Length in metres of the unit of a file that is read, taken to be a centimetre.
pub const METRES_PER_UNIT: f32 = 0.01;

impl BvhUnit {
    /// Length of a unit of the document, in this unit.
    pub fn per_unit(self, document: &Document) -> f64 {
        let per_metre = match self {
            Self::Centimetres => METRES_PER_UNIT.recip(),
            Self::Metres => 1.0,
            Self::Scene => return 1.0,
        };
        f64::from(document.metres_per_unit() * per_metre)
    }
}
