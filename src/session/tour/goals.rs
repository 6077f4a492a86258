//! The goals of the steps: how the program notices that a task is done, and does it for the user.

use core::f32::consts::{FRAC_PI_2, PI, TAU};

use glam::{Quat, Vec3};

use super::steps::Goal;
use crate::document::{Document, TwistReferenceKind};
use crate::kinematics::chain_ik::Status;
use crate::kinematics::soft_reach::SoftReach;
use crate::session::action::Action;
use crate::session::arm::edits::ArmEdit;
use crate::session::parts::PoseMode;
use crate::session::playback::PlaybackAction;
use crate::session::session::Session;
use crate::session::skeleton::joints::JointEdit;
use crate::session::solver::solvers::SolverAction;
use crate::session::solver::status::farthest_target;

/// Smallest distance that counts as a move, as a fraction of the length of the straight arm.
const MOVE: f32 = 0.05;
/// Largest distance that counts as none, as a fraction of the length of the straight arm.
const REST: f32 = 0.01;

/// Compares the session with the document with which the step began.
type IsMet = fn(&Session, &Document) -> bool;
/// Actions that do the task, with the scene as it is at the beginning of the step.
type Demonstration = fn(&Session) -> Vec<Action>;

impl Goal {
    /// True once the user has done the task of a step that began with the document `start`.
    pub(in crate::session) fn is_met(self, session: &Session, start: &Document) -> bool {
        let (is_met, _) = self.task();
        is_met(session, start)
    }

    /// Actions that do the task, with the scene as it is at the beginning of the step.
    pub(in crate::session) fn demonstration(self, session: &Session) -> Vec<Action> {
        let (_, demonstration) = self.task();
        demonstration(session)
    }

    fn task(self) -> (IsMet, Demonstration) {
        match self {
            Self::PassOverTheShoulder => (passed_over_the_shoulder, pass_over_the_shoulder),
            Self::MoveTheHandByFk => (moved_the_hand_by_fk, move_the_hand_by_fk),
            Self::BendTheElbowAtARightAngle => {
                (bent_the_elbow_at_a_right_angle, bend_the_elbow_at_a_right_angle)
            }
            Self::TurnTheElbowAlongItsCircle => {
                (turned_the_elbow_along_its_circle, turn_the_elbow_along_its_circle)
            }
            Self::CloseTheHole => (closed_the_hole, close_the_hole),
            Self::MoveTheCursorOutOfReach => {
                (moved_the_cursor_out_of_reach, move_the_cursor_out_of_reach)
            }
            Self::SoftenTheLimits => (softened_the_limits, soften_the_limits),
            Self::ChooseTransport => (chose_transport, choose_transport),
            Self::MoveTheShoulderAndKeepTheHand => {
                (moved_the_shoulder_and_kept_the_hand, move_the_shoulder_and_keep_the_hand)
            }
            Self::PlayByIk => (plays_by_ik, play_by_ik),
            Self::RaceAllSolvers => (raced_all_solvers, race_all_solvers),
            Self::LeaveATargetOutOfReach => {
                (left_a_target_out_of_reach, leave_a_target_out_of_reach)
            }
        }
    }
}

/// Length of the straight arm.
fn length(session: &Session) -> f32 {
    session.arm().bones.outer_limit()
}

fn passed_over_the_shoulder(session: &Session, start: &Document) -> bool {
    let (from, hand) = (start.arm.pose().hand, session.pose().hand);
    let is_above = hand.y > hand.x.abs() && hand.y > hand.z.abs();
    is_above && from.x * hand.x < 0.0 && hand.x.abs() > REST * length(session)
}

fn pass_over_the_shoulder(session: &Session) -> Vec<Action> {
    const STEPS: u16 = 72;
    let cursor = session.arm().cursor_in_root();
    let part = |step| 1.0 - 2.0 * f32::from(step) / f32::from(STEPS);
    moves((0..=STEPS).map(|step| cursor.with_x(cursor.x * part(step))))
}

fn moved_the_hand_by_fk(session: &Session, start: &Document) -> bool {
    let moved = session.pose().hand.distance(start.arm.pose().hand);
    session.arm().influence == 0.0 && moved > MOVE * length(session)
}

fn move_the_hand_by_fk(_: &Session) -> Vec<Action> {
    vec![ArmEdit::SwitchPoseMode(PoseMode::Angles).into(), ArmEdit::SetBend(0.5 * FRAC_PI_2).into()]
}

fn bent_the_elbow_at_a_right_angle(session: &Session, _: &Document) -> bool {
    const TOLERANCE: f32 = 3.0 * PI / 180.0;
    (session.pose().elbow_angle() - FRAC_PI_2).abs() < TOLERANCE
}

fn bend_the_elbow_at_a_right_angle(session: &Session) -> Vec<Action> {
    let cursor = session.arm().cursor_in_root();
    let bones = session.arm().bones;
    let distance = bones.upper().hypot(bones.lower());
    vec![ArmEdit::SetHand(cursor.normalize_or_zero() * distance).into()]
}

fn turned_the_elbow_along_its_circle(session: &Session, start: &Document) -> bool {
    let (now, before) = (session.pose(), start.arm.pose());
    let (from, to) = (before.outward(), now.outward());
    from.dot(to) <= 0.0 && now.hand.distance(before.hand) < REST * length(session)
}

fn turn_the_elbow_along_its_circle(session: &Session) -> Vec<Action> {
    vec![ArmEdit::SetTwist(session.arm().twist + 1.1 * FRAC_PI_2).into()]
}

fn closed_the_hole(session: &Session, _: &Document) -> bool {
    session.arm().reach_limits().inner < REST * length(session)
}

fn close_the_hole(session: &Session) -> Vec<Action> {
    let bones = session.arm().bones;
    vec![ArmEdit::SetLower(bones.upper()).into()]
}

fn moved_the_cursor_out_of_reach(session: &Session, _: &Document) -> bool {
    let arm = session.arm();
    let outer = arm.reach_limits().outer;
    arm.uses_ik() && arm.cursor_in_root().length() > outer * (1.0 + MOVE)
}

fn move_the_cursor_out_of_reach(session: &Session) -> Vec<Action> {
    let cursor = session.arm().cursor_in_root();
    let bones = session.arm().bones;
    let distance = 1.3 * bones.outer_limit();
    vec![ArmEdit::SetHand(cursor.normalize_or_zero() * distance).into()]
}

fn softened_the_limits(session: &Session, _: &Document) -> bool {
    session.arm().soft_reach.softness() >= 0.095
}

fn soften_the_limits(_: &Session) -> Vec<Action> {
    let soft = SoftReach::new(0.1, 1.0, 0.0);
    soft.into_iter().map(|soft| ArmEdit::SetSoftReach(soft).into()).collect()
}

fn chose_transport(session: &Session, _: &Document) -> bool {
    session.arm().twist_reference == TwistReferenceKind::Transport
}

fn choose_transport(session: &Session) -> Vec<Action> {
    let cursor = session.arm().cursor_in_root();
    let transport = ArmEdit::SetTwistReference(TwistReferenceKind::Transport);
    core::iter::once(transport.into()).chain(moves(round_trip(cursor))).collect()
}

fn moved_the_shoulder_and_kept_the_hand(session: &Session, start: &Document) -> bool {
    let arm = session.arm();
    let hand = arm.root + session.pose().hand;
    let before = start.arm.root + start.arm.pose().hand;
    arm.root.distance(start.arm.root) > MOVE * length(session)
        && hand.distance(before) < REST * length(session)
}

fn move_the_shoulder_and_keep_the_hand(session: &Session) -> Vec<Action> {
    let bones = session.arm().bones;
    vec![
        ArmEdit::PinHand(true).into(),
        ArmEdit::SetRoot(session.arm().root + Vec3::Y * (0.2 * bones.outer_limit())).into(),
    ]
}

fn plays_by_ik(session: &Session, _: &Document) -> bool {
    session.playback().is_playing() && session.arm().influence == 1.0
}

fn play_by_ik(_: &Session) -> Vec<Action> {
    vec![ArmEdit::SwitchPoseMode(PoseMode::Hand).into(), PlaybackAction::Play(true).into()]
}

fn raced_all_solvers(session: &Session, _: &Document) -> bool {
    session.solvers().comparison().is_some_and(|race| {
        !race.is_running() && race.runs().any(|run| run.report().status == Status::Converged)
    })
}

fn race_all_solvers(_: &Session) -> Vec<Action> {
    vec![SolverAction::Compare.into()]
}

fn left_a_target_out_of_reach(session: &Session, _: &Document) -> bool {
    let farthest = farthest_target(session.posed()).map_or(0.0, |(_, miss)| miss);
    farthest > REST * session.skeleton_rig().reach()
}

fn leave_a_target_out_of_reach(session: &Session) -> Vec<Action> {
    let at: Vec3 = session.skeleton().transform().translation.into();
    vec![JointEdit::SetTranslation(at + Vec3::Y * 0.3).into()]
}

/// Moves of the hand through points in Root space.
fn moves(points: impl Iterator<Item = Vec3>) -> Vec<Action> {
    points.map(|point| ArmEdit::SetHand(point).into()).collect()
}

/// A cone of directions around the middle of `from` and +y, once around and back.
fn round_trip(from: Vec3) -> impl Iterator<Item = Vec3> {
    const STEPS: u16 = 48;
    let axis = (from.normalize_or_zero() + Vec3::Y).normalize_or(Vec3::Y);
    (0..=STEPS).map(move |step| {
        let angle = TAU * f32::from(step) / f32::from(STEPS);
        if step == STEPS { from } else { Quat::from_axis_angle(axis, angle) * from }
    })
}
