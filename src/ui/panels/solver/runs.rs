//! Runs of solvers: a plot of the error against the iteration on a logarithmic scale, the slider
//! through the iterations, the button that applies the shown pose; the comparison ("race") of all
//! solvers with iterations, error and time of each; and the reason why solvers are disabled.

use core::ops::RangeInclusive;
use core::time::Duration;

use egui::{
    Align, Color32, Grid, Layout, Rangef, Rect, Role, Sense, Slider, Stroke, StrokeKind, Ui,
    WidgetInfo, vec2,
};
use egui_plot::{AxisHints, GridMark, HLine, Line, PlotBounds, PlotPoints, Points, VLine};

use crate::kinematics::chain_ik::{Method, Report, Status};
use crate::session::{
    Actions, ComparedSolver, Iterate, Session, ShownIteration, SolverAction, SolverEdit, SolverRun,
};
use crate::ui::keyboard::focus;
use crate::ui::widgets::{self, plot, text};
use crate::ui::{labels, style};

const HEIGHT: f32 = 132.0;
/// Smallest error on the scale, as a fraction of the skeleton's reach.
const LEAST: f32 = 1e-8;

pub(in crate::ui) fn convergence(ui: &mut Ui, session: &Session) {
    let least = f64::from(LEAST * session.rig().reach());
    let tolerance = f64::from(session.rig().tolerance());
    let curves: Vec<Curve> = session.solvers().runs().map(|run| Curve::new(run, least)).collect();
    let all = || curves.iter().flat_map(|curve| &curve.points);
    let last = all().map(|point| point[0]).fold(10.0, f64::max);
    let low = all().map(|point| point[1]).fold(tolerance.log10(), f64::min);
    let high = all().map(|point| point[1]).fold(tolerance.log10() + 1.0, f64::max);
    let bounds = PlotBounds::from_min_max([0.0, low - 0.3], [1.04 * last, high + 0.3]);
    let shown = session.solvers().shown_iteration();

    let palette = style::palette(ui);
    let (weak, strong) = (ui.visuals().weak_text_color(), ui.visuals().strong_text_color());
    let response = plot::still("convergence", HEIGHT)
        .custom_x_axes(vec![
            AxisHints::new_x().formatter(iteration_mark).label_spacing(Rangef::new(20.0, 28.0)),
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
            plot::show(plot, bounds);
            plot.hline(
                HLine::new("tolerance", tolerance.log10())
                    .stroke(Stroke::new(1.0, weak))
                    .style(egui_plot::LineStyle::dashed_dense()),
            );
            if let Some(ShownIteration { number, .. }) = shown {
                let cursor = VLine::new("shown iteration", f64::from(number));
                plot.vline(cursor.stroke(Stroke::new(1.5, strong)));
            }
            for Curve { method, points, shown } in curves {
                let colour = style::colour(palette.method(method));
                let line = Line::new(method.name(), PlotPoints::from(points));
                plot.line(line.color(colour).width(2.0));
                plot.points(Points::new(method.name(), shown).color(colour).radius(3.5));
            }
        })
        .response;
    let said = describe(session);
    response.widget_info(|| WidgetInfo::labeled(Role::Image, true, &said));
    response.on_hover_text("Error over iterations, dashed: tolerance, line: shown iteration");
}

fn describe(session: &Session) -> String {
    let Some(ShownIteration { number, latest, .. }) = session.solvers().shown_iteration() else {
        return "Convergence: no solver run yet".to_owned();
    };
    match session.solvers().run() {
        Some(run) => {
            let error = text::short(run.shown().error);
            format!("Convergence: error {error} at iteration {number} of {latest}")
        }
        None => format!("Convergence: iteration {number} of {latest} of the race"),
    }
}

/// The errors of a solver run. A point is the iteration and the log₁₀ of the error.
struct Curve {
    method: Method,
    points: Vec<[f64; 2]>,
    /// The point of the shown iterate.
    shown: [f64; 2],
}

impl Curve {
    /// Errors below `least` count as `least`.
    fn new(run: &SolverRun, least: f64) -> Self {
        let point = |iterate: &Iterate| {
            [f64::from(iterate.iteration), f64::from(iterate.error).max(least).log10()]
        };
        Self {
            method: run.method(),
            points: run.iterates().iter().map(point).collect(),
            shown: point(run.shown()),
        }
    }
}

/// The largest number that is at most `step` and is 1, 2 or 5 times a power of ten; 1 if `step` is
/// below 1.
fn round_step(step: f64) -> f64 {
    let power = 10_f64.powf(step.max(1.0).log10().floor());
    [5.0, 2.0].map(|times| times * power).into_iter().find(|it| *it <= step).unwrap_or(power)
}

/// Label of an iteration; empty if the right edge of the plot would cut the label off.
fn iteration_mark(mark: GridMark, shown: &RangeInclusive<f64>) -> String {
    let edge = shown.end() - 0.04 * (shown.end() - shown.start());
    if mark.value > edge { String::new() } else { mark.value.to_string() }
}

/// A power of ten as a number, such as "0.001", or from the fifth on in scientific notation.
fn power_of_ten(exponent: f64) -> String {
    const DIGITS: i32 = 4;
    match exponent.round() as i32 {
        exponent if exponent.abs() <= DIGITS => 10_f64.powi(exponent).to_string(),
        exponent => format!("1e{exponent}"),
    }
}

pub(in crate::ui) fn iteration(
    ui: &mut Ui,
    session: &Session,
    shown: ShownIteration,
    actions: &mut Actions,
) {
    slider(ui, shown, actions);
    apply(ui, session, shown, actions);
}

fn slider(ui: &mut Ui, shown: ShownIteration, actions: &mut Actions) {
    let (mut number, latest) = (shown.number, shown.latest);
    ui.horizontal(|ui| {
        let label = ui.label("Iteration");
        let value_width = number_width(ui, latest) + ui.spacing().item_spacing.x;
        ui.spacing_mut().slider_width = (ui.available_width() - value_width).max(40.0);
        // Without a second value the slider could not be laid out.
        let slider = ui.add(Slider::new(&mut number, 0..=latest.max(1))).labelled_by(label.id);
        focus::leave_letters(ui, slider.id);
        let tooltip = "Show the pose of an iteration: 0 is FK (, and .)";
        if slider.on_hover_text(tooltip).changed() {
            actions.push(SolverAction::Show(number));
        }
    });
}

/// Width of the box of a number of up to `most`, in points.
fn number_width(ui: &Ui, most: u32) -> f32 {
    let font = ui.style().drag_value_text_style.resolve(ui.style());
    let text = ui.painter().layout_no_wrap(most.to_string(), font, Color32::PLACEHOLDER);
    let spacing = ui.spacing();
    spacing.interact_size.x.max(text.size().x + 2.0 * spacing.button_padding.x)
}

fn apply(ui: &mut Ui, session: &Session, shown: ShownIteration, actions: &mut Actions) {
    let nothing = match shown.number {
        _ if session.solvers().comparison().is_some() => {
            Some("End the race and run one solver to apply its pose")
        }
        0 => Some("Iteration 0 is the start already"),
        _ => None,
    };
    let tooltip = "Write the shown pose to the joints' own angles (FK)";
    if widgets::wide_button(ui, "Apply pose", tooltip, nothing) {
        actions.push(SolverEdit::ApplyPose);
    }
}

pub(in crate::ui) fn race(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    let Some(comparison) = session.solvers().comparison() else {
        let tooltip = "Run every solver from the same start, each as a coloured ghost";
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
        let right = Layout::right_to_left(Align::Center);
        for heading in ["iter.", "error", "time"] {
            ui.with_layout(right, |ui| ui.weak(heading));
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
            [shown.iteration.to_string(), text::short(shown.error), duration(run.elapsed())]
        }
        Err(_) => ["–", "–", "–"].map(str::to_owned),
    };
    for text in texts {
        widgets::value(ui, text).on_hover_text(status(solver));
    }
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
    let rig = session.rig();
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
