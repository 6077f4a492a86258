//! The axes of the graph editor: one at the left and one at the right, each with the unit of its
//! values.

use egui::{Align2, Color32, Id, Pos2, Rect, Role, Sense, Stroke, TextStyle, Ui, WidgetInfo, pos2};

use crate::ui::timeline::areas::VALUES;
use crate::ui::timeline::value_scale::{ValueKind, ValueScales};
use crate::ui::widgets::format;

/// Minimum distance in points between labels.
const BETWEEN: f32 = 20.0;
/// Distance in points between the plot and the labels.
const GAP: f32 = 5.0;

/// The kinds of values that have an axis, at the left and at the right. Angles are at the left and
/// lengths at the right; ratios take a side that is free.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::ui::timeline) struct AxisSides {
    pub left: Option<ValueKind>,
    pub right: Option<ValueKind>,
}

impl AxisSides {
    pub fn new(has: impl Fn(ValueKind) -> bool) -> Self {
        let given = |kind| Some(kind).filter(|kind| has(*kind));
        let [angle, length, ratio] = ValueKind::ALL.map(given);
        match (angle, length) {
            (Some(_), Some(_)) => Self { left: angle, right: length },
            (one, None) | (None, one) => match one {
                Some(_) => Self { left: one, right: ratio },
                None => Self { left: ratio, right: None },
            },
        }
    }
}

/// Draws lines through the plot at round values, and the axes beside it.
pub(in crate::ui::timeline) fn ui(
    ui: &Ui,
    scales: ValueScales,
    sides: AxisSides,
    plot: Rect,
    metres_per_unit: f32,
) {
    let font = TextStyle::Small.resolve(ui.style());
    let colours = (ui.visuals().text_color(), ui.visuals().weak_text_color());
    let write = |at: Pos2, align: Align2, text: String, colour: Color32| {
        ui.painter().text(at, align, text, font.clone(), colour);
    };
    for (kind, is_left) in [(sides.left, true), (sides.right, false)] {
        let Some(kind) = kind else { continue };
        let (x, align) = if is_left {
            (plot.left() - GAP, egui::Align::Max)
        } else {
            (plot.right() + GAP, egui::Align::Min)
        };
        let (name, unit) = kind.unit(metres_per_unit);
        let top = Align2([align, egui::Align::Min]);
        write(pos2(x, plot.top() + 2.0), top, unit.to_owned(), colours.0);
        let marks = marks(scales.range(kind), plot.height());
        for mark in marks.values() {
            let y = scales.y(kind, mark, plot.y_range());
            if is_left {
                let line = ui.visuals().widgets.noninteractive.bg_stroke.color.gamma_multiply(0.5);
                ui.painter().with_clip_rect(plot).hline(plot.x_range(), y, Stroke::new(1.0, line));
            }
            // The unit stands above the labels.
            if y > plot.top() + BETWEEN && y < plot.bottom() - 6.0 {
                let label = Align2([align, egui::Align::Center]);
                write(pos2(x, y), label, written(mark, marks.step), colours.1);
            }
        }
        let rect = if is_left {
            Rect::from_min_max(pos2(plot.left() - VALUES, plot.top()), plot.left_bottom())
        } else {
            Rect::from_min_max(plot.right_top(), pos2(plot.right() + VALUES, plot.bottom()))
        };
        let response = ui.interact(rect, Id::unique(("timeline axis", is_left)), Sense::click());
        response.widget_info(|| {
            WidgetInfo::labeled(Role::Label, true, format!("Axis in {name} ({unit})"))
        });
        if response.double_clicked() {
            ValueScales::fit(ui);
            ui.request_repaint();
        }
        response
            .on_hover_text(format!("Values in {name}. Ctrl+wheel zooms, double-click shows all"));
    }
}

/// Round values within a range.
#[derive(Clone, Copy)]
struct Marks {
    first: f64,
    step: f64,
    count: usize,
}

fn marks((low, high): (f64, f64), height: f32) -> Marks {
    let step = round_step((high - low) * f64::from((BETWEEN / height.max(1.0)).min(1.0)));
    let first = (low / step).ceil();
    let count = ((high / step).floor() - first + 1.0).clamp(0.0, 1_000.0) as usize;
    Marks { first, step, count }
}

impl Marks {
    fn values(self) -> impl Iterator<Item = f64> {
        (0..self.count).map(move |index| (self.first + index as f64) * self.step)
    }
}

/// Formats a value with enough decimals to distinguish it from a label that is `step` away.
fn written(value: f64, step: f64) -> String {
    let digits = -step.max(1e-6).log10().floor();
    format::fixed(value, digits.max(0.0) as usize)
}

/// The smallest number that is at least `step` and is 1, 2 or 5 times a power of ten.
fn round_step(step: f64) -> f64 {
    let power = 10_f64.powf(step.max(1e-30).log10().floor());
    let steps = [1.0, 2.0, 5.0].map(|times| times * power);
    steps.into_iter().find(|it| *it >= step).unwrap_or(10.0 * power)
}
