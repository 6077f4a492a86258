//! The quantities of the arm's triangle, and where they place the elbow.

use egui::Ui;
use glam::Vec3;

use super::formulas::{FormulaRow, degrees, length, pair, point, table};
use super::lit::Lit;
use crate::session::{ArmFigure, Session};
use crate::ui::style;

/// Shows the quantities of the triangle.
pub(super) fn triangle(ui: &mut Ui, session: &Session, lit: &mut Lit) {
    let rows = quantities(ui, session);
    table(ui, "triangle", &rows, lit);
}

/// Shows the positions of Cursor and elbow.
pub(super) fn positions(ui: &mut Ui, session: &Session, lit: &mut Lit) {
    let (arm, pose) = (session.arm(), session.pose());
    let in_socket = Vec3::new(pose.along, pose.out, 0.0);
    let cursor =
        ["Cursor c", "x_c, y_c and z_c: the Cursor in Root space; where FK has a part, the hand"];
    let socket = ["Elbow in Socket", "h_e along the Pointer and o_e away from it"];
    let elbow =
        ["Elbow e", "x_e, y_e and z_e: the elbow in Root space, turned there by Socket and Limb"];
    pair(ui, lit, ArmFigure::Cursor, cursor, point(arm, arm.pointed_at(pose)));
    pair(ui, lit, ArmFigure::Out, socket, point(arm, in_socket));
    pair(ui, lit, ArmFigure::Elbow, elbow, point(arm, pose.elbow));
}

fn quantities(ui: &Ui, session: &Session) -> [FormulaRow; 8] {
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
            figure: Some(ArmFigure::Upper),
        },
        FormulaRow {
            symbol: "Lower d_2",
            formula: "",
            value: length(arm, lower),
            meaning: "Length of the Lower limb",
            colour: Some(style::colour(palette.lower)),
            figure: Some(ArmFigure::Lower),
        },
        FormulaRow {
            symbol: "Sum L",
            formula: "d_1 + d_2",
            value: length(arm, outer),
            meaning: "Reach of the straight arm",
            colour: None,
            figure: None,
        },
        FormulaRow {
            symbol: "Difference δ",
            formula: "d_1 − d_2",
            value: length(arm, difference),
            meaning: "Difference of the limb lengths; its size is the inner limit",
            colour: None,
            figure: None,
        },
        FormulaRow {
            symbol: "Along h_e",
            formula: "(D + δ L / D) / 2",
            value: length(arm, pose.along),
            meaning: "Distance of the elbow along the Pointer",
            colour: None,
            figure: Some(ArmFigure::Along),
        },
        FormulaRow {
            symbol: "Out o_e",
            formula: "√((d_1 − h_e)(d_1 + h_e))",
            value: length(arm, pose.out),
            meaning: "Distance of the elbow from the Pointer: twice the triangle's area over D",
            colour: None,
            figure: Some(ArmFigure::Out),
        },
        FormulaRow {
            symbol: "Shoulder θ_e",
            formula: "atan2(o_e, h_e)",
            value: degrees(pose.shoulder_angle()),
            meaning: "Angle at the shoulder, between Pointer and Upper limb",
            colour: None,
            figure: Some(ArmFigure::ShoulderAngle),
        },
        FormulaRow {
            symbol: "Elbow angle φ",
            formula: "",
            value: degrees(pose.elbow_angle()),
            meaning: "Inner angle at the elbow: 180° straight, 0° folded",
            colour: None,
            figure: Some(ArmFigure::ElbowAngle),
        },
    ]
}
