//! Recorded elbow speed, pops and their fixes.

use crate::common::arm::{Arm, ArmEdit, ArmSession, channels};
use glam::Vec3;
use ik_arm::document::{Channel, Document, Timeline, TwistReferenceKind};
use ik_arm::kinematics::pop::{InputChange, PopCause, PosedLimb};
use ik_arm::kinematics::soft_reach::SoftReach;
use ik_arm::session::{
    FileAction, KeysEdit, PlaybackAction, PopFix, PopSampleKind, Session, Spike, TransactionAction,
};

fn drag(session: &mut Session, from: Vec3, to: Vec3, steps: u16) {
    session.edit_arm(ArmEdit::SetHand(from));
    session.apply(TransactionAction::Begin);
    for step in 1..=steps {
        let part = f32::from(step) / f32::from(steps);
        session.edit_arm(ArmEdit::SetHand(from.lerp(to, part)));
    }
    session.apply(TransactionAction::Commit);
}

fn over_the_top(session: &mut Session) {
    drag(session, Vec3::new(150.0, 300.0, 20.0), Vec3::new(-150.0, 300.0, 20.0), 30);
}

fn into_the_limit(session: &mut Session) {
    drag(session, Vec3::new(420.0, 0.0, 40.0), Vec3::new(560.0, 0.0, 40.0), 28);
}

fn fold_up(session: &mut Session) {
    drag(session, Vec3::new(200.0, 0.0, 10.0), Vec3::new(90.0, 0.0, 10.0), 40);
}

fn past_the_shoulder(session: &mut Session) {
    drag(session, Vec3::new(95.0, 3.0, 5.0), Vec3::new(-95.0, 3.0, 5.0), 19);
}

/// The pose of the shown limb with its inputs.
fn posed(session: &Session) -> &PosedLimb {
    &session.limb().expect("a limb").frames.posed
}

fn persisting(session: &Session) -> Vec<Spike> {
    let persists = |spike: &Spike| spike.persists(posed(session));
    session.evaluated().pops().spikes().into_iter().filter(persists).collect()
}

fn changes(session: &Session) -> Vec<InputChange> {
    let change = |what| match what {
        PopSampleKind::Change(change) => Some(change),
        PopSampleKind::Step(_) => None,
    };
    session.evaluated().pops().samples().filter_map(|sample| change(sample.kind)).collect()
}

/// Drags, applies the fix of the only pop, and checks that the same drag no longer pops. Returns
/// the fix.
fn fix_pop(session: &mut Session, drag: fn(&mut Session)) -> PopFix {
    drag(session);
    let spikes = persisting(session);
    assert_eq!(spikes.len(), 1, "{spikes:?}");
    let pop_fix = PopFix::new(&spikes[0], posed(session)).expect("a fix");
    let edit = pop_fix.edit(session.rig(), session.limb().expect("a limb"));
    session.apply(edit.expect("an edit"));
    assert_eq!(session.shell().message(), None);
    assert_eq!(PopFix::new(&spikes[0], posed(session)), None, "it is taken");
    drag(session);
    assert_eq!(persisting(session), []);
    pop_fix
}

#[test]
fn each_fix_prevents_the_pop_of_the_same_drag() {
    let map = PopFix::ChangeReference(TwistReferenceKind::Stereographic);
    assert_eq!(fix_pop(&mut Session::default(), over_the_top), map);
    let soft = PopFix::Soften(SoftReach::new(0.25, 1.0, 0.0).expect("soft"));
    assert_eq!(fix_pop(&mut Session::default(), into_the_limit), soft);
    assert_eq!(fix_pop(&mut Session::default(), fold_up), soft);
}

#[test]
fn pops_of_a_pole_reference_are_fixed_by_stereographic_too() {
    let mut session = Session::default();
    session.edit_arm(ArmEdit::SetPole(Vec3::new(0.0, 300.0, 10.0)));
    session.edit_arm(ArmEdit::SetTwistReference(TwistReferenceKind::Pole));
    assert_eq!(
        fix_pop(&mut session, over_the_top),
        PopFix::ChangeReference(TwistReferenceKind::Stereographic)
    );
}

#[test]
fn behind_the_body_stereographic_pops_and_transport_fixes_it() {
    let mut session = Session::default();
    session.edit_arm(ArmEdit::SetTwistReference(TwistReferenceKind::Stereographic));
    let behind = |session: &mut Session| {
        drag(session, Vec3::new(-300.0, 100.0, 9.0), Vec3::new(-300.0, -100.0, 9.0), 40);
    };
    assert_eq!(
        fix_pop(&mut session, behind),
        PopFix::ChangeReference(TwistReferenceKind::Transport)
    );
}

#[test]
fn a_soft_arm_that_still_pops_at_a_limit_can_be_softer_or_kept_open() {
    let mut session = Session::default();
    let almost_hard = SoftReach::new(0.01, 1.2, 0.0).expect("soft");
    session.edit_arm(ArmEdit::SetSoftReach(almost_hard));
    let expected = PopFix::KeepOpen(SoftReach::new(0.01, 1.2, 30_f32.to_radians()).expect("soft"));
    assert_eq!(fix_pop(&mut session, fold_up), expected);

    let spike = |pop, soft_reach| {
        let arm = Arm { soft_reach, ..Arm::default() };
        let frames = arm.frames();
        let (ik, reference) = (frames.posed.ik, arm.twist_reference);
        let spike = Spike { at: 0, ratio: 9.0, pop, ik, reference };
        PopFix::new(&spike, &frames.posed)
    };
    let soft = |softness| SoftReach::new(softness, 1.2, 0.3).expect("soft");
    for (from, to) in [(0.1, 0.25), (0.2, 0.4), (0.3, 0.5)] {
        assert_eq!(spike(PopCause::Straight, soft(from)), Some(PopFix::Soften(soft(to))), "{from}");
    }
    assert_eq!(spike(PopCause::Straight, soft(0.5)), None);
    let open = SoftReach::new(0.2, 1.0, 1.5).expect("soft");
    assert_eq!(spike(PopCause::Folded, open), None);
}

#[test]
fn a_cursor_that_passes_the_shoulder_has_no_fix() {
    let mut session = Session::default();
    past_the_shoulder(&mut session);
    let spikes = persisting(&session);
    assert!(spikes.iter().any(|spike| spike.pop == PopCause::Shoulder), "{spikes:?}");
    for spike in spikes.iter().filter(|spike| spike.pop == PopCause::Shoulder) {
        assert_eq!(PopFix::new(spike, posed(&session)), None);
    }
}

#[test]
fn each_drag_and_each_playback_is_a_separate_run() {
    let mut session = Session::default();
    into_the_limit(&mut session);
    over_the_top(&mut session);
    let runs = |session: &Session| {
        let mut runs: Vec<u32> =
            session.evaluated().pops().samples().map(|sample| sample.run).collect();
        let steps = runs.len();
        runs.dedup();
        (runs.len(), steps)
    };
    assert_eq!(runs(&session), (2, 28 + 30));
    session.apply(TransactionAction::Undo);
    session.edit_arm(ArmEdit::SetHand(Vec3::new(222.0, 0.0, 0.0)));
    assert_eq!(runs(&session), (2, 28 + 30), "what is not dragged is not measured");
}

/// Keys that move the hand over the top in a second, with a changing twist.
fn keyed(channels: &[Channel]) -> Session {
    let mut session = Session::default();
    session.apply(KeysEdit::SetTimeline(Timeline { end: 1.0, ..Timeline::default() }));
    for (time, x, twist) in [(0.0, 150.0, 0.0), (1.0, -150.0, 2.0)] {
        session.apply(PlaybackAction::SetTime(time));
        session.edit_arm(ArmEdit::SetHand(Vec3::new(x, 300.0, 20.0)));
        session.edit_arm(ArmEdit::SetTwist(twist));
        session.apply(KeysEdit::Key(channels.to_vec()));
    }
    session
}

fn play(session: &mut Session, seconds: std::ops::Range<f64>) {
    session.apply(PlaybackAction::SetTime(0.0));
    session.apply(PlaybackAction::Play(true));
    for picture in 0..=40 {
        let part = f64::from(picture) / 40.0;
        session
            .apply(PlaybackAction::Advance(seconds.start + part * (seconds.end - seconds.start)));
    }
}

#[test]
fn playback_is_measured_and_a_loop_starts_a_new_run() {
    let mut session = keyed(&[channels::HAND]);
    let typed = session.evaluated().pops().samples().count();
    play(&mut session, 10.0..11.9);
    let samples: Vec<_> = session.evaluated().pops().samples().skip(typed).collect();
    assert!(samples.len() > 30, "{}", samples.len());
    let mut runs: Vec<u32> = samples.iter().map(|sample| sample.run).collect();
    runs.dedup();
    assert_eq!(runs.len(), 2);
    let spikes = session.evaluated().pops().spikes();
    assert_eq!(spikes.len(), 2, "{spikes:?}");
    assert!(
        spikes.iter().all(|spike| matches!(spike.pop, PopCause::Singular { .. })),
        "{spikes:?}"
    );
}

#[test]
fn a_played_twist_is_one_input_change_and_no_pop() {
    let mut session = keyed(&[channels::HAND, channels::TWIST]);
    let before = changes(&session).len();
    play(&mut session, 10.0..10.9);
    assert_eq!(changes(&session)[before..], [InputChange::Twist]);
    assert_eq!(session.evaluated().pops().spikes(), []);
}

#[test]
fn moving_the_root_is_an_input_change_only_with_a_pinned_hand() {
    for (pinned, marked) in [(false, vec![]), (true, vec![InputChange::Root])] {
        let mut session = Session::default();
        session.edit_arm(ArmEdit::PinHand(pinned));
        session.apply(TransactionAction::Begin);
        for step in 1..9_u8 {
            session.edit_arm(ArmEdit::SetRoot(Vec3::Y * 10.0 * f32::from(step)));
        }
        session.apply(TransactionAction::Commit);
        assert_eq!(changes(&session), marked);
        assert_eq!(session.evaluated().pops().samples().count(), marked.len());
    }
}

#[test]
fn a_slow_hand_adds_up_to_the_same_pop() {
    let mut session = Session::default();
    drag(&mut session, Vec3::new(40.0, 300.0, 4.0), Vec3::new(-40.0, 300.0, 4.0), 1600);
    let count = session.evaluated().pops().samples().count();
    assert!((130..=160).contains(&count), "{count} of 80 units in steps of half a one or more");
    assert_eq!(persisting(&session).len(), 1);
}

#[test]
fn samples_are_bounded_and_cleared_with_the_document() {
    let mut session = Session::default();
    drag(&mut session, Vec3::new(150.0, 300.0, 20.0), Vec3::new(-150.0, 300.0, 20.0), 200);
    for _ in 0..4 {
        over_the_top(&mut session);
        drag(&mut session, Vec3::new(300.0, 0.0, 0.0), Vec3::new(0.0, 0.0, 300.0), 200);
    }
    assert_eq!(session.evaluated().pops().samples().count(), 600);
    let document = Box::new(Document::default());
    session.apply(FileAction::Discard(Box::new(FileAction::Opened {
        document,
        file: None,
        contents: None,
    })));
    assert_eq!(session.evaluated().pops().samples().count(), 0);
}

#[test]
fn a_drag_straight_out_of_reach_does_not_move_the_elbow() {
    let mut session = Session::default();
    drag(&mut session, Vec3::new(600.0, 0.0, 0.0), Vec3::new(900.0, 0.0, 0.0), 10);
    let ratios: Vec<f32> = session
        .evaluated()
        .pops()
        .samples()
        .map(|sample| match sample.kind {
            PopSampleKind::Step(step) => step.ratio,
            PopSampleKind::Change(change) => panic!("{change:?}"),
        })
        .collect();
    assert!(ratios.len() == 10 && ratios.iter().all(|ratio| *ratio < 1e-5), "{ratios:?}");
}
