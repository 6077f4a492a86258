//! Channels of colours from 0 to 1: sRGB in this program, linear in materials of glTF.

pub fn linear(srgb: f32) -> f32 {
    if srgb <= 0.04045 { srgb / 12.92 } else { ((srgb + 0.055) / 1.055).powf(2.4) }
}

/// The sRGB channel of a linear one, which is clamped to 0 to 1.
pub fn srgb(linear: f32) -> f32 {
    match linear {
        1.0.. => 1.0,
        0.003_130_8.. => 1.055 * linear.powf(1.0 / 2.4) - 0.055,
        0.0.. => 12.92 * linear,
        _ => 0.0,
    }
}
