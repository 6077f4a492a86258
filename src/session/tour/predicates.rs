//! Whether the user has done the task of a step. Each predicate compares the session with the
//! document that the step began with.

use core::f32::consts::{FRAC_PI_2, PI};

use super::goal::Goal;
use crate::document::{Document, TwistReferenceKind};
use crate::kinematics::chain_ik::Status;
use crate::session::session::Session;

/// Smallest distance that counts as a move, as a fraction of the length of the straight arm.
const MOVE: f32 = 0.05;
/// Largest distance that counts as none, as a fraction of the length of the straight arm.
const REST: f32 = 0.01;

/// Whether the goal is met in a step that began with the document `start`.
pub(super) fn is_met(goal: Goal, session: &Session, start: &Document) -> bool {
    match goal {
        Goal::PassOverTheShoulder => passed_over_the_shoulder(session, start),
        Goal::MoveTheHandByFk => moved_the_hand_by_fk(session, start),
        Goal::BendTheElbowAtARightAngle => bent_the_elbow_at_a_right_angle(session),
        Goal::TurnTheElbowAlongItsCircle => turned_the_elbow_along_its_circle(session, start),
        Goal::CloseTheHole => closed_the_hole(session),
        Goal::MoveTheCursorOutOfReach => moved_the_cursor_out_of_reach(session),
        Goal::SoftenTheLimits => softened_the_limits(session),
        Goal::ChooseTransport => chose_transport(session),
        Goal::MoveTheShoulderAndKeepTheHand => moved_the_shoulder_and_kept_the_hand(session, start),
        Goal::PlayByIk => plays_by_ik(session),
        Goal::RaceAllSolvers => raced_all_solvers(session),
        Goal::LeaveATargetOutOfReach => left_a_target_out_of_reach(session),
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

fn moved_the_hand_by_fk(session: &Session, start: &Document) -> bool {
    let moved = session.pose().hand.distance(start.arm.pose().hand);
    session.arm().influence == 0.0 && moved > MOVE * length(session)
}

fn bent_the_elbow_at_a_right_angle(session: &Session) -> bool {
    const TOLERANCE: f32 = 3.0 * PI / 180.0;
    (session.pose().elbow_angle() - FRAC_PI_2).abs() < TOLERANCE
}

fn turned_the_elbow_along_its_circle(session: &Session, start: &Document) -> bool {
    let (now, before) = (session.pose(), start.arm.pose());
    let (from, to) = (before.outward(), now.outward());
    from.dot(to) <= 0.0 && now.hand.distance(before.hand) < REST * length(session)
}

fn closed_the_hole(session: &Session) -> bool {
    session.arm().reach_limits().inner < REST * length(session)
}

fn moved_the_cursor_out_of_reach(session: &Session) -> bool {
    let arm = session.arm();
    let outer = arm.reach_limits().outer;
    arm.uses_ik() && arm.cursor_in_root().length() > outer * (1.0 + MOVE)
}

fn softened_the_limits(session: &Session) -> bool {
    session.arm().soft_reach.softness() >= 0.095
}

fn chose_transport(session: &Session) -> bool {
    session.arm().twist_reference == TwistReferenceKind::Transport
}

fn moved_the_shoulder_and_kept_the_hand(session: &Session, start: &Document) -> bool {
    let arm = session.arm();
    let hand = arm.root + session.pose().hand;
    let before = start.arm.root + start.arm.pose().hand;
    arm.root.distance(start.arm.root) > MOVE * length(session)
        && hand.distance(before) < REST * length(session)
}

fn plays_by_ik(session: &Session) -> bool {
    session.is_playing() && session.arm().influence == 1.0
}

fn raced_all_solvers(session: &Session) -> bool {
    session.comparison().is_some_and(|race| {
        !race.is_running() && race.runs().any(|run| run.report().status == Status::Converged)
    })
}

fn left_a_target_out_of_reach(session: &Session) -> bool {
    let farthest = session.farthest_target().map_or(0.0, |(_, miss)| miss);
    farthest > REST * session.skeleton_rig().reach()
}
