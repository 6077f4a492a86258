//! The left panel: which rig it is, its parts, and what is shown.

use egui::{ScrollArea, Ui};
use glam::Vec3;

use super::point::Point;
use super::{arm, joint, motion, outliner, point, targets, widgets};
use crate::document::{Overlay, RigKind};
use crate::session::{Action, Session};

pub(super) fn ui(ui: &mut Ui, session: &Session, actions: &mut Vec<Action>) {
    ui.add_space(4.0);
    rig(ui, session, actions);
    ui.add_space(2.0);
    ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        match session.rig() {
            RigKind::Arm => arm::ui(ui, session, actions),
            RigKind::Skeleton => skeleton(ui, session, actions),
        }
        widgets::section(ui, "Guides", |ui| layers(ui, session, 2, guides(session), actions));
        let hand = (session.rig() == RigKind::Arm).then_some(Overlay::Hand);
        let surroundings: Vec<_> = Overlay::SURROUNDINGS.into_iter().chain(hand).collect();
        widgets::section(ui, "Display", |ui| layers(ui, session, 3, &surroundings, actions));
        resets(ui, session, actions);
        ui.add_space(8.0);
    });
}

fn rig(ui: &mut Ui, session: &Session, actions: &mut Vec<Action>) {
    let rigs = [
        (RigKind::Arm, "Arm", "Two limbs in closed form"),
        (RigKind::Skeleton, "Skeleton", "A tree of joints, brought to targets by iteration"),
    ];
    ui.columns(2, |columns| {
        for (column, (rig, name, tooltip)) in columns.iter_mut().zip(rigs) {
            let chosen = session.rig() == rig;
            let layout = egui::Layout::top_down_justified(egui::Align::Center);
            column.with_layout(layout, |ui| {
                let button =
                    ui.add(egui::Button::selectable(chosen, name).frame_when_inactive(true));
                if button.on_hover_text(tooltip).clicked() && !chosen {
                    actions.push(Action::ShowRig(rig));
                }
            });
        }
    });
}

fn skeleton(ui: &mut Ui, session: &Session, actions: &mut Vec<Action>) {
    let rig = session.skeleton();
    widgets::section(ui, "Joints", |ui| outliner::ui(ui, session, actions));
    if let Some(selected) = session.selected()
        && let Some(joint) = rig.skeleton.joint(selected)
    {
        let title = format!("Joint: {}", joint.name);
        widgets::named_section(ui, "joint", &title, |ui| joint::ui(ui, session, selected, actions));
        if let Some(target) = rig.target(selected) {
            let title = format!("Target of {}", joint.name);
            let target = rig.targets[target];
            widgets::named_section(ui, "target", &title, |ui| {
                targets::selected(ui, session, target, actions);
            });
        }
    }
    widgets::section(ui, "Targets", |ui| targets::list(ui, session, actions));
    widgets::section(ui, "Place", |ui| place(ui, session, actions));
    widgets::section(ui, "Motion", |ui| motion::ui(ui, session, actions));
}

fn place(ui: &mut Ui, session: &Session, actions: &mut Vec<Action>) {
    let rig = session.skeleton();
    let place = Point {
        name: "Skeleton",
        labels: point::AXES,
        value: rig.skeleton.transform().translation.into(),
        default: Vec3::ZERO,
        range: 2.0 * rig.reach(),
        step: session.shown().cell() * 0.1,
        tooltip: "Where the skeleton's own origin is, in the world; its targets stay",
        disabled: None,
    };
    place.show(ui, session, actions, Action::SetTranslation);
}

fn guides(session: &Session) -> &'static [Overlay] {
    match session.rig() {
        RigKind::Arm => &Overlay::GUIDES,
        RigKind::Skeleton if session.skeleton().follow_path.is_some() => {
            &[Overlay::Cursor, Overlay::Pointer]
        }
        RigKind::Skeleton => &[Overlay::Cursor],
    }
}

/// In so many columns.
fn layers(
    ui: &mut Ui,
    session: &Session,
    count: usize,
    layers: &[Overlay],
    actions: &mut Vec<Action>,
) {
    ui.columns(count, |columns| {
        for (index, layer) in layers.iter().enumerate() {
            let (name, tooltip) = describe(session.rig(), *layer);
            let mut shown = session.shown().display.shows(*layer);
            let column = &mut columns[index % count];
            if column.checkbox(&mut shown, name).on_hover_text(tooltip).changed() {
                actions.push(Action::Show(*layer, shown));
            }
        }
    });
}

/// What a layer is called, and what it is.
pub(super) fn describe(rig: RigKind, layer: Overlay) -> (&'static str, &'static str) {
    match (rig, layer) {
        (RigKind::Skeleton, Overlay::Cursor) => {
            ("Targets", "Where tips are asked to be, with their ways and the gaps to them")
        }
        (RigKind::Skeleton, Overlay::Pointer) => ("Path", "The way that the head goes"),
        (RigKind::Arm, Overlay::Trail) => {
            ("Trail", "The way of the hand, with a dot for every frame")
        }
        (RigKind::Skeleton, Overlay::Trail) => {
            ("Trail", "The way of the selected joint's tip, with a dot for every frame")
        }
        (_, Overlay::OnionSkins) => {
            ("Onion skins", "The rig as it stands 5, 10 and 15 frames before and after")
        }
        (RigKind::Skeleton, Overlay::Labels) => ("Labels", "Names of the selected joints"),
        (RigKind::Arm, Overlay::Cursor) => {
            ("Cursor", "A small sphere where the hand is asked to be")
        }
        (RigKind::Arm, Overlay::Pointer) => (
            "Pointer",
            "The axis from the Root through the hand to the Cursor, as long as the whole arm",
        ),
        (_, Overlay::InnerLimit) => (
            "Inner limit",
            "The sphere that the hand cannot enter: its radius is the difference of the lengths",
        ),
        (_, Overlay::OuterLimit) => (
            "Outer limit",
            "The sphere that the hand cannot leave: its radius is the sum of the lengths",
        ),
        (_, Overlay::Hand) => {
            ("Hand", "A hand at the wrist, and stripes that show the forearm's roll")
        }
        (_, Overlay::Globe) => (
            "Singularity globe",
            "The outer limit, hot where a small move of the hand turns the elbow far",
        ),
        (_, Overlay::References) => (
            "Four references",
            "The elbow as each reference would have it, with how far apart they are",
        ),
        (_, Overlay::GridXy) => ("XY grid", "The grid in which z is 0"),
        (_, Overlay::GridXz) => ("XZ grid", "The grid in which y is 0"),
        (_, Overlay::GridYz) => ("YZ grid", "The grid in which x is 0"),
        (_, Overlay::Ground) => ("Ground", "A floor at y = 0"),
        (_, Overlay::Axes) => ("Axes", "Arrows along the world's x, y and z"),
        (RigKind::Arm, Overlay::Labels) => ("Labels", "Names at root, elbow and hand"),
        (_, Overlay::Shadow) => ("Shadow", "Soft on the floor: the higher the rig, the softer"),
    }
}

fn resets(ui: &mut Ui, session: &Session, actions: &mut Vec<Action>) {
    let (name, tooltip) = match session.rig() {
        RigKind::Arm => (
            "Reset pose",
            "Reset hand, pin, elbow, root, lengths, soft limits, FK and hand orientation",
        ),
        RigKind::Skeleton => ("Bind pose", "Every joint without rotation"),
    };
    ui.horizontal(|ui| {
        if ui.button(name).on_hover_text(tooltip).clicked() {
            actions.push(Action::ResetPose);
        }
        let all = ui
            .button("Reset all")
            .on_hover_text("Reset the pose, guides, display and view, and hide the crowd");
        if all.clicked() {
            actions.push(Action::ResetAll);
        }
    });
}
