//! Figures of a limb that light up, here and in the view: lines of drawings with labels beside
//! them, where they cover nothing, and rows of quantities with symbol, formula and value.

use core::f32::consts::PI;
use std::sync::Arc;

use egui::{Color32, Galley, Grid, Painter, Pos2, Rect, Response, Shape, Stroke, Ui, Vec2, vec2};
use glam::Vec3;

use crate::session::{LimbFigure, Session, ShownLimb};
use crate::ui::gizmo::screen::to_segment;
use crate::ui::style;
use crate::ui::widgets::{self, text};

/// Distance from the mouse to a line that it points at, in points.
const NEAR: f32 = 7.0;

/// The figure that is lit up, and the one that the mouse points at.
pub(super) struct Lit {
    shown: Option<LimbFigure>,
    pointed: Option<LimbFigure>,
}

/// A line of a drawing, through these points of the screen.
pub(super) struct FigureLine {
    pub figure: LimbFigure,
    pub points: Vec<Pos2>,
}

impl Lit {
    pub fn new(session: &Session) -> Self {
        Self { shown: session.selection().figure(), pointed: None }
    }

    /// The figure that the mouse points at.
    pub fn pointed(&self) -> Option<LimbFigure> {
        self.pointed
    }

    pub fn shows(&self, figure: LimbFigure) -> bool {
        self.shown == Some(figure)
    }

    /// Shows a row of the figure, with a lit background while it is lit up.
    pub fn row(&mut self, ui: &mut Ui, figure: LimbFigure, contents: impl FnOnce(&mut Ui) -> Rect) {
        let behind = ui.painter().add(Shape::Noop);
        let rect = contents(ui).expand2(vec2(4.0, 0.5 * ui.spacing().item_spacing.y));
        if ui.rect_contains_pointer(rect) {
            self.pointed = Some(figure);
        }
        if self.shows(figure) {
            ui.painter().set(behind, Shape::rect_filled(rect, 4.0, fill(ui)));
        }
    }

    /// Paints the lit lines of a drawing, below its other lines.
    pub fn paint(&self, painter: &Painter, ui: &Ui, lines: &[FigureLine]) {
        let stroke = Stroke::new(9.0, fill(ui));
        let lit = lines.iter().filter(|line| self.shows(line.figure));
        painter.extend(lit.map(|line| Shape::line(line.points.clone(), stroke)));
    }

    /// Finds the label of a drawing under the mouse, or else the line nearest to it.
    pub fn point(
        &mut self,
        drawing: &Response,
        lines: &[FigureLine],
        labels: &[(Rect, LimbFigure)],
    ) {
        let Some(mouse) = drawing.hover_pos() else { return };
        let label = labels.iter().find(|(rect, _)| rect.contains(mouse)).map(|(_, figure)| *figure);
        let distances = lines.iter().map(|line| (line.distance(mouse), line.figure));
        let nearest = distances.min_by(|a, b| a.0.total_cmp(&b.0));
        let line = nearest.filter(|(distance, _)| *distance < NEAR).map(|(_, figure)| figure);
        self.pointed = label.or(line).or(self.pointed);
    }
}

impl FigureLine {
    fn distance(&self, mouse: Pos2) -> f32 {
        let segments = self.points.windows(2);
        segments.map(|ends| to_segment(mouse, ends[0], ends[1])).fold(f32::INFINITY, f32::min)
    }
}

fn fill(ui: &Ui) -> Color32 {
    style::accent(ui).gamma_multiply(0.3)
}

const LABEL_SIZE: f32 = 13.0;

/// A place for a label: beside a point, on the side in the direction `away`; centred on it for 0.
#[derive(Clone, Copy)]
pub(super) struct Place {
    pub at: Pos2,
    pub away: Vec2,
}

impl Place {
    fn rect(self, size: Vec2) -> Rect {
        let extent = self.away.x.abs() * size.x + self.away.y.abs() * size.y;
        Rect::from_center_size(self.at + self.away * extent * 0.5, size)
    }
}

/// Places to the left of a line, seen from its first point: near its middle first.
pub(super) fn beside(from: Pos2, to: Pos2) -> Vec<Place> {
    const GAP: f32 = 6.0;
    let along = (to - from).normalized();
    let away = vec2(along.y, -along.x);
    let parts = [0.5, 0.35, 0.65, 0.2, 0.8, 0.05, 0.95];
    parts.map(|part| Place { at: from + (to - from) * part + away * GAP, away }).to_vec()
}

/// Places around a corner, outside the arc of its angle: near the direction `middle` first, in
/// radians clockwise from the right.
pub(super) fn around(corner: Pos2, arc: f32, middle: f32) -> Vec<Place> {
    let place = |radius: f32, turn: f32| Place {
        at: corner + radius * Vec2::angled(middle + turn),
        away: Vec2::ZERO,
    };
    let inside = [14.0, 22.0, 30.0].map(|gap| [0.0, 0.3, -0.3].map(|turn| place(arc + gap, turn)));
    let behind =
        [16.0, 22.0].map(|radius| [PI, PI - 0.8, PI + 0.8].map(|turn| place(radius, turn)));
    [inside.concat(), behind.concat()].concat()
}

/// Points of an arc around a point. Angles are in radians, clockwise from the right.
pub(super) fn arc(centre: Pos2, radius: f32, start: f32, turn: f32) -> Vec<Pos2> {
    const STEPS: u8 = 24;
    let part = |step: u8| f32::from(step) / f32::from(STEPS);
    (0..=STEPS).map(|step| centre + radius * Vec2::angled(start + part(step) * turn)).collect()
}

/// Labels of a drawing, beside its lines.
pub(super) struct FigureLabels<'a> {
    painter: &'a Painter,
    ui: &'a Ui,
    /// The rectangle that labels stay in.
    room: Rect,
    lines: Vec<[Pos2; 2]>,
    written: Vec<(Rect, LimbFigure)>,
}

impl<'a> FigureLabels<'a> {
    pub fn new(painter: &'a Painter, ui: &'a Ui, lines: Vec<[Pos2; 2]>) -> Self {
        Self { painter, ui, room: painter.clip_rect().shrink(3.0), lines, written: Vec::new() }
    }

    /// Writes a label at the first clear place, if there is one.
    pub fn write(&mut self, text: &str, colour: Color32, figure: LimbFigure, places: &[Place]) {
        let galley = self.galley(text, colour);
        let rects = places.iter().map(|place| place.rect(galley.size()));
        if let Some(rect) = rects.into_iter().find(|rect| self.is_clear(*rect)) {
            self.paint(rect, galley, colour, figure);
        }
    }

    /// Writes a label at the first clear place, or else at the first one, moved into the room.
    pub fn write_always(
        &mut self,
        text: &str,
        colour: Color32,
        figure: LimbFigure,
        places: &[Place],
    ) {
        let galley = self.galley(text, colour);
        let mut rects = places.iter().map(|place| place.rect(galley.size()));
        let Some(first) = rects.clone().next() else { return };
        let rect = rects.find(|rect| self.is_clear(*rect)).unwrap_or_else(|| self.moved_in(first));
        self.paint(rect, galley, colour, figure);
    }

    /// The rectangles of the labels that were written.
    pub fn written(self) -> Vec<(Rect, LimbFigure)> {
        self.written
    }

    fn moved_in(&self, rect: Rect) -> Rect {
        let inwards = (self.room.min - rect.min).max(Vec2::ZERO);
        rect.translate(inwards + (self.room.max - rect.max).min(Vec2::ZERO))
    }

    fn galley(&self, text: &str, colour: Color32) -> Arc<Galley> {
        self.ui.fonts_mut(|fonts| fonts.layout_job(text::layout(text, LABEL_SIZE, colour)))
    }

    fn paint(&mut self, rect: Rect, galley: Arc<Galley>, colour: Color32, figure: LimbFigure) {
        self.painter.galley(rect.min, galley, colour);
        self.written.push((rect, figure));
    }

    fn is_clear(&self, rect: Rect) -> bool {
        let rect = rect.expand(2.0);
        let is_crossed = |[from, to]: &[Pos2; 2]| {
            const STEPS: usize = 64;
            (0..=STEPS)
                .any(|step| rect.contains(*from + (*to - *from) * (step as f32 / STEPS as f32)))
        };
        self.room.contains_rect(rect)
            && !self.lines.iter().any(is_crossed)
            && !self
                .written
                .iter()
                .any(|(other, _)| other.expand2(vec2(12.0, 0.0)).intersects(rect))
    }
}

const FORMULA_SIZE: f32 = 13.5;

/// A quantity with symbol, formula, value and meaning.
pub(super) struct FormulaRow {
    pub symbol: String,
    /// Empty for a quantity that is given.
    pub formula: &'static str,
    pub value: String,
    pub meaning: String,
    /// Lights up while the mouse is over the row.
    pub figure: Option<LimbFigure>,
}

pub(super) fn table(ui: &mut Ui, id: &str, rows: &[FormulaRow], lit: &mut Lit) {
    let right = ui.available_rect_before_wrap().right();
    Grid::new(id).num_columns(3).min_col_width(24.0).spacing(vec2(10.0, 4.0)).show(ui, |ui| {
        for row in rows {
            match row.figure {
                Some(figure) => {
                    let is_lit = lit.shows(figure);
                    lit.row(ui, figure, |ui| show(ui, row, is_lit, right));
                }
                None => {
                    show(ui, row, false, right);
                }
            }
            ui.end_row();
        }
    });
}

/// The colour of a figure's name: that of its limb, or else of text.
pub(super) fn figure_colour(ui: &Ui, figure: Option<LimbFigure>) -> Color32 {
    let palette = style::palette(ui);
    match figure {
        Some(LimbFigure::Upper) => style::colour(palette.upper),
        Some(LimbFigure::Lower) => style::colour(palette.lower),
        _ => ui.visuals().text_color(),
    }
}

/// Shows a row that ends at `right`, and returns its rectangle.
fn show(ui: &mut Ui, row: &FormulaRow, is_lit: bool, right: f32) -> Rect {
    let (text, weak) = (ui.visuals().text_color(), ui.visuals().weak_text_color());
    let symbol = explained(ui, &row.symbol, figure_colour(ui, row.figure), &row.meaning);
    if row.formula.is_empty() {
        ui.label("");
    } else {
        explained(ui, row.formula, if is_lit { text } else { weak }, &row.meaning);
    }
    let value = widgets::value(ui, &row.value);
    let mut rect = symbol.rect.union(value.rect);
    rect.max.x = rect.max.x.min(right);
    rect
}

/// Shows a name or formula with a tooltip; both may have symbols.
fn explained(ui: &mut Ui, text: &str, colour: Color32, meaning: &str) -> Response {
    let shown = text::label(ui, text, FORMULA_SIZE, colour);
    shown.on_hover_ui(|ui| {
        let colour = ui.visuals().text_color();
        text::label(ui, meaning, FORMULA_SIZE, colour);
    })
}

/// Shows the name and the value of a quantity that has no formula.
pub(super) fn pair(
    ui: &mut Ui,
    lit: &mut Lit,
    figure: LimbFigure,
    [name, meaning]: [&str; 2],
    value: String,
) {
    let colour = ui.visuals().text_color();
    lit.row(ui, figure, |ui| {
        let row = ui.horizontal(|ui| {
            explained(ui, name, colour, meaning);
            widgets::value(ui, value);
        });
        row.response.rect
    });
}

/// Writes a formula on a line of its own.
pub(super) fn formula(ui: &mut Ui, text: &str) {
    let colour = ui.visuals().text_color();
    text::label(ui, text, FORMULA_SIZE, colour);
}

pub(super) fn degrees(radians: f32) -> String {
    format!("{:.1}°", tidy(radians.to_degrees()))
}

/// Formats a length of a limb; a length that rounds to 0 is shown without a sign.
pub(super) fn length(limb: &ShownLimb, length: f32) -> String {
    let lengths = limb.lengths();
    let nothing = 0.0005 * lengths.cell();
    lengths.show(if length.abs() < nothing { 0.0 } else { length })
}

/// Formats a point of Root space.
pub(super) fn point(limb: &ShownLimb, point: Vec3) -> String {
    let [x, y, z] = point.to_array().map(|coordinate| length(limb, coordinate));
    format!("({x}, {y}, {z})")
}

/// Returns 0 for a value that rounds to 0 at one decimal, so that 0 has no sign; otherwise the
/// value.
fn tidy(value: f32) -> f32 {
    if value.abs() < 0.05 { 0.0 } else { value }
}
