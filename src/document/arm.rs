use glam::Vec3;

use crate::kinematics::two_bone::{Facing, LengthError, Pose, TwoBone};
use crate::rig::ArmRig;

/// The arm as the user set it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Arm {
    /// Where the hand is asked to be, in Root space.
    pub cursor: Vec3,
    /// ψ, radians.
    pub elbow_spin: f32,
    /// The shoulder, in the world.
    pub root: Vec3,
    pub bones: TwoBone,
    /// Where the arm last faced: decides for a cursor that does not say.
    pub facing: Facing,
}

impl Arm {
    /// An arm in the seed's first pose.
    ///
    /// # Errors
    ///
    /// Refuses a length that no bone can have.
    pub fn new(upper: f32, lower: f32) -> Result<Self, LengthError> {
        let cursor = Vec3::new(250.0, 120.0, 60.0);
        Ok(Self {
            cursor,
            elbow_spin: 0.0,
            root: Vec3::ZERO,
            bones: TwoBone::new(upper, lower)?,
            facing: Facing::towards(cursor, Facing::default()),
        })
    }

    pub fn pose(&self) -> Pose {
        self.bones.solve_from(self.cursor, self.elbow_spin, self.facing)
    }

    pub fn rig(&self, pose: &Pose) -> ArmRig {
        ArmRig::new(self.bones, self.root, self.cursor, pose)
    }

    /// Where the hand is asked to be, in the world.
    pub fn cursor_world(&self) -> Vec3 {
        self.root + self.cursor
    }

    /// Lengths that no bones can have change nothing.
    pub(super) fn set_lengths(&mut self, upper: f32, lower: f32) {
        self.bones = TwoBone::new(upper, lower).unwrap_or(self.bones);
    }

    /// A sphere around the arm as it stands, in the world: centre and radius.
    pub fn bounds(&self, pose: &Pose) -> (Vec3, f32) {
        let points = [Vec3::ZERO, pose.elbow, pose.hand];
        let low = points.into_iter().fold(Vec3::MAX, Vec3::min);
        let high = points.into_iter().fold(Vec3::MIN, Vec3::max);
        let centre = low.midpoint(high);
        let reach = points.into_iter().map(|point| point.distance(centre)).fold(0.0, f32::max);
        (self.root + centre, reach.max(self.bones.outer_limit() * 0.5))
    }
}

impl Default for Arm {
    /// The seed's arm: 200 and 300 long.
    fn default() -> Self {
        const SEED: (f32, f32) = (200.0, 300.0);
        Self::new(SEED.0, SEED.1).unwrap_or_else(|_| unreachable!("200 and 300 are lengths"))
    }
}
