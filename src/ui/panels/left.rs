//! The left panel: the rig's settings, guides and display.

use egui::{ScrollArea, Ui};

use super::{arm, overlays, skeleton};
use crate::document::{Overlay, RigKind};
use crate::session::{Actions, EditAction, Session};
use crate::ui::widgets::{self, Segment};

pub(in crate::ui) fn ui(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    ui.add_space(4.0);
    rig(ui, session, actions);
    ui.add_space(2.0);
    let note = skeleton::noted(session);
    let height = ui.available_height();
    let room = height - note.map_or(0.0, |_| skeleton::note_height(height));
    let rows = ScrollArea::vertical().auto_shrink(false).max_height(room);
    rows.show(ui, |ui| {
        match session.rig() {
            RigKind::Arm => arm::ui(ui, session, actions),
            RigKind::Skeleton => skeleton::ui(ui, session, actions),
        }
        widgets::section(ui, "Guides", |ui| {
            overlays::check_boxes(ui, session, 2, guides(session), None, actions);
        });
        if session.rig() == RigKind::Arm {
            arm::more(ui, session, actions);
        }
        let hand = (session.rig() == RigKind::Arm).then_some(Overlay::Hand);
        let surroundings: Vec<_> = Overlay::SURROUNDINGS.into_iter().chain(hand).collect();
        widgets::folded_section(ui, "Display", |ui| {
            overlays::check_boxes(ui, session, 3, &surroundings, None, actions);
        });
        resets(ui, session, actions);
        ui.add_space(8.0);
    });
    if let Some(target) = note {
        skeleton::note(ui, session, target, actions);
    }
}

fn rig(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    let rigs = [
        Segment {
            name: "Arm",
            tooltip: "Pose an arm of two limbs, solved in closed form",
            value: RigKind::Arm,
        },
        Segment {
            name: "Skeleton",
            tooltip: "Pose a tree of joints, solved by iteration",
            value: RigKind::Skeleton,
        },
    ];
    let chosen = widgets::segments(ui, session.rig(), &rigs);
    actions.extend(chosen.map(EditAction::ShowRig));
}

fn guides(session: &Session) -> &'static [Overlay] {
    match session.rig() {
        RigKind::Arm => &Overlay::GUIDES,
        RigKind::Skeleton if !session.skeleton_rig().follow_paths.is_empty() => {
            &[Overlay::Cursor, Overlay::Pointer, Overlay::FkPose, Overlay::ElbowCircle]
        }
        RigKind::Skeleton => &[Overlay::Cursor, Overlay::FkPose, Overlay::ElbowCircle],
    }
}

fn resets(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    let (name, tooltip) = match session.rig() {
        RigKind::Arm => ("Reset pose", "Reset everything that poses the arm"),
        RigKind::Skeleton => ("Reset to bind pose", "Set every joint rotation to 0"),
    };
    ui.horizontal(|ui| {
        if ui.button(name).on_hover_text(tooltip).clicked() {
            actions.push(EditAction::ResetPose);
        }
        let all = ui
            .button("Reset all")
            .on_hover_text("Reset pose, guides, display and view; hide the crowd");
        if all.clicked() {
            actions.push(EditAction::ResetAll);
        }
    });
}
