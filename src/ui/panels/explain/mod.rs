//! Figures and formulas of the arm with the numbers of the current pose.

mod drawing;
mod elbow;
mod formulas;
mod hierarchy;
mod pointer;
mod pops;
mod reach;
mod triangle;
mod twist_references;

use egui::{Ui, vec2};

use crate::session::{Actions, ArmFigure, Session, TourState};
use crate::ui::{pose_summary, widgets};
use drawing::Lit;

/// The triangle of the arm, a sentence on its pose, and its angles and lengths. Returns the figure
/// under the mouse.
pub(in crate::ui) fn triangle(
    ui: &mut Ui,
    session: &Session,
    actions: &mut Actions,
) -> Option<ArmFigure> {
    let mut lit = Lit::new(session);
    triangle::ui(ui, session, &mut lit);
    sentence(ui, session);
    let lit = &mut lit;
    widgets::section(ui, "Hierarchy", |ui| hierarchy::ui(ui, session, lit, actions));
    widgets::section(ui, "Pointer", |ui| pointer::ui(ui, session, lit));
    widgets::section(ui, "Elbow triangle", |ui| elbow::triangle(ui, session, lit));
    widgets::section(ui, "Law of cosines", |ui| elbow::law_of_cosines(ui, session, lit));
    widgets::section(ui, "Positions", |ui| elbow::positions(ui, session, lit));
    lit.pointed()
}

/// The twist references compared.
pub(in crate::ui) fn twist(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    twist_references::ui(ui, session, actions);
}

/// The distances that the hand can have, and those that it has.
pub(in crate::ui) fn reach(ui: &mut Ui, session: &Session) {
    reach::meter(ui, session);
    sentence(ui, session);
    // A step of the tour asks for what this section shows.
    if session.tour().is_none_or(TourState::shows_result) {
        widgets::section(ui, "Same step, two poses", |ui| reach::same_step(ui, session));
    }
    widgets::section(ui, "Reach curve", |ui| reach::curve(ui, session));
}

/// The elbow's jumps with their causes and fixes.
pub(in crate::ui) fn pops(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    pops::ui(ui, session, actions);
}

/// Why the arm has no solver that iterates.
pub(in crate::ui) fn closed_form(ui: &mut Ui, session: &Session) {
    let arm = session.arm();
    let [upper, lower] = [arm.bones.upper(), arm.bones.lower()].map(|it| arm.format_length(it));
    let distance = arm.format_length(session.pose().distance);
    ui.label(format!(
        "Two limbs need no iterations. Their lengths {upper} and {lower} and the distance {distance} from \
         shoulder to hand are the three sides of a triangle, and three sides fix all its angles."
    ));
    ui.add_space(4.0);
    ui.label(
        "A longer chain has many poses with its tip at the target. A solver finds one of them step by \
         step: show a skeleton to watch that.",
    );
}

fn sentence(ui: &mut Ui, session: &Session) {
    // Always as high as the longest sentence, so that nothing below moves.
    let height = 3.0 * ui.text_style_height(&egui::TextStyle::Body) + 4.0;
    ui.allocate_ui(vec2(ui.available_width(), height), |ui| {
        ui.set_min_height(height);
        ui.label(pose_summary::sentence(session.arm(), session.pose()));
    });
}
