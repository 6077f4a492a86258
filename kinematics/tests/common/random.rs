use std::f32::consts::PI;
use std::ops::Range;

use glam::{EulerRot, Mat3, Quat, Vec3};

/// A generator of numbers (SplitMix64), and of what is made of numbers alone. Its field is the
/// seed.
pub struct Random(pub u64);

impl Random {
    pub fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    // Choices

    pub fn below(&mut self, bound: usize) -> usize {
        (self.next() % bound as u64) as usize
    }

    pub fn chance(&mut self, probability: f32) -> bool {
        self.within(0.0..1.0) < probability
    }

    pub fn coin(&mut self) -> bool {
        self.below(2) == 0
    }

    pub fn one_of<T: Copy>(&mut self, all: &[T]) -> T {
        all[self.below(all.len())]
    }

    // Numbers

    pub fn within(&mut self, range: Range<f32>) -> f32 {
        let fraction = (self.next() >> 40) as f32 / (1_u64 << 24) as f32;
        range.start + (range.end - range.start) * fraction
    }

    /// Uniform in its logarithm.
    pub fn power_of_ten(&mut self, exponents: Range<f32>) -> f64 {
        10_f64.powf(self.within(exponents).into())
    }

    /// Any finite number, often -0.
    pub fn finite(&mut self) -> f32 {
        loop {
            let value = f32::from_bits(self.next() as u32);
            if self.below(16) == 0 {
                return -0.0;
            }
            if value.is_finite() {
                return value;
            }
        }
    }

    /// Any finite number above 0.
    pub fn positive(&mut self) -> f32 {
        self.finite().abs().max(f32::from_bits(1))
    }

    // Vectors

    /// Coordinates within ±`size`.
    pub fn vector(&mut self, size: f32) -> Vec3 {
        Vec3::from_array([(); 3].map(|()| self.within(-size..size)))
    }

    /// Any finite coordinates.
    pub fn finite_vector(&mut self) -> Vec3 {
        Vec3::from_array([(); 3].map(|()| self.finite()))
    }

    /// Uniform on the unit sphere.
    pub fn direction(&mut self) -> Vec3 {
        loop {
            let v = self.vector(1.0);
            if (0.01..1.0).contains(&v.length_squared()) {
                return v.normalize();
            }
        }
    }

    /// Euler angles, each within ±π.
    pub fn angles(&mut self) -> Vec3 {
        self.vector(PI)
    }

    pub fn rotation(&mut self) -> Mat3 {
        let Vec3 { x, y, z } = self.angles();
        Mat3::from_quat(Quat::from_euler(EulerRot::ZYX, z, y, x))
    }
}
