//! The line of the figures and formulas that is lit up, here and in the view.

use egui::{Painter, Pos2, Rect, Response, Shape, Stroke, Ui};

use crate::session::{ArmFigure, Session};
use crate::ui::style;

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
        Self { shown: session.figure(), pointed: None }
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
