use core::f64::consts::TAU;

use glam::{Affine3A, Vec3};

use crate::skeleton::Skeleton;

/// A closed path: a circle around the origin of skeleton space, at the height of the head, with
/// waves on it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WavyRing {
    /// Radius of the circle, in skeleton space.
    pub radius: f32,
    /// Amplitude of the waves, in skeleton space.
    pub amplitude: f32,
    /// Number of waves on the circle.
    pub waves: u32,
    /// Duration of one revolution in seconds.
    pub period: f32,
}

impl WavyRing {
    /// Point of the ring in skeleton space, at height 0, after `turns` revolutions around the
    /// circle.
    pub fn point(&self, turns: f64) -> Vec3 {
        let turn = turns.rem_euclid(1.0) * TAU;
        let wave = f64::from(self.amplitude) * (turn * f64::from(self.waves)).sin();
        let radius = f64::from(self.radius) + wave;
        Vec3::new((radius * turn.cos()) as f32, 0.0, (-radius * turn.sin()) as f32)
    }

    /// Number of revolutions around the circle up to a time in seconds.
    pub fn turns_at(&self, time: f64) -> f64 {
        time / f64::from(self.period)
    }

    /// Number of revolutions over which the ring is nearly straight.
    pub(super) fn stride(&self) -> f64 {
        const STRIDES_PER_WAVE: f64 = 64.0;
        1.0 / (STRIDES_PER_WAVE * f64::from(self.waves.max(1)))
    }

    /// Ends of two perpendicular diameters of the circle that encloses the ring, at height 0, in
    /// the world.
    pub fn corners(&self, skeleton: &Skeleton) -> [Vec3; 4] {
        let far = self.radius.abs() + self.amplitude.abs();
        [Vec3::X, Vec3::NEG_X, Vec3::Z, Vec3::NEG_Z]
            .map(|side| skeleton.transform().transform_point3(side * far))
    }

    /// Points of the ring in the world, from `from` to `to` revolutions. `transform` maps skeleton
    /// space to the world; `height` is the ring's height in skeleton space.
    pub fn trail(
        &self,
        transform: Affine3A,
        height: f32,
        from: f64,
        to: f64,
    ) -> impl Iterator<Item = Vec3> {
        const POINTS: usize = 256;
        let at = move |fraction: f64| from + (to - from) * fraction;
        (0..=POINTS)
            .map(move |index| self.point(at(index as f64 / POINTS as f64)) + Vec3::Y * height)
            .map(move |point| transform.transform_point3(point))
    }
}
