//! Comparison of pictures.

use image::RgbaImage;

/// Mean difference between the colours of two pictures.
pub fn difference(a: &RgbaImage, b: &RgbaImage) -> f64 {
    let sum: u64 = a.iter().zip(b.iter()).map(|(a, b)| u64::from(a.abs_diff(*b))).sum();
    sum as f64 / a.len() as f64
}
