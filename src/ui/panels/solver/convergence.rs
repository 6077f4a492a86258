//! A plot of the solver's error against the iteration, on a logarithmic scale.

use core::ops::RangeInclusive;

use egui::{Rangef, Stroke, Ui, Vec2b};
use egui_plot::{AxisHints, GridMark, HLine, Line, PlotBounds, PlotPoints};

use crate::kinematics::chain_ik::Method;
use crate::session::{Comparison, ResidualHistory, Session};
use crate::ui::style;
use crate::ui::widgets::{format, plot};

const HEIGHT: f32 = 132.0;
/// Smallest error on the scale, as a fraction of the skeleton's reach.
const LEAST: f32 = 1e-8;

pub(in crate::ui) fn ui(ui: &mut Ui, session: &Session) {
    let rig = session.skeleton_rig();
    let least = f64::from(LEAST * rig.reach());
    let tolerance = f64::from(rig.solver.tolerance.unwrap_or(1e-4 * rig.reach()));
    let curves = curves(session, least);
    let all = || curves.iter().flat_map(|(_, points)| points);
    let first = all().map(|point| point[0]).fold(f64::INFINITY, f64::min);
    let last = all().map(|point| point[0]).fold(1.0, f64::max);
    let low = all().map(|point| point[1]).fold(tolerance.log10(), f64::min);
    let high = all().map(|point| point[1]).fold(tolerance.log10() + 1.0, f64::max);
    let first = if first.is_finite() { first } else { 0.0 };
    let bounds = PlotBounds::from_min_max(
        [first, low - 0.3],
        [last.max(first + 10.0) + 0.04 * (last - first).max(10.0), high + 0.3],
    );

    let palette = style::palette(ui);
    let weak = ui.visuals().weak_text_color();
    let response = plot::still("convergence", HEIGHT)
        .custom_x_axes(vec![
            AxisHints::new_x().formatter(iteration).label_spacing(Rangef::new(20.0, 28.0)),
        ])
        .x_grid_spacer(egui_plot::uniform_grid_spacer(|grid| {
            let step = round_step((grid.bounds.1 - grid.bounds.0) / 4.0);
            [step, 2.0 * step, 4.0 * step]
        }))
        .custom_y_axes(vec![
            AxisHints::new_y()
                .formatter(|mark, _| power_of_ten(mark.value))
                .label_spacing(Rangef::new(13.0, 15.0))
                .min_thickness(34.0),
        ])
        .y_grid_spacer(egui_plot::uniform_grid_spacer(|_| [1.0, 2.0, 4.0]))
        .show(ui, |plot| {
            plot.set_auto_bounds(Vec2b::FALSE);
            plot.set_plot_bounds(bounds);
            plot.hline(
                HLine::new("tolerance", tolerance.log10())
                    .stroke(Stroke::new(1.0, weak))
                    .style(egui_plot::LineStyle::dashed_dense()),
            );
            for (method, points) in &curves {
                let colour = style::colour(palette.method(*method));
                let line = Line::new(method.name(), PlotPoints::from(points.clone()));
                plot.line(line.color(colour).width(2.0));
            }
        })
        .response;
    let said = match session.solver_run().map(crate::session::SolverRun::report) {
        Some(report) => format!(
            "Convergence: error {} after {} iterations",
            format::short(report.error),
            report.iterations
        ),
        None => "Convergence: no solver run yet".to_owned(),
    };
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Image, true, &said));
    response.on_hover_text("Error over iterations, dashed: tolerance");
}

/// One curve for each running or finished solver of the comparison or, without a comparison, for
/// the solver run. A point is the iteration and the log₁₀ of the error, or of `least` if the error
/// is smaller.
fn curves(session: &Session, least: f64) -> Vec<(Method, Vec<[f64; 2]>)> {
    let points = |history: &ResidualHistory| {
        let point = |(iteration, error): (usize, f32)| {
            [iteration as f64, f64::from(error).max(least).log10()]
        };
        history.points().map(point).collect::<Vec<_>>()
    };
    if let Some(comparison) = session.comparison() {
        let solvers =
            Comparison::solvers(comparison).iter().filter(|solver| solver.report().is_ok());
        return solvers.map(|solver| (solver.method, points(&solver.history))).collect();
    }
    let solver_run = session.solver_run();
    solver_run.map(|it| (it.report().method, points(it.history()))).into_iter().collect()
}

/// The largest number that is at most `step` and is 1, 2 or 5 times a power of ten; 1 if `step` is
/// below 1.
fn round_step(step: f64) -> f64 {
    let power = 10_f64.powf(step.max(1.0).log10().floor());
    [5.0, 2.0].map(|times| times * power).into_iter().find(|it| *it <= step).unwrap_or(power)
}

/// Label of an iteration; empty if the right edge of the plot would cut the label off.
fn iteration(mark: GridMark, shown: &RangeInclusive<f64>) -> String {
    let edge = shown.end() - 0.04 * (shown.end() - shown.start());
    if mark.value > edge { String::new() } else { mark.value.to_string() }
}

fn power_of_ten(exponent: f64) -> String {
    match exponent.round() as i32 {
        0 => "1".to_owned(),
        1 => "10".to_owned(),
        2 => "100".to_owned(),
        exponent => format!("1e{exponent}"),
    }
}
