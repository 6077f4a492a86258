//! Figures and formulas of the arm with the numbers of the current pose; its hierarchy as a tree,
//! each part with what places it in its parent.

mod figure_pops;
mod figures;
mod pointer;
mod pops;
mod reach;
mod triangle;
mod twist_references;

use egui::{Align, Label, Layout, Pos2, RichText, Stroke, Ui, vec2};

use crate::document::Overlay;
use crate::session::{Actions, ArmFigure, Session, TourState};
use crate::ui::{pose_summary, widgets};
use figures::{Lit, degrees, figure_colour, length, point};

pub(super) use figure_pops::ui as figure_pops;
pub(super) use pops::ui as pops;
pub(super) use twist_references::ui as twist;

/// The triangle of the arm, a sentence on its pose, and its angles and lengths. Returns the figure
/// under the mouse.
pub(in crate::ui) fn triangle(
    ui: &mut Ui,
    session: &Session,
    actions: &mut Actions,
) -> Option<ArmFigure> {
    let lit = &mut Lit::new(session);
    triangle::ui(ui, session, lit);
    sentence(ui, session);
    widgets::section(ui, "Hierarchy", |ui| hierarchy(ui, session, lit, actions));
    widgets::section(ui, "Pointer", |ui| pointer::ui(ui, session, lit));
    widgets::section(ui, "Elbow triangle", |ui| triangle::quantities(ui, session, lit));
    widgets::section(ui, "Law of cosines", |ui| triangle::law_of_cosines(ui, session, lit));
    widgets::section(ui, "Positions", |ui| triangle::positions(ui, session, lit));
    lit.pointed()
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

/// A text on why the arm has no solver that iterates.
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

const ROW: f32 = 20.0;
const INDENT: f32 = 16.0;

/// A part of the hierarchy.
struct HierarchyRow {
    name: &'static str,
    depth: u8,
    figure: ArmFigure,
    value: String,
    meaning: &'static str,
}

fn hierarchy(ui: &mut Ui, session: &Session, lit: &mut Lit, actions: &mut Actions) {
    ui.scope(|ui| {
        ui.spacing_mut().item_spacing.y = 0.0;
        for part in parts(session) {
            lit.row(ui, part.figure, |ui| show(ui, &part));
        }
    });
    let (name, tooltip) = ("Axes in the view", "Show the axes of Root, Limb and Socket");
    widgets::overlay_check_box(ui, session, Overlay::Frames, name, tooltip, None, actions);
}

fn parts(session: &Session) -> [HierarchyRow; 5] {
    let (arm, pose) = (session.arm(), session.pose());
    let [upper, lower] =
        [arm.bones.upper(), arm.bones.lower()].map(|it| length(arm, it * pose.stretch));
    [
        HierarchyRow {
            name: "Root",
            depth: 0,
            figure: ArmFigure::Root,
            value: point(arm, arm.root),
            meaning: "The Root places the shoulder in the world",
        },
        HierarchyRow {
            name: "Limb",
            depth: 1,
            figure: ArmFigure::Limb,
            value: format!("yaw {}, pitch {}", degrees(pose.yaw()), degrees(pose.pitch())),
            meaning: "The Limb turns in the Root until its x axis, the Pointer, goes through the Cursor",
        },
        HierarchyRow {
            name: "Socket",
            depth: 2,
            figure: ArmFigure::Socket,
            value: format!("twist {}", degrees(pose.twist)),
            meaning: "The Socket turns in the Limb about the Pointer and takes the elbow along",
        },
        HierarchyRow {
            name: "Upper limb",
            depth: 3,
            figure: ArmFigure::Upper,
            value: format!("length {upper}"),
            meaning: "The Upper limb leads from the shoulder to the elbow, in the Socket's xy-plane",
        },
        HierarchyRow {
            name: "Lower limb",
            depth: 3,
            figure: ArmFigure::Lower,
            value: format!("length {lower}"),
            meaning: "The Lower limb leads from the elbow to the hand, in the Socket's xy-plane",
        },
    ]
}

/// Shows a row, with a line from its parent's, and returns its rectangle.
fn show(ui: &mut Ui, part: &HierarchyRow) -> egui::Rect {
    let size = vec2(ui.available_width(), ROW);
    let row = ui.allocate_ui_with_layout(size, Layout::left_to_right(Align::Center), |ui| {
        let left = ui.max_rect().left_center();
        ui.add_space(INDENT * f32::from(part.depth));
        if part.depth > 0 {
            paint_branch(ui, left + vec2(INDENT * (f32::from(part.depth) - 0.5), 0.0));
        }
        let colour = figure_colour(ui, Some(part.figure));
        let name = Label::new(RichText::new(part.name).color(colour)).selectable(false);
        ui.add(name).on_hover_text(part.meaning);
        widgets::value(ui, &part.value);
    });
    row.response.rect
}

/// Paints the branch of a tree, from the row above to the right of `corner`.
fn paint_branch(ui: &Ui, corner: Pos2) {
    let stroke = Stroke::new(1.0, ui.visuals().weak_text_color());
    let top = corner - vec2(0.0, 0.5 * ROW);
    ui.painter().line(vec![top, corner, corner + vec2(0.35 * INDENT, 0.0)], stroke);
}
