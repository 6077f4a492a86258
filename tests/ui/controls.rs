//! All controls of the window in one go: each has a tooltip that starts with a verb, and Tab
//! reaches each in reading order.

use crate::common::arm::{ArmEdit, Step, channels};
use std::collections::BTreeSet;

use egui::accesskit::{Action as Ask, Role};
use egui::{Key, Pos2, Rect, Vec2, vec2};
use egui_kittest::Node;
use egui_kittest::kittest::NodeT as _;
use ik_arm::session::{Action, KeysEdit, PanelTab, PlaybackAction, SelectAction, ViewAction};

use crate::bench::Bench;
use crate::common::documents::open_example;

const MENUS: [&str; 5] = ["File", "Edit", "View", "Examples", "Help"];

/// High enough that no panel scrolls.
const TALL: Vec2 = vec2(1280.0, 2500.0);

/// First words of tooltips.
const VERBS: [&str; 51] = [
    "Add", "Apply", "Begin", "Bend", "Blend", "Change", "Choose", "Clear", "Click", "Colour",
    "Compare", "Delete", "Disable", "Drag", "Draw", "Enable", "End", "Fix", "Give", "Go", "Hide",
    "Iterate", "Keep", "Key", "Let", "Limit", "Make", "Measure", "Move", "Play", "Pose", "Raise",
    "Remove", "Rename", "Repeat", "Reset", "Restart", "Rotate", "Run", "Select", "Set", "Show",
    "Slow", "Solve", "Stop", "Turn", "Use", "View", "Watch", "Weigh", "Write",
];

#[derive(Clone, Debug, PartialEq)]
struct Control {
    role: Role,
    name: String,
    rect: Rect,
    disabled: bool,
}

/// Everything that can be pressed, chosen or typed into.
fn controls(bench: &Bench) -> Vec<Control> {
    let nodes = bench.harness.root().children_recursive();
    let mut controls = Vec::new();
    for node in nodes {
        let inner = node.accesskit_node();
        let role = inner.role();
        let is_control = matches!(
            role,
            Role::Button
                | Role::CheckBox
                | Role::RadioButton
                | Role::Slider
                | Role::SpinButton
                | Role::ComboBox
                | Role::Tab
                | Role::TextInput
                | Role::Link
                | Role::ColorWell
        );
        if is_control && (inner.data().supports_action(Ask::Click) || inner.is_disabled()) {
            let name = inner.label().or(inner.value()).unwrap_or_default();
            controls.push(Control { role, name, rect: node.rect(), disabled: inner.is_disabled() });
        }
    }
    controls
}

fn texts(bench: &Bench) -> BTreeSet<String> {
    let nodes = bench.harness.root().children_recursive();
    nodes
        .filter_map(|node| {
            let node = node.accesskit_node();
            (node.role() == Role::Label).then(|| node.label().or(node.value())).flatten()
        })
        .collect()
}

fn tall() -> Bench {
    Bench::with_timeline(TALL)
}

fn example(name: &str) -> Bench {
    let mut bench = tall();
    bench.apply([open_example(name)]);
    bench
}

/// The arm with every section unfolded, one bench for each page of the right panel.
fn arms() -> Vec<Bench> {
    let pages = PanelTab::ALL[..6].iter().map(|page| {
        let mut bench = tall();
        bench.toggle(&["FK and IK", "Soft limits", "Hand orientation", "Display"]);
        bench.apply([
            Step::from(ArmEdit::SetInfluence(0.5)),
            KeysEdit::Key(vec![channels::HAND]).into(),
            // Hides the note about auto-key, which is over the view.
            PlaybackAction::SetAutoKey(true).into(),
        ]);
        bench.show_tab(*page);
        bench
    });
    pages.collect()
}

/// Skeletons with limb targets, whole-body targets, a path and a skin, and the graph editor.
fn skeletons() -> Vec<Bench> {
    let mut benches = Vec::new();
    let (all, own) = (&PanelTab::ALL[..], &PanelTab::ALL[3..4]);
    for (name, pages) in [("human", all), ("ten-joints", own), ("snake", own)] {
        for page in pages {
            let mut bench = example(name);
            let rig = bench.session().rig();
            let mut limbs_last = rig.targets.iter().rev();
            let limb = limbs_last.find(|target| target.limb().is_some());
            let target = limb.or(rig.targets.last()).map(|target| target.joint);
            let id = target.or(rig.skeleton.iter().last().map(|(id, _)| id)).expect("a joint");
            bench.apply([
                Action::from(SelectAction::Joints(vec![id])),
                ViewAction::ShowGraphEditor(true).into(),
            ]);
            bench.show_tab(*page);
            benches.push(bench);
        }
    }
    benches
}

/// The texts that appear while the mouse is over a control.
fn tooltip(bench: &mut Bench, control: &Control) -> Vec<String> {
    bench.move_to(bench.viewport().left_bottom() + vec2(30.0, -30.0));
    bench.skip(1.0);
    bench.frame([]);
    let before = texts(bench);
    bench.move_to(control.rect.center());
    for _ in 0..4 {
        bench.skip(0.5);
    }
    texts(bench).difference(&before).cloned().collect()
}

/// Height of the tree's bar for scrolling sideways, which lies over its last row.
const BAR: f32 = 12.0;

/// True if the control is a row of the tree of joints that the list has scrolled out of sight.
fn is_scrolled_out(bench: &Bench, control: &Control) -> bool {
    let tree = || bench.rect(Role::List, "Joints as a tree");
    control.name.starts_with("Joint ")
        && (control.rect.top() < tree().top() || control.rect.bottom() + BAR > tree().bottom())
}

#[test]
fn every_control_has_a_tooltip_that_starts_with_a_verb() {
    let mut known = BTreeSet::new();
    let mut problems = BTreeSet::new();
    for mut bench in arms().into_iter().chain(skeletons()) {
        for control in controls(&bench) {
            let is_new = known.insert((format!("{:?}", control.role), control.name.clone()));
            if !is_new
                || MENUS.contains(&control.name.as_str())
                || is_scrolled_out(&bench, &control)
            {
                continue;
            }
            let texts = tooltip(&mut bench, &control);
            let starts_with_a_verb = |text: &String| {
                let word = text.split([' ', ',']).next().unwrap_or_default();
                VERBS.contains(&word)
            };
            if !(control.disabled && !texts.is_empty() || texts.iter().any(starts_with_a_verb)) {
                problems.insert(format!(
                    "{:?} {} at {}: {texts:?}",
                    control.role, control.name, control.rect
                ));
            }
        }
    }
    assert!(problems.is_empty(), "{problems:#?}");
}

/// The parts of the window in reading order.
fn part(bench: &Bench, rect: Rect) -> usize {
    let (view, at) = (bench.viewport(), rect.center());
    if at.y < 37.0 {
        0
    } else if at.y > view.bottom() {
        4
    } else if at.x < view.left() {
        1
    } else if at.x > view.right() {
        3
    } else {
        2
    }
}

/// True if a reader comes to `next` after `before`: further right in the same row, also if it is higher
/// than the row, or lower.
fn is_read_after(bench: &Bench, before: Rect, next: Rect) -> bool {
    let (first, second) = (part(bench, before), part(bench, next));
    let is_beside = next.left() >= before.right() && next.y_range().contains(before.center().y);
    let is_as_high = before.height() < 2.0 * next.height();
    let in_one_row = is_beside || is_as_high && (before.center().y - next.center().y).abs() < 8.0;
    // The places of the buttons for the views follow the camera.
    first == 2 && second == 2
        || first < second
        || first == second
            && if in_one_row { next.left() >= before.left() } else { next.top() > before.top() }
}

#[test]
fn tab_reaches_every_control_in_reading_order() {
    let mut problems = BTreeSet::new();
    for mut bench in arms().into_iter().chain(skeletons()) {
        let mut left: Vec<_> = controls(&bench);
        left.retain(|control| !control.disabled);
        // Keys are chosen with the arrows, while the dope sheet has the focus.
        left.retain(|control| {
            !control.name.starts_with("Key of ") && !control.name.starts_with("Keys at ")
        });
        let window = Rect::from_min_size(Pos2::ZERO, TALL);
        let mut before: Option<Control> = None;
        for _ in 0..200 {
            bench.key(Key::Tab);
            let focused = bench.harness.root().children_recursive().find(Node::is_focused);
            let Some(focused) = focused else { continue };
            let (node, rect) = (focused.accesskit_node(), focused.rect());
            let name = node.label().or(node.value()).unwrap_or_default();
            if node.role() == Role::Splitter {
                continue;
            }
            left.retain(|other| (other.role, &other.name) != (node.role(), &name));
            let control = Control { role: node.role(), name, rect, disabled: false };
            if !window.contains(rect.center()) || is_scrolled_out(&bench, &control) {
                // A list is about to scroll to it.
                before = None;
                continue;
            }
            if control.role == Role::Button && control.name == MENUS[0] && before.is_some() {
                break;
            }
            if let Some(before) = &before
                && !is_read_after(&bench, before.rect, rect)
            {
                problems.insert(format!(
                    "{} at {:?} after {} at {:?}",
                    control.name, rect, before.name, before.rect
                ));
            }
            before = Some(control);
        }
        problems.extend(left.iter().map(|control| format!("never at {control:?}")));
    }
    assert!(problems.is_empty(), "{problems:#?}");
}
