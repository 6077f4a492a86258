//! The arm: where the hand is, how the elbow is spun, where the root is, how long the limbs are.

use core::f32::consts::TAU;

use egui::Ui;
use glam::Vec3;

use super::point::Point;
use super::slider::Slider;
use super::{row, style};
use crate::document::Arm;
use crate::session::{Action, Session};

const ROOT_RANGE: f32 = 500.0;
const LENGTH_RANGE: (f32, f32) = (10.0, 1000.0);

pub(super) fn ui(ui: &mut Ui, session: &Session, actions: &mut Vec<Action>) {
    row::section(ui, "Hand", |ui| hand(ui, session, actions));
    row::section(ui, "Elbow", |ui| elbow(ui, session, actions));
    row::section(ui, "Root", |ui| root(ui, session, actions));
    row::section(ui, "Lengths", |ui| lengths(ui, session, actions));
}

fn hand(ui: &mut Ui, session: &Session, actions: &mut Vec<Action>) {
    let hand = Point {
        name: "Hand",
        value: session.arm().cursor(),
        default: Arm::default().cursor(),
        range: session.arm().bones.outer_limit(),
        step: 1.0,
        tooltip: "Where the Cursor is, and so the hand is asked to be, relative to the Root",
    };
    hand.show(ui, session, actions, Action::SetHand);
}

fn root(ui: &mut Ui, session: &Session, actions: &mut Vec<Action>) {
    let root = Point {
        name: "Root",
        value: session.arm().root,
        default: Vec3::ZERO,
        range: ROOT_RANGE,
        step: 1.0,
        tooltip: "Where the Root, the shoulder, is in the world; the whole arm moves with it",
    };
    root.show(ui, session, actions, Action::SetRoot);
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
        step: 1.0,
        disabled: None,
    };
    slider.show(ui, super::is_sliding(session), actions, |degrees| {
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
        step: 1.0,
        disabled: None,
    };
    upper.show(ui, super::is_sliding(session), actions, Action::SetUpper);
    let lower = Slider {
        name: "Lower length",
        label: "Lower d_2",
        colour: Some(style::colour(palette.lower)),
        tooltip: "The Lower Limb, from elbow to hand",
        value: bones.lower(),
        range: LENGTH_RANGE,
        default: seed.lower(),
        unit: "",
        step: 1.0,
        disabled: None,
    };
    lower.show(ui, super::is_sliding(session), actions, Action::SetLower);
}
