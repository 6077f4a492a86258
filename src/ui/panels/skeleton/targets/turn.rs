//! What a whole-body target does with the rotation of its joint: nothing, turn it to a rotation, or aim
//! one of its axes at a point.

use egui::Ui;
use glam::Vec3;

use crate::document::{Channel, Target};
use crate::kinematics::chain_ik::OrientRefusal;
use crate::rig::Aim;
use crate::session::{Actions, Session, TargetEdit};
use crate::ui::widgets::{self, AXES, Choice, NumberField, PointSliders, euler_sliders};

/// Axes that can be aimed, with their names.
const AIMED: [(Vec3, &str, &str); 6] = [
    (Vec3::X, "x", ""),
    (Vec3::Y, "y", ""),
    (Vec3::Z, "z", ""),
    (Vec3::NEG_X, "\u{2212}x", ""),
    (Vec3::NEG_Y, "\u{2212}y", ""),
    (Vec3::NEG_Z, "\u{2212}z", ""),
];

/// Shows the choice, and what it needs. `step` is that of points.
pub(super) fn show(
    ui: &mut Ui,
    session: &Session,
    target: Target,
    step: f32,
    actions: &mut Actions,
) {
    kind(ui, session, target, actions);
    if let Some(angles) = target.orientation {
        let (name, tooltip) = ("Target rotation", "Rotate the joint in the target's space");
        let channel = Some(Channel::TargetOrientation(target.joint));
        euler_sliders(ui, session, (name, tooltip, channel), angles, actions, |angles| {
            TargetEdit::SetTarget(Target { orientation: Some(angles), ..target })
        });
    }
    if let Some(aim) = target.aim {
        point(ui, session, (target, aim), step, actions);
    }
    if target.turns_joint() {
        let tooltip = "Let the tip be anywhere, and turn the joint alone";
        let is_free = target.has_free_place();
        let cannot = cannot(session, OrientRefusal::FreePlace, "needs a place for the tip");
        let refused = cannot.filter(|_| !is_free);
        let changed = widgets::check_box(ui, "Free place", tooltip, is_free, refused.as_deref());
        actions.extend(changed.map(|is_free| {
            let weight = if is_free { 0.0 } else { 1.0 };
            TargetEdit::SetTarget(Target { weight, ..target })
        }));
        let weight = NumberField {
            name: "Turn weight",
            value: target.orientation_weight,
            unit: "",
            step: 0.1,
            digits: 2,
            tooltip: "Weigh the turn against places: 1 radian counts like a quarter of the chain",
        };
        weight.row(ui, session, "Turn weight", actions, |weight: f32| {
            TargetEdit::SetTarget(Target { orientation_weight: weight.max(0.0), ..target })
        });
    }
}

fn kind(ui: &mut Ui, session: &Session, target: Target, actions: &mut Actions) {
    let shown = match (target.orientation, target.aim) {
        (Some(_), _) => "To a rotation",
        (None, Some(_)) => "Aims at a point",
        (None, None) => "Free",
    };
    let choice = Choice {
        label: "Turns",
        name: "Target turns",
        tooltip: "Choose what the target does with the joint's rotation",
        shown,
    };
    let mut set = |orientation: Option<Vec3>, aim: Option<Aim>| {
        let is_free = orientation.is_none() && aim.is_none() && target.has_free_place();
        let weight = if is_free { 1.0 } else { target.weight };
        actions.push(TargetEdit::SetTarget(Target { orientation, aim, weight, ..target }));
    };
    choice.show(ui, |list| {
        let is_free = target.orientation.is_none() && target.aim.is_none();
        if list.item(is_free, "Free", "Leave the rotation to what the place needs", None) {
            set(None, None);
        }
        let to_rotation = "Turn the joint to three angles in the target's space";
        let is_rotation = target.orientation.is_some();
        let refused = cannot(session, OrientRefusal::Any, "turns no joint");
        if list.item(is_rotation, "To a rotation", to_rotation, refused.as_deref()) {
            set(Some(present_rotation(session, &target)), None);
        }
        let at_point = "Turn an axis of the joint to a point, as a head looks at something";
        let refused = cannot(session, OrientRefusal::Aim, "aims no joint");
        if list.item(target.aim.is_some(), "Aims at a point", at_point, refused.as_deref()) {
            set(None, Some(present_aim(session, &target, Vec3::Z)));
        }
    });
}

/// Why the solver cannot do what it refuses; `None` if it does not refuse it.
fn cannot(session: &Session, refusal: OrientRefusal, what: &str) -> Option<String> {
    let method = session.rig().solver.method;
    let refused = method.refuses(refusal);
    refused.then(|| format!("{} {what}; choose another solver", method.title()))
}

/// Shows the axis and the point of an aim.
fn point(
    ui: &mut Ui,
    session: &Session,
    (target, aim): (Target, Aim),
    step: f32,
    actions: &mut Actions,
) {
    let set = |aim| TargetEdit::SetTarget(Target { aim: Some(aim), ..target });
    let tooltip = "Choose the axis of the joint that is aimed; faces look along z";
    let choice = Choice { label: "Axis", name: "Aimed axis", tooltip, shown: "" };
    if let Some(axis) = choice.pick(ui, &AIMED, |axis| *axis == aim.axis) {
        actions.push(set(present_aim(session, &target, axis)));
    }
    let sliders = PointSliders {
        name: "Aim",
        labels: AXES,
        value: aim.point,
        default: present_aim(session, &target, aim.axis).point,
        range: 1.5 * session.rig().reach(),
        step,
        tooltip: "Move the point that the axis is aimed at",
        disabled: None,
        channel: Some(Channel::TargetAim(target.joint)),
    };
    sliders.show(ui, session, actions, |point| set(Aim { point, ..aim }));
}

/// Angles of the rotation that a target's joint has at present.
fn present_rotation(session: &Session, target: &Target) -> Vec3 {
    let pose = &session.posed().evaluated_skeleton().solved;
    let present = pose.rotation_in_world(target.joint).as_quat();
    target.orientation_angles(pose, present, pose[target.joint].rotation)
}

/// An aim that a target's joint has at present: at a point half the rig's reach away.
fn present_aim(session: &Session, target: &Target, axis: Vec3) -> Aim {
    let pose = &session.posed().evaluated_skeleton().solved;
    let away = pose.rotation_in_world(target.joint).as_quat() * axis * 0.5 * session.rig().reach();
    let point = pose.base(target.joint) + away;
    Aim { axis, point: target.present_space().point_from_world(pose, point) }
}
