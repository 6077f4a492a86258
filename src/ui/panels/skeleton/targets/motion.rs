//! Motion of a target along a path.

use egui::Ui;

use super::super::choice::Choice;
use crate::document::{Target, TargetMotion, TargetPath};
use crate::session::{Actions, EditAction, PlaybackAction, Session};
use crate::ui::widgets::{self, NumberField, format};

const PATHS: [(TargetPath, &str, &str); 3] = [
    (TargetPath::Still, "Still", "Stay in place, or where keys put it"),
    (TargetPath::Circle, "Circle", "Go around a circle"),
    (TargetPath::FigureEight, "Figure eight", "Go around an eight"),
];

/// Shows the choice of the path.
pub(super) fn path(ui: &mut Ui, target: Target, actions: &mut Actions) {
    let now = PATHS.iter().find(|(path, ..)| *path == target.motion.path);
    let choice = Choice {
        label: "Motion",
        name: "Motion",
        tooltip: "Move the target along a path during playback",
        shown: now.map_or("", |now| now.1),
    };
    choice.show(ui, |list| {
        for (path, name, tooltip) in PATHS {
            if list.item(path == target.motion.path, name, tooltip, None) {
                let motion = TargetMotion { path, ..target.motion };
                actions.push(EditAction::SetTarget(Target { motion, ..target }));
                actions.push(PlaybackAction::Play(path != TargetPath::Still));
            }
        }
    });
}

/// Shows the size and the period of the path.
pub(super) fn ui(ui: &mut Ui, session: &Session, target: Target, step: f32, actions: &mut Actions) {
    let set = |motion| EditAction::SetTarget(Target { motion, ..target });
    widgets::pair(ui, "Radius", |ui| {
        let radius = NumberField {
            name: "Radius",
            value: target.motion.radius,
            unit: "",
            step,
            digits: format::decimals(step),
            tooltip: "Set the radius of the path",
        };
        radius.show(ui, session, actions, |radius| set(TargetMotion { radius, ..target.motion }));
    });
    widgets::pair(ui, "Period", |ui| {
        let period = NumberField {
            name: "Period",
            value: target.motion.period,
            unit: " s",
            step: 0.1,
            digits: 2,
            tooltip: "Set the time for one round",
        };
        period.show(ui, session, actions, |period| set(TargetMotion { period, ..target.motion }));
    });
}
