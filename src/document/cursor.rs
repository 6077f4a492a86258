use glam::Vec3;

/// The Cursor, the hand's target: a point in Root space, a point in the world, and the switch
/// between them. The point that is not in use keeps its value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cursor {
    /// The Cursor in Root space while it is not pinned: it moves with the shoulder.
    pub in_root: Vec3,
    /// The Cursor in the world while it is pinned: it stays when the shoulder moves.
    pub in_world: Vec3,
    /// True if the Cursor is pinned to the world.
    pub is_pinned: bool,
}

impl Cursor {
    /// A Cursor that is not pinned, at a point in Root space. Its point in the world is the same
    /// for a shoulder at the origin.
    pub const fn unpinned(point: Vec3) -> Self {
        Self { in_root: point, in_world: point, is_pinned: false }
    }

    /// A Cursor that is pinned to a point in the world. Its point in Root space is the same for a
    /// shoulder at the origin.
    pub const fn pinned(point: Vec3) -> Self {
        Self { is_pinned: true, ..Self::unpinned(point) }
    }

    /// Position of the Cursor in Root space, for a shoulder at `root` in the world. Overflow is
    /// clamped to ±`f32::MAX`.
    pub fn position_in_root(self, root: Vec3) -> Vec3 {
        if self.is_pinned { clamped(self.in_world - root) } else { self.in_root }
    }

    /// Position of the Cursor in the world, for a shoulder at `root` in the world. Overflow is
    /// clamped to ±`f32::MAX`.
    pub fn position_in_world(self, root: Vec3) -> Vec3 {
        if self.is_pinned { self.in_world } else { clamped(root + self.in_root) }
    }

    /// Moves the Cursor to a point in Root space, for a shoulder at `root` in the world.
    pub fn move_in_root(&mut self, root: Vec3, point: Vec3) {
        match self.is_pinned {
            true => self.in_world = clamped(root + point),
            false => self.in_root = point,
        }
    }

    /// Pins the Cursor to the world or unpins it, for a shoulder at `root` in the world. The Cursor
    /// does not move: the point that comes into use is set to its position.
    #[must_use]
    pub fn with_pinned(self, is_pinned: bool, root: Vec3) -> Self {
        match (self.is_pinned, is_pinned) {
            (false, true) => Self { in_world: self.position_in_world(root), is_pinned, ..self },
            (true, false) => Self { in_root: self.position_in_root(root), is_pinned, ..self },
            _ => self,
        }
    }
}

fn clamped(point: Vec3) -> Vec3 {
    point.clamp(Vec3::MIN, Vec3::MAX)
}
