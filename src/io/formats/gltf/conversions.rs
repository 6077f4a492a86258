//! Hermite's polynomials.

/// Weights of the cubic Hermite polynomial at a part of the way: of the first value, the slope
/// there, the last value, and the slope there.
pub fn hermite(s: f64) -> [f64; 4] {
    let (s2, s3) = (s * s, s * s * s);
    [2.0 * s3 - 3.0 * s2 + 1.0, s3 - 2.0 * s2 + s, 3.0 * s2 - 2.0 * s3, s3 - s2]
}
