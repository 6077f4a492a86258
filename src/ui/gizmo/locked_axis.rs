//! The coloured lines of the axis or the plane that a drag is locked to.

use egui::{Painter, Stroke, Ui};
use glam::Vec3;

use crate::session::{Constraint, Drag, Session};
use crate::ui::style;
use crate::ui::viewport::projection::ScreenProjection;

/// Draws a line along the locked axis, or two along those of the locked plane, through the point that
/// is dragged.
pub(in crate::ui) fn locked_axis(
    painter: &Painter,
    ui: &Ui,
    screen: &ScreenProjection,
    session: &Session,
) {
    let Some(drag) = session.drag().and_then(Drag::point) else { return };
    let Some(constraint) = drag.constraint() else { return };
    let is_free = |axis: usize| match constraint {
        Constraint::Axis(free) => axis == free,
        Constraint::Plane(normal) => axis != normal,
    };
    let colours = style::palette(ui).axes;
    for axis in (0..3).filter(|axis| is_free(*axis)) {
        let stroke = Stroke::new(1.5, style::colour(colours[axis]));
        line(painter, screen, drag.at(), Vec3::AXES[axis], stroke);
    }
}

/// Draws a line in world space to both sides of a point, as far as it is before the eye.
fn line(painter: &Painter, screen: &ScreenProjection, at: Vec3, along: Vec3, stroke: Stroke) {
    /// Length to each side, in heights of the view.
    const FARTHEST: f32 = 20.0;
    const HALVINGS: i32 = 12;
    let Some(here) = screen.place(at) else { return };
    let height = screen.units_per_point(at) * screen.rect.height();
    for direction in [along, -along] {
        let lengths = (0..HALVINGS).map(|halving| FARTHEST * 0.5_f32.powi(halving) * height);
        let ends = lengths.filter_map(|length| screen.place(at + direction * length));
        if let Some(end) = ends.into_iter().next() {
            painter.line_segment([here, end], stroke);
        }
    }
}
