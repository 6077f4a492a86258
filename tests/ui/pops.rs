//! Pops of the elbow by name, with a button for each fix.

use crate::common::arm::{ArmEdit, ArmSession, Step};
use egui::accesskit::Role;
use egui::{PointerButton, Vec2, vec2};
use egui_kittest::{SnapshotResults, try_image_snapshot_options};
use glam::Vec3;
use ik_arm::document::{AxisView, Document, Theme, TwistReferenceKind};
use ik_arm::kinematics::soft_reach::SoftReach;
use ik_arm::session::{FileAction, PanelTab, Preferences, TransactionAction, ViewAction};
use image::{RgbaImage, imageops};

use crate::bench::{Bench, snapshot_options, themed};

const LEFT: PointerButton = PointerButton::Primary;
/// Large enough for all that the hand can reach.
const HUGE: Vec2 = vec2(2000.0, 1640.0);
const HIGH: Vec2 = vec2(900.0, 800.0);

/// Looks at all that the hand can reach from the front: there the hand is dragged in x and y.
fn from_the_front() -> Bench {
    let preferences = Preferences { timeline_open: Some(false), ..Preferences::default() };
    let mut bench = Bench::liking(HUGE, preferences);
    bench.show_tab(PanelTab::Pops);
    let all = bench.session().framing_all();
    bench.apply([ViewAction::SetCamera(all.along(AxisView::Front))]);
    bench
}

fn drag(bench: &mut Bench, from: Vec3, to: Vec3, steps: u16) {
    bench.apply([ArmEdit::SetHand(from)]);
    let (start, end) = (bench.on_screen(from), bench.on_screen(to));
    bench.move_to(start);
    bench.press(LEFT);
    for step in 1..=steps {
        bench.move_to(start + (end - start) * (f32::from(step) / f32::from(steps)));
    }
    bench.release(LEFT);
    bench.settle();
    let there = bench.hand().distance(to);
    assert!(there < 2.0, "the hand is {there} from where it was dragged to");
}

fn over_the_top(bench: &mut Bench) {
    drag(bench, Vec3::new(120.0, 300.0, 20.0), Vec3::new(-120.0, 300.0, 20.0), 40);
}

fn out_straight(bench: &mut Bench) {
    drag(bench, Vec3::new(420.0, 60.0, 0.0), Vec3::new(550.0, 80.0, 0.0), 26);
}

fn softened(softness: f32) -> SoftReach {
    SoftReach::new(softness, 1.0, 0.0).expect("soft")
}

#[test]
fn without_data_the_section_says_what_to_do() {
    let bench = from_the_front();
    assert!(bench.says("Drag the hand, or play the timeline"));
    assert!(!bench.shows(Role::Image, "Pops: none"), "an empty plot is not shown");
}

#[test]
fn a_drag_without_pops_is_reported_as_such() {
    let mut bench = from_the_front();
    drag(&mut bench, Vec3::new(300.0, 0.0, 0.0), Vec3::new(200.0, 150.0, 0.0), 20);
    assert!(bench.says("No pops"));
    assert!(bench.shows(Role::Image, "Pops: none"));
}

#[test]
fn a_hand_dragged_over_the_top_pops_at_the_pole_until_stereographic_is_used() {
    let mut bench = from_the_front();
    over_the_top(&mut bench);
    assert!(bench.shows(Role::Image, "Pops: 1, the last one Singularity"));
    assert!(bench.says("Singularity: the Pointer passed within 3."));
    let (elbow, hand) = (bench.session().pose().elbow, bench.hand());
    bench.click(Role::Button, "Use Stereographic");
    assert_eq!(bench.session().arm().twist_reference, TwistReferenceKind::Stereographic);
    assert!(bench.session().pose().elbow.distance(elbow) < 0.01 && bench.hand() == hand);
    assert!(bench.says("settings have changed since"));
    assert!(!bench.shows(Role::Button, "Use Stereographic"), "it is done");
    over_the_top(&mut bench);
    assert!(bench.shows(Role::Image, "Pops: 1, the last one Singularity"), "no other one");
}

#[test]
fn behind_the_body_stereographic_pops_until_transport_is_used() {
    let mut bench = from_the_front();
    bench.apply([ArmEdit::SetTwistReference(TwistReferenceKind::Stereographic)]);
    let behind = |bench: &mut Bench| {
        drag(bench, Vec3::new(-300.0, 90.0, 12.0), Vec3::new(-300.0, -90.0, 12.0), 40);
    };
    behind(&mut bench);
    assert!(bench.says("of straight behind, −x"));
    bench.click(Role::Button, "Use Transport");
    assert_eq!(bench.session().arm().twist_reference, TwistReferenceKind::Transport);
    behind(&mut bench);
    assert!(bench.shows(Role::Image, "Pops: 1, the last one Singularity"), "no other one");
}

#[test]
fn a_hand_dragged_out_straight_pops_until_the_reach_is_soft() {
    let mut bench = from_the_front();
    out_straight(&mut bench);
    assert!(bench.says("Straight: the limb reached its outer limit"));
    bench.click(Role::Button, "Add softness");
    assert_eq!(bench.session().arm().soft_reach, softened(0.25));
    out_straight(&mut bench);
    assert!(bench.shows(Role::Image, "Pops: 1, the last one Straight"), "no other one");
    bench.apply([TransactionAction::Undo, TransactionAction::Undo, TransactionAction::Undo]);
    assert_eq!(bench.session().arm().soft_reach, softened(0.0), "it is a step to undo");
}

#[test]
fn a_hand_dragged_to_the_inner_limit_pops_there() {
    let mut bench = from_the_front();
    drag(&mut bench, Vec3::new(170.0, 10.0, 0.0), Vec3::new(92.0, 10.0, 0.0), 26);
    assert!(bench.says("Inner limit: the limb folded up"));
    assert!(bench.shows(Role::Button, "Add softness"));
}

#[test]
fn a_hand_dragged_past_the_shoulder_has_an_explanation_and_no_fix() {
    let mut bench = from_the_front();
    drag(&mut bench, Vec3::new(95.0, 8.0, 4.0), Vec3::new(-95.0, 8.0, 4.0), 20);
    assert!(bench.says("Shoulder: the Cursor passed the shoulder"));
    assert!(bench.says("must jump by twice the inner limit, 200.0"));
}

#[test]
fn the_same_fix_is_offered_once() {
    let mut bench = from_the_front();
    over_the_top(&mut bench);
    over_the_top(&mut bench);
    assert!(bench.shows(Role::Image, "Pops: 2, the last one Singularity"));
    let _ = bench.node(Role::Button, "Use Stereographic");
}

#[test]
fn other_input_changes_are_distinguished_from_pops() {
    let mut bench = from_the_front();
    slide(&mut bench, Vec3::new(250.0, 100.0, 20.0), Vec3::new(260.0, 120.0, 20.0));
    bench.apply([ArmEdit::SetTwist(2.0), ArmEdit::SetLower(240.0)]);
    assert!(bench.says("Dotted lines, not pops: lengths, Socket twist changed"));
    assert!(bench.shows(Role::Image, "Pops: none"));
}

#[test]
fn opening_another_document_clears_the_pops() {
    let mut bench = from_the_front();
    over_the_top(&mut bench);
    let document = Box::new(Document::default());
    bench.apply([FileAction::Discard(Box::new(FileAction::Opened {
        document,
        file: None,
        contents: None,
    }))]);
    assert!(bench.says("Drag the hand, or play the timeline"));
}

/// Drags as a slider would.
fn slide(bench: &mut Bench, from: Vec3, to: Vec3) {
    let way = (1..=40).map(|step| ArmEdit::SetHand(from.lerp(to, step as f32 / 40.0)).into());
    let way = [Step::from(ArmEdit::SetHand(from)), TransactionAction::Begin.into()]
        .into_iter()
        .chain(way);
    bench.apply(way.chain([TransactionAction::Commit.into()]));
}

/// A page of the panel on the right as it is painted, and nothing around it.
fn page(bench: &mut Bench, tab: PanelTab) -> RgbaImage {
    bench.show_tab(tab);
    let first = bench.rect(Role::Tab, "Triangle");
    let [left, top] = [first.left() - 8.0, first.top() - 4.0].map(|at| at as u32);
    let picture = bench.harness.render().expect("a picture");
    imageops::crop_imm(&picture, left, top, picture.width() - left, 420).to_image()
}

#[test]
fn pops_and_the_reach_curve_look_as_they_did() {
    let mut results = SnapshotResults::new();
    for theme in [Theme::Dark, Theme::Light] {
        let preferences =
            Preferences { timeline_open: Some(false), theme, ..Preferences::default() };
        let mut bench = Bench::liking(HIGH, preferences);
        slide(&mut bench, Vec3::new(120.0, 300.0, 20.0), Vec3::new(-120.0, 300.0, 20.0));
        bench.apply([
            ArmEdit::SetTwistReference(TwistReferenceKind::Stereographic),
            ArmEdit::SetTwist(0.4),
        ]);
        slide(&mut bench, Vec3::new(400.0, 60.0, 0.0), Vec3::new(550.0, 80.0, 0.0));
        slide(&mut bench, Vec3::new(95.0, 8.0, 4.0), Vec3::new(-95.0, 8.0, 4.0));
        bench.apply([ArmEdit::SetHand(Vec3::new(480.0, 20.0, 60.0))]);
        let options = snapshot_options(600);
        for (tab, name) in [(PanelTab::Pops, "pops"), (PanelTab::Reach, "reach_curve")] {
            let name = themed(name, theme);
            results.add(try_image_snapshot_options(&page(&mut bench, tab), name, &options));
        }
    }
}

#[test]
fn the_cause_of_a_pop_has_another_name_than_the_twist_references() {
    let mut bench = from_the_front();
    over_the_top(&mut bench);
    assert!(bench.says("Pops: 1, the last one Singularity"));
    let is_reference = |kind: TwistReferenceKind| kind.name() == "Singularity";
    assert!(!TwistReferenceKind::ALL.into_iter().any(is_reference));
}
