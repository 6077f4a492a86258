use core::fmt;

use crate::kinematics::two_bone::TwoBone;

/// Decimals of the lengths of a limb, which depend on its size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LengthFormat {
    cell: f32,
}

impl LengthFormat {
    /// The format for limbs of these lengths.
    pub fn of_limb(bones: TwoBone) -> Self {
        Self::of_length(bones.outer_limit())
    }

    /// The format for limbs of a length.
    pub fn of_length(length: f32) -> Self {
        const FRACTION: f32 = 0.2;
        let cell = 10_f32.powf((length * FRACTION).log10().round());
        Self { cell: if cell.is_normal() { cell } else { 1.0 } }
    }

    /// Width of a cell of a grid around the limb: the power of ten nearest to a fifth of its
    /// length.
    pub fn cell(self) -> f32 {
        self.cell
    }

    /// Number of decimals with which a thousandth of a cell is visible, from 0 to 8.
    pub fn decimals(self) -> usize {
        (3.0 - self.cell.log10().round()).clamp(0.0, 8.0) as usize
    }

    /// A length as text, rounded to a thousandth of a cell.
    pub fn show(self, length: f32) -> String {
        ShownLength { length, decimals: self.decimals() }.to_string()
    }
}

/// Writes a length with some decimals, and a very large one in scientific notation.
pub(crate) struct ShownLength {
    pub length: f32,
    pub decimals: usize,
}

impl fmt::Display for ShownLength {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        const LARGE: f32 = 1e9;
        let Self { length, decimals } = *self;
        match length.abs() {
            size if size.is_nan() || size >= f32::MAX => f.write_str("overflow"),
            LARGE.. => write!(f, "{length:.3e}"),
            _ => write!(f, "{length:.decimals$}"),
        }
    }
}
