//! The hierarchy of the arm as a tree, each part with what places it in its parent.

use egui::{Align, Label, Layout, Pos2, RichText, Stroke, Ui, vec2};

use super::drawing::Lit;
use super::formulas::{degrees, length, point};
use crate::document::Overlay;
use crate::session::{Actions, ArmFigure, DisplayEdit, Session};
use crate::ui::style;

const ROW: f32 = 20.0;
const INDENT: f32 = 16.0;

/// A part of the hierarchy.
struct Part {
    name: &'static str,
    depth: u8,
    figure: ArmFigure,
    value: String,
    meaning: &'static str,
}

pub(super) fn ui(ui: &mut Ui, session: &Session, lit: &mut Lit, actions: &mut Actions) {
    ui.scope(|ui| {
        ui.spacing_mut().item_spacing.y = 0.0;
        for part in parts(session) {
            lit.row(ui, part.figure, |ui| show(ui, &part));
        }
    });
    let mut shown = session.shown().display.shows(Overlay::Frames);
    let tooltip = "Show the axes of Root, Limb and Socket";
    if ui.checkbox(&mut shown, "Axes in the view").on_hover_text(tooltip).changed() {
        actions.push(DisplayEdit::ShowOverlay(Overlay::Frames, shown));
    }
}

fn parts(session: &Session) -> [Part; 5] {
    let (arm, pose) = (session.arm(), session.pose());
    let [upper, lower] =
        [arm.bones.upper(), arm.bones.lower()].map(|it| length(arm, it * pose.stretch));
    [
        Part {
            name: "Root",
            depth: 0,
            figure: ArmFigure::Root,
            value: point(arm, arm.root),
            meaning: "The Root places the shoulder in the world",
        },
        Part {
            name: "Limb",
            depth: 1,
            figure: ArmFigure::Limb,
            value: format!("yaw {}, pitch {}", degrees(pose.yaw()), degrees(pose.pitch())),
            meaning: "The Limb turns in the Root until its x axis, the Pointer, goes through the Cursor",
        },
        Part {
            name: "Socket",
            depth: 2,
            figure: ArmFigure::Socket,
            value: format!("twist {}", degrees(pose.twist)),
            meaning: "The Socket turns in the Limb about the Pointer and takes the elbow along",
        },
        Part {
            name: "Upper limb",
            depth: 3,
            figure: ArmFigure::Upper,
            value: format!("length {upper}"),
            meaning: "The Upper limb leads from the shoulder to the elbow, in the Socket's xy-plane",
        },
        Part {
            name: "Lower limb",
            depth: 3,
            figure: ArmFigure::Lower,
            value: format!("length {lower}"),
            meaning: "The Lower limb leads from the elbow to the hand, in the Socket's xy-plane",
        },
    ]
}

/// Shows a row, with a line from its parent's, and returns its rectangle.
fn show(ui: &mut Ui, part: &Part) -> egui::Rect {
    let size = vec2(ui.available_width(), ROW);
    let row = ui.allocate_ui_with_layout(size, Layout::left_to_right(Align::Center), |ui| {
        let left = ui.max_rect().left_center();
        ui.add_space(INDENT * f32::from(part.depth));
        if part.depth > 0 {
            paint_branch(ui, left + vec2(INDENT * (f32::from(part.depth) - 0.5), 0.0));
        }
        let palette = style::palette(ui);
        let colour = match part.figure {
            ArmFigure::Upper => style::colour(palette.upper),
            ArmFigure::Lower => style::colour(palette.lower),
            _ => ui.visuals().text_color(),
        };
        let name = Label::new(RichText::new(part.name).color(colour)).selectable(false);
        ui.add(name).on_hover_text(part.meaning);
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            ui.label(RichText::new(&part.value).monospace());
        });
    });
    row.response.rect
}

/// Paints the branch of a tree, from the row above to the right of `corner`.
fn paint_branch(ui: &Ui, corner: Pos2) {
    let stroke = Stroke::new(1.0, ui.visuals().weak_text_color());
    let top = corner - vec2(0.0, 0.5 * ROW);
    ui.painter().line(vec![top, corner, corner + vec2(0.35 * INDENT, 0.0)], stroke);
}
