//! The numbers of a part of an iteration.

use egui::{Align, Grid, Layout, RichText, Ui, vec2};

use crate::kinematics::chain_ik::{
    AngleChange, Ellipsoid, Gradient, StepTaken, SubStep, SubStepKind, Turn,
};
use crate::kinematics::skeleton::JointId;
use crate::session::{Session, SolverRun};
use crate::ui::widgets::format;

/// Number of angles in a table, so that it stays readable; those that turn most are listed.
const MOST: usize = 12;

pub(super) fn ui(ui: &mut Ui, session: &Session, run: &SolverRun, shown: usize) {
    let parts = run.parts();
    let part: &SubStep = &parts[shown];
    ui.add_space(4.0);
    match &part.kind {
        SubStepKind::Gradient(gradient) => jacobian(ui, session, gradient),
        SubStepKind::Step(step) => angles(ui, session, step),
        SubStepKind::Turn(turn) => turned(ui, session, turn),
        _ => {}
    }
    let before = match shown.checked_sub(1) {
        Some(before) => parts[before].error,
        None => {
            let iteration = run.shown().iteration.saturating_sub(1);
            run.iterates().at(iteration).error
        }
    };
    pairs(
        ui,
        "error",
        &[("Error before", format::short(before)), ("Error after", format::short(part.error))],
    );
}

/// The lengths of the columns, and the axes of the ellipsoid.
fn jacobian(ui: &mut Ui, session: &Session, gradient: &Gradient) {
    let selection = session.selection();
    let any = gradient.columns.iter().any(|column| selection.contains(&column.joint));
    let shown = gradient.columns.iter().filter(|it| !any || selection.contains(&it.joint));
    let mut rows: Vec<[String; 2]> = shown
        .map(|column| {
            let name = format!("{} {}", name(session, column.joint), column.axis);
            (column.by.length(), name)
        })
        .map(|(speed, name)| [name, format::short(speed)])
        .collect();
    rows.truncate(MOST);
    table(ui, "columns", ["Angle", "Column, per radian"], &rows);
    if let (Some(damping), [ellipsoid]) = (gradient.damping, &gradient.ellipsoids[..]) {
        singular_values(ui, ellipsoid, damping);
    }
}

fn singular_values(ui: &mut Ui, ellipsoid: &Ellipsoid, damping: f32) {
    let gains = ellipsoid.gains(damping);
    let rows: Vec<[String; 2]> = ellipsoid
        .values
        .iter()
        .zip(gains)
        .map(|(value, gain)| [format::short(*value), format!("{:.0} %", 100.0 * gain)])
        .collect();
    table(ui, "ellipsoid", ["Singular value σ", "Kept: σ²/(σ² + λ²)"], &rows);
    pairs(ui, "damping", &[("Damping λ, as a length", format::short(damping))]);
}

/// Gradient and change of the angles that turn most, and the length of the step.
fn angles(ui: &mut Ui, session: &Session, step: &StepTaken) {
    let mut changes: Vec<&AngleChange> = step.changes.iter().filter(|it| it.by != 0.0).collect();
    changes.sort_by(|one, other| other.by.abs().total_cmp(&one.by.abs()));
    let rows: Vec<[String; 3]> = changes
        .into_iter()
        .take(MOST)
        .map(|change| {
            let limit = if change.is_at_limit { " limit" } else { "" };
            [
                format!("{} {}{limit}", name(session, change.joint), change.axis),
                format::short(change.gradient),
                format!("{:+.2}°", change.by.to_degrees()),
            ]
        })
        .collect();
    table(ui, "angles", ["Angle", "Gradient", "Δθ"], &rows);
    let length = step.length.map(|length| ("Step length τ", format::short(length)));
    let damping = step.damping.map(|damping| ("Damping λ, as a length", format::short(damping)));
    let refused = (step.refused > 0).then(|| ("Refused before", step.refused.to_string()));
    let rows: Vec<_> = [length, damping, refused].into_iter().flatten().collect();
    pairs(ui, "step", &rows);
}

fn turned(ui: &mut Ui, session: &Session, turn: &Turn) {
    let rows = [
        ("Joint", name(session, turn.joint)),
        ("Turned by", format!("{:.2}°", turn.angle.to_degrees())),
    ];
    pairs(ui, "turn", &rows);
}

fn name(session: &Session, joint: JointId) -> String {
    session.skeleton().joint(joint).map_or_else(String::new, |joint| joint.name.clone())
}

fn table<const N: usize>(ui: &mut Ui, id: &str, titles: [&str; N], rows: &[[String; N]]) {
    if rows.is_empty() {
        return;
    }
    Grid::new(id).num_columns(N).spacing(vec2(10.0, 2.0)).show(ui, |ui| {
        for (column, title) in titles.into_iter().enumerate() {
            cell(ui, column, RichText::new(title).weak().small());
        }
        ui.end_row();
        for row in rows {
            for (column, text) in row.iter().enumerate() {
                let text = RichText::new(text);
                cell(ui, column, if column == 0 { text } else { text.monospace() });
            }
            ui.end_row();
        }
    });
    ui.add_space(2.0);
}

fn pairs(ui: &mut Ui, id: &str, rows: &[(&str, String)]) {
    let rows: Vec<[String; 2]> =
        rows.iter().map(|(name, value)| [(*name).to_owned(), value.clone()]).collect();
    if rows.is_empty() {
        return;
    }
    Grid::new(id).num_columns(2).spacing(vec2(10.0, 2.0)).show(ui, |ui| {
        for [name, value] in rows {
            ui.label(name);
            cell(ui, 1, RichText::new(value).monospace());
            ui.end_row();
        }
    });
}

fn cell(ui: &mut Ui, column: usize, text: RichText) {
    let align = if column == 0 { Align::Min } else { Align::Max };
    let layout = match align {
        Align::Min => Layout::left_to_right(Align::Center),
        _ => Layout::right_to_left(Align::Center),
    };
    ui.with_layout(layout, |ui| ui.label(text));
}
