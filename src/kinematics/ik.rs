//! Inverse kinematics of the arm with a choice of twist reference and of soft limits.
//!
//! [`Ik`] combines a [`TwoBone`] with a [`TwistReference`] and a [`SoftReach`]. With
//! [`TwistReference::Limb`] and hard limits its results are those of [`TwoBone`], bit for bit.
//!
//! Everything is in Root space, right-handed; lengths share any one unit, angles are radians.
//!
//! # Bound on the elbow speed
//!
//! With root, twist and lengths constant, no stretch, and a cursor no nearer to the shoulder than
//! 0.05·L, the elbow is at most
//!
//! ```text
//! hypot( r'·d₁·|D − hₑ| / (D·oₑ),  (d₁ + oₑ·g) / d )
//! ```
//!
//! times as fast as the cursor; r' = dD/dd is [`Solved::slope`], g the reference's
//! [gain](TwistReference::gain), d how far the cursor is from the shoulder. Where this is unbounded the
//! elbow pops: at a straight or folded arm without softness (oₑ → 0 while r' = 1), where the reference
//! is singular (g → ∞), and at a cursor that crosses the shoulder (d → 0).

use glam::Vec3;

use super::soft_reach::SoftReach;
use super::twist::{TransportedFrame, TwistReference, angle_from_limb, respun};
use super::two_bone::{Facing, Reach, TwoBone, TwoBonePose};

/// Bones with a twist reference and soft limits.
///
/// ```
/// use glam::Vec3;
/// use ik_arm::kinematics::ik::Ik;
/// use ik_arm::kinematics::soft_reach::SoftReach;
/// use ik_arm::kinematics::twist::{TwistReference, Stereographic};
/// use ik_arm::kinematics::two_bone::{Facing, TwoBone};
///
/// let ik = Ik {
///     bones: TwoBone::new(200.0, 300.0)?,
///     reference: TwistReference::Stereographic(Stereographic::default()),
///     soft_reach: SoftReach::new(0.1, 1.0, 0.0)?,
/// };
/// let solved = ik.solve(Vec3::new(0.0, 490.0, 0.0), 0.0, Facing::default(), None);
/// assert!(solved.pose.distance < 490.0, "the hand lags behind before the arm is straight");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ik {
    /// The two bones.
    pub bones: TwoBone,
    /// Origin of the twist angle.
    pub reference: TwistReference,
    /// Behaviour of the hand near its limits.
    pub soft_reach: SoftReach,
}

/// A solved arm, with the state that the next solve continues from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Solved {
    /// The pose.
    pub pose: TwoBonePose,
    /// The Pointer with the direction from which the twist was measured.
    pub transported: TransportedFrame,
    /// r' = dD/dd, the hand's radial speed per radial speed of the cursor.
    pub slope: f32,
}

impl Ik {
    /// Poses the hand at `cursor` with the elbow at the twist `spin` (ψ) from the reference.
    ///
    /// `last` and `transported` are [`TwoBonePose::facing`] and [`Solved::transported`] of the previous
    /// pose. They resolve a cursor without a direction and a singular reference, and
    /// [`TwistReference::Transport`] continues from them; without them it begins at the stereographic
    /// direction.
    ///
    /// With softness or stretch the hand is [`Reach::Reached`] when it is within 1e-6·L of the
    /// cursor.
    ///
    /// # Panics
    ///
    /// In debug builds, if an argument is not finite.
    pub fn solve(
        &self,
        cursor: Vec3,
        spin: f32,
        last: Facing,
        transported: Option<TransportedFrame>,
    ) -> Solved {
        let facing = Facing::towards(cursor, last);
        let outward = self.reference.outward(facing, transported);
        let transported = TransportedFrame { direction: facing.direction, outward };
        let spin = match self.reference {
            TwistReference::Limb => spin,
            _ => spin + angle_from_limb(facing, outward),
        };
        let asked = length(cursor);
        let extent = self.soft_reach.extent(self.bones, asked.min(f32::MAX));
        let pose = if self.soft_reach.is_hard() {
            self.bones.solve_from(cursor, spin, last)
        } else {
            let bones = self.bones.stretched(extent.stretch);
            let pose = bones.solve_at(facing, extent.distance, spin);
            let hand = if extent.distance == asked { cursor } else { pose.hand };
            let reach = reach(extent.distance, asked, self.bones);
            TwoBonePose { hand, reach, stretch: extent.stretch, ..pose }
        };
        Solved { pose, transported, slope: extent.slope }
    }

    /// Inverse of [`Self::solve`]: cursor and twist ψ in [0, 2π) of a pose. The side of the elbow is
    /// kept for a straight or folded arm too.
    ///
    /// A hand that soft limits cannot reach is brought as near as they allow. Stretch is a function of
    /// the hand's distance: a pose with another stretch keeps its hand and changes its elbow.
    pub fn matching(
        &self,
        pose: &TwoBonePose,
        transported: Option<TransportedFrame>,
    ) -> (Vec3, f32) {
        let distance = self.soft_reach.cursor_distance(self.bones, pose.distance);
        let cursor = if self.soft_reach.is_hard() || distance == pose.distance {
            pose.hand
        } else {
            (pose.facing.direction * distance).clamp(Vec3::MIN, Vec3::MAX)
        };
        let facing = Facing::towards(cursor, pose.facing);
        let reference = self.reference.angle(facing, transported);
        (cursor, respun(angle_from_limb(facing, pose.outward()), 0.0, reference))
    }
}

/// Whether a hand that is `distance` from the shoulder is as far out as a cursor.
pub(super) fn reach(distance: f32, asked: f32, bones: TwoBone) -> Reach {
    const NEAR: f64 = 1e-6;
    let near = NEAR * (f64::from(bones.upper()) + f64::from(bones.lower()));
    match f64::from(distance) - f64::from(asked) {
        short if short < -near => Reach::TooFar,
        long if long > near => Reach::TooClose,
        _ => Reach::Reached,
    }
}

/// In f64, where no square overflows. Infinite where it is more than the largest number: a hand that
/// is as far as that is not there.
pub(super) fn length(v: Vec3) -> f32 {
    v.as_dvec3().length() as f32
}
