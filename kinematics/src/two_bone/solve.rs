use glam::Vec3;

use super::bones::TwoBone;
use super::closed_form::{ClosedForm, ScaledBones};
use super::pointer::Pointer;
use super::pose::TwoBonePose;

impl TwoBone {
    /// Poses the hand at `cursor` (Root space) with the elbow turned by `twist` (ψ, radians,
    /// right-handed about the Pointer) from the Limb frame's +y.
    ///
    /// A cursor at the shoulder or straight above or below it takes its direction or yaw from
    /// [`Pointer::default`]; see [`Self::solve_from`].
    ///
    /// # Panics
    ///
    /// In debug builds, if an argument is not finite; in release builds the pose is then
    /// meaningless. Callers check numbers where they enter the program.
    #[must_use]
    pub fn solve(self, cursor: Vec3, twist: f32) -> TwoBonePose {
        self.solve_from(cursor, twist, Pointer::default())
    }

    /// As [`Self::solve`], with the previous pose's [`Pointer`] as `last`: a cursor at the shoulder
    /// takes its direction, and a cursor straight above or below the shoulder takes its yaw.
    #[must_use]
    pub fn solve_from(self, cursor: Vec3, twist: f32, last: Pointer) -> TwoBonePose {
        debug_assert!(cursor.is_finite(), "cursor is {cursor}");
        debug_assert!(twist.is_finite(), "twist is {twist}");
        let (sin, cos) = twist.sin_cos();
        let solved = ClosedForm::new::<true>(self, cursor, cos, sin, last);
        let pose = solved.pose(twist);
        TwoBonePose { hand: solved.hand_or(cursor), reach: Some(solved.reach), ..pose }
    }

    /// Poses the hand in the direction of `pointer` at `distance` from the shoulder, clamped to the
    /// limits. The pose has no cursor, so its reach is `None`.
    ///
    /// # Panics
    ///
    /// As [`Self::solve`].
    #[must_use]
    pub fn solve_at(self, pointer: Pointer, distance: f32, twist: f32) -> TwoBonePose {
        debug_assert!(distance.is_finite(), "distance is {distance}");
        debug_assert!(twist.is_finite(), "twist is {twist}");
        let (sin, cos) = twist.sin_cos();
        let scaled = ScaledBones::new(self);
        ClosedForm::at::<true>(scaled, pointer, distance * scaled.scale, cos, sin).pose(twist)
    }
}
