//! Handles in the viewport: their positions on screen, hit tests and painting.

mod arm;
mod handles;
pub(in crate::ui) mod screen;
mod skeleton;
mod twist_ring;

pub(in crate::ui) use screen::locked_axis;

use egui::{Painter, Pos2, Ui};

use crate::document::RigKind;
use crate::kinematics::skeleton::JointId;
use crate::session::{Grip, Session};
use arm::ArmGizmo;
use screen::ScreenProjection;
use skeleton::SkeletonGizmo;

pub(in crate::ui) enum Gizmo {
    Arm(ArmGizmo),
    Skeleton(SkeletonGizmo),
    /// No handles, because a crowd is shown.
    None,
}

impl Gizmo {
    pub fn new(screen: &ScreenProjection, session: &Session) -> Self {
        if session.crowd().is_some() {
            return Self::None;
        }
        match session.rig() {
            RigKind::Arm => Self::Arm(ArmGizmo::new(screen, session)),
            RigKind::Skeleton => Self::Skeleton(SkeletonGizmo::new(screen, session)),
        }
    }

    /// The handle at a screen position; `None` if there is no handle.
    pub fn at(&self, mouse: Pos2) -> Option<Grip> {
        match self {
            Self::Arm(arm) => arm.at(mouse),
            Self::Skeleton(skeleton) => skeleton.at(mouse),
            Self::None => None,
        }
    }

    /// The joint whose bone is at a screen position; `None` if there is no bone, and for an arm or
    /// a crowd.
    pub fn joint_at(&self, mouse: Pos2) -> Option<JointId> {
        match self {
            Self::Arm(_) | Self::None => None,
            Self::Skeleton(skeleton) => skeleton.joint_at(mouse),
        }
    }

    /// Draws the handles and highlights the hovered or dragged one.
    pub fn paint(&self, painter: &Painter, ui: &Ui, pointed: Option<Grip>, dragged: Option<Grip>) {
        match self {
            Self::Arm(arm) => arm.paint(painter, ui, pointed, dragged),
            Self::Skeleton(skeleton) => skeleton.paint(painter, ui, pointed, dragged),
            Self::None => {}
        }
    }
}
