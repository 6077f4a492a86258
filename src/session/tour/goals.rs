//! The goals of the steps: how the program notices that a task is done, and does it for the user.

use core::f32::consts::{FRAC_PI_2, PI, TAU};

use glam::{Quat, Vec3};

use super::steps::Goal;
use crate::document::{Document, Target, TwistReferenceKind};
use crate::kinematics::chain_ik::Status;
use crate::kinematics::skeleton::JointId;
use crate::kinematics::soft_reach::SoftReach;
use crate::kinematics::two_bone::TwoBone;
use crate::rig::{LimbFrames, LimbPart, LimbSettings, TargetKind};
use crate::session::action::Action;
use crate::session::limb::ShownLimb;
use crate::session::parts::PoseMode;
use crate::session::playback::PlaybackAction;
use crate::session::session::Session;
use crate::session::skeleton::joints::JointEdit;
use crate::session::skeleton::targets::TargetEdit;
use crate::session::solver::solvers::SolverAction;
use crate::session::solver::status::farthest_target;

/// Smallest distance that counts as a move, as a fraction of the length of the straight limb.
const MOVE: f32 = 0.05;
/// Largest distance that counts as none, as a fraction of the length of the straight limb.
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
            Self::PullTheBodyAlong => (pulled_the_body_along, pull_the_body_along),
        }
    }
}

/// Length of the straight limb.
fn length(session: &Session) -> f32 {
    session.limb().map_or(0.0, |limb| limb.frames.bones().outer_limit())
}

/// The first limb of the document with which a step began, in its pose at the start.
fn limb_of(start: &Document) -> Option<LimbFrames> {
    ShownLimb::frames(&start.at(start.timeline.start), None)
}

/// The target of the shown limb.
fn target(session: &Session) -> Option<Target> {
    let rig = session.rig();
    Some(rig.targets[rig.target(session.limb()?.target)?])
}

/// The action that changes the target of the shown limb.
fn with_target(session: &Session, change: impl FnOnce(Target) -> Target) -> Option<Action> {
    Some(TargetEdit::SetTarget(change(target(session)?)).into())
}

/// The action that changes the settings of the shown limb.
fn with_limb(
    session: &Session,
    change: impl FnOnce(LimbSettings) -> LimbSettings,
) -> Option<Action> {
    let limb = *target(session)?.limb()?;
    with_target(session, |target| Target { kind: TargetKind::Limb(change(limb)), ..target })
}

fn passed_over_the_shoulder(session: &Session, start: &Document) -> bool {
    let Some((limb, before)) = session.limb().zip(limb_of(start)) else { return false };
    let (from, hand) = (before.pose().hand, limb.frames.pose().hand);
    let is_above = hand.y > hand.x.abs() && hand.y > hand.z.abs();
    is_above && from.x * hand.x < 0.0 && hand.x.abs() > REST * length(session)
}

fn pass_over_the_shoulder(session: &Session) -> Vec<Action> {
    const STEPS: u16 = 72;
    let Some(limb) = session.limb() else { return Vec::new() };
    let cursor = limb.frames.posed.cursor;
    let part = |step| 1.0 - 2.0 * f32::from(step) / f32::from(STEPS);
    moves(session, (0..=STEPS).map(|step| cursor.with_x(cursor.x * part(step))))
}

fn moved_the_hand_by_fk(session: &Session, start: &Document) -> bool {
    let Some((limb, before)) = session.limb().zip(limb_of(start)) else { return false };
    let moved = limb.frames.pose().hand.distance(before.pose().hand);
    !limb.frames.uses_ik() && moved > MOVE * length(session)
}

fn move_the_hand_by_fk(session: &Session) -> Vec<Action> {
    let Some(joint) = session.limb().map(|limb| limb.target) else { return Vec::new() };
    let rotation = Vec3::Z * (0.5 * FRAC_PI_2);
    vec![
        TargetEdit::SwitchPoseMode { joint, mode: PoseMode::Angles }.into(),
        JointEdit::SetRotation { joint, rotation }.into(),
    ]
}

fn bent_the_elbow_at_a_right_angle(session: &Session, _: &Document) -> bool {
    const TOLERANCE: f32 = 3.0 * PI / 180.0;
    let is_right = |angle: f32| (angle - FRAC_PI_2).abs() < TOLERANCE;
    session.limb().is_some_and(|limb| is_right(limb.frames.pose().elbow_angle()))
}

fn bend_the_elbow_at_a_right_angle(session: &Session) -> Vec<Action> {
    move_to_distance(session, |bones| bones.upper().hypot(bones.lower()))
}

/// Moves the Cursor along its line from the base to a distance.
fn move_to_distance(session: &Session, distance: impl Fn(TwoBone) -> f32) -> Vec<Action> {
    let Some(limb) = session.limb() else { return Vec::new() };
    let at = limb.frames.posed.cursor.normalize_or_zero() * distance(limb.frames.bones());
    moves(session, [at].into_iter())
}

fn turned_the_elbow_along_its_circle(session: &Session, start: &Document) -> bool {
    let Some((limb, before)) = session.limb().zip(limb_of(start)) else { return false };
    let (now, before) = (limb.frames.pose(), before.pose());
    let (from, to) = (before.outward(), now.outward());
    from.dot(to) <= 0.0 && now.hand.distance(before.hand) < REST * length(session)
}

fn turn_the_elbow_along_its_circle(session: &Session) -> Vec<Action> {
    let turned = |limb: LimbSettings| LimbSettings { twist: limb.twist + 1.1 * FRAC_PI_2, ..limb };
    with_limb(session, turned).into_iter().collect()
}

fn closed_the_hole(session: &Session, _: &Document) -> bool {
    session.limb().is_some_and(|limb| limb.frames.limits.inner < REST * length(session))
}

fn close_the_hole(session: &Session) -> Vec<Action> {
    let Some(limb) = session.limb() else { return Vec::new() };
    let length = limb.frames.bones().upper();
    vec![JointEdit::SetLength { joint: limb.target, length }.into()]
}

fn moved_the_cursor_out_of_reach(session: &Session, _: &Document) -> bool {
    let is_out = |limb: &LimbFrames| {
        limb.uses_ik() && limb.posed.cursor.length() > limb.limits.outer * (1.0 + MOVE)
    };
    session.limb().is_some_and(|limb| is_out(&limb.frames))
}

fn move_the_cursor_out_of_reach(session: &Session) -> Vec<Action> {
    move_to_distance(session, |bones| 1.3 * bones.outer_limit())
}

fn softened_the_limits(session: &Session, _: &Document) -> bool {
    session.limb().is_some_and(|limb| limb.frames.posed.ik.soft_reach.softness() >= 0.095)
}

fn soften_the_limits(session: &Session) -> Vec<Action> {
    let soft = SoftReach::new(0.1, 1.0, 0.0);
    let softened =
        soft.map(|soft_reach| with_limb(session, |limb| LimbSettings { soft_reach, ..limb }));
    softened.ok().flatten().into_iter().collect()
}

fn chose_transport(session: &Session, _: &Document) -> bool {
    session.limb().is_some_and(|limb| limb.frames.posed.kind == TwistReferenceKind::Transport)
}

fn choose_transport(session: &Session) -> Vec<Action> {
    let Some(limb) = session.limb() else { return Vec::new() };
    let reference = TwistReferenceKind::Transport;
    let chosen = TargetEdit::SetReference { joint: limb.target, reference };
    // The moves change the place alone, so that they keep the reference that is chosen first.
    let mut all = vec![chosen.into()];
    all.extend(moves_with(session, round_trip(limb.frames.posed.cursor), Some(reference)));
    all
}

fn moved_the_shoulder_and_kept_the_hand(session: &Session, start: &Document) -> bool {
    let Some((limb, before)) = session.limb().zip(limb_of(start)) else { return false };
    let place = |limb: &LimbFrames, part| limb.origin(part);
    let moved = |part| place(&limb.frames, part).distance(place(&before, part));
    moved(LimbPart::Root) > MOVE * length(session) && moved(LimbPart::Hand) < REST * length(session)
}

fn move_the_shoulder_and_keep_the_hand(session: &Session) -> Vec<Action> {
    let Some(limb) = session.limb() else { return Vec::new() };
    let joint = JointId::default();
    let Some(root) = session.skeleton().joint(joint) else { return Vec::new() };
    let offset = root.offset + Vec3::Y * (0.2 * limb.frames.bones().outer_limit());
    vec![
        TargetEdit::Pin { joint: limb.target, is_pinned: true }.into(),
        JointEdit::SetOffset { joint, offset }.into(),
    ]
}

fn plays_by_ik(session: &Session, _: &Document) -> bool {
    session.playback().is_playing()
        && session.limb().is_some_and(|limb| limb.frames.posed.influence == 1.0)
}

fn play_by_ik(session: &Session) -> Vec<Action> {
    let Some(joint) = session.limb().map(|limb| limb.target) else { return Vec::new() };
    vec![
        TargetEdit::SwitchPoseMode { joint, mode: PoseMode::Hand }.into(),
        PlaybackAction::Play(true).into(),
    ]
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
    farthest > REST * session.rig().reach()
}

fn leave_a_target_out_of_reach(session: &Session) -> Vec<Action> {
    let at: Vec3 = session.skeleton().transform().translation.into();
    vec![JointEdit::SetTranslation(at + Vec3::Y * 0.3).into()]
}

fn pulled_the_body_along(session: &Session, start: &Document) -> bool {
    let (posed, before) = (session.posed(), start.at(start.timeline.start));
    let Some(chest) = session.skeleton().find("chest") else { return false };
    let moved = posed.skeleton().tip(chest).distance(before.skeleton().tip(chest));
    let is_reached = |(_, miss)| miss <= session.rig().tolerance();
    moved > MOVE * session.rig().reach() && farthest_target(posed).is_none_or(is_reached)
}

fn pull_the_body_along(session: &Session) -> Vec<Action> {
    let pulled = |target: Target| target.with_home(target.home + Vec3::new(0.3, 0.2, 0.6));
    with_target(session, pulled).into_iter().collect()
}

/// Moves of the target of the shown limb through points in Root space.
fn moves(session: &Session, points: impl Iterator<Item = Vec3>) -> Vec<Action> {
    moves_with(session, points, None)
}

/// Moves of the target of the shown limb through points in Root space, with another twist reference.
fn moves_with(
    session: &Session,
    points: impl Iterator<Item = Vec3>,
    reference: Option<TwistReferenceKind>,
) -> Vec<Action> {
    let (Some(limb), Some(mut target)) = (session.limb(), target(session)) else {
        return Vec::new();
    };
    if let (Some(settings), Some(reference)) = (target.limb_mut(), reference) {
        settings.reference = reference;
    }
    let (pose, time) = (session.posed().skeleton(), session.playback().time());
    let to = |point| target.placed(pose, time, limb.frames.in_world(point));
    points.map(|point| TargetEdit::SetTarget(to(point)).into()).collect()
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
