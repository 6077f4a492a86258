use core::f64::consts::TAU;

use glam::{Affine3A, Vec3};

use crate::skeleton::{JointId, Skeleton};

/// A path that a chain of joints follows, as a snake follows its head. The chain is a root, called the
/// head, that root's first child, and so on.
///
/// If limits keep a joint's tip off the path, the next joint starts at that tip and turns back towards the
/// path. Locked joints follow, too.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FollowPath {
    /// The head: a joint without a parent.
    pub root: JointId,
    /// What moves the head.
    pub kind: PathKind,
}

/// What moves the head of a chain that follows a path.
///
/// Behind the path that a key or a target gives, the joints' own angles give the line of the body. A
/// joint keeps its roll as far as the least rotation from its own direction to the path does; where the
/// path turns back in space, the roll can turn quickly.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PathKind {
    /// The head moves around a ring.
    Ring(WavyRing),
    /// The keys of the head move it, and the chain follows the path that the head has travelled since its
    /// first key. Until then, or without keys, the joints keep their own angles.
    Head,
    /// The enabled target of the head moves it, and the chain follows the path that the target has
    /// travelled. That target moves nothing else, whatever its influence. Without such a target the
    /// joints keep their own angles.
    Target,
}

impl PathKind {
    /// True if the path has finite lengths and a period above 0.
    pub fn is_valid(&self) -> bool {
        match self {
            Self::Ring(WavyRing { radius, amplitude, waves: _, period }) => {
                let are_finite = [radius, amplitude, period].into_iter().all(|it| it.is_finite());
                are_finite && *period > 0.0
            }
            Self::Head | Self::Target => true,
        }
    }
}

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
