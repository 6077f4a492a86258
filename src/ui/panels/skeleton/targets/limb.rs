//! The joints that a target moves, the whole body or a limb; settings of a limb's target: elbow,
//! hand and soft limits; the space in which a target or a pole is fixed.

use egui::Ui;
use glam::Vec3;

use crate::document::{Channel, Target};
use crate::kinematics::limb_ik::Limb;
use crate::kinematics::twist::TwistReferenceKind;
use crate::rig::{LimbSettings, SkeletonRig, TargetKind, TargetSpace};
use crate::session::{Actions, Session, TargetEdit};
use crate::ui::widgets::{
    self, AXES, Choice, PointSliders, Slider, angle_slider, soft_reach_sliders, with_axis,
};

pub(super) fn kind(ui: &mut Ui, session: &Session, target: Target, actions: &mut Actions) {
    let no_limb = Limb::ending_at(session.skeleton(), target.joint)
        .err()
        .map(|reason| format!("No limb: {reason}"));
    let is_limb = target.limb().is_some();
    let choice = Choice {
        label: "Moves",
        name: "Target kind",
        tooltip: "Choose the joints that the target moves",
        shown: if is_limb { "Limb" } else { "Whole body" },
    };
    let mut set = |kind| actions.push(TargetEdit::SetTarget(Target { kind, ..target }));
    choice.show(ui, |list| {
        let by_body = "Solve from the root, together with the other whole-body targets";
        if list.item(!is_limb, "Whole body", by_body, None) {
            set(TargetKind::WholeBody);
        }
        let by_limb = "Solve the two bones above the tip in closed form";
        if list.item(is_limb, "Limb", by_limb, no_limb.as_deref()) {
            set(TargetKind::Limb(LimbSettings::default()));
        }
    });
}

const NO_HAND: &str = "There is no hand or foot: no single joint is at the tip";

pub(super) fn settings(
    ui: &mut Ui,
    session: &Session,
    target: Target,
    settings: LimbSettings,
    actions: &mut Actions,
) {
    let set =
        |settings| TargetEdit::SetTarget(Target { kind: TargetKind::Limb(settings), ..target });
    reference(ui, &target, settings, actions);
    let twist = Slider {
        label: "Twist",
        channel: Some(Channel::TargetTwist(target.joint)),
        ..angle_slider(
            "Limb twist",
            "Turn the elbow or knee about the line to the target",
            settings.twist,
        )
    };
    twist.show(ui, session, actions, |degrees| {
        set(LimbSettings { twist: degrees.to_radians(), ..settings })
    });
    pole(ui, session, &target, settings, actions, &set);
    hand(ui, session, &target, settings, actions, &set);
    widgets::folded_section(ui, "Soft limits of the limb", |ui| {
        soft_reach_sliders(ui, session, "Limb ", settings.soft_reach, actions, |soft_reach| {
            set(LimbSettings { soft_reach, ..settings })
        });
    });
}

fn reference(ui: &mut Ui, target: &Target, settings: LimbSettings, actions: &mut Actions) {
    let references = [
        (TwistReferenceKind::Fk, "FK", "Keep the side that the joint angles give"),
        (TwistReferenceKind::Up, "Up", "Measure from up"),
        (TwistReferenceKind::Pole, "Pole", "Measure from the direction to a point"),
        (TwistReferenceKind::Stereographic, "Stereographic", "Measure from a stereographic map"),
        (
            TwistReferenceKind::Transport,
            "Transport",
            "Carry the direction along the motion: no direction of the target is singular",
        ),
    ];
    let tooltip = "Choose the direction of the elbow or knee at twist 0";
    let choice = Choice { label: "Elbow from", name: "Elbow reference", tooltip, shown: "" };
    let chosen = choice.pick(ui, &references, |kind| *kind == settings.reference);
    let joint = target.joint;
    actions.extend(chosen.map(|reference| TargetEdit::SetReference { joint, reference }));
}

/// A pole in front of the elbow as it is posed, in the pole's space.
fn new_pole(session: &Session, target: &Target) -> Vec3 {
    let rig = session.rig();
    let index = rig.target(target.joint);
    let pole = index.and_then(|it| rig.new_pole(session.posed().evaluated_skeleton(), it));
    pole.unwrap_or(target.present_home())
}

fn pole(
    ui: &mut Ui,
    session: &Session,
    target: &Target,
    settings: LimbSettings,
    actions: &mut Actions,
    set: &impl Fn(LimbSettings) -> TargetEdit,
) {
    let Some((now, pole)) = settings.pole() else { return };
    let sliders = PointSliders {
        name: "Limb pole",
        labels: ["Pole x", "Pole y", "Pole z"],
        value: pole,
        default: new_pole(session, target),
        range: 1.5 * session.rig().reach(),
        step: session.shown().grid_cell() * 0.1,
        tooltip: "Move the pole",
        disabled: None,
        channel: Some(Channel::TargetPole(target.joint)),
    };
    sliders.show(ui, session, actions, |pole| set(LimbSettings { pole: Some(pole), ..settings }));
    of_pole(ui, session, target, now, actions);
}

/// Shows whether the hand or foot follows the lower bone or keeps its orientation, and its angles.
fn hand(
    ui: &mut Ui,
    session: &Session,
    target: &Target,
    settings: LimbSettings,
    actions: &mut Actions,
    set: &impl Fn(LimbSettings) -> TargetEdit,
) {
    let pose = &session.posed().evaluated_skeleton().solved;
    let hand = Limb::ending_at(pose, target.joint).ok().and_then(|limb| limb.hand);
    let row = ui.add_enabled_ui(hand.is_some(), |ui| {
        ui.horizontal(|ui| {
            let now = settings.orientation;
            let tooltip = "Turn the hand or foot with the bone above it";
            let joint = target.joint;
            if ui.radio(now.is_none(), "Follow bone").on_hover_text(tooltip).clicked() {
                actions.push(TargetEdit::KeepHand { joint, is_kept: false });
            }
            let tooltip = "Keep the orientation of the hand or foot in the target's space";
            if ui.radio(now.is_some(), "Keep orientation").on_hover_text(tooltip).clicked() {
                actions.push(TargetEdit::KeepHand { joint, is_kept: true });
            }
        });
    });
    if hand.is_none() {
        row.response.on_disabled_hover_text(NO_HAND);
    }
    let Some(angles) = settings.orientation else { return };
    for (axis, label) in AXES.into_iter().enumerate() {
        let name = format!("Target rotation {label}");
        let tooltip = "Rotate the hand or foot in the target's space";
        let slider = Slider {
            label: ["Rotate x", "Rotate y", "Rotate z"][axis],
            disabled: hand.is_none().then_some(NO_HAND),
            channel: Some(Channel::TargetOrientation(target.joint)),
            ..angle_slider(&name, tooltip, angles[axis])
        };
        slider.show(ui, session, actions, |degrees| {
            let turned = with_axis(angles, axis, degrees.to_radians());
            set(LimbSettings { orientation: Some(turned), ..settings })
        });
    }
}

/// Shows the choice of the target's space.
pub(super) fn of_target(ui: &mut Ui, session: &Session, target: &Target, actions: &mut Actions) {
    let choice = Choice {
        label: "Moves with",
        name: "Target space",
        tooltip: "Fix the target to the world or to a joint; it stays where it is",
        shown: name(session.rig(), target.space),
    };
    let put = |target: &mut Target, space| target.space = space;
    spaces(ui, session, target, target.space, &choice, put, |space| {
        actions.push(TargetEdit::SetTargetSpace { joint: target.joint, space });
    });
}

/// Shows the choice of the space of a limb's pole.
pub(super) fn of_pole(
    ui: &mut Ui,
    session: &Session,
    target: &Target,
    now: TargetSpace,
    actions: &mut Actions,
) {
    let choice = Choice {
        label: "Pole moves with",
        name: "Pole space",
        tooltip: "Fix the pole to the world or to a joint; it stays where it is",
        shown: name(session.rig(), now),
    };
    let put = |target: &mut Target, space| {
        if let Some(limb) = target.limb_mut() {
            limb.pole_space = space;
        }
    };
    spaces(ui, session, target, now, &choice, put, |space| {
        actions.push(TargetEdit::SetPoleSpace { joint: target.joint, space });
    });
}

fn name(rig: &SkeletonRig, space: TargetSpace) -> &str {
    space.joint().and_then(|joint| rig.skeleton.joint(joint)).map_or("World", |joint| &joint.name)
}

/// Shows a choice of spaces. `put` writes a space into a target, to find out whether the target
/// could be evaluated there.
fn spaces(
    ui: &mut Ui,
    session: &Session,
    target: &Target,
    now: TargetSpace,
    choice: &Choice<'_>,
    put: impl Fn(&mut Target, TargetSpace),
    mut choose: impl FnMut(TargetSpace),
) {
    choice.show(ui, |list| {
        let mut rig = session.rig().clone();
        let Some(index) = rig.target(target.joint) else { return };
        let joints = session.skeleton().ids().map(TargetSpace::Joint);
        for space in std::iter::once(TargetSpace::World).chain(joints) {
            put(&mut rig.targets[index], space);
            let refused = rig.check_target_spaces().err().map(|error| error.reason());
            let name = name(session.rig(), space);
            let tooltip = match space {
                TargetSpace::World => "Stay in the world",
                TargetSpace::Joint(_) => "Move and turn with this joint",
            };
            if list.item(space == now, name, tooltip, refused) {
                choose(space);
            }
        }
    });
}
