//! The tour as a session sees it: each step notices its task and nothing else, and the user's own
//! document comes back as it was.

use crate::common::arm::{ArmEdit, ArmSession, Step};
use std::path::PathBuf;

use glam::Vec3;
use ik_arm::document::{Document, Overlay, TwistReferenceKind};
use ik_arm::io::{Example, to_json};
use ik_arm::kinematics::skeleton::JointId;
use ik_arm::kinematics::soft_reach::SoftReach;
use ik_arm::session::{
    Dialog, DisplayEdit, Effect, FileAction, JointEdit, PlaybackAction, PoseMode, Preferences,
    Session, SolverAction, TargetEdit, TourAction, TourEnd, TourState, TourStep, TransactionAction,
    ViewAction, filled,
};

fn session() -> Session {
    Session::new(Preferences::default())
}

/// A session in a step of the tour, counted from 1.
fn in_step(number: usize) -> Session {
    let mut session = session();
    session.apply(TourAction::Enter(number - 1));
    session
}

fn shows_result(session: &Session) -> bool {
    session.tour().is_some_and(TourState::shows_result)
}

/// Does what the step asks for, and waits for the end of a race.
fn demonstrate(session: &mut Session) {
    session.apply(TourAction::Demonstrate);
    for frame in 0..500 {
        session.apply(PlaybackAction::Advance(f64::from(frame) / 60.0));
    }
}

/// The same actions by the user, so that the step has to notice them.
fn act(session: &mut Session, actions: impl IntoIterator<Item = impl Into<Step>>) {
    for action in actions {
        action.into().apply(session);
    }
}

#[test]
fn there_are_thirteen_steps_each_with_a_question_of_two_to_four_answers() {
    assert_eq!(TourStep::all().len(), 13);
    for step in TourStep::all() {
        let answers = &step.guess.answers;
        assert!((2..=4).contains(&answers.len()), "{}", step.title);
        assert!(answers.iter().enumerate().all(|(at, one)| !answers[..at].contains(one)));
        assert!(step.guess.question.ends_with('?'), "{}", step.title);
        assert!(
            answers.iter().any(|answer| *answer == step.guess.right_answer()),
            "{}",
            step.title
        );
        let right = (0..answers.len()).filter(|answer| step.guess.is_right(*answer));
        assert_eq!(right.count(), 1, "{}", step.title);
        let told = [&step.title, &step.text].map(|text| text.to_lowercase());
        let answer = step.guess.right_answer().to_lowercase();
        assert!(!told.iter().any(|text| text.contains(&answer)), "{}", step.title);
        let document = step.document().expect("a scene");
        let is_arm = document.rig.sole_limb().is_some();
        assert_eq!(document.display.shows(Overlay::ElbowCircle), is_arm, "{}", step.title);
    }
}

#[test]
fn every_sentence_of_a_result_has_its_numbers_once_the_task_is_done() {
    for (number, step) in TourStep::all().iter().enumerate() {
        let mut session = in_step(number + 1);
        let texts = [&step.text, &step.task];
        for text in texts {
            let said = filled(text, &session);
            assert!(!said.contains(['{', '}']), "{said}");
            assert_eq!(said.matches(". ").count(), text.matches(". ").count(), "{said}");
        }
        demonstrate(&mut session);
        let said = filled(step.result, &session);
        assert!(!said.contains(['{', '}']), "{said}");
        assert_eq!(said.matches(". ").count(), step.result.matches(". ").count(), "{said}");
        assert!(shows_result(&session));
        assert!(
            !session.tour().unwrap().is_done(number),
            "a demonstration is not the user's doing"
        );
    }
}

#[test]
fn a_number_that_the_scene_does_not_have_takes_its_sentence_along() {
    let session = in_step(1);
    let text = "First. It was {elbow_to_hand} times as far. Last.";
    assert_eq!(filled(text, &session), "First. Last.");
    assert_eq!(filled("Nobody knows {nothing}. Last.", &session), "Last.");
    assert_eq!(filled("The hand is at {hand}.", &session), "The hand is at (180.0, 320.0, 0.0).");
}

/// Begins each step, does something else than its task, and expects that the step does not take it
/// for its task.
#[test]
fn a_step_does_not_take_another_move_for_its_task() {
    let hand = |x: f32, y: f32, z: f32| ArmEdit::SetHand(Vec3::new(x, y, z));
    let wrong: [(usize, Vec<Step>); 14] = [
        (1, vec![hand(180.0, -320.0, 0.0).into(), hand(-180.0, -320.0, 0.0).into()]),
        (1, vec![hand(350.0, 100.0, 0.0).into()]),
        (2, vec![hand(100.0, 300.0, 0.0).into()]),
        (2, vec![ArmEdit::SwitchPoseMode(PoseMode::Angles).into()]),
        (3, vec![ArmEdit::SetTwist(1.0).into(), hand(150.0, 60.0, 0.0).into()]),
        (4, vec![ArmEdit::SetTwist(0.7).into()]),
        (4, vec![hand(-250.0, -120.0, -60.0).into()]),
        (5, vec![ArmEdit::SetLower(250.0).into(), ArmEdit::SetUpper(350.0).into()]),
        (6, vec![hand(300.0, 300.0, 100.0).into(), ArmEdit::SetTwist(3.0).into()]),
        (7, vec![ArmEdit::SetSoftReach(SoftReach::new(0.0, 1.5, 0.2).unwrap()).into()]),
        (8, vec![ArmEdit::SetTwistReference(TwistReferenceKind::Pole).into()]),
        (9, vec![ArmEdit::SetRoot(Vec3::X * 100.0).into()]),
        (10, vec![PlaybackAction::Play(true).into(), PlaybackAction::Advance(1.0).into()]),
        (11, vec![SolverAction::Run(true).into(), PlaybackAction::Advance(1.0).into()]),
    ];
    for (number, actions) in wrong {
        let mut session = in_step(number);
        act(&mut session, actions);
        assert!(!shows_result(&session), "step {number}");
        assert!(!session.tour().unwrap().is_done(number - 1), "step {number}");
    }
    let mut session = in_step(12);
    let (joint, rotation) = (JointId::new(4), Vec3::new(0.0, 0.4, 0.0));
    act(&mut session, [JointEdit::SetRotation { joint, rotation }]);
    act(&mut session, [JointEdit::SetTranslation(Vec3::NEG_Y * 0.05)]);
    assert!(!shows_result(&session), "step 12");
    let mut session = in_step(13);
    let hand = session.rig().targets[0];
    act(&mut session, [TargetEdit::SetTarget(hand.with_home(hand.home + Vec3::Y * 0.2))]);
    act(&mut session, [JointEdit::SetTranslation(Vec3::NEG_Y * 0.02)]);
    assert!(!shows_result(&session), "step 13");
}

fn example(name: &str) -> Document {
    let example = Example::find(name).expect("an example");
    example.open().expect("it opens").document
}

/// A session with a changed document, a history, a file and a moved playhead.
fn changed() -> Session {
    let mut session = session();
    let document = Box::new(example("walk"));
    let file = Some(PathBuf::from("/tmp/walk.json"));
    session.apply(FileAction::Opened { document, file, contents: None });
    session.apply(PlaybackAction::SetTime(0.5));
    session.apply(JointEdit::SetTranslation(Vec3::new(0.1, 0.02, 0.0)));
    session.apply(DisplayEdit::ShowOverlay(Overlay::Labels, false));
    session
}

fn bytes(session: &Session) -> String {
    let document: &Document = session.document();
    to_json(document).expect("a document is valid")
}

#[test]
fn the_own_document_comes_back_as_it_was_after_every_step() {
    for number in 1..=TourStep::all().len() + 1 {
        let mut session = changed();
        let before = session.clone();
        session.apply(TourAction::Enter(number - 1));
        session.apply(TourAction::Guess(0));
        assert_ne!(bytes(&session), bytes(&before));
        assert_eq!(bytes(session.own()), bytes(&before), "kept during step {number}");
        demonstrate(&mut session);
        session.apply(TourAction::Leave);

        assert!(session.tour().is_none());
        assert_eq!(bytes(&session), bytes(&before), "step {number}");
        assert_eq!(session.shown(), before.shown());
        assert_eq!(session.history().undo_label(), before.history().undo_label());
        assert_eq!(
            (session.playback().time(), session.files().file()),
            (before.playback().time(), before.files().file())
        );
        assert_eq!(session.history().is_unsaved(), before.history().is_unsaved());
        assert_eq!(session.history().revision(), before.history().revision());
        let preferences = Preferences { offers_tour: false, ..*before.preferences() };
        assert_eq!(*session.preferences(), preferences);
        session.apply(TransactionAction::Undo);
        assert!(session.shown().display.shows(Overlay::Labels), "its history continues");
    }
}

#[test]
fn a_drag_that_was_under_way_is_kept_as_an_undo_step() {
    let mut session = session();
    session.apply(TransactionAction::Begin);
    session.edit_arm(ArmEdit::SetTwist(0.5));
    session.apply(TourAction::Enter(3));
    session.apply(TourAction::Leave);
    assert_eq!(session.arm().twist, 0.5);
    assert!(!session.history().is_editing() && session.history().undo_label().is_some());
}

#[test]
fn scenes_of_the_tour_are_not_saved_over_the_own_document() {
    let save_as = session().files().save_as_dialog();
    for action in [
        FileAction::Save,
        FileAction::SaveAs(PathBuf::from("/tmp/other.json")),
        FileAction::AskPath(save_as),
    ] {
        let mut session = changed();
        session.apply(TourAction::Enter(0));
        assert_eq!(session.apply(action), None);
        assert!(session.shell().has_failed(), "says why");
        assert!(session.tour().is_some());
    }
}

#[test]
fn opening_another_document_ends_the_tour_and_asks_for_unsaved_changes_of_the_own() {
    let example = Example::find("snake").unwrap();
    let mut session = changed();
    let before = bytes(&session);
    session.apply(TourAction::Enter(4));
    session.apply(FileAction::OpenExample(example));
    assert!(matches!(session.shell().dialog(), Some(Dialog::Unsaved { .. })));
    assert!(session.tour().is_none());
    assert_eq!(bytes(&session), before);

    let mut session = in_step(4);
    assert_eq!(session.apply(FileAction::Quit), Some(Effect::Quit), "nothing is unsaved");
    assert!(session.tour().is_none());
}

#[test]
fn steps_can_be_entered_in_any_order_and_remember_what_was_done() {
    let mut session = in_step(4);
    session.edit_arm(ArmEdit::SetTwist(2.0));
    assert!(shows_result(&session) && session.tour().unwrap().is_done(3));
    session.apply(TourAction::Enter(11));
    session.apply(TourAction::Enter(0));
    let tour = session.tour().unwrap();
    assert_eq!(tour.number(), 0);
    assert!(tour.is_done(3) && !tour.is_done(0) && !tour.shows_result());
    session.apply(TourAction::Enter(3));
    assert!(!shows_result(&session), "a step that is entered again begins again");
}

#[test]
fn after_the_last_step_a_card_tells_what_the_user_can_say_now() {
    let steps = TourStep::all().len();
    for number in [steps, 999] {
        let mut session = in_step(number + 1);
        let tour = session.tour().unwrap();
        assert_eq!((tour.number(), tour.step()), (steps, None));
        assert_eq!(tour.title(), "What you can say now");
        act(&mut session, [TourAction::Guess(0), TourAction::Demonstrate]);
        act(&mut session, [JointEdit::SetTranslation(Vec3::Y * 0.5)]);
        let tour = session.tour().unwrap();
        assert!(!tour.shows_result() && (0..=steps).all(|step| !tour.is_done(step)));
        session.apply(TourAction::Enter(steps - 1));
        assert_eq!(session.tour().unwrap().step(), TourStep::all().last());
    }
    assert_eq!(TourEnd::get().sentences.len(), 5);
}

/// The elbow of an arm in its plane, by the law of cosines.
fn elbow(upper: f64, lower: f64, distance: f64) -> (f64, f64) {
    let along = (distance * distance + upper * upper - lower * lower) / (2.0 * distance);
    (along, (upper * upper - along * along).sqrt())
}

#[test]
fn the_nearly_straight_arm_races_as_far_as_its_step_says_wherever_the_cursor_was_dragged() {
    let mut session = in_step(7);
    assert!(filled("{cursor_at_start}", &session).starts_with("497.5"));
    let ((x, y), (to_x, to_y)) = (elbow(200.0, 300.0, 497.5), elbow(200.0, 300.0, 498.5));
    let moved = (to_x - x).hypot(to_y - y);
    assert!(moved > 5.0, "the right answer says so: {moved}");
    let cursor = session.arm().cursor_in_root();
    for hand in [cursor, cursor * 1.3, cursor * 0.5] {
        act(&mut session, [ArmEdit::SetHand(hand)]);
        assert_eq!(filled("{hard_race}", &session), format!("{moved:.1}"));
    }
    act(&mut session, [ArmEdit::SetSoftReach(SoftReach::new(0.1, 1.0, 0.0).unwrap())]);
    assert!(shows_result(&session));
    let number = |name: &str| filled(name, &session).parse::<f64>().expect("a number");
    assert!(number("{race}") < 2.0 && number("{hard_race}") > 5.0);
    // The soft zone is 0.1·(500 − 100)/2 = 20 wide.
    let gap = 497.5 - (500.0 - 20.0 * (-(497.5_f64 - 480.0) / 20.0).exp());
    assert_eq!(filled("{soft_gap}", &session), format!("{gap:.1}"));
}

#[test]
fn the_jump_over_the_shoulder_names_the_steps_of_hand_and_elbow() {
    let mut session = in_step(1);
    demonstrate(&mut session);
    let number = |name: &str| filled(name, &session).parse::<f64>().expect("a number");
    let [hand, elbow, ratio] = ["{hand_step}", "{elbow_step}", "{elbow_to_hand}"].map(number);
    // The demonstration moves the hand from x = 180 to -180 in 72 steps.
    assert_eq!(hand, 5.0);
    assert!((elbow / hand - ratio).abs() < 1.0, "{elbow} / {hand} = {ratio}");
}

#[test]
fn outside_the_tour_its_actions_change_nothing() {
    let mut session = session();
    let before = session.clone();
    for action in [TourAction::Leave, TourAction::Guess(1), TourAction::Demonstrate] {
        session.apply(action);
    }
    assert_eq!(session, before);
    session.apply(TourAction::Decline);
    assert!(!session.preferences().offers_tour);
}

#[test]
fn what_the_user_sets_in_the_tour_for_good_is_kept_and_its_pages_are_not() {
    let mut session = session();
    session.apply(ViewAction::ShowExplain(false));
    session.apply(TourAction::Enter(2));
    assert!(session.preferences().explain, "the step shows its page");
    let light = ik_arm::document::Theme::Light;
    session.apply(ik_arm::session::ShellAction::SetTheme(light));
    let budget = ik_arm::session::FrameBudget::Sixtieth;
    session.apply(ik_arm::session::ShellAction::SetFrameBudget(budget));
    session.apply(TourAction::Leave);
    assert_eq!(session.preferences().theme, light);
    assert_eq!(session.preferences().frame_budget, budget);
    assert!(!session.preferences().explain);
}
