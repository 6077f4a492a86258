use glam::{Mat3, Vec3};

use super::drag::{Drag, DragKind, Grip};
use super::point_drag::{PointDrag, PointHandle};
use super::session::Session;
use super::turn_drag::{GripRing, TurnDrag};
use crate::document::{Arm, Ray, TwistReferenceKind};
use crate::kinematics::euler;

/// Drags of the arm.
impl Session {
    /// Begins to drag the Cursor. If the Cursor is out of reach and the mouse is nearer to the
    /// hand, a free drag (not along an axis
    /// or in a plane) starts with the Cursor at the hand, which does not change the pose.
    pub(super) fn grab_hand(&mut self, handle: PointHandle, ray: Ray, forward: Vec3) {
        let (arm, hand) = (*self.arm(), self.pose().hand);
        if !arm.uses_ik() {
            return;
        }
        let aside = |point: Vec3| (arm.root + point - ray.origin).cross(ray.direction).length();
        let is_free = handle == PointHandle::Free && arm.influence == 1.0;
        let is_at_hand = is_free && aside(hand) < aside(arm.cursor_in_root());
        let start = if is_at_hand { hand } else { arm.cursor_in_root() };
        let drag = PointDrag::new(handle, start, arm.root, forward, ray).with_step(self.snap());
        self.begin_edit(Some(Drag::new(Grip::Hand(handle), DragKind::Point(drag))));
    }

    pub(super) fn grab_pole(&mut self, handle: PointHandle, ray: Ray, forward: Vec3) {
        let arm = *self.arm();
        if arm.twist_reference == TwistReferenceKind::Pole {
            let drag = PointDrag::new(handle, arm.pole, arm.root, forward, ray);
            let drag = drag.with_step(self.snap());
            self.begin_edit(Some(Drag::new(Grip::Pole(handle), DragKind::Point(drag))));
        }
    }

    pub(super) fn grab_root(&mut self, handle: PointHandle, ray: Ray, forward: Vec3) {
        let drag = PointDrag::new(handle, self.arm().root, Vec3::ZERO, forward, ray);
        let drag = drag.with_step(self.snap());
        self.begin_edit(Some(Drag::new(Grip::Root(handle), DragKind::Point(drag))));
    }

    pub(super) fn grab_arm_ring(&mut self, grip: Grip, ray: Ray) {
        let Arm { twist, fk, .. } = *self.arm();
        let start = match grip {
            Grip::Twist => twist,
            Grip::Shoulder(axis) => fk.shoulder[axis],
            _ => fk.bend,
        };
        if let Some(ring) = self.arm_ring(grip) {
            let kind = DragKind::Turn(TurnDrag::new(ring, start, ray));
            self.begin_edit(Some(Drag::new(grip, kind)));
        }
    }

    /// The ring of a grip, in world space. With IK it is the ring of the Socket twist, around the
    /// Pointer at the elbow; in FK those of the shoulder's angles and of the elbow's bend. `None`
    /// for other grips.
    pub fn arm_ring(&self, grip: Grip) -> Option<GripRing> {
        match (grip, self.arm().uses_ik()) {
            (Grip::Twist, true) => Some(self.twist_ring()),
            (_, false) => self.fk_ring(grip),
            _ => None,
        }
    }

    fn twist_ring(&self) -> GripRing {
        let pose = self.pose();
        let axis = pose.pointer.direction;
        GripRing { centre: self.arm().root + axis * pose.along, axis }
    }

    fn fk_ring(&self, grip: Grip) -> Option<GripRing> {
        let arm = self.arm();
        let angles = arm.fk.shoulder;
        let yaw = Mat3::from_rotation_y(angles.y);
        let axis = match grip {
            Grip::Shoulder(1) => Vec3::Y,
            Grip::Shoulder(2) => yaw.z_axis,
            Grip::Shoulder(_) => (yaw * Mat3::from_rotation_z(angles.z)).x_axis,
            // The lower limb turns clockwise about the hinge as the bend grows.
            Grip::Bend => -euler::rotation(angles).z_axis.as_vec3(),
            _ => return None,
        };
        let centre = if grip == Grip::Bend { arm.root + self.pose().elbow } else { arm.root };
        Some(GripRing { centre, axis })
    }
}
