use glam::Vec3;

/// The Cursor, the hand's target: a point and the space in which it is fixed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Cursor {
    /// In Root space: it moves with the shoulder.
    Root(Vec3),
    /// Pinned to the world: it stays when the shoulder moves.
    World(Vec3),
}

impl Cursor {
    /// The Cursor in Root space, for a shoulder at `root` in the world. Overflow is clamped to
    /// ±`f32::MAX`.
    pub fn in_root(self, root: Vec3) -> Vec3 {
        match self {
            Self::Root(point) => point,
            Self::World(point) => clamped(point - root),
        }
    }

    /// The Cursor in the world, for a shoulder at `root` in the world. Overflow is clamped to
    /// ±`f32::MAX`.
    pub fn in_world(self, root: Vec3) -> Vec3 {
        match self {
            Self::Root(point) => clamped(root + point),
            Self::World(point) => point,
        }
    }
}

fn clamped(point: Vec3) -> Vec3 {
    point.clamp(Vec3::MIN, Vec3::MAX)
}
