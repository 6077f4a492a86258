//! Settings of the arm: hand, Socket twist, Root, lengths, soft limits, hand orientation.

mod disabled;
mod fk_ik;
mod hand_orientation;
mod socket_twist;
mod soft_limits;

use egui::Ui;
use glam::Vec3;

use crate::document::{Arm, Channel};
use crate::session::{Actions, EditAction, Session};
use crate::ui::style;
use crate::ui::widgets::{self, AXES, KeyButton, PointSliders, Slider};
use disabled::ANGLES_LEAD;

/// Maximum of the sliders of a world coordinate, in units of [`Session::arm_unit`].
const ROOT_RANGE: f32 = 500.0;
/// Range of the length sliders, in units of [`Session::arm_unit`].
const LENGTH_RANGE: (f32, f32) = (10.0, 1000.0);
const PINNED: &str = "Pinned to world";

/// Shows what poses the arm by IK: the hand and the Socket twist.
pub(in crate::ui) fn ui(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    let mut aside = Actions::new();
    let pinned = |ui: &mut Ui| pin(ui, session, &mut aside);
    widgets::section_with(ui, "Hand", pinned, |ui| hand(ui, session, actions));
    let reference = |ui: &mut Ui| socket_twist::reference(ui, session, &mut aside);
    widgets::section_with(ui, "Socket twist", reference, |ui| {
        socket_twist::ui(ui, session, actions);
    });
    actions.extend(aside);
}

/// Shows all other settings of the arm, folded at first.
pub(in crate::ui) fn more(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    widgets::folded_section(ui, "Root", |ui| root(ui, session, actions));
    widgets::folded_section(ui, "Lengths", |ui| lengths(ui, session, actions));
    widgets::folded_section(ui, "FK and IK", |ui| fk_ik::ui(ui, session, actions));
    widgets::folded_section(ui, "Soft limits", |ui| soft_limits::ui(ui, session, actions));
    widgets::folded_section(ui, "Hand orientation", |ui| {
        hand_orientation::ui(ui, session, actions);
    });
}

fn hand(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    let (arm, default) = (session.arm(), Arm::default().cursor_in_root());
    let disabled = (!arm.uses_ik()).then_some(ANGLES_LEAD);
    let hand = PointSliders {
        name: "Hand",
        labels: AXES,
        value: arm.cursor_in_root(),
        default,
        range: arm.reach_limits().outer,
        step: session.arm_unit(),
        tooltip: "Move the Cursor, the hand's target, relative to the Root",
        disabled,
        channel: None,
    };
    if !arm.is_pinned() {
        return hand.show(ui, session, actions, EditAction::SetHand);
    }
    let pinned = PointSliders {
        value: arm.cursor_in_world(),
        default: arm.root + default,
        range: arm.reach_limits().outer.max(ROOT_RANGE * session.arm_unit()),
        tooltip: "Move the Cursor, the hand's target, in world space",
        ..hand
    };
    pinned.show(ui, session, actions, EditAction::SetPin);
}

/// Shows the switch of the pin and its diamond, which also keys the point that the Cursor has.
fn pin(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    widgets::at_right(ui, |ui| {
        let mut pinned = session.arm().is_pinned();
        let check = ui
            .checkbox(&mut pinned, PINNED)
            .on_hover_text("Keep the hand in place when the Root moves");
        if check.changed() {
            actions.push(EditAction::PinHand(pinned));
        }
        let others = vec![Channel::of_cursor(session.arm())];
        KeyButton { channel: Channel::Pinned, others }.show(ui, session, PINNED, actions);
    });
}

fn root(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    let root = PointSliders {
        name: "Root",
        labels: AXES,
        value: session.arm().root,
        default: Vec3::ZERO,
        range: ROOT_RANGE * session.arm_unit(),
        step: session.arm_unit(),
        tooltip: "Move the Root, the shoulder, in world space",
        disabled: None,
        channel: None,
    };
    root.show(ui, session, actions, EditAction::SetRoot);
}

fn lengths(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    let (palette, bones) = (style::palette(ui), session.arm().bones);
    let (default, unit) = (Arm::default().bones, session.arm_unit());
    let range = (LENGTH_RANGE.0 * unit, LENGTH_RANGE.1 * unit);
    let upper = Slider {
        name: "Upper length",
        label: "Upper d_1",
        colour: Some(style::colour(palette.upper)),
        tooltip: "Set the length from shoulder to elbow",
        value: bones.upper(),
        range,
        default: default.upper(),
        step: unit,
        ..Slider::default()
    };
    upper.show(ui, session, actions, EditAction::SetUpper);
    let lower = Slider {
        name: "Lower length",
        label: "Lower d_2",
        colour: Some(style::colour(palette.lower)),
        tooltip: "Set the length from elbow to hand",
        value: bones.lower(),
        range,
        default: default.lower(),
        step: unit,
        ..Slider::default()
    };
    lower.show(ui, session, actions, EditAction::SetLower);
}
