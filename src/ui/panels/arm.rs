//! Settings of the arm: FK and IK, hand, Socket twist, Root, lengths, soft limits, hand
//! orientation.

use core::f32::consts::TAU;

use egui::{Color32, ComboBox, RichText, TextStyle, Ui, vec2};
use glam::Vec3;

use crate::document::{Arm, Channel, HandSpace, TwistReferenceKind};
use crate::session::{Actions, ArmEdit, PoseMode, Session, TransactionAction};
use crate::ui::widgets::{
    self, AXES, KeyButton, PointSliders, Slider, angle_slider, euler_sliders, soft_reach_sliders,
};
use crate::ui::{glossary, labels, style};

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
    let reference = |ui: &mut Ui| reference(ui, session, &mut aside);
    widgets::section_with(ui, "Socket twist", reference, |ui| {
        socket_twist(ui, session, actions);
    });
    actions.extend(aside);
}

/// Shows all other settings of the arm, folded at first.
pub(in crate::ui) fn more(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    widgets::folded_section(ui, "Root", |ui| root(ui, session, actions));
    widgets::folded_section(ui, "Lengths", |ui| lengths(ui, session, actions));
    widgets::folded_section(ui, "FK and IK", |ui| fk_ik(ui, session, actions));
    widgets::folded_section(ui, "Soft limits", |ui| soft_limits(ui, session, actions));
    widgets::folded_section(ui, "Hand orientation", |ui| {
        hand_orientation(ui, session, actions);
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
        step: session.history().arm_unit(),
        tooltip: "Move the Cursor, the hand's target, relative to the Root",
        disabled,
        channel: None,
    };
    if !arm.is_pinned() {
        return hand.show(ui, session, actions, ArmEdit::SetHand);
    }
    let pinned = PointSliders {
        value: arm.cursor_in_world(),
        default: arm.root + default,
        range: arm.reach_limits().outer.max(ROOT_RANGE * session.history().arm_unit()),
        tooltip: "Move the Cursor, the hand's target, in world space",
        ..hand
    };
    pinned.show(ui, session, actions, ArmEdit::SetPin);
}

/// Shows the switch of the pin and its diamond, which also keys the point that the Cursor has.
fn pin(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    widgets::at_right(ui, |ui| {
        let mut pinned = session.arm().is_pinned();
        let check = ui
            .checkbox(&mut pinned, PINNED)
            .on_hover_text("Keep the hand in place when the Root moves");
        if check.changed() {
            actions.push(ArmEdit::PinHand(pinned));
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
        range: ROOT_RANGE * session.history().arm_unit(),
        step: session.history().arm_unit(),
        tooltip: "Move the Root, the shoulder, in world space",
        disabled: None,
        channel: None,
    };
    root.show(ui, session, actions, ArmEdit::SetRoot);
}

fn lengths(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    let (palette, bones) = (style::palette(ui), session.arm().bones);
    let (default, unit) = (Arm::default().bones, session.history().arm_unit());
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
    upper.show(ui, session, actions, ArmEdit::SetUpper);
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
    lower.show(ui, session, actions, ArmEdit::SetLower);
}

/// Reason shown on controls that act only in IK.
pub(in crate::ui) const ANGLES_LEAD: &str = "Switch to IK to set this";

/// Width in points of each of the two buttons.
const WIDTH: f32 = 33.0;

/// Shows the switch between IK and FK and, if FK has a part in the pose, the joint angles.
pub(in crate::ui) fn fk_ik(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    switch(ui, session, actions);
    if session.arm().influence < 1.0 {
        angles(ui, session, actions);
    }
}

/// Shows buttons for IK and FK, and the slider that blends between them.
fn switch(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    let influence = session.arm().influence;
    let modes = [
        (PoseMode::Hand, "IK", 1.0, "Pose by IK (hand → joint angles)"),
        (PoseMode::Angles, "FK", 0.0, "Pose by FK (joint angles → hand)"),
    ];
    let blend = Slider {
        name: "IK influence",
        label: "IK influence",
        tooltip: "Blend from FK at 0 to IK at 1",
        value: influence,
        range: (0.0, 1.0),
        default: 1.0,
        step: 0.1,
        ..Slider::default()
    };
    blend.show_after(ui, session, actions, ArmEdit::SetInfluence, |ui, actions| {
        ui.spacing_mut().item_spacing.x = 2.0;
        for (mode, name, whole, tooltip) in modes {
            let chosen = influence == whole;
            let button = egui::Button::selectable(chosen, name).frame_when_inactive(true);
            let button = button.min_size(vec2(WIDTH, 0.0));
            if ui.add(button).on_hover_text(tooltip).clicked() && !chosen {
                actions.push(ArmEdit::SwitchPoseMode(mode));
            }
        }
        ui.spacing_mut().item_spacing.x = 8.0;
    });
}

/// Shows sliders of the three shoulder angles and the elbow bend, and a button that sets all to 0.
fn angles(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    let fk = session.arm().fk;
    let shoulder = [
        (1, "Shoulder yaw", "Turn the Upper limb about the vertical, first"),
        (2, "Shoulder pitch", "Raise the Upper limb, second"),
        (0, "Shoulder roll", "Turn the Upper limb about itself, third"),
    ];
    let slide =
        |ui: &mut Ui, slider: Slider<'_>, actions: &mut Actions, set: &dyn Fn(f32) -> ArmEdit| {
            slider.show(ui, session, actions, |degrees| set(degrees.to_radians()));
        };
    for (axis, name, tooltip) in shoulder {
        let slider = angle_slider(name, tooltip, fk.shoulder[axis]);
        let colour = style::colour(style::palette(ui).axes[axis]);
        let label = ["Roll x", "Yaw y", "Pitch z"][axis];
        let slider = Slider { label, colour: Some(colour), ..slider };
        let set = |radians| {
            let mut angles = fk.shoulder;
            angles[axis] = radians;
            ArmEdit::SetShoulder(angles)
        };
        slide(ui, slider, actions, &set);
    }
    let bend = angle_slider("Elbow bend", "Bend the elbow: 0° straight, 180° folded", fk.bend);
    let bend = Slider { label: "Bend β", range: (0.0, 180.0), ..bend };
    slide(ui, bend, actions, &ArmEdit::SetBend);
    ui.add_space(2.0);
    if widgets::button(ui, "Straighten", "Set all four angles to 0", None) {
        actions.push(TransactionAction::Begin);
        actions.push(ArmEdit::SetShoulder(Vec3::ZERO));
        actions.push(ArmEdit::SetBend(0.0));
        actions.push(TransactionAction::Commit);
    }
}

/// Least width of the combo box's text, in points.
const COMBO: f32 = 36.0;

pub(in crate::ui) fn socket_twist(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    let arm = session.arm();
    let slider = Slider {
        name: "Socket twist",
        label: "Twist",
        tooltip: "Turn the elbow about the Pointer; the hand stays",
        term: Some("Socket twist"),
        value: arm.twist.to_degrees(),
        range: (0.0, TAU.to_degrees()),
        default: 0.0,
        unit: "°",
        step: 1.0,
        disabled: (!arm.uses_ik()).then_some(ANGLES_LEAD),
        ..Slider::default()
    };
    slider.show(ui, session, actions, |degrees| ArmEdit::SetTwist((degrees % 360.0).to_radians()));
    if arm.twist_reference == TwistReferenceKind::Pole {
        pole(ui, session, actions);
    }
}

/// Shows the combo box of the twist references, for the title row of the section, with a label if
/// there is room for both.
pub(in crate::ui) fn reference(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    /// Width in points of the section's title with its triangle.
    const TITLE: f32 = 104.0;
    const LABEL: &str = "reference";
    let chosen = session.arm().twist_reference;
    let spacing = ui.spacing();
    let around = 2.0 * (spacing.button_padding.x + spacing.item_spacing.x);
    let icon = spacing.icon_spacing + spacing.icon_width;
    let needed = TITLE + width(ui, LABEL) + width(ui, chosen.name()).max(COMBO) + icon + around;
    let has_room = ui.available_width() > needed;
    widgets::at_right(ui, |ui| {
        if has_room {
            glossary::term_label(ui, LABEL, "Twist reference", actions);
        }
        choice(ui, chosen, actions);
    });
}

/// Width of a text, in points.
fn width(ui: &Ui, text: &str) -> f32 {
    let font = TextStyle::Body.resolve(ui.style());
    ui.painter().layout_no_wrap(text.to_owned(), font, Color32::PLACEHOLDER).size().x
}

fn choice(ui: &mut Ui, chosen: TwistReferenceKind, actions: &mut Actions) {
    let combo = ComboBox::from_id_salt("twist reference").width(60.0).selected_text(chosen.name());
    let response = combo.show_ui(ui, |ui| {
        for twist_reference in TwistReferenceKind::ALL {
            let item = ui.selectable_label(twist_reference == chosen, twist_reference.name());
            let item = item.on_hover_text(labels::twist_reference(twist_reference));
            if item.clicked() && twist_reference != chosen {
                actions.push(ArmEdit::SetTwistReference(twist_reference));
            }
        }
    });
    let response = response.response;
    ui.ctx().accesskit_node_builder(response.id, |node| node.set_label("Twist reference"));
    response.on_hover_text(labels::twist_reference(chosen));
}

fn pole(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    let arm = session.arm();
    let pole = PointSliders {
        name: "Pole",
        labels: ["Pole x", "Pole y", "Pole z"],
        value: arm.pole,
        default: Arm::default().pole,
        range: arm.bones.outer_limit(),
        step: session.history().arm_unit(),
        tooltip: "Move the Pole, the point that the elbow turns towards",
        disabled: (!arm.uses_ik()).then_some(ANGLES_LEAD),
        channel: None,
    };
    pole.show(ui, session, actions, ArmEdit::SetPole);
}

pub(in crate::ui) fn soft_limits(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    let soft_reach = session.arm().soft_reach;
    soft_reach_sliders(ui, session, "", soft_reach, actions, ArmEdit::SetSoftReach);
}

pub(in crate::ui) fn hand_orientation(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    let arm = session.arm();
    let spaces = [
        (HandSpace::LowerLimb, "Follow forearm", "Turn the hand with the Lower limb"),
        (HandSpace::World, "Keep in world", "Keep the world orientation of the hand"),
    ];
    ui.horizontal(|ui| {
        for (space, name, tooltip) in spaces {
            if ui.radio(arm.hand_orientation.space == space, name).on_hover_text(tooltip).clicked()
            {
                actions.push(ArmEdit::SetHandSpace(space));
            }
        }
    });
    let tooltip = match arm.hand_orientation.space {
        HandSpace::LowerLimb => "Rotate the hand relative to the forearm",
        HandSpace::World => "Rotate the hand in world space",
    };
    euler_sliders(
        ui,
        session,
        "Hand rotation",
        tooltip,
        arm.hand_orientation.angles,
        actions,
        ArmEdit::SetHandOrientation,
    );
    widgets::pair(ui, "Forearm roll τ", |ui| {
        let roll = format!("{:.1}°", arm.roll(session.pose()).to_degrees());
        ui.label(RichText::new(roll).monospace())
            .on_hover_text("Hand rotation about the forearm, spread along its stripes");
    });
}
