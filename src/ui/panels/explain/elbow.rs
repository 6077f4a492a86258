//! The quantities of the arm's triangle, and where they place the elbow; the angle at the shoulder
//! by the law of cosines, beside the form that the solver uses.

use egui::{RichText, Ui};
use glam::Vec3;

use super::drawing::Lit;
use super::formulas::{FormulaRow, degrees, formula, length, pair, point, table};
use crate::document::Arm;
use crate::kinematics::two_bone::TwoBonePose;
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

pub(super) fn law_of_cosines(ui: &mut Ui, session: &Session, lit: &mut Lit) {
    let (arm, pose) = (session.arm(), session.pose());
    let [upper, lower] = [arm.bones.upper(), arm.bones.lower()].map(|it| it * pose.stretch);
    let [d1, d2, d] = [upper, lower, pose.distance].map(|it| length(arm, it));
    let Some(cosine) = Cosine::new(arm, pose) else {
        ui.label("The hand is at the shoulder: there is no triangle.");
        return;
    };
    lit.row(ui, ArmFigure::ShoulderAngle, |ui| {
        let lines = ui.vertical(|ui| {
            ui.weak("Written out");
            formula(ui, "d_2² = d_1² + D² − 2 d_1 D cos θ_e");
            ui.weak("Filled in");
            formula(ui, &format!("{d2}² = {d1}² + {d}² − 2 · {d1} · {d} cos θ_e"));
            let [cos, angle] = [cosine.cosine, cosine.by_cosine.to_degrees()];
            formula(ui, &format!("cos θ_e = {cos:.4}, so θ_e = {angle:.1}°"));
        });
        lines.response.rect
    });
    ui.add_space(4.0);
    ui.weak("The solver's form");
    formula(ui, "h_e = (D + δ L / D) / 2");
    formula(ui, "d_1 − h_e = (L − D)(D − δ) / (2 D)");
    formula(ui, "o_e = √((d_1 − h_e)(d_1 + h_e))");
    formula(ui, "θ_e = atan2(o_e, h_e)");
    ui.add_space(4.0);
    ui.label(
        "Near a straight or folded arm the cosine hardly changes with the angle, so a rounded cosine \
         gives a wrong angle and the elbow trembles. The solver's form subtracts lengths, never their squares.",
    );
    let [theirs, ours] = [cosine.error_of_cosine(), cosine.error_of_solver()].map(micro_degrees);
    ui.label("Error in this pose, in millionths of a degree:");
    egui::Grid::new("errors").num_columns(2).spacing(egui::vec2(10.0, 2.0)).show(ui, |ui| {
        for (name, value) in [("By the cosine", theirs), ("By the solver", ours)] {
            ui.label(name);
            ui.label(RichText::new(value).monospace());
            ui.end_row();
        }
    });
}

/// The angle at the shoulder in radians, computed in three ways.
struct Cosine {
    cosine: f32,
    by_cosine: f32,
    by_solver: f32,
    /// In 64-bit numbers, from the same sides.
    exact: f64,
}

impl Cosine {
    /// `None` for a hand at the shoulder.
    fn new(arm: &Arm, pose: &TwoBonePose) -> Option<Self> {
        let [upper, lower] = [arm.bones.upper(), arm.bones.lower()].map(|it| it * pose.stretch);
        let distance = pose.distance;
        let cosine =
            (upper * upper + distance * distance - lower * lower) / (2.0 * upper * distance);
        cosine.is_finite().then(|| Self {
            cosine,
            by_cosine: cosine.clamp(-1.0, 1.0).acos(),
            by_solver: pose.shoulder_angle(),
            exact: exact_angle(upper.into(), lower.into(), distance.into()),
        })
    }

    fn error_of_cosine(&self) -> f64 {
        (f64::from(self.by_cosine) - self.exact).abs()
    }

    fn error_of_solver(&self) -> f64 {
        (f64::from(self.by_solver) - self.exact).abs()
    }
}

/// The angle between the sides `upper` and `distance` of a triangle whose third side is `lower`:
/// twice the arctangent that Kahan's formula for the area gives. A triangle that does not close is
/// straight or folded.
fn exact_angle(upper: f64, lower: f64, distance: f64) -> f64 {
    let sum = (upper + distance + lower) * (upper + distance - lower).max(0.0);
    let difference = (lower - (upper - distance)) * (lower + (upper - distance));
    2.0 * difference.max(0.0).sqrt().atan2(sum.sqrt())
}

fn micro_degrees(radians: f64) -> String {
    format!("{:.1}", radians.to_degrees() * 1e6)
}
