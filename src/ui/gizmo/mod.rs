//! What can be taken hold of in the viewport, where it is on screen, and how it shows.

mod arm;
mod rotate;
mod shape;
mod skeleton;
mod translate;
pub(in crate::ui) mod view_axes;

use egui::{Painter, Pos2, Ui};

use crate::document::RigKind;
use crate::session::{Grip, Session};
use crate::ui::viewport::projection::ScreenProjection;
use arm::ArmGizmo;
use skeleton::SkeletonGizmo;

pub(in crate::ui) enum Gizmo {
    Arm(ArmGizmo),
    Skeleton(SkeletonGizmo),
    /// A crowd has none.
    None,
}

impl Gizmo {
    pub fn new(picture: &ScreenProjection, session: &Session) -> Self {
        if session.crowd().is_some() {
            return Self::None;
        }
        match session.rig() {
            RigKind::Arm => Self::Arm(ArmGizmo::new(picture, session)),
            RigKind::Skeleton => Self::Skeleton(SkeletonGizmo::new(picture, session)),
        }
    }

    /// What is under a point of the screen.
    pub fn at(&self, pointer: Pos2) -> Option<Grip> {
        match self {
            Self::Arm(arm) => arm.at(pointer),
            Self::Skeleton(figure) => figure.at(pointer),
            Self::None => None,
        }
    }

    /// The joint whose bone is under a point of the screen.
    pub fn joint_at(&self, pointer: Pos2) -> Option<usize> {
        match self {
            Self::Arm(_) | Self::None => None,
            Self::Skeleton(figure) => figure.joint_at(pointer),
        }
    }

    /// Draws them; what is held or pointed at stands out.
    pub fn paint(&self, painter: &Painter, ui: &Ui, pointed: Option<Grip>, held: Option<Grip>) {
        match self {
            Self::Arm(arm) => arm.paint(painter, ui, pointed, held),
            Self::Skeleton(figure) => figure.paint(painter, ui, pointed, held),
            Self::None => {}
        }
    }
}
