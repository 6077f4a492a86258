//! A plot of the solver's error against the iteration, on a logarithmic scale; the slider through
//! the iterations of a run, and the button that applies the shown pose.

use core::ops::RangeInclusive;

use egui::{Align, Color32, Layout, Rangef, Slider, Stroke, Ui, Vec2b};
use egui_plot::{AxisHints, GridMark, HLine, Line, PlotBounds, PlotPoints, Points, VLine};

use crate::kinematics::chain_ik::Method;
use crate::session::{
    Actions, Iterate, Session, ShownIteration, SolverAction, SolverEdit, SolverRun,
};
use crate::ui::keyboard::focus;
use crate::ui::style;
use crate::ui::widgets::{self, format, plot};

const HEIGHT: f32 = 132.0;
/// Smallest error on the scale, as a fraction of the skeleton's reach.
const LEAST: f32 = 1e-8;

pub(in crate::ui) fn ui(ui: &mut Ui, session: &Session) {
    let least = f64::from(LEAST * session.skeleton_rig().reach());
    let tolerance = f64::from(session.skeleton_rig().tolerance());
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
            plot.set_auto_bounds(Vec2b::FALSE);
            plot.set_plot_bounds(bounds);
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
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Image, true, &said));
    response.on_hover_text("Error over iterations, dashed: tolerance, line: shown iteration");
}

fn describe(session: &Session) -> String {
    let Some(ShownIteration { number, latest, .. }) = session.solvers().shown_iteration() else {
        return "Convergence: no solver run yet".to_owned();
    };
    match session.solvers().run() {
        Some(run) => {
            let error = format::short(run.shown().error);
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
        let slider = slider.on_hover_text("Show the pose of an iteration: 0 is FK (, and .)");
        if slider.changed() {
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
        0 => Some("Iteration 0 is the FK pose already"),
        _ => None,
    };
    let tooltip = "Write the shown pose to the joints' own angles (FK)";
    let layout = Layout::top_down_justified(Align::Center);
    if ui.with_layout(layout, |ui| widgets::button(ui, "Apply pose", tooltip, nothing)).inner {
        actions.push(SolverEdit::ApplyPose);
    }
}
