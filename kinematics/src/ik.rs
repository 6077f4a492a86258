//! Inverse kinematics of the arm with a choice of twist reference and of soft limits.
//!
//! [`Ik`] combines a [`TwoBone`] with a [`TwistReference`] and a [`SoftReach`]. With
//! [`TwistReference::Up`] and hard limits its results are those of [`TwoBone`], bit for bit.
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
//! times as fast as the cursor; r' = dD/dd is [`IkSolution::slope`], g the reference's
//! [gain](TwistReference::gain), d the cursor's distance from the shoulder. Where this bound is
//! infinite the elbow pops: at a straight or folded arm without softness (oₑ → 0 while r' = 1),
//! where the reference is singular (g → ∞), and at a cursor that crosses the shoulder (d → 0).

use glam::Vec3;

use super::soft_reach::SoftReach;
use super::twist::{TransportedFrame, TwistReference, angle_from_limb, remeasured};
use super::two_bone::{Pointer, Reach, TwoBone, TwoBonePose};

/// Bones with a twist reference and soft limits.
///
/// ```
/// use glam::Vec3;
/// use ik_arm_kinematics::ik::{Ik, IkState};
/// use ik_arm_kinematics::soft_reach::SoftReach;
/// use ik_arm_kinematics::twist::{Stereographic, TwistReference};
/// use ik_arm_kinematics::two_bone::TwoBone;
///
/// let ik = Ik {
///     bones: TwoBone::new(200.0, 300.0)?,
///     reference: TwistReference::Stereographic(Stereographic::default()),
///     soft_reach: SoftReach::new(0.1, 1.0, 0.0)?,
/// };
/// let solved = ik.solve(Vec3::new(0.0, 490.0, 0.0), 0.0, IkState::default());
/// assert!(solved.pose.distance < 490.0, "the hand lags behind before the arm is straight");
/// // The next solve continues from this one.
/// let next = ik.solve(Vec3::new(0.0, 480.0, 10.0), 0.0, solved.state());
/// assert!(next.pose.elbow.distance(solved.pose.elbow) < 30.0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Ik {
    /// The two bones.
    pub bones: TwoBone,
    /// Origin of the twist angle.
    pub reference: TwistReference,
    /// Behaviour of the hand near its limits.
    pub soft_reach: SoftReach,
}

/// State of an arm from which the next solve continues. It supplies the direction for a cursor at
/// the shoulder, the yaw for a cursor straight above or below the shoulder, and the twist reference
/// where that is singular. The default is an arm without a previous pose.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct IkState {
    /// Direction and yaw of the previous pose's Pointer.
    pub pointer: Pointer,
    /// Twist reference of the previous pose. With `None`, [`TwistReference::Transport`] begins at
    /// the stereographic direction.
    pub transported: Option<TransportedFrame>,
}

/// A solved arm.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct IkSolution {
    /// The pose.
    pub pose: TwoBonePose,
    /// The Pointer with the direction from which the twist was measured.
    pub transported: TransportedFrame,
    /// r' = dD/dd, the ratio of the hand's radial speed to the cursor's.
    pub slope: f32,
}

impl IkSolution {
    /// The state from which to solve the next pose.
    #[must_use]
    pub fn state(&self) -> IkState {
        IkState { pointer: self.pose.pointer, transported: Some(self.transported) }
    }
}

impl Ik {
    /// Poses the hand at `cursor` with the elbow at the angle `twist` (ψ) from the twist reference.
    /// `last` is the [state](IkSolution::state) of the previous pose.
    ///
    /// With softness or stretch, the reach is [`Reach::Reached`] if the hand is within 1e-6·L of
    /// the cursor.
    ///
    /// # Panics
    ///
    /// In debug builds, if an argument is not finite.
    #[must_use]
    pub fn solve(&self, cursor: Vec3, twist: f32, last: IkState) -> IkSolution {
        let pointer = Pointer::towards(cursor, last.pointer);
        let outward = self.reference.outward(pointer, last.transported);
        let transported = TransportedFrame { direction: pointer.direction, outward };
        let twist = match self.reference {
            TwistReference::Up => twist,
            _ => twist + angle_from_limb(pointer, outward),
        };
        let wanted = length(cursor);
        let extent = self.soft_reach.hand_distance(self.bones, wanted.min(f32::MAX));
        let pose = if self.soft_reach.is_hard() {
            self.bones.solve_from(cursor, twist, last.pointer)
        } else {
            let bones = self.bones.stretched(extent.stretch);
            let pose = bones.solve_at(pointer, extent.distance, twist);
            let hand = if extent.distance == wanted { cursor } else { pose.hand };
            let reach = Some(reach(extent.distance, wanted, self.bones));
            TwoBonePose { hand, reach, stretch: extent.stretch, ..pose }
        };
        IkSolution { pose, transported, slope: extent.slope }
    }

    /// Returns the cursor and the twist ψ, in [0, 2π), for which [`Self::solve`] gives `pose`. The
    /// elbow keeps its side even if the arm is straight or folded.
    ///
    /// A hand that soft limits cannot reach is brought as near as they allow. Stretch is a function
    /// of the hand's distance: for a pose with another stretch, the hand is kept and the elbow
    /// changes.
    #[must_use]
    pub fn matching(
        &self,
        pose: &TwoBonePose,
        transported: Option<TransportedFrame>,
    ) -> (Vec3, f32) {
        let distance = self.soft_reach.cursor_distance(self.bones, pose.distance);
        let cursor = if self.soft_reach.is_hard() || distance == pose.distance {
            pose.hand
        } else {
            (pose.pointer.direction * distance).clamp(Vec3::MIN, Vec3::MAX)
        };
        let pointer = Pointer::towards(cursor, pose.pointer);
        let reference = self.reference.angle(pointer, transported);
        (cursor, remeasured(angle_from_limb(pointer, pose.outward()), 0.0, reference))
    }
}

/// Reach of a hand at `distance` from the shoulder for a cursor at `wanted` from the shoulder.
pub(crate) fn reach(distance: f32, wanted: f32, bones: TwoBone) -> Reach {
    const NEAR: f64 = 1e-6;
    let near = NEAR * (f64::from(bones.upper()) + f64::from(bones.lower()));
    match f64::from(distance) - f64::from(wanted) {
        short if short < -near => Reach::TooFar,
        long if long > near => Reach::TooClose,
        _ => Reach::Reached,
    }
}

/// Length of a vector, computed in f64, where no square of an f32 overflows; infinite above
/// `f32::MAX`.
pub(crate) fn length(v: Vec3) -> f32 {
    v.as_dvec3().length() as f32
}
