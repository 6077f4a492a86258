use glam::{DMat3, DQuat, Mat3, Vec3};

use super::body_part::BodyPart;
use super::drag::{Drag, DragKind, Grip};
use super::point_drag::{PointDrag, PointHandle};
use super::session::Session;
use super::turn_drag::{GripRing, TurnDrag};
use crate::document::{Arm, HandSpace, Ray, TwistReferenceKind};
use crate::kinematics::euler;
use crate::kinematics::fk::limb_rotations;
use crate::kinematics::skeleton::RotationAxis;

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
        let Arm { twist, fk, hand_orientation, .. } = *self.arm();
        let start = match grip {
            Grip::Twist => twist,
            Grip::Shoulder(axis) => fk.shoulder[axis.index()],
            Grip::HandRing(axis) => hand_orientation.angles[axis.index()],
            _ => fk.bend,
        };
        if let Some(ring) = self.arm_ring(grip) {
            let kind = DragKind::Turn(TurnDrag::new(ring, start, ray));
            self.begin_edit(Some(Drag::new(grip, kind)));
        }
    }

    /// Begins to turn the elbow about the Pointer, by the point of a limb at the mouse: it moves on
    /// a circle around the Pointer as the elbow does.
    pub(super) fn grab_limb(&mut self, ray: Ray) {
        let Arm { root, twist, .. } = *self.arm();
        if !self.arm().uses_ik() {
            return;
        }
        let [shoulder, elbow, hand] = self.joints_in_world();
        let limb = match self.arm_part_at(ray) {
            Some(BodyPart::UpperLimb) => [shoulder, elbow],
            _ => [elbow, hand],
        };
        let point = limb[0].lerp(limb[1], ray.nearest_on_segment(limb));
        let axis = self.pose().pointer.direction;
        let ring = GripRing { centre: root + axis * (point - root).dot(axis), axis };
        self.begin_edit(Some(Drag::new(
            Grip::Limb,
            DragKind::Turn(TurnDrag::new(ring, twist, ray)),
        )));
    }

    /// Begins to turn the shoulder in FK, by the point of the Upper limb at the mouse.
    pub(super) fn grab_upper_limb(&mut self, ray: Ray, forward: Vec3) {
        // Nearer to the shoulder a point has no direction from it.
        const NEAREST: f32 = 0.1;
        if self.arm().uses_ik() {
            return;
        }
        let [shoulder, elbow, _] = self.joints_in_world();
        let part = ray.nearest_on_segment([shoulder, elbow]).max(NEAREST);
        let start = self.pose().elbow * part;
        let drag = PointDrag::new(PointHandle::Free, start, shoulder, forward, ray);
        let drag = drag.with_step(self.snap());
        self.begin_edit(Some(Drag::new(Grip::UpperLimb, DragKind::Point(drag))));
    }

    /// Shoulder, elbow and hand in the world.
    fn joints_in_world(&self) -> [Vec3; 3] {
        let (root, pose) = (self.arm().root, self.pose());
        [Vec3::ZERO, pose.elbow, pose.hand].map(|point| root + point)
    }

    /// The ring of a grip, in world space. With IK it is the ring of the Socket twist, around the
    /// Pointer at the elbow; in FK those of the shoulder's angles and of the elbow's bend; with
    /// both those of the hand's angles. `None` for other grips.
    pub fn arm_ring(&self, grip: Grip) -> Option<GripRing> {
        match (grip, self.arm().uses_ik()) {
            (Grip::HandRing(axis), _) => Some(self.hand_ring(axis)),
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
        let axis = match grip {
            Grip::Shoulder(axis) => turned_axis(angles, axis),
            // The lower limb turns clockwise about the hinge as the bend grows.
            Grip::Bend => -euler::rotation(angles).z_axis.as_vec3(),
            _ => return None,
        };
        let centre = if grip == Grip::Bend { arm.root + self.pose().elbow } else { arm.root };
        Some(GripRing { centre, axis })
    }

    fn hand_ring(&self, axis: RotationAxis) -> GripRing {
        let (arm, pose) = (self.arm(), self.pose());
        let axis = turned_axis(arm.hand_orientation.angles, axis).as_dvec3();
        let axis = match arm.hand_orientation.space {
            HandSpace::LowerLimb => limb_rotations(pose).1 * axis,
            HandSpace::World => axis,
        };
        GripRing { centre: arm.root + pose.hand, axis: axis.as_vec3() }
    }
}

/// The axis about which the angle x, y or z of a ball joint of the arm turns, in the
/// space of the angles: see [`euler`].
fn turned_axis(angles: Vec3, axis: RotationAxis) -> Vec3 {
    let yaw = Mat3::from_rotation_y(angles.y);
    match axis {
        RotationAxis::X => (yaw * Mat3::from_rotation_z(angles.z)).x_axis,
        RotationAxis::Y => Vec3::Y,
        RotationAxis::Z => yaw.z_axis,
    }
}

/// Angles of the shoulder after the least rotation that points the Upper limb at a point of Root
/// space. They do not change for a point at the shoulder.
pub(super) fn aimed(angles: Vec3, point: Vec3) -> Vec3 {
    let before = euler::rotation(angles);
    let Some(to) = point.as_dvec3().try_normalize() else { return angles };
    let turn = DQuat::from_rotation_arc(before.x_axis, to);
    euler::angles(DMat3::from_quat(turn) * before, angles)
}
