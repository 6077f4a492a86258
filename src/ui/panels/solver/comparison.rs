//! The comparison ("race") of all solvers: iterations, error and time of every solver; and the
//! reason why solvers are disabled.

use core::time::Duration;

use egui::{
    Align, Color32, Grid, Layout, Rect, RichText, Role, Sense, StrokeKind, Ui, WidgetInfo, vec2,
};

use crate::kinematics::chain_ik::{Report, Status};
use crate::session::{Actions, ComparedSolver, Session, SolverAction};
use crate::ui::widgets::{self, format};
use crate::ui::{labels, style};

pub(in crate::ui) fn ui(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    let Some(comparison) = session.solvers().comparison() else {
        let tooltip = "Run every solver from the FK pose, each as a coloured ghost";
        if widgets::button(ui, "Race all solvers", tooltip, why_not(session)) {
            actions.push(SolverAction::Compare);
        }
        return;
    };
    let tooltip = "Remove the ghosts (Esc)";
    if widgets::button(ui, "End race", tooltip, None) {
        actions.push(SolverAction::Reset);
    }
    Grid::new("race").num_columns(4).min_col_width(20.0).spacing(vec2(8.0, 4.0)).show(ui, |ui| {
        ui.weak("Solver");
        for heading in ["iter.", "error", "time"] {
            right(ui, |ui| ui.weak(heading));
        }
        ui.end_row();
        for solver in comparison.solvers() {
            show(ui, solver);
            ui.end_row();
        }
    });
    legend(ui);
}

/// Says what a filled and a hollow square mean.
fn legend(ui: &mut Ui) {
    let colour = ui.visuals().weak_text_color();
    ui.horizontal(|ui| {
        for (is_filled, meaning) in [(true, "converged"), (false, "not converged")] {
            ui.spacing_mut().item_spacing.x = 6.0;
            let (rect, _) = ui.allocate_exact_size(vec2(10.0, 10.0), Sense::hover());
            square(ui, rect, colour, is_filled);
            ui.weak(meaning);
            ui.add_space(6.0);
        }
    });
}

fn square(ui: &Ui, rect: Rect, colour: Color32, is_filled: bool) {
    if is_filled {
        ui.painter().rect_filled(rect, 2.0, colour)
    } else {
        ui.painter().rect_stroke(rect, 2.0, (1.5, colour), StrokeKind::Inside)
    };
}

fn show(ui: &mut Ui, solver: &ComparedSolver) {
    let colour = style::colour(style::palette(ui).method(solver.method));
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 6.0;
        let (rect, response) = ui.allocate_exact_size(vec2(10.0, 10.0), Sense::hover());
        let said = format!("{}: {}", solver.method.short_title(), status(solver));
        response.widget_info(|| WidgetInfo::labeled(Role::Image, true, &said));
        let has_converged = solver.run.as_ref().is_ok_and(|run| run.report().converged());
        square(ui, rect, colour, has_converged);
        response.on_hover_text(said);
        let label = ui.label(solver.method.short_title());
        label.on_hover_text(format!("{}. {}", solver.method.title(), status(solver)));
    });
    let texts = match &solver.run {
        Ok(run) => {
            let shown = run.shown();
            [shown.iteration.to_string(), format::short(shown.error), duration(run.elapsed())]
        }
        Err(_) => ["–", "–", "–"].map(str::to_owned),
    };
    for text in texts {
        right(ui, |ui| ui.label(RichText::new(text).monospace())).on_hover_text(status(solver));
    }
}

fn right(ui: &mut Ui, label: impl FnOnce(&mut Ui) -> egui::Response) -> egui::Response {
    ui.with_layout(Layout::right_to_left(Align::Center), label).inner
}

fn status(solver: &ComparedSolver) -> String {
    match &solver.run {
        Err(error) => error.to_string(),
        Ok(run) if run.report().status == Status::Iterating => "running".to_owned(),
        Ok(run) => {
            let Report { status, iterations, .. } = run.report();
            format!("{status} after {iterations} iterations")
        }
    }
}

fn duration(time: Duration) -> String {
    let micros = time.as_secs_f64() * 1e6;
    match micros {
        ..10.0 => format!("{micros:.1} µs"),
        ..1_000.0 => format!("{micros:.0} µs"),
        ..100_000.0 => format!("{:.1} ms", micros / 1e3),
        _ => format!("{:.0} ms", micros / 1e3),
    }
}

/// The reason why solvers are disabled; `None` if they can run.
pub(in crate::ui) fn why_not(session: &Session) -> Option<&'static str> {
    let rig = session.skeleton_rig();
    let enabled = rig.targets.iter().filter(|target| target.enabled);
    if let Some(reason) = enabled.filter_map(|it| labels::why_on_path(session, it.joint)).next() {
        Some(reason)
    } else if rig.targets.is_empty() {
        Some("Add a target to a joint first")
    } else if !rig.targets.iter().any(|target| target.enabled) {
        Some("Enable a target first")
    } else {
        None
    }
}
