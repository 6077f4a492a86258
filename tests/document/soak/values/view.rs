//! Cameras, and drags by rays.

use crate::common::arm::{LOWER, ROOT, UPPER, WRIST};
use ik_arm::kinematics::skeleton::{Extreme, JointId, LimitEnd, RotationAxis, SwingAxis};
use std::f32::consts::FRAC_PI_2;

use glam::{Vec2, Vec3};
use ik_arm::document::{AxisView, Camera, Overlay, Ray};
use ik_arm::session::{CameraMotion, Constraint, DragInput, Grip, PointDrag, PointHandle};

use super::Values;

impl Values<'_> {
    pub fn place(&mut self) -> Vec2 {
        Vec2::new(self.number(1.0), self.number(1.0))
    }

    pub fn aspect(&mut self) -> f32 {
        if self.is_wild() { self.wild_number() } else { self.one_of(&[0.3, 1.0, 1.6, 3.0]) }
    }

    pub fn camera(&mut self) -> Camera {
        let camera = *self.session.camera();
        match self.random.below(5) {
            0 => self.session.framing_all(),
            1 => self.session.framing_selection(),
            2 => camera.along(self.one_of(&[
                AxisView::Front,
                AxisView::Back,
                AxisView::Right,
                AxisView::Left,
                AxisView::Top,
                AxisView::Bottom,
            ])),
            3 => {
                let (at, aspect) = (self.place(), self.aspect());
                camera.zoomed(self.above_0(3.0), at, aspect)
            }
            _ => {
                let size = self.size();
                Camera {
                    target: self.point(size),
                    yaw: self.number(7.0),
                    pitch: self.number(FRAC_PI_2),
                    distance: self.above_0(4.0 * size),
                    orthographic: self.coin(),
                }
            }
        }
    }

    pub fn turn(&mut self) -> CameraMotion {
        self.one_of(&[CameraMotion::Orbit, CameraMotion::Pan, CameraMotion::Zoom])
    }

    pub fn layer(&mut self) -> Overlay {
        let all: Vec<Overlay> = Overlay::all().collect();
        self.one_of(&all)
    }

    // Drags

    pub fn grip(&mut self) -> Grip {
        let joint = self.joint();
        match self.random.below(17) {
            0 | 1 => Grip::Target(LOWER, self.handle()),
            2 => Grip::LimbPole(LOWER, self.handle()),
            3 => Grip::Ring(UPPER, self.rotation_axis()),
            4 => Grip::Ring(LOWER, RotationAxis::Z),
            5 => Grip::Target(self.aimed(), self.handle()),
            6 => Grip::Tip(joint, self.handle()),
            7 => Grip::Tip(ROOT, self.handle()),
            8 => Grip::LimbTwist(LOWER),
            9 => Grip::Head(joint, self.handle()),
            10 => Grip::Tip(UPPER, PointHandle::Free),
            11 => Grip::Tip(UPPER, PointHandle::Free),
            12 => Grip::Ring(WRIST, self.rotation_axis()),
            15 => Grip::Limit(joint, self.limit_end()),
            14 => Grip::Aim(self.aimed(), self.handle()),
            13 => Grip::Orientation(self.aimed(), self.rotation_axis()),
            _ => Grip::Ring(joint, self.rotation_axis()),
        }
    }

    pub fn hovered(&mut self) -> Option<JointId> {
        if self.coin() { None } else { Some(self.joint()) }
    }

    fn limit_end(&mut self) -> LimitEnd {
        let extreme = if self.coin() { Extreme::Least } else { Extreme::Greatest };
        match self.random.below(4) {
            0 => LimitEnd::Twist(extreme),
            1 => LimitEnd::Swing(SwingAxis::X, extreme),
            2 => LimitEnd::Swing(SwingAxis::Z, extreme),
            _ => LimitEnd::Range(self.rotation_axis(), extreme),
        }
    }

    fn handle(&mut self) -> PointHandle {
        match self.random.below(4) {
            0 => PointHandle::Axis(self.axis()),
            1 => PointHandle::Plane(self.axis()),
            _ => PointHandle::Free,
        }
    }

    pub fn constraint(&mut self) -> Option<Constraint> {
        match self.random.below(3) {
            0 => None,
            1 => Some(Constraint::Axis(self.axis())),
            _ => Some(Constraint::Plane(self.axis())),
        }
    }

    pub fn ray(&mut self) -> Ray {
        if self.is_wild() {
            let (origin, direction) = (self.point(100.0), self.point(1.0));
            return Ray { origin, direction };
        }
        let projection = self.session.camera().projection(1.6);
        if self.chance(0.3)
            && let Some(held) = self.session.history().point_drag().map(PointDrag::moved)
            && let Some(at) = projection.project(held)
        {
            return projection.ray(at);
        }
        let at = Vec2::new(self.random.within(-1.0..1.0), self.random.within(-1.0..1.0));
        projection.ray(at)
    }

    pub fn forward(&mut self) -> Vec3 {
        if self.is_wild() { self.point(1.0) } else { self.session.camera().projection(1.0).forward }
    }

    pub fn drag_input(&mut self) -> DragInput {
        DragInput { ray: self.ray(), precise: self.chance(0.2), snap: self.chance(0.2) }
    }

    pub fn typed(&mut self) -> String {
        const TYPED: [&str; 16] = [
            "", "-", "1", "12.5", "-3,4", "1,2,3", ",,", "1,,2", "1e99", "1e38", "-1e38", "nan",
            "inf", "0,0,0,0", "é", "180",
        ];
        self.one_of(&TYPED).to_owned()
    }
}
