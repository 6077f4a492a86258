//! The limits of the selected joint: the arcs of its ranges, and a dot at each end, which can be
//! dragged.

use egui::{Color32, Painter, Pos2, Shape, Stroke, Ui};

use super::screen::ScreenProjection;
use crate::kinematics::skeleton::{LimitEnd, RotationAxis};
use crate::session::{Grip, LimitFan, Session};
use crate::ui::style;

/// Radius in points of the dot at an end.
const END: f32 = 5.0;
/// Maximum distance in points at which the mouse hits a dot.
const END_HIT: f32 = 9.0;

/// Screen positions of the limits of the selected joint; none while they are not shown.
#[derive(Default)]
pub(super) struct LimitMarks {
    ends: Vec<LimitMark>,
    arcs: Vec<(RotationAxis, Vec<Pos2>)>,
}

/// The dot at an end.
struct LimitMark {
    grip: Grip,
    end: LimitEnd,
    at: Pos2,
}

impl LimitMarks {
    pub fn new(screen: &ScreenProjection, session: &Session) -> Self {
        let Some(joint) = session.selection().active() else { return Self::default() };
        let Some(fan) = LimitFan::shown(session.posed(), joint) else { return Self::default() };
        let mark = |(end, at)| {
            Some(LimitMark { grip: Grip::Limit(joint, end), end, at: screen.place(at)? })
        };
        let arc = |axis| (axis, fan.range_arc(axis).filter_map(|at| screen.place(at)).collect());
        Self {
            ends: fan.ends().filter_map(mark).collect(),
            arcs: RotationAxis::ALL.map(arc).to_vec(),
        }
    }

    /// The nearest end at a screen position; `None` if there is none.
    pub fn at(&self, mouse: Pos2) -> Option<Grip> {
        let ends = self.ends.iter().map(|end| (end.at.distance(mouse), end.grip));
        let near = ends.filter(|(distance, _)| *distance <= END_HIT);
        near.min_by(|one, other| one.0.total_cmp(&other.0)).map(|(_, grip)| grip)
    }

    pub fn paint(
        &self,
        painter: &Painter,
        ui: &Ui,
        stands_out: impl Fn(Grip) -> bool,
        faded: impl Fn(Grip, Color32) -> Color32,
    ) {
        let axes = style::palette(ui).axes.map(style::colour);
        for (axis, points) in &self.arcs {
            let stroke = Stroke::new(1.5, axes[axis.index()]);
            painter.add(Shape::line(points.clone(), stroke));
        }
        let rim = ui.visuals().strong_text_color();
        for LimitMark { grip, end, at } in &self.ends {
            let own = match end {
                LimitEnd::Range(axis, _) => axes[axis.index()],
                LimitEnd::Swing(..) | LimitEnd::Twist(_) => style::accent(ui),
            };
            painter.circle_filled(*at, END, faded(*grip, own));
            let width = if stands_out(*grip) { 2.0 } else { 1.0 };
            painter.circle_stroke(*at, END, Stroke::new(width, rim));
        }
    }
}
