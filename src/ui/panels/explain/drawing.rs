//! Parts of the drawings: lines that light up, here and in the view, and labels beside the lines,
//! where they cover nothing.

use core::f32::consts::PI;
use std::sync::Arc;

use egui::{Color32, Galley, Painter, Pos2, Rect, Response, Shape, Stroke, Ui, Vec2, vec2};

use crate::session::{ArmFigure, Session};
use crate::ui::style;
use crate::ui::widgets::symbol;

/// Distance from the mouse to a line that it points at, in points.
const NEAR: f32 = 7.0;

/// The figure that is lit up, and the one that the mouse points at.
pub(super) struct Lit {
    shown: Option<ArmFigure>,
    pointed: Option<ArmFigure>,
}

/// A line of a drawing, through these points of the screen.
pub(super) struct FigureLine {
    pub figure: ArmFigure,
    pub points: Vec<Pos2>,
}

impl Lit {
    pub fn new(session: &Session) -> Self {
        Self { shown: session.selection().figure(), pointed: None }
    }

    /// The figure that the mouse points at.
    pub fn pointed(&self) -> Option<ArmFigure> {
        self.pointed
    }

    pub fn shows(&self, figure: ArmFigure) -> bool {
        self.shown == Some(figure)
    }

    /// Shows a row of the figure, with a lit background while it is lit up.
    pub fn row(&mut self, ui: &mut Ui, figure: ArmFigure, contents: impl FnOnce(&mut Ui) -> Rect) {
        let behind = ui.painter().add(Shape::Noop);
        let rect = contents(ui).expand2(egui::vec2(4.0, 0.5 * ui.spacing().item_spacing.y));
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
        labels: &[(Rect, ArmFigure)],
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
        let distances = segments.map(|ends| {
            let (way, to_mouse) = (ends[1] - ends[0], mouse - ends[0]);
            let part = (to_mouse.dot(way) / way.length_sq().max(1e-6)).clamp(0.0, 1.0);
            (to_mouse - part * way).length()
        });
        distances.fold(f32::INFINITY, f32::min)
    }
}

fn fill(ui: &Ui) -> egui::Color32 {
    style::colour(style::palette(ui).accent).gamma_multiply(0.3)
}

const SIZE: f32 = 13.0;

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
    let parts = [0.5, 0.35, 0.65, 0.2, 0.8];
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

/// Labels of a drawing, beside its lines.
pub(super) struct Labels<'a> {
    painter: &'a Painter,
    ui: &'a Ui,
    /// The rectangle that labels stay in.
    room: Rect,
    lines: Vec<[Pos2; 2]>,
    written: Vec<(Rect, ArmFigure)>,
}

impl<'a> Labels<'a> {
    pub fn new(painter: &'a Painter, ui: &'a Ui, lines: Vec<[Pos2; 2]>) -> Self {
        Self { painter, ui, room: painter.clip_rect().shrink(3.0), lines, written: Vec::new() }
    }

    /// Writes a label at the first clear place, if there is one.
    pub fn write(&mut self, text: &str, colour: Color32, figure: ArmFigure, places: &[Place]) {
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
        figure: ArmFigure,
        places: &[Place],
    ) {
        let galley = self.galley(text, colour);
        let mut rects = places.iter().map(|place| place.rect(galley.size()));
        let Some(first) = rects.clone().next() else { return };
        let rect = rects.find(|rect| self.is_clear(*rect)).unwrap_or_else(|| self.moved_in(first));
        self.paint(rect, galley, colour, figure);
    }

    /// The rectangles of the labels that were written.
    pub fn written(self) -> Vec<(Rect, ArmFigure)> {
        self.written
    }

    fn moved_in(&self, rect: Rect) -> Rect {
        let inwards = (self.room.min - rect.min).max(Vec2::ZERO);
        rect.translate(inwards + (self.room.max - rect.max).min(Vec2::ZERO))
    }

    fn galley(&self, text: &str, colour: Color32) -> Arc<Galley> {
        self.ui.fonts_mut(|fonts| fonts.layout_job(symbol::layout(text, SIZE, colour)))
    }

    fn paint(&mut self, rect: Rect, galley: Arc<Galley>, colour: Color32, figure: ArmFigure) {
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
            && !self.written.iter().any(|(other, _)| other.expand2(vec2(6.0, 0.0)).intersects(rect))
    }
}
