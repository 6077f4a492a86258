//! Frame statistics: a graph of the most recent frames, durations, and contents of the scene.

use core::time::Duration;

use egui::{Align, Color32, Grid, Layout, RichText, Role, Sense, Stroke, Ui, WidgetInfo, vec2};
use egui_plot::{AxisHints, HLine, Line, PlotBounds, PlotPoints};

use crate::scene::Palette;
use crate::ui::frame_times::{FrameTime, FrameTimes, Machine};
use crate::ui::style;
use crate::ui::widgets::plot;
use crate::ui::widgets::text::grouped;

pub(in crate::ui) const WIDTH: f32 = 272.0;
const HEIGHT: f32 = 96.0;
const ROW: f32 = 17.0;
/// Width in points of a number, enough for any duration below a second.
const FIGURE: f32 = 76.0;
const GAP: f32 = 8.0;
const NAME: f32 = WIDTH - 2.0 * (FIGURE + GAP);
/// Duration of a frame at 60 Hz, in milliseconds.
const SIXTIETH: f64 = 1000.0 / 60.0;

/// Stages of a frame in the order in which the graph stacks them.
const PARTS: [FramePart; 5] = [
    FramePart {
        name: "Solve",
        tooltip: "Actions, solvers and playback",
        of: |frame| frame.solve,
        colour: |palette| style::colour(palette.series(2)),
    },
    FramePart {
        name: "Panels",
        tooltip: "Layout and tessellation of the panels",
        of: |frame| frame.panels,
        colour: |palette| style::colour(palette.series(4)),
    },
    FramePart {
        name: "Scene",
        tooltip: "Making the scene from the document",
        of: |frame| frame.scene,
        colour: |palette| style::colour(palette.series(6)),
    },
    FramePart {
        name: "Encode",
        tooltip: "Upload of changes and GPU commands",
        of: |frame| frame.encode,
        colour: |palette| style::colour(palette.series(1)),
    },
    FramePart {
        name: "Wait",
        tooltip: "Waiting for vsync or the GPU",
        of: |frame| frame.wait,
        colour: |palette| style::colour(palette.joint).gamma_multiply(0.55),
    },
];

struct FramePart {
    name: &'static str,
    tooltip: &'static str,
    of: fn(&FrameTime) -> Duration,
    colour: fn(&Palette) -> Color32,
}

pub(in crate::ui) fn ui(ui: &mut Ui, machine: &Machine) {
    ui.set_width(WIDTH);
    ui.spacing_mut().item_spacing.y = 4.0;
    let times = &machine.times;
    graph(ui, times);
    ui.add_space(4.0);
    grid("parts", 3).show(ui, |ui| parts(ui, machine));
    ui.separator();
    grid("counts", 2).show(ui, |ui| {
        let count = |count: Option<u64>| count.map_or("–".to_owned(), grouped);
        let per_second = times.per_second().map(|it| it.round() as u64);
        row(ui, "Frames per second", "Median while something moves", &count(per_second));
        let resolution_scale = times.last().map_or(1.0, |last| last.resolution_scale);
        let tooltip = "Ratio of the drawn size of the scene to that of the view";
        row(ui, "Resolution", tooltip, &format!("{:.0} %", 100.0 * resolution_scale));
        let counts = machine.counts;
        let of = |part: fn(crate::render::Counts) -> u64| count(counts.map(part));
        row(ui, "Cones and spheres", "In the scene", &of(|it| it.solids.into()));
        row(ui, "Lines", "In the scene", &of(|it| it.lines.into()));
        row(ui, "Labels", "In the scene", &of(|it| it.labels.into()));
        row(ui, "Triangles", "In the scene, without the panels", &of(|it| it.triangles.into()));
        let uploaded = "Upload of the last frame; unchanged data stays on the GPU";
        row(ui, "Bytes uploaded", uploaded, &of(|it| it.uploaded));
    });
    ui.separator();
    let (adapter, backend) = machine.adapter.rsplit_once(" (").unwrap_or((&machine.adapter, ""));
    ui.label(RichText::new(adapter).size(12.0)).on_hover_text("Graphics adapter");
    let backend = backend.trim_end_matches(')');
    ui.label(RichText::new(format!("Backend: {backend}")).size(12.0).weak())
        .on_hover_text("Graphics API");
}

fn grid(name: &str, columns: usize) -> Grid {
    Grid::new(name).num_columns(columns).min_row_height(ROW).spacing(vec2(GAP, 2.0))
}

fn parts(ui: &mut Ui, machine: &Machine) {
    let (times, palette) = (&machine.times, style::palette(ui));
    ui.allocate_exact_size(vec2(NAME, ROW), Sense::hover());
    heading(ui, "median", "Half of the frames took less");
    heading(ui, "99 %", "One frame in a hundred took longer");
    ui.end_row();
    for part in &PARTS {
        name(ui, part.name, part.tooltip, Some((part.colour)(&palette)));
        figures(ui, times, |frame| Some((part.of)(frame)));
    }
    name(ui, "Total", "From input to presentation", None);
    figures(ui, times, |frame| Some(frame.total()));
    let text = ui.visuals().strong_text_color();
    if machine.has_clock {
        let tooltip = "GPU time for scene and panels, in parallel to the CPU";
        name(ui, "GPU", tooltip, Some(text));
        figures(ui, times, |frame| frame.gpu);
    } else {
        name(ui, "GPU", "GPU time for scene and panels", None);
        ui.label(RichText::new("not measured by this adapter").weak().size(12.0))
            .on_hover_text("The adapter has no timestamp queries");
        ui.end_row();
    }
}

fn heading(ui: &mut Ui, text: &str, tooltip: &str) {
    number(ui, RichText::new(format!("{text}, ms")).weak().size(12.0)).on_hover_text(tooltip);
}

/// Shows a name and, to its left, a square of `colour` if there is a colour.
fn name(ui: &mut Ui, text: &str, tooltip: &str, colour: Option<Color32>) {
    let left = Layout::left_to_right(Align::Center);
    ui.allocate_ui_with_layout(vec2(NAME, ROW), left, |ui| {
        ui.set_min_width(NAME);
        ui.spacing_mut().item_spacing.x = 6.0;
        let (rect, _) = ui.allocate_exact_size(vec2(10.0, 10.0), Sense::hover());
        if let Some(colour) = colour {
            ui.painter().rect_filled(rect, 2.0, colour);
        }
        ui.label(text).on_hover_text(tooltip);
    });
}

fn figures(ui: &mut Ui, times: &FrameTimes, part: impl Fn(&FrameTime) -> Option<Duration>) {
    let spread = times.spread(part);
    for time in [spread.map(|it| it.median), spread.map(|it| it.slowest)] {
        let text = time.map_or("–".to_owned(), |time| format!("{:.3}", milliseconds(time)));
        number(ui, RichText::new(text).monospace());
    }
    ui.end_row();
}

fn row(ui: &mut Ui, name: &str, tooltip: &str, text: &str) {
    let size = vec2(NAME + FIGURE + GAP, ROW);
    let left = Layout::left_to_right(Align::Center);
    ui.allocate_ui_with_layout(size, left, |ui| {
        ui.set_min_width(size.x);
        ui.label(name).on_hover_text(tooltip);
    });
    number(ui, RichText::new(text).monospace());
    ui.end_row();
}

/// Shows right-aligned text in a column of constant width.
fn number(ui: &mut Ui, text: RichText) -> egui::Response {
    let right = Layout::right_to_left(Align::Center);
    let label = |ui: &mut Ui| {
        ui.set_min_width(FIGURE);
        ui.label(text)
    };
    ui.allocate_ui_with_layout(vec2(FIGURE, ROW), right, label).inner
}

/// Shows the graph: the stages of each frame, stacked, and the GPU time as a line.
fn graph(ui: &mut Ui, times: &FrameTimes) {
    let top = top(times);
    let (palette, weak) = (style::palette(ui), ui.visuals().weak_text_color());
    let strong = ui.visuals().strong_text_color();
    // Positions of the labels, as fractions of the graph's height.
    let ticks = [0.0, 0.5, 1.0];
    let points = |part: &dyn Fn(&FrameTime) -> Option<Duration>| points(times, top, part);
    let response = plot::still("frame times", HEIGHT)
        .label_formatter(|_| None)
        .show_grid(false)
        .show_axes([false, true])
        .custom_y_axes(vec![plot::axis(ui, AxisHints::new_y(), move |part| {
            format!("{} ms", part * top)
        })])
        .y_grid_spacer(move |_| plot::marks(&ticks))
        .show(ui, |plot| {
            let last = FrameTimes::MOST as f64;
            plot::show(plot, PlotBounds::from_min_max([1.0, 0.0], [last, 1.04]));
            // Each area covers the lower part of the area drawn before it.
            for count in (1..=PARTS.len()).rev() {
                let sum = |frame: &FrameTime| {
                    Some(PARTS[..count].iter().map(|part| (part.of)(frame)).sum())
                };
                let colour = (PARTS[count - 1].colour)(&palette);
                let line = Line::new(PARTS[count - 1].name, points(&sum));
                plot.line(line.color(colour).width(1.0).fill(0.0).fill_alpha(1.0));
            }
            let gpu = Line::new("GPU", points(&|frame| frame.gpu));
            plot.line(gpu.color(strong).width(1.5));
            for at in [SIXTIETH / top, 1.0].into_iter().filter(|at| *at <= 1.0) {
                plot.hline(HLine::new("", at).stroke(Stroke::new(1.0, weak.gamma_multiply(0.4))));
            }
        })
        .response;
    let said = match times.last() {
        Some(frame) => {
            format!("Frame times: the last took {:.1} ms", milliseconds(frame.total()))
        }
        None => "Frame times: no frame drawn yet".to_owned(),
    };
    response.widget_info(|| WidgetInfo::labeled(Role::Image, true, &said));
    response.on_hover_text("The last 240 frames, newest right; idle windows draw none");
}

/// Points of the graph of the duration `part`: x is the frame, with the newest at the right, and y
/// is the ratio of the duration to `top`, which is in milliseconds.
fn points(
    times: &FrameTimes,
    top: f64,
    part: &dyn Fn(&FrameTime) -> Option<Duration>,
) -> PlotPoints<'static> {
    let frames = times.frames();
    let first = FrameTimes::MOST - frames.len() + 1;
    let point = |(index, frame)| Some([(first + index) as f64, milliseconds(part(frame)?) / top]);
    frames.enumerate().filter_map(point).collect()
}

/// Duration at the top of the graph in milliseconds: a round number that is at least the 99th
/// percentile, so that it seldom changes.
fn top(times: &FrameTimes) -> f64 {
    let total = times.spread(|frame| Some(frame.total().max(frame.gpu.unwrap_or_default())));
    let slowest = total.map_or(1.0, |total| milliseconds(total.slowest)).max(1.0);
    let power = 10_f64.powf(slowest.log10().floor());
    [1.0, 2.0, 3.0, 5.0, 10.0]
        .map(|times| times * power)
        .into_iter()
        .find(|it| *it >= slowest)
        .unwrap_or(slowest)
}

fn milliseconds(time: Duration) -> f64 {
    time.as_secs_f64() * 1e3
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_graph_ends_at_a_round_number_above_nearly_all_frames() {
        for (micros, expected) in [
            (0, 1.0),
            (900, 1.0),
            (1_100, 2.0),
            (16_700, 20.0),
            (23_100, 30.0),
            (49_000, 50.0),
            (51_000, 100.0),
            (100_000, 100.0),
        ] {
            let mut times = FrameTimes::default();
            times.push(FrameTime { wait: Duration::from_micros(micros), ..FrameTime::default() });
            assert!((top(&times) - expected).abs() < 1e-9, "{micros} µs: {}", top(&times));
        }
    }
}
