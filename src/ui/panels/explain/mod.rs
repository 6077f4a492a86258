//! Figures and formulas of the arm with the numbers of the current pose.

mod pops;
mod reach_curve;
mod reach_meter;
mod triangle;
mod twist_references;

use egui::{Align, Color32, Grid, Layout, RichText, Ui, vec2};

use crate::document::Arm;
use crate::session::{Actions, Session};
use crate::ui::widgets::{self, symbol};
use crate::ui::{pose_summary, style};

const FORMULA_SIZE: f32 = 13.5;

/// A quantity with symbol, formula, value and meaning.
struct FormulaRow {
    symbol: &'static str,
    formula: &'static str,
    value: String,
    meaning: &'static str,
    colour: Option<Color32>,
}

/// The triangle of the arm, a sentence on its pose, and its angles and lengths.
pub(in crate::ui) fn triangle(ui: &mut Ui, session: &Session) {
    triangle::ui(ui, session.arm(), session.pose());
    sentence(ui, session);
    widgets::section(ui, "Pointer", |ui| table(ui, "pointer", &pointer(session)));
    widgets::section(ui, "Elbow triangle", |ui| table(ui, "triangle", &elbow(ui, session)));
}

/// The twist references compared.
pub(in crate::ui) fn twist(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    twist_references::ui(ui, session, actions);
}

/// The distances that the hand can have, and those that it has.
pub(in crate::ui) fn reach(ui: &mut Ui, session: &Session) {
    reach_meter::ui(ui, session);
    sentence(ui, session);
    widgets::section(ui, "Reach curve", |ui| reach_curve::ui(ui, session));
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

fn pointer(session: &Session) -> [FormulaRow; 4] {
    let (arm, pose) = (session.arm(), session.pose());
    let cursor = if arm.uses_ik() { arm.cursor_in_root() } else { pose.hand };
    [
        FormulaRow {
            symbol: "Yaw θ_z",
            formula: "atan2(z_c, x_c)",
            value: degrees(pose.yaw()),
            meaning: "Angle of the Pointer about the vertical, from x towards z",
            colour: None,
        },
        FormulaRow {
            symbol: "Level h_c",
            formula: "hypot(x_c, z_c)",
            value: length(arm, cursor.x.hypot(cursor.z)),
            meaning: "Horizontal distance from the Root to the Cursor (x_c, y_c, z_c)",
            colour: None,
        },
        FormulaRow {
            symbol: "Pitch θ_y",
            formula: "atan2(y_c, h_c)",
            value: degrees(pose.pitch()),
            meaning: "Angle of the Pointer above the xz-plane",
            colour: None,
        },
        FormulaRow {
            symbol: "Distance D",
            formula: match arm.soft_reach.is_hard() {
                true => "|c|, limited",
                false => "|c|, softened",
            },
            value: length(arm, pose.distance),
            meaning: "Distance from shoulder to hand: the Cursor's, within the limits",
            colour: None,
        },
    ]
}

fn elbow(ui: &Ui, session: &Session) -> [FormulaRow; 8] {
    let (arm, pose) = (session.arm(), session.pose());
    let bones = arm.bones;
    let [upper, lower] = [bones.upper(), bones.lower()].map(|length| length * pose.stretch);
    let (outer, difference) = (upper + lower, upper - lower);
    let palette = style::palette(ui);
    [
        FormulaRow {
            symbol: "Upper d_1",
            formula: "",
            value: length(arm, upper),
            meaning: "Length of the Upper limb",
            colour: Some(style::colour(palette.upper)),
        },
        FormulaRow {
            symbol: "Lower d_2",
            formula: "",
            value: length(arm, lower),
            meaning: "Length of the Lower limb",
            colour: Some(style::colour(palette.lower)),
        },
        FormulaRow {
            symbol: "Sum L",
            formula: "d_1 + d_2",
            value: length(arm, outer),
            meaning: "Reach of the straight arm",
            colour: None,
        },
        FormulaRow {
            symbol: "Difference δ",
            formula: "d_1 − d_2",
            value: length(arm, difference),
            meaning: "Difference of the limb lengths; its size is the inner limit",
            colour: None,
        },
        FormulaRow {
            symbol: "Along h_e",
            formula: "(D + δ L / D) / 2",
            value: length(arm, pose.along),
            meaning: "Distance of the elbow along the Pointer",
            colour: None,
        },
        FormulaRow {
            symbol: "Out o_e",
            formula: "√((d_1 − h_e)(d_1 + h_e))",
            value: length(arm, pose.out),
            meaning: "Distance of the elbow from the Pointer: twice the triangle's area over D",
            colour: None,
        },
        FormulaRow {
            symbol: "Shoulder θ_e",
            formula: "atan2(o_e, h_e)",
            value: degrees(pose.shoulder_angle()),
            meaning: "Angle at the shoulder, between Pointer and Upper limb",
            colour: None,
        },
        FormulaRow {
            symbol: "Elbow angle φ",
            formula: "",
            value: degrees(pose.elbow_angle()),
            meaning: "Inner angle at the elbow: 180° straight, 0° folded",
            colour: None,
        },
    ]
}

fn table(ui: &mut Ui, id: &str, quantities: &[FormulaRow]) {
    let (text, weak) = (ui.visuals().text_color(), ui.visuals().weak_text_color());
    Grid::new(id).num_columns(3).min_col_width(24.0).spacing(vec2(10.0, 4.0)).show(ui, |ui| {
        for quantity in quantities {
            let colour = quantity.colour.unwrap_or(text);
            symbol::label(ui, quantity.symbol, FORMULA_SIZE, colour)
                .on_hover_text(quantity.meaning);
            if quantity.formula.is_empty() {
                ui.label("");
            } else {
                symbol::label(ui, quantity.formula, FORMULA_SIZE, weak)
                    .on_hover_text(quantity.meaning);
            }
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                ui.label(RichText::new(&quantity.value).monospace());
            });
            ui.end_row();
        }
    });
}

fn degrees(radians: f32) -> String {
    format!("{:.1}°", tidy(radians.to_degrees()))
}

/// Formats a length of the arm; a length that rounds to 0 is shown without a sign.
fn length(arm: &Arm, length: f32) -> String {
    let nothing = 0.0005 * arm.grid_cell();
    arm.format_length(if length.abs() < nothing { 0.0 } else { length })
}

/// Returns 0 for a value that rounds to 0 at one decimal, so that 0 has no sign; otherwise the
/// value.
fn tidy(value: f32) -> f32 {
    if value.abs() < 0.05 { 0.0 } else { value }
}
