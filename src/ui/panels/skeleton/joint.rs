//! The selected joint: rotation, limits, bone and parent.

use core::f32::consts::{PI, TAU};

use egui::Ui;
use glam::{Vec2, Vec3};

use super::targets;
use crate::document::Channel;
use crate::kinematics::skeleton::{Cone, Joint, JointId, JointLimits, Limit, RotationAxis};
use crate::session::{Actions, Edit, JointEdit, Session};
use crate::ui::widgets::{self, AXES, Choice, NumberField, Slider, text, with_axis};
use crate::ui::{labels, style};

const STIFF: &str = "The limits leave one angle only";

pub(in crate::ui) fn ui(ui: &mut Ui, session: &Session, index: JointId, actions: &mut Actions) {
    let Some(joint) = session.skeleton().joint(index) else { return };
    if session.selection().joints().len() > 1 {
        let count = session.selection().joints().len();
        ui.weak(format!("{count} joints selected; this is the last one."));
    }
    rotation(ui, session, index, joint, actions);
    limits(ui, session, index, joint, actions);
    stiffness(ui, session, index, joint, actions);
    bone(ui, session, index, joint, actions);
    if session.rig().skin.is_some() {
        skin_scale(ui, session, index, joint, actions);
    }
    parent(ui, session, index, joint, actions);
    let tooltip = "Keep solvers from rotating this joint";
    let changed = widgets::check_box(ui, "Locked", tooltip, joint.locked, None);
    actions.extend(changed.map(|locked| JointEdit::SetLocked { joint: index, locked }));
}

fn rotation(ui: &mut Ui, session: &Session, index: JointId, joint: &Joint, actions: &mut Actions) {
    /// Opacity of sliders that do nothing as long as a target poses the joint.
    const IDLE: f32 = 0.6;
    let opacity = ui.opacity();
    if say_what_poses(ui, session, index) {
        ui.multiply_opacity(IDLE);
    }
    angles(ui, session, index, joint, actions);
    ui.set_opacity(opacity);
}

/// Says what else poses a joint. Returns whether its angles do nothing.
fn say_what_poses(ui: &mut Ui, session: &Session, joint: JointId) -> bool {
    let rig = session.rig();
    let target = rig.target_that_turns(joint);
    if let Some((target, (_, end))) = target.and_then(|it| Some((it, targets::end(rig, it)?))) {
        let is_whole = target.influence >= 1.0;
        let how = match is_whole {
            true => "poses this joint; these angles (FK) count only without it.",
            false => "poses this joint in part; the rest is these angles (FK).",
        };
        ui.weak(format!("The target of {end} {how}"));
        return is_whole;
    }
    if rig.is_pulled(joint) {
        ui.weak(
            "Follows hands and feet where they cannot reach; these angles (FK) count only without \
             them.",
        );
    }
    false
}

fn angles(ui: &mut Ui, session: &Session, index: JointId, joint: &Joint, actions: &mut Actions) {
    let colours = style::palette(ui).axes;
    let follows_path = labels::why_on_path(session, index);
    let shown = match follows_path {
        Some(_) => session.posed().evaluated_skeleton().fk[index].rotation,
        None => joint.rotation,
    };
    for axis in RotationAxis::ALL {
        let label = axis.name();
        let is_stiff = joint.limits.is_fixed(axis);
        let limit = joint.limits.range(axis).filter(|_| !is_stiff);
        let range =
            limit.map_or((-180.0, 180.0), |limit| (limit.min.to_degrees(), limit.max.to_degrees()));
        let slider = Slider {
            name: &format!("Rotation {label}"),
            label: &format!("Rotate {label}"),
            colour: Some(style::colour(colours[axis.index()])),
            term: None,
            tooltip: &format!("Rotate about {label} (Euler order x, y, z)"),
            value: shown[axis.index()].to_degrees(),
            range,
            default: 0.0,
            unit: "°",
            step: 1.0,
            disabled: follows_path.or(is_stiff.then_some(STIFF)),
            channel: Some(Channel::Rotation(index)),
        };
        slider.show(ui, session, actions, |degrees| {
            let rotation = with_axis(joint.rotation, axis.index(), degrees.to_radians());
            JointEdit::SetRotation { joint: index, rotation }
        });
    }
}

const LIMITS: [(bool, &str, &str); 2] = [
    (false, "Angles", "Limit each angle to a range"),
    (true, "Cone", "Limit the swing of the bone to a cone, and its twist to a range"),
];

/// The cone of a joint that gets one.
const NEW_CONE: Cone = Cone {
    x: PI / 3.0,
    z: PI / 3.0,
    twist: Limit { min: -PI / 4.0, max: PI / 4.0 },
    middle: Vec2::ZERO,
};

/// Shows the choice between ranges of angles and a cone, and the rows of the chosen one.
fn limits(ui: &mut Ui, session: &Session, index: JointId, joint: &Joint, actions: &mut Actions) {
    let set = |limits| JointEdit::SetLimits { joint: index, limits };
    let cone = joint.limits.as_cone();
    let tooltip = "Choose how the joint is limited";
    let choice = Choice { label: "Limits", name: "Limits", tooltip, shown: "" };
    if let Some(is_cone) = choice.pick(ui, &LIMITS, |is_cone| *is_cone == cone.is_some()) {
        actions.push(set(if is_cone { JointLimits::cone(NEW_CONE) } else { JointLimits::NONE }));
    }
    match cone {
        Some(cone) => {
            self::cone(ui, session, cone, actions, &|cone| set(JointLimits::cone(cone)).into());
        }
        None => ranges(ui, session, index, joint, actions),
    }
}

/// Shows the greatest swings of a cone, the range of its twist and where its middle is.
fn cone(
    ui: &mut Ui,
    session: &Session,
    cone: Cone,
    actions: &mut Actions,
    set: &dyn Fn(Cone) -> Edit,
) {
    /// The least swing of a cone that can be entered, in radians.
    const LEAST: f32 = 1e-3;
    let swings = [
        ("Swing x", "Set the greatest swing about the frame's x", 0, cone.x),
        ("Swing z", "Set the greatest swing across the bone and x", 1, cone.z),
    ];
    for (name, tooltip, which, value) in swings {
        let value = value.to_degrees();
        let field = NumberField { name, value, unit: "°", step: 1.0, digits: 1, tooltip };
        field.row(ui, session, name, actions, |degrees| {
            let swing = degrees.to_radians().clamp(LEAST, Cone::WIDEST);
            set(if which == 0 { Cone { x: swing, ..cone } } else { Cone { z: swing, ..cone } })
        });
    }
    widgets::pair(ui, "Twist", |ui| {
        widgets::at_right(ui, |ui| {
            let Limit { min, max } = cone.twist;
            end(ui, session, actions, "Twist minimum", min, &|to| {
                let to = to.max(max - TAU);
                set(Cone { twist: Limit { min: to, max: max.max(to) }, ..cone })
            });
            ui.weak("to");
            end(ui, session, actions, "Twist maximum", max, &|to| {
                let to = to.min(min + TAU);
                set(Cone { twist: Limit { min: min.min(to), max: to }, ..cone })
            });
        });
    });
    widgets::pair(ui, "Middle", |ui| {
        widgets::at_right(ui, |ui| {
            let tooltip = "Turn the middle of the cone away from the bone at rest";
            for (name, label, axis) in [("Middle x", "x", 0), ("Middle z", "z", 1)] {
                ui.weak(label);
                angle(ui, session, actions, name, tooltip, cone.middle[axis], &|to| {
                    let mut middle = cone.middle;
                    middle[axis] = to;
                    set(Cone { middle: middle.clamp_length_max(Cone::WIDEST), ..cone })
                });
            }
        });
    });
}

/// Shows, for each axis, a check box that limits the rotation, with the range beside it.
fn ranges(ui: &mut Ui, session: &Session, index: JointId, joint: &Joint, actions: &mut Actions) {
    for axis in RotationAxis::ALL {
        let (label, limit) = (axis.name(), joint.limits.range(axis));
        let set = |limit| JointEdit::SetLimits {
            joint: index,
            limits: joint.limits.with_range(axis, limit),
        };
        ui.horizontal(|ui| {
            ui.set_height(22.0);
            let (name, tooltip) =
                (format!("Limit {label}"), format!("Limit the rotation about {label}"));
            let changed = widgets::check_box(ui, &name, &tooltip, limit.is_some(), None);
            let wide = Limit { min: -PI / 2.0, max: PI / 2.0 };
            actions.extend(changed.map(|limited| set(limited.then_some(wide))));
            let Some(limit) = limit else { return };
            widgets::at_right(ui, |ui| {
                end(ui, session, actions, &format!("{label} minimum"), limit.min, &|min| {
                    set(Some(Limit { min, max: limit.max.max(min) })).into()
                });
                ui.weak("to");
                end(ui, session, actions, &format!("{label} maximum"), limit.max, &|max| {
                    set(Some(Limit { min: limit.min.min(max), max })).into()
                });
            });
        });
    }
}

/// Shows a field for an end of a range, as [`angle`] does.
fn end(
    ui: &mut Ui,
    session: &Session,
    actions: &mut Actions,
    name: &str,
    value: f32,
    set: &dyn Fn(f32) -> Edit,
) {
    angle(ui, session, actions, name, "Set the end of the range", value, set);
}

/// Shows a field for an angle of a limit. `value` and the argument of `set` are in radians; the
/// field shows degrees.
fn angle(
    ui: &mut Ui,
    session: &Session,
    actions: &mut Actions,
    name: &str,
    tooltip: &str,
    value: f32,
    set: &dyn Fn(f32) -> Edit,
) {
    let value = value.to_degrees();
    let field = NumberField { name, value, unit: "°", step: 1.0, digits: 1, tooltip };
    field.show(ui, session, actions, |degrees| set(degrees.to_radians()));
}

/// Shows a slider for the stiffness of all angles and, in a section of its own, one for each angle.
fn stiffness(ui: &mut Ui, session: &Session, index: JointId, joint: &Joint, actions: &mut Actions) {
    let set = |stiffness| JointEdit::SetStiffness { joint: index, stiffness };
    let tooltip = "Let solvers turn this joint less than others, where others can do it";
    let of_all = joint.stiffness.max_element();
    stiffness_slider(["Stiffness"; 2], tooltip, joint.locked, of_all).show(
        ui,
        session,
        actions,
        |value| set(Vec3::splat(within_stiffness(value))),
    );
    widgets::named_folded_section(ui, "stiffness by angle", "Stiffness by angle", |ui| {
        for axis in RotationAxis::ALL {
            let names = [&*format!("Stiffness {axis}"), &format!("About {axis}")];
            let tooltip = format!("Set the stiffness of the angle about {axis}");
            let value = joint.stiffness[axis.index()];
            stiffness_slider(names, &tooltip, joint.locked, value).show(
                ui,
                session,
                actions,
                |value| {
                    let value = within_stiffness(value);
                    set(with_axis(joint.stiffness, axis.index(), value))
                },
            );
        }
    });
}

fn within_stiffness(value: f32) -> f32 {
    value.clamp(0.0, Joint::MAX_STIFFNESS)
}

fn stiffness_slider<'a>(
    [name, label]: [&'a str; 2],
    tooltip: &'a str,
    is_locked: bool,
    value: f32,
) -> Slider<'a> {
    /// The greatest stiffness that the rail reaches.
    const MOST: f32 = 0.95;
    Slider {
        name,
        label,
        tooltip,
        value,
        range: (0.0, MOST),
        step: 0.05,
        disabled: is_locked.then_some("The joint is locked"),
        ..Slider::default()
    }
}

fn bone(ui: &mut Ui, session: &Session, index: JointId, joint: &Joint, actions: &mut Actions) {
    let step = session.shown().grid_cell() * 0.1;
    widgets::pair(ui, "Bone", |ui| {
        widgets::at_right(ui, |ui| {
            for (axis, label) in AXES.into_iter().enumerate() {
                let field = NumberField {
                    name: &format!("Bone {label}"),
                    value: joint.axis[axis],
                    unit: "",
                    step,
                    digits: text::decimals(step),
                    tooltip: "Set the vector from base to tip, in joint space",
                };
                field.show(ui, session, actions, |value| JointEdit::SetAxis {
                    joint: index,
                    axis: with_axis(joint.axis, axis, value),
                });
            }
        });
    });
    let length = NumberField {
        name: "Length",
        value: joint.axis.length(),
        unit: "",
        step,
        digits: text::decimals(step),
        tooltip: "Set the bone length; the direction stays",
    };
    length.row(ui, session, "Length", actions, |length| {
        let direction = joint.axis.try_normalize().unwrap_or(Vec3::Y);
        JointEdit::SetAxis { joint: index, axis: direction * length.max(0.0) }
    });
}

/// Shows, in a section of its own, the factors by which the joint scales the skin.
fn skin_scale(
    ui: &mut Ui,
    session: &Session,
    index: JointId,
    joint: &Joint,
    actions: &mut Actions,
) {
    widgets::named_folded_section(ui, "skin scale", "Skin scale", |ui| {
        for axis in RotationAxis::ALL {
            let slider = Slider {
                name: &format!("Skin scale {axis}"),
                label: &format!("Along {axis}"),
                colour: Some(style::colour(style::palette(ui).axes[axis.index()])),
                tooltip: "Squash or stretch the skin that follows this joint; other joints stay",
                value: joint.skin.scale[axis.index()],
                range: (0.0, 2.0),
                default: 1.0,
                step: 0.05,
                channel: Some(Channel::SkinScale(index)),
                ..Slider::default()
            };
            slider.show(ui, session, actions, |scale| {
                let scale = with_axis(joint.skin.scale, axis.index(), scale);
                JointEdit::SetSkinScale { joint: index, scale }
            });
        }
    });
}

fn parent(ui: &mut Ui, session: &Session, index: JointId, joint: &Joint, actions: &mut Actions) {
    let skeleton = &session.skeleton();
    let name = |joint: Option<JointId>| match joint.and_then(|joint| skeleton.joint(joint)) {
        Some(joint) => joint.name.clone(),
        None => "none".to_owned(),
    };
    let choice = Choice {
        label: "Parent",
        name: "Parent",
        tooltip: "Change the parent; the joint stays in place",
        shown: &name(joint.parent),
    };
    choice.show(ui, |list| {
        let others = skeleton.ids().filter(|j| !skeleton.is_in_subtree(*j, index));
        for parent in std::iter::once(None).chain(others.map(Some)) {
            if list.item(joint.parent == parent, &name(parent), "", None) {
                actions.push(JointEdit::ReparentJoint { joint: index, parent });
            }
        }
    });
}
