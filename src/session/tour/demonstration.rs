//! Actions that do the task of a step, with its scene as it is at the beginning of the step.

use core::f32::consts::{FRAC_PI_2, TAU};

use glam::{Quat, Vec3};

use super::goal::Goal;
use crate::document::TwistReferenceKind;
use crate::kinematics::soft_reach::SoftReach;
use crate::session::action::Action;
use crate::session::edit_action::EditAction;
use crate::session::playback_action::PlaybackAction;
use crate::session::pose_mode::PoseMode;
use crate::session::session::Session;
use crate::session::solver_action::SolverAction;

pub(super) fn actions(goal: Goal, session: &Session) -> Vec<Action> {
    let arm = session.arm();
    let (cursor, bones) = (arm.cursor_in_root(), arm.bones);
    match goal {
        Goal::PassOverTheShoulder => {
            const STEPS: u16 = 72;
            let part = |step| 1.0 - 2.0 * f32::from(step) / f32::from(STEPS);
            moves((0..=STEPS).map(|step| cursor.with_x(cursor.x * part(step))))
        }
        Goal::MoveTheHandByFk => vec![
            EditAction::SwitchPoseMode(PoseMode::Angles).into(),
            EditAction::SetBend(0.5 * FRAC_PI_2).into(),
        ],
        Goal::BendTheElbowAtARightAngle => {
            let distance = bones.upper().hypot(bones.lower());
            vec![EditAction::SetHand(cursor.normalize_or_zero() * distance).into()]
        }
        Goal::TurnTheElbowAlongItsCircle => {
            vec![EditAction::SetTwist(arm.twist + 1.1 * FRAC_PI_2).into()]
        }
        Goal::CloseTheHole => vec![EditAction::SetLower(bones.upper()).into()],
        Goal::MoveTheCursorOutOfReach => {
            let distance = 1.3 * bones.outer_limit();
            vec![EditAction::SetHand(cursor.normalize_or_zero() * distance).into()]
        }
        Goal::SoftenTheLimits => {
            let soft = SoftReach::new(0.1, 1.0, 0.0);
            soft.into_iter().map(|soft| EditAction::SetSoftReach(soft).into()).collect()
        }
        Goal::ChooseTransport => {
            let transport = EditAction::SetTwistReference(TwistReferenceKind::Transport);
            core::iter::once(transport.into()).chain(moves(round_trip(cursor))).collect()
        }
        Goal::MoveTheShoulderAndKeepTheHand => vec![
            EditAction::PinHand(true).into(),
            EditAction::SetRoot(arm.root + Vec3::Y * (0.2 * bones.outer_limit())).into(),
        ],
        Goal::PlayByIk => vec![
            EditAction::SwitchPoseMode(PoseMode::Hand).into(),
            PlaybackAction::Play(true).into(),
        ],
        Goal::RaceAllSolvers => vec![SolverAction::Compare.into()],
        Goal::LeaveATargetOutOfReach => {
            let at: Vec3 = session.skeleton().transform().translation.into();
            vec![EditAction::SetTranslation(at + Vec3::Y * 0.3).into()]
        }
    }
}

/// Moves of the hand through points in Root space.
fn moves(points: impl Iterator<Item = Vec3>) -> Vec<Action> {
    points.map(|point| EditAction::SetHand(point).into()).collect()
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
