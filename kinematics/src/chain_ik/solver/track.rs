//! Tracking: each step of a motion continues from the configuration of the step before.
//!
//! Solving each frame anew gives a map from targets to poses that is not continuous: neighbouring
//! frames fall into different minima. A step goes on from the last one instead, without restarts:
//!
//! 1. Each joint keeps its rotation relative to the FK pose: it turns by what the FK pose turned,
//!    q ← q · FK⁻¹(before) · FK(now).
//! 2. The configuration moves towards the FK pose in the null space of the targets, by at most
//!    γ·s/L with the posture rate γ, the length L of the longest chain and the largest change s of a tip's way to its
//!    target. Without this, a pose would not return after a closed path of the targets, and limited
//!    chains would lose targets.
//! 3. The method iterates to a fraction of s, so that slow motions do not proceed in leaps. A
//!    target that was lost is approached by at most s + 0.02·L in a step.
//!
//! If s is above 0.1·L, the target or the FK pose has jumped, and the step is a run with restarts.
//! If nothing has changed since a step that ended, its configuration is kept, bit for bit.

use glam::{Quat, Vec3A};

use super::ChainSolver;
use crate::chain_ik::configuration::Configuration;
use crate::chain_ik::inside::Recorder;
use crate::chain_ik::problem::{EndEffector, HeldLimb, Problem, Wanted};
use crate::chain_ik::report::{Report, Status};
use crate::chain_ik::tracker::Tracker;
use crate::chain_ik::{ChainTarget, SolveError, SolverOptions};
use crate::skeleton::Skeleton;
use crate::vector::saturate;

/// Part of the targets' motion to which a step is solved.
const FINENESS: f64 = 1.0 / 50.0;
/// The finest tolerance of a step, in chain lengths; below it is rounding.
const FINEST: f64 = 1e-6;
/// The way, beside the targets' motion, by which a step may approach a target that was lost, in
/// chain lengths.
const CATCH_UP: f64 = 0.02;
/// The part of the way to a target that was lost by which a step must approach it at least, or the
/// target is out of reach.
const LEAST_APPROACH: f64 = 1e-2;
/// Motion of a target beyond which it has jumped, in chain lengths.
const JUMP: f64 = 0.1;
/// The least gain of an iteration, as a part of the distance that is left: a step ends whose
/// iterations gain less, on average over the method's patience.
const LEAST_GAIN: f64 = 1e-4;

/// The result of a step of a motion.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct TrackStep {
    /// Iterations and error of this step.
    pub report: Report,
    /// Largest change of the vector from a tip to its target since the last step, before this step
    /// moved the tips and with the tips as the FK pose takes them along; in world units.
    pub target_motion: f32,
    /// Largest distance by which this step moved a joint or a tip from where the FK pose took it,
    /// in world units. A multiple of `target_motion` is a pop.
    pub joint_motion: f32,
    /// True if a target was too far away to be reached in this step. Further steps approach it,
    /// also while it rests.
    pub is_held_back: bool,
    /// True if a target or the FK pose has jumped: the step was a run with restarts.
    pub has_jumped: bool,
}

impl TrackStep {
    fn at_rest(report: Report) -> Self {
        Self {
            report,
            target_motion: 0.0,
            joint_motion: 0.0,
            is_held_back: false,
            has_jumped: false,
        }
    }
}

impl ChainSolver {
    /// Makes the next step of a motion: continues from the present configuration to targets and an
    /// FK pose that have moved a little. Small motions of targets give small motions of joints,
    /// also at limits and out of reach, where [`ChainSolver::run`] from each frame's FK pose would
    /// jump.
    ///
    /// Prepare the solver with the first frame and [run](ChainSolver::run) it; then call this for
    /// each frame, and [`ChainSolver::write`] to a copy of the FK pose. The result depends on the
    /// frames before: a motion is a track.
    ///
    /// `targets` must be for the joints of the solver's targets, in the same order; points and
    /// weights may differ. `fk` is the skeleton in the FK pose of this frame: its angles, offsets,
    /// bones, frames, limits and transform may differ from those before, but not the parents and
    /// locks of the joints between targets and roots. After the first call, nothing is allocated.
    ///
    /// ```
    /// use glam::Vec3;
    /// use ik_arm_kinematics::chain_ik::{ChainSolver, SolverOptions, ChainTarget};
    /// use ik_arm_kinematics::skeleton::{Joint, JointId, Skeleton};
    ///
    /// let mut fk = Skeleton::with_root("root");
    /// let mut tip = JointId::new(0);
    /// for name in ["a", "b", "c", "d"] {
    ///     tip = fk.add(Joint { offset: fk[tip].axis, ..Joint::new(name, Some(tip), Vec3::Y) })?;
    /// }
    /// let target = |frame: u16| {
    ///     let (sin, cos) = (f32::from(frame) / 60.0).sin_cos();
    ///     ChainTarget::at(tip, Vec3::new(2.0 + cos, sin, 0.5))
    /// };
    /// let mut solver = ChainSolver::new(&fk, &[target(0)], &SolverOptions::default())?;
    /// solver.run();
    /// let mut posed = fk.clone();
    /// for frame in 1..240 {
    ///     let step = solver.track(&[target(frame)], &fk)?;
    ///     assert!(step.joint_motion < 4.0 * step.target_motion, "no joint pops");
    ///     solver.write(&mut posed);
    ///     assert!(posed.tip(tip).distance(target(frame).point) < 1e-3);
    /// }
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    ///
    /// [`SolveError::NoJoint`] for targets of other joints or in another order;
    /// [`SolveError::OtherJoint`]; [`SolveError::CannotStiffen`]; [`SolveError::Point`]; [`SolveError::Weight`];
    /// [`SolveError::Singular`]; [`SolveError::TwoBone`] if a bone has lost its length. The
    /// configuration is unchanged.
    pub fn track(
        &mut self,
        targets: &[ChainTarget],
        fk: &Skeleton,
    ) -> Result<TrackStep, SolveError> {
        self.check_targets(targets)?;
        let tracker = self.tracker.take();
        let new = || Box::new(Tracker::new(&self.problem, &self.config));
        let mut tracker = tracker.unwrap_or_else(new);
        let step = self.track_with(&mut tracker, targets, fk);
        self.tracker = Some(tracker);
        step
    }

    /// [`ChainSolver::track`] for a centre of mass of a body with limbs whose tips are held.
    pub(crate) fn track_with_limbs(
        &mut self,
        targets: &[ChainTarget],
        limbs: &[HeldLimb],
        fk: &Skeleton,
    ) -> Result<TrackStep, SolveError> {
        self.builder.held_limbs.clear();
        self.builder.held_limbs.extend_from_slice(limbs);
        self.track(targets, fk)
    }

    /// Brings the configuration as near to the FK pose as the targets allow, if they are reached:
    /// to where [tracking](ChainSolver::track) would bring it after long motions, so that a motion
    /// that begins here closes its loops.
    pub fn relax(&mut self) {
        /// Most steps.
        const STEPS: usize = 200;
        /// Assumed motion of a target in a step, in chain lengths.
        const MOTION: f64 = 1e-2;
        /// Motion of a joint, in chain lengths, below which the configuration rests.
        const RESTS: f64 = 1e-4;
        if !self.report.converged() {
            return;
        }
        let tracker = self.tracker.take();
        let new = || Box::new(Tracker::new(&self.problem, &self.config));
        let mut tracker = tracker.unwrap_or_else(new);
        self.update_angles();
        for _ in 0..STEPS {
            tracker.mark(&self.config);
            self.follow(&mut tracker, MOTION * self.problem.world_length());
            if tracker.displacement(&self.config) < RESTS * f64::from(self.problem.length) {
                break;
            }
        }
        tracker.was_held_back = false;
        self.tracker = Some(tracker);
    }

    fn track_with(
        &mut self,
        tracker: &mut Tracker,
        targets: &[ChainTarget],
        fk: &Skeleton,
    ) -> Result<TrackStep, SolveError> {
        self.builder.fill(&mut tracker.next, fk, targets)?;
        super::check_stiffness(self.options.method, &tracker.next)?;
        super::check_hinges(self.options.method, &tracker.next, targets)?;
        tracker.next.carry_origins(&self.problem);
        tracker.next.set_targets(targets);
        if self.is_settled() && !tracker.was_held_back && tracker.next == self.problem {
            tracker.last_motion = 0.0;
            return Ok(TrackStep::at_rest(self.report));
        }
        self.update_angles();
        let SolverOptions { damping, step, .. } = self.options;
        self.state.refit(&tracker.next, &self.config, damping, step)?;
        let motion = tracker.take_along(&mut self.problem, &mut self.config);
        self.tolerance = self.options.tolerance_of(&self.problem);
        let has_jumped = motion > JUMP * self.problem.world_length();
        if has_jumped {
            self.set_targets(targets);
            self.run();
            tracker.was_held_back = false;
        } else {
            tracker.was_held_back = self.follow(tracker, motion);
            self.problem.set_targets(targets);
        }
        tracker.last_motion = motion;
        let joint_motion = self.problem.length_to_world(tracker.displacement(&self.config));
        Ok(TrackStep {
            report: self.report,
            target_motion: saturate(motion),
            joint_motion: saturate(joint_motion),
            is_held_back: tracker.was_held_back,
            has_jumped,
        })
    }

    /// Moves towards the FK pose, then to the targets. Returns whether a target was too far away to
    /// be reached in this step, and came nearer.
    fn follow(&mut self, tracker: &mut Tracker, motion: f64) -> bool {
        let length = self.problem.world_length();
        let reach = motion + CATCH_UP * length;
        let most_way = self.problem.length_from_world(reach) as f32;
        let is_far = hold_back(&mut self.problem, &self.config, most_way);
        let most_turn = (f64::from(self.options.posture_rate) * motion / length) as f32;
        tracker.move_to_fk(&self.problem, &mut self.config, most_turn);
        let before = self.config.total_error(&self.problem);
        // Not finer than the step before: a short step, such as to a time between two frames, would
        // iterate from a pose that was solved less finely, and move the joints for that alone.
        let fineness = FINENESS * motion.max(tracker.last_motion);
        let finest = self.tolerance.min(fineness).max(FINEST * length);
        self.approach(self.problem.length_from_world(finest));
        let gain = before - self.config.total_error(&self.problem);
        is_far && gain > LEAST_APPROACH * reach
    }

    /// Iterates without restarts until the tips are within `tolerance` of their points, in the
    /// problem's units, or further iterations gain almost nothing. Makes at least one iteration.
    fn approach(&mut self, tolerance: f64) {
        self.begin();
        let window = self.report.method.row().patience.iterations();
        let mut best = self.config.farthest(&self.problem);
        let mut best_before = best;
        self.escape.best.copy_from(&self.config);
        loop {
            let can_go_on =
                self.state.iterate(&self.problem, &mut self.config, &mut Recorder::off());
            self.report.iterations += 1;
            let left = self.config.farthest(&self.problem);
            if left <= tolerance {
                break;
            }
            if left < best {
                best = left;
                self.escape.best.copy_from(&self.config);
            }
            let is_checked = self.report.iterations.is_multiple_of(window);
            let has_gained = best < best_before * (1.0 - f64::from(window) * LEAST_GAIN);
            if !can_go_on || is_checked && !has_gained || self.used_up().is_some() {
                self.config.copy_from(&self.escape.best);
                break;
            }
            if is_checked {
                best_before = best;
            }
        }
        self.measure();
        if self.report.status == Status::Iterating {
            self.report.status = Status::Stalled;
        }
    }
}

/// Brings the places and orientations to which joints move to at most `most` from where they are, in
/// the problem's units, until the targets are set again; a turn by φ counts as ℓ φ. Returns whether
/// one was farther away.
fn hold_back(problem: &mut Problem, config: &Configuration, most: f32) -> bool {
    let mut is_held_back = false;
    let most_turn = most / problem.turn_length() as f32;
    for (effector, tip) in problem.effectors.iter_mut().zip(&config.tips) {
        let way = effector.destination(*tip) - *tip;
        if effector.weight > 0.0 && way.length() > most {
            effector.target = if effector.has_shell() {
                effector.target - (way - way.clamp_length_max(most))
            } else {
                *tip + way.clamp_length_max(most)
            };
            is_held_back = true;
        }
        let turn = config.missing_turn(effector).map(|missing| missing.turn);
        if let Some(turn) = turn.filter(|turn| turn.length() > most_turn) {
            turn_back(effector, turn - turn.clamp_length_max(most_turn), config);
            is_held_back = true;
        }
    }
    is_held_back
}

/// Takes a turn, a rotation vector, from the wanted orientation of an end effector.
fn turn_back(effector: &mut EndEffector, turn: Vec3A, config: &Configuration) {
    let back = Quat::from_scaled_axis((-turn).into());
    let at = config.joint_of(effector);
    match effector.orientation.as_mut().map(|orienting| &mut orienting.wanted) {
        Some(Wanted::Rotation(wanted)) => *wanted = back * *wanted,
        Some(Wanted::Aim { point, .. }) => *point = at + back * (*point - at),
        None => {}
    }
}
