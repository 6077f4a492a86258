//! The sides from which `render` and `export` show a rig.

use clap::ValueEnum;
use glam::Vec3;

use super::argument::SizeArgument;
use crate::document::{AxisView, Camera, Display, Document, Overlay, Posed};

#[derive(Clone, Copy, ValueEnum)]
pub enum ViewName {
    Front,
    Right,
    Top,
    Perspective,
}

impl ViewName {
    /// The default camera, turned to look from this side.
    pub fn camera(self) -> Camera {
        let camera = Camera::default();
        match self {
            Self::Front => camera.along(AxisView::Front),
            Self::Right => camera.along(AxisView::Right),
            Self::Top => camera.along(AxisView::Top),
            Self::Perspective => camera,
        }
    }

    /// A camera that looks from this side and frames the shown rig over the timeline.
    pub fn framing(self, document: &Document, size: SizeArgument) -> Camera {
        let display = document.display;
        let (centre, radius) = document.motion_bounds_by(|posed| arm_bounds(posed, display));
        let aspect = size.width as f32 / size.height as f32;
        self.camera().framing(centre, radius, aspect)
    }
}

/// Centre and radius of a bounding sphere of the arm, in world space. The sphere contains the outer
/// limit if that is shown, otherwise the Cursor if that is shown.
fn arm_bounds(posed: &Posed, display: Display) -> (Vec3, f32) {
    let arm = posed.arm();
    let (centre, radius) = arm.bounds(posed.arm_pose());
    if display.shows(Overlay::OuterLimit) {
        (arm.root, arm.reach_limits().outer.max(arm.root.distance(centre) + radius))
    } else if display.shows(Overlay::Cursor) {
        let cursor = arm.cursor_in_world();
        let excess = (centre.distance(cursor) - radius).max(0.0);
        let centre = centre.move_towards(cursor, excess / 2.0);
        (centre, radius + excess / 2.0)
    } else {
        (centre, radius)
    }
}
