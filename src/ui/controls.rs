//! The left panel: where the hand is, how the elbow is spun, and what is shown.

use core::f32::consts::TAU;

use egui::{ScrollArea, Ui};
use glam::Vec3;

use super::slider::Slider;
use super::{row, style};
use crate::document::{Arm, Layer};
use crate::session::{Action, Session};

const AXES: [&str; 3] = ["x", "y", "z"];
const ROOT_RANGE: f32 = 500.0;
const LENGTH_RANGE: (f32, f32) = (10.0, 1000.0);

pub(super) fn ui(ui: &mut Ui, session: &Session, actions: &mut Vec<Action>) {
    ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        ui.add_space(6.0);
        row::section(ui, "Hand", |ui| hand(ui, session, actions));
        row::section(ui, "Elbow", |ui| elbow(ui, session, actions));
        row::section(ui, "Root", |ui| root(ui, session, actions));
        row::section(ui, "Lengths", |ui| lengths(ui, session, actions));
        row::section(ui, "Guides", |ui| layers(ui, session, &Layer::GUIDES, actions));
        row::section(ui, "Display", |ui| layers(ui, session, &Layer::SURROUNDINGS, actions));
        resets(ui, actions);
        ui.add_space(8.0);
    });
}

/// Whether the change under way is a slider's, not that of a hand in the viewport.
fn is_sliding(session: &Session) -> bool {
    session.is_editing() && session.hand_drag().is_none()
}

fn hand(ui: &mut Ui, session: &Session, actions: &mut Vec<Action>) {
    let reach = session.arm().bones.outer_limit();
    point(
        ui,
        session,
        actions,
        &Point {
            name: "Hand",
            value: session.arm().cursor,
            default: Arm::default().cursor,
            range: reach,
            tooltip: "Where the Cursor is, and so the hand is asked to be, relative to the Root",
            set: Action::SetHand,
        },
    );
}

fn root(ui: &mut Ui, session: &Session, actions: &mut Vec<Action>) {
    point(
        ui,
        session,
        actions,
        &Point {
            name: "Root",
            value: session.arm().root,
            default: Vec3::ZERO,
            range: ROOT_RANGE,
            tooltip: "Where the Root, the shoulder, is in the world; the whole arm moves with it",
            set: Action::SetRoot,
        },
    );
}

/// Three sliders that set a point, each leaving the two other coordinates as they are.
struct Point<'a> {
    name: &'a str,
    value: Vec3,
    default: Vec3,
    range: f32,
    tooltip: &'a str,
    set: fn(Vec3) -> Action,
}

fn point(ui: &mut Ui, session: &Session, actions: &mut Vec<Action>, point: &Point<'_>) {
    let axes = style::palette(ui).axes;
    for (axis, label) in AXES.into_iter().enumerate() {
        let slider = Slider {
            name: &format!("{} {label}", point.name),
            label,
            colour: Some(style::colour(axes[axis])),
            tooltip: &format!("{}: {label}", point.tooltip),
            value: point.value[axis],
            range: (-point.range, point.range),
            default: point.default[axis],
            unit: "",
        };
        slider.show(ui, is_sliding(session), actions, |coordinate| {
            let mut moved = point.value;
            moved[axis] = coordinate;
            (point.set)(moved)
        });
    }
}

fn elbow(ui: &mut Ui, session: &Session, actions: &mut Vec<Action>) {
    let slider = Slider {
        name: "Elbow spin",
        label: "Spin",
        colour: None,
        tooltip: "How far the Socket is turned about the Pointer: it takes the elbow around and \
                  leaves the hand",
        value: session.arm().elbow_spin.to_degrees(),
        range: (0.0, TAU.to_degrees()),
        default: 0.0,
        unit: "°",
    };
    slider.show(ui, is_sliding(session), actions, |degrees| {
        Action::SetElbowSpin((degrees % 360.0).to_radians())
    });
}

fn lengths(ui: &mut Ui, session: &Session, actions: &mut Vec<Action>) {
    let (palette, bones) = (style::palette(ui), session.arm().bones);
    let seed = Arm::default().bones;
    let upper = Slider {
        name: "Upper length",
        label: "Upper d_1",
        colour: Some(style::colour(palette.upper)),
        tooltip: "The Upper Limb, from shoulder to elbow",
        value: bones.upper(),
        range: LENGTH_RANGE,
        default: seed.upper(),
        unit: "",
    };
    upper.show(ui, is_sliding(session), actions, Action::SetUpper);
    let lower = Slider {
        name: "Lower length",
        label: "Lower d_2",
        colour: Some(style::colour(palette.lower)),
        tooltip: "The Lower Limb, from elbow to hand",
        value: bones.lower(),
        range: LENGTH_RANGE,
        default: seed.lower(),
        unit: "",
    };
    lower.show(ui, is_sliding(session), actions, Action::SetLower);
}

fn layers(ui: &mut Ui, session: &Session, layers: &[Layer], actions: &mut Vec<Action>) {
    ui.columns(2, |columns| {
        for (index, layer) in layers.iter().enumerate() {
            let (name, tooltip) = describe(*layer);
            let mut shown = session.document().display.shows(*layer);
            if columns[index % 2].checkbox(&mut shown, name).on_hover_text(tooltip).changed() {
                actions.push(Action::Show(*layer, shown));
            }
        }
    });
}

fn describe(layer: Layer) -> (&'static str, &'static str) {
    match layer {
        Layer::Cursor => ("Cursor", "A small sphere where the hand is asked to be"),
        Layer::Pointer => (
            "Pointer",
            "The axis from the Root through the hand to the Cursor, as long as the whole arm",
        ),
        Layer::InnerLimit => (
            "Inner limit",
            "The sphere that the hand cannot enter: its radius is the difference of the lengths",
        ),
        Layer::OuterLimit => (
            "Outer limit",
            "The sphere that the hand cannot leave: its radius is the sum of the lengths",
        ),
        Layer::GridXy => ("XY grid", "The grid in which z is 0, in cells of 100"),
        Layer::GridXz => ("XZ grid", "The grid in which y is 0, in cells of 100"),
        Layer::GridYz => ("YZ grid", "The grid in which x is 0, in cells of 100"),
        Layer::Ground => ("Ground", "A floor at y = 0"),
        Layer::Axes => ("Axes", "Arrows along the world's x, y and z"),
        Layer::Labels => ("Labels", "Names at root, elbow and hand"),
        Layer::Shadow => ("Shadow", "Soft on the floor: the higher the arm, the softer"),
    }
}

fn resets(ui: &mut Ui, actions: &mut Vec<Action>) {
    ui.horizontal(|ui| {
        if ui
            .button("Reset pose")
            .on_hover_text("Arm, spin, root and lengths as at first")
            .clicked()
        {
            actions.push(Action::ResetPose);
        }
        let all =
            ui.button("Reset all").on_hover_text("Pose, guides, display and view as at first");
        if all.clicked() {
            actions.push(Action::ResetAll);
        }
    });
}
