//! The left panel: the rig's settings, guides and display.

use egui::{ScrollArea, Ui};

use super::{arm, skeleton};
use crate::document::{Overlay, RigKind};
use crate::session::{Actions, EditAction, Session};
use crate::ui::labels;
use crate::ui::widgets;

pub(in crate::ui) fn ui(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    ui.add_space(4.0);
    rig(ui, session, actions);
    ui.add_space(2.0);
    ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        match session.rig() {
            RigKind::Arm => arm::ui(ui, session, actions),
            RigKind::Skeleton => skeleton::ui(ui, session, actions),
        }
        widgets::section(ui, "Guides", |ui| overlays(ui, session, 2, guides(session), actions));
        let hand = (session.rig() == RigKind::Arm).then_some(Overlay::Hand);
        let surroundings: Vec<_> = Overlay::SURROUNDINGS.into_iter().chain(hand).collect();
        widgets::section(ui, "Display", |ui| overlays(ui, session, 3, &surroundings, actions));
        resets(ui, session, actions);
        ui.add_space(8.0);
    });
}

fn rig(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    let rigs = [
        (RigKind::Arm, "Arm", "Pose an arm of two limbs, solved in closed form"),
        (RigKind::Skeleton, "Skeleton", "Pose a tree of joints, solved by iteration"),
    ];
    ui.columns(2, |columns| {
        for (column, (rig, name, tooltip)) in columns.iter_mut().zip(rigs) {
            let chosen = session.rig() == rig;
            let layout = egui::Layout::top_down_justified(egui::Align::Center);
            column.with_layout(layout, |ui| {
                let button =
                    ui.add(egui::Button::selectable(chosen, name).frame_when_inactive(true));
                if button.on_hover_text(tooltip).clicked() && !chosen {
                    actions.push(EditAction::ShowRig(rig));
                }
            });
        }
    });
}

fn guides(session: &Session) -> &'static [Overlay] {
    match session.rig() {
        RigKind::Arm => &Overlay::GUIDES,
        RigKind::Skeleton if session.skeleton_rig().follow_path.is_some() => {
            &[Overlay::Cursor, Overlay::Pointer, Overlay::FkPose]
        }
        RigKind::Skeleton => &[Overlay::Cursor, Overlay::FkPose],
    }
}

/// Shows check boxes of overlays in `count` columns.
fn overlays(
    ui: &mut Ui,
    session: &Session,
    count: usize,
    overlays: &[Overlay],
    actions: &mut Actions,
) {
    ui.columns(count, |columns| {
        for (index, overlay) in overlays.iter().enumerate() {
            let (name, tooltip) = labels::overlay(session.rig(), *overlay);
            let mut shown = session.shown().display.shows(*overlay);
            let column = &mut columns[index % count];
            if column.checkbox(&mut shown, name).on_hover_text(tooltip).changed() {
                actions.push(EditAction::ShowOverlay(*overlay, shown));
            }
        }
    });
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
