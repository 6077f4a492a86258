//! A plot of the ratio of elbow speed to Cursor speed, and a list of the pops with their fixes.

use egui::{Align2, Color32, RichText, Role, Stroke, Ui, WidgetInfo};
use egui_plot::{
    AxisHints, Line, LineStyle, MarkerShape, PlotBounds, PlotPoint, PlotPoints, PlotUi, Points,
    Text, VLine,
};

use crate::document::TwistReferenceKind;
use crate::kinematics::pop::{InputChange, PopCause};
use crate::kinematics::soft_reach::SoftReach;
use crate::session::{Actions, PopFix, PopSample, PopSampleKind, Pops, Session, ShownLimb, Spike};
use crate::ui::style;
use crate::ui::widgets::{self, plot, text::capitalized};
use crate::words::LimbWords;

const HEIGHT: f32 = 140.0;
/// Range of ratios on the plot; a ratio outside is clamped.
const SHOWN: (f64, f64) = (0.05, 100.0);
/// Maximum number of pops in the list, which has the newest first.
const LISTED: usize = 3;

/// Shows the pops of the limb in the latest drag or playback.
pub(in crate::ui) fn ui(ui: &mut Ui, session: &Session, limb: &ShownLimb, actions: &mut Actions) {
    let LimbWords { middle, end, .. } = limb.words;
    let is_step = |sample: &PopSample| matches!(sample.kind, PopSampleKind::Step(_));
    if !session.evaluated().pops().samples().any(is_step) {
        ui.label(format!(
            "Drag the {end}, or play the timeline: this page then shows where the {middle} jumped, and why."
        ));
        return;
    }
    let spikes = session.evaluated().pops().spikes();
    ui.weak(format!("Up: {middle} speed / Cursor speed · across: steps"));
    show(ui, session.evaluated().pops(), &spikes, limb.words);
    if spikes.is_empty() {
        ui.label(format!("No pops: the {middle} moves smoothly."));
    }
    let mut offered: Vec<PopFix> = Vec::new();
    for spike in spikes.iter().rev().take(LISTED) {
        list(ui, session, limb, spike, &mut offered, actions);
    }
    let changes = InputChange::ALL
        .into_iter()
        .filter(|change| is_marked(session.evaluated().pops(), *change));
    let changes: Vec<_> = changes.map(InputChange::name).collect();
    if !changes.is_empty() {
        ui.weak(format!("Dotted lines, not pops: {} changed", changes.join(", ")));
    }
}

fn is_marked(pops: &Pops, change: InputChange) -> bool {
    pops.samples().any(|sample| sample.kind == PopSampleKind::Change(change))
}

/// Shows one pop and a button for its fix. The button is left out if `offered`, the fixes of the
/// pops above, contains the same fix.
fn list(
    ui: &mut Ui,
    session: &Session,
    limb: &ShownLimb,
    spike: &Spike,
    offered: &mut Vec<PopFix>,
    actions: &mut Actions,
) {
    let now = &limb.frames.posed;
    let text = format!("{}: {}", name(spike.pop), describe(spike, limb.words));
    if !spike.persists(now) {
        ui.weak(format!("{text} – settings have changed since"));
        return;
    }
    ui.label(RichText::new(text));
    match PopFix::new(spike, now) {
        Some(pop_fix) if !offered.contains(&pop_fix) => {
            offered.push(pop_fix);
            let (label, tooltip) = wording(pop_fix, now.ik.soft_reach);
            if widgets::button(ui, label, &tooltip, None) {
                actions.extend(pop_fix.edit(session.rig(), limb));
            }
        }
        Some(_) => {}
        None => {
            ui.weak(why_none(spike.pop, limb));
        }
    }
}

fn name(pop: PopCause) -> &'static str {
    match pop {
        PopCause::Singular { .. } => "Singularity",
        PopCause::Straight => "Straight",
        PopCause::Folded => "Inner limit",
        PopCause::Shoulder => "Shoulder",
    }
}

fn describe(spike: &Spike, words: LimbWords) -> String {
    let LimbWords { base, .. } = words;
    let times = if spike.ratio < 1e3 { format!("{:.1}×", spike.ratio) } else { ">999×".into() };
    match spike.pop {
        PopCause::Singular { nearest } => {
            let pole = match spike.reference {
                TwistReferenceKind::Up => "the vertical",
                TwistReferenceKind::Pole => "the pole",
                TwistReferenceKind::Stereographic | TwistReferenceKind::Transport => {
                    "straight behind, −x"
                }
                TwistReferenceKind::Fk => "the opposite of its FK pose",
            };
            let degrees = nearest.to_degrees();
            format!("the Pointer passed within {degrees:.1}° of {pole} ({times})")
        }
        PopCause::Straight => format!("the limb reached its outer limit ({times})"),
        PopCause::Folded => format!("the limb folded up ({times})"),
        PopCause::Shoulder => format!("the Cursor passed the {base} ({times})"),
    }
}

/// Label and tooltip of a fix.
fn wording(pop_fix: PopFix, now: SoftReach) -> (&'static str, String) {
    match pop_fix {
        PopFix::ChangeReference(TwistReferenceKind::Transport) => {
            ("Use Transport", "Use the Transport twist reference, which never flips".to_owned())
        }
        PopFix::ChangeReference(_) => (
            "Use Stereographic",
            "Use the Stereographic twist reference, which flips only at −x".to_owned(),
        ),
        PopFix::Soften(soft_reach) => (
            if now.softness() == 0.0 { "Add softness" } else { "Add more softness" },
            format!(
                "Set softness to {:.2} to slow the hand near its limits",
                soft_reach.softness()
            ),
        ),
        PopFix::KeepOpen(soft_reach) => (
            "Keep elbow open",
            format!(
                "Set the minimum elbow angle to {:.0}°",
                soft_reach.min_elbow_angle().to_degrees()
            ),
        ),
    }
}

fn why_none(pop: PopCause, limb: &ShownLimb) -> String {
    match pop {
        PopCause::Shoulder => {
            let least = limb.frames.range.inner;
            if least > 1e-3 * limb.frames.bones().outer_limit() {
                let jump = limb.lengths().show(2.0 * least);
                let end = limb.words.end;
                format!("No fix: the {end} must jump by twice the inner limit, {jump}.")
            } else {
                "No fix: the whole limb must turn around.".to_owned()
            }
        }
        _ => "No fix: all settings that help are in use.".to_owned(),
    }
}

fn show(ui: &mut Ui, pops: &Pops, spikes: &[Spike], words: LimbWords) {
    let places = places(pops);
    let room = places.last().map_or(0.0, |last| *last).max(60.0);
    let logs = SHOWN.0.log10()..=SHOWN.1.log10();
    let bounds = PlotBounds::from_min_max([-0.02 * room, *logs.start()], [1.03 * room, 2.25]);
    let colours = PopColours::new(ui);
    let response = plot::still("pops", HEIGHT)
        .label_formatter(|_| None)
        .show_grid(egui::Vec2b::new(false, true))
        .custom_x_axes(vec![])
        .custom_y_axes(vec![plot::axis(ui, AxisHints::new_y(), times).min_thickness(30.0)])
        .x_grid_spacer(|_| Vec::new())
        .y_grid_spacer(|_| plot::marks(&[-1.0, 0.0, 1.0, 2.0]))
        .show(ui, |plot| {
            plot::show(plot, bounds);
            draw_changes(plot, pops, &places, colours);
            for run in runs(pops, &places) {
                draw_run(plot, &run, colours);
            }
            draw_spikes(plot, spikes, &places, room, colours);
        })
        .response;
    let said = match spikes {
        [] => "Pops: none".to_owned(),
        [.., last] => format!("Pops: {}, the last one {}", spikes.len(), name(last.pop)),
    };
    response.widget_info(|| WidgetInfo::labeled(Role::Image, true, &said));
    let middle = capitalized(words.middle);
    response.on_hover_text(format!(
        "{middle} speed over Cursor speed per step; above the dashed line it pops"
    ));
}

#[derive(Clone, Copy)]
struct PopColours {
    line: Color32,
    limit: Color32,
    spike: Color32,
    change: Color32,
}

impl PopColours {
    fn new(ui: &Ui) -> Self {
        let visuals = ui.visuals();
        let weak = visuals.weak_text_color();
        Self {
            line: visuals.text_color(),
            limit: weak,
            spike: style::accent(ui),
            change: weak.gamma_multiply(0.7),
        }
    }
}

/// The plotted steps of one drag or playback: the x of each step with the log₁₀ of its ratio, and
/// with the log₁₀ of the limit above which the ratio is a pop.
#[derive(Default)]
struct PlottedRun {
    ratios: Vec<[f64; 2]>,
    limits: Vec<[f64; 2]>,
}

/// The x of each sample on the plot, with a gap between runs.
fn places(pops: &Pops) -> Vec<f64> {
    const GAP: f64 = 4.0;
    let (mut at, mut last) = (0.0, None);
    let place = |sample: &PopSample| {
        at += if last.is_some_and(|run| run != sample.run) { GAP } else { 1.0 };
        last = Some(sample.run);
        at
    };
    pops.samples().map(place).collect()
}

fn runs(pops: &Pops, places: &[f64]) -> Vec<PlottedRun> {
    let mut runs: Vec<PlottedRun> = Vec::new();
    let mut last = None;
    for (sample, at) in pops.samples().zip(places) {
        let PopSampleKind::Step(step) = sample.kind else {
            last = None;
            continue;
        };
        if last != Some(sample.run) {
            runs.push(PlottedRun::default());
        }
        last = Some(sample.run);
        if let Some(run) = runs.last_mut() {
            run.ratios.push([*at, log(step.ratio)]);
            run.limits.push([*at, log(step.limit)]);
        }
    }
    runs
}

fn draw_run(plot: &mut PlotUi<'_>, run: &PlottedRun, colours: PopColours) {
    let dashed = LineStyle::dashed_dense();
    let limits = Line::new("limit", PlotPoints::from(run.limits.clone()));
    plot.line(limits.color(colours.limit).width(1.0).style(dashed));
    let ratios = PlotPoints::from(run.ratios.clone());
    match run.ratios.len() {
        1 => plot.points(Points::new("ratio", ratios).color(colours.line).radius(1.5)),
        _ => plot.line(Line::new("ratio", ratios).color(colours.line).width(1.5)),
    }
}

fn draw_changes(plot: &mut PlotUi<'_>, pops: &Pops, places: &[f64], colours: PopColours) {
    let dotted = LineStyle::Dotted { spacing: 4.0 };
    for (sample, at) in pops.samples().zip(places) {
        if let PopSampleKind::Change(change) = sample.kind {
            let stroke = Stroke::new(1.0, colours.change);
            plot.vline(VLine::new(change.name(), *at).stroke(stroke).style(dotted));
        }
    }
}

/// Draws a mark on each pop, which is an arrow if the ratio exceeds the plot, and the names of the
/// pops. Where names would overlap, only that of the newest pop is drawn.
fn draw_spikes(
    plot: &mut PlotUi<'_>,
    spikes: &[Spike],
    places: &[f64],
    room: f64,
    colours: PopColours,
) {
    const APART: f64 = 0.28;
    let mut named: Vec<f64> = Vec::new();
    for spike in spikes.iter().rev() {
        let Some(at) = places.get(spike.at).copied() else {
            continue;
        };
        let is_beyond = f64::from(spike.ratio) > SHOWN.1;
        let shape = if is_beyond { MarkerShape::Up } else { MarkerShape::Diamond };
        let height = log(spike.ratio);
        let mark = Points::new(name(spike.pop), vec![[at, height]]);
        plot.points(mark.shape(shape).radius(4.5).color(colours.spike));
        if named.iter().all(|other| (other - at).abs() > APART * room) {
            named.push(at);
            let anchor = match at / room {
                ..0.2 => Align2::LEFT_BOTTOM,
                0.8.. => Align2::RIGHT_BOTTOM,
                _ => Align2::CENTER_BOTTOM,
            };
            let above = PlotPoint::new(at, height + 0.12);
            let text = RichText::new(name(spike.pop)).size(11.5);
            plot.text(Text::new("", above, text).anchor(anchor).color(colours.spike));
        }
    }
}

fn log(ratio: f32) -> f64 {
    f64::from(ratio).clamp(SHOWN.0, SHOWN.1).log10()
}

fn times(power: f64) -> String {
    format!("{}×", 10_f64.powf(power))
}
