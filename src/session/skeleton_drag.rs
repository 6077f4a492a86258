use glam::{Quat, Vec3, Vec3A};

use super::drag::{Drag, DragKind, Grip};
use super::point_drag::{Constraint, PointDrag, PointHandle};
use super::session::Session;
use super::turn_drag::{GripRing, TurnDrag};
use crate::document::{Channel, Overlay, PathKind, Ray, Target};
use crate::kinematics::limb_ik::{ElbowReference, Limb};
use crate::kinematics::skeleton::{JointId, RotationAxis};
use crate::rig::EvaluatedSkeleton;

/// Smallest slope of the view, as the height that it loses per length, for which a head is dragged on
/// its level.
const EDGE_ON: f32 = 0.1;

/// Drags of the skeleton.
impl Session {
    pub(super) fn grab_target(
        &mut self,
        joint: JointId,
        handle: PointHandle,
        ray: Ray,
        forward: Vec3,
    ) {
        if let Some(at) = self.target_report(joint).map(|report| report.position) {
            self.grab_point(Grip::Target(joint, handle), handle, at, ray, forward);
        }
    }

    pub(super) fn grab_limb_pole(
        &mut self,
        joint: JointId,
        handle: PointHandle,
        ray: Ray,
        forward: Vec3,
    ) {
        if let Some(at) = self.target_report(joint).and_then(|report| report.pole) {
            self.grab_point(Grip::LimbPole(joint, handle), handle, at, ray, forward);
        }
    }

    pub(super) fn grab_tip(
        &mut self,
        joint: JointId,
        handle: PointHandle,
        ray: Ray,
        forward: Vec3,
    ) {
        if joint.index() < self.skeleton_pose().len()
            && !self.skeleton_rig().is_joint_on_path(joint, self.time())
        {
            let tip = self.skeleton_pose().tip(joint);
            self.grab_point(Grip::Tip(joint, handle), handle, tip, ray, forward);
        }
    }

    pub(super) fn grab_head(
        &mut self,
        joint: JointId,
        handle: PointHandle,
        ray: Ray,
        forward: Vec3,
    ) {
        let rig = self.skeleton_rig();
        if rig.path_kind(joint) == Some(PathKind::Head) {
            let at = self.evaluated_skeleton().fk.base(joint);
            self.grab_point(Grip::Head(joint, handle), handle, at, ray, forward);
            if handle == PointHandle::Free && forward.y.abs() > EDGE_ON {
                self.keep_head_level();
            }
        }
    }

    fn grab_point(&mut self, grip: Grip, handle: PointHandle, at: Vec3, ray: Ray, forward: Vec3) {
        let drag = PointDrag::new(handle, at, Vec3::ZERO, forward, ray).with_step(self.snap());
        self.begin_edit(Some(Drag::new(grip, DragKind::Point(drag))));
    }

    pub(super) fn grab_ring(&mut self, joint: JointId, axis: RotationAxis, ray: Ray) {
        let Some(ring) = self.ring(joint, axis) else { return };
        let start = self.skeleton()[joint].rotation[axis.index()];
        let drag = TurnDrag::new(ring, start, ray);
        self.begin_edit(Some(Drag::new(Grip::Ring(joint, axis), DragKind::Turn(drag))));
    }

    pub(super) fn grab_orientation(&mut self, joint: JointId, axis: RotationAxis, ray: Ray) {
        let (Some(ring), Some(angles)) =
            (self.orientation_ring(joint, axis), self.held_orientation(joint))
        else {
            return;
        };
        let drag = TurnDrag::new(ring, angles[axis.index()], ray);
        self.begin_edit(Some(Drag::new(Grip::Orientation(joint, axis), DragKind::Turn(drag))));
    }

    /// The ring, at the target of a joint and in world space, of the angle about x, y or z of the
    /// orientation that the target holds. `None` if it holds none, or if there is no hand
    /// or foot.
    pub fn orientation_ring(&self, joint: JointId, axis: RotationAxis) -> Option<GripRing> {
        let angles = self.held_orientation(joint)?;
        let rig = self.skeleton_rig();
        Limb::ending_at(&rig.skeleton, joint).ok()?.hand?;
        let space = rig.targets[rig.target(joint)?].space;
        let turn = Quat::from_rotation_z(angles.z);
        let local = match axis {
            RotationAxis::X => turn * (Quat::from_rotation_y(angles.y) * Vec3::X),
            RotationAxis::Y => turn * Vec3::Y,
            RotationAxis::Z => Vec3::Z,
        };
        let axis = space.rotation(&self.evaluated_skeleton().solved) * local;
        Some(GripRing { centre: self.target_report(joint)?.position, axis })
    }

    /// The angles about x, y and z in radians that the target of a joint holds; `None` if it holds
    /// none.
    fn held_orientation(&self, joint: JointId) -> Option<Vec3> {
        let rig = self.skeleton_rig();
        rig.targets[rig.target(joint)?].limb()?.orientation
    }

    /// The ring, in world space, of a joint's FK angle about x, y or z. `None` if a limit fixes the
    /// angle, if there is no such joint, or if a target alone poses the joint and the FK pose is
    /// hidden.
    pub fn ring(&self, joint: JointId, axis: RotationAxis) -> Option<GripRing> {
        let rig = self.skeleton_rig();
        let own = rig.skeleton.joint(joint)?;
        if own.limits.is_fixed(axis) {
            return None;
        }
        let EvaluatedSkeleton { fk, solved, .. } = self.evaluated_skeleton();
        // A hand that follows the bone above it keeps its own angles.
        let is_following = |target: &Target| {
            let follows = target.limb().is_some_and(|limb| limb.orientation.is_none());
            follows && target.joint != joint && rig.end_of(target) == joint
        };
        let posing = rig.target_that_turns(joint).filter(|it| it.influence >= 1.0);
        let is_solved = posing.is_some_and(|target| !is_following(target));
        let pose = match is_solved {
            false => solved,
            true if self.shown().display.shows(Overlay::FkPose) => fk,
            true => return None,
        };
        let above = own.parent.map_or(pose.transform(), |parent| pose.full_transform(parent));
        let local = own.rotation_axis(axis);
        // A mirrored transform reverses every rotation.
        let sign = above.matrix3.determinant().signum();
        let axis = (Vec3::from(above.matrix3 * Vec3A::from(local)) * sign).try_normalize()?;
        Some(GripRing { centre: pose.base(joint), axis })
    }

    /// Step of snapping in world units: a tenth of a cell of the grid.
    pub(super) fn snap(&self) -> f32 {
        self.shown().grid_cell() * 0.1
    }

    pub(super) fn drag_skeleton(&mut self, grip: Grip, to: Vec3, moved: Vec3) {
        match grip {
            Grip::Target(joint, _) => self.drag_target(joint, to),
            Grip::LimbPole(joint, _) => self.drag_limb_pole(joint, to),
            Grip::Tip(joint, _) => self.drag_tip(joint, to, moved),
            _ => {}
        }
    }

    fn drag_target(&mut self, joint: JointId, to: Vec3) {
        let Some(index) = self.skeleton_rig().target(joint) else { return };
        let target = self.skeleton_rig().targets[index];
        self.set_target(target.placed(&self.evaluated_skeleton().solved, self.time(), to));
    }

    fn drag_limb_pole(&mut self, joint: JointId, to: Vec3) {
        let Some(index) = self.skeleton_rig().target(joint) else { return };
        let mut target = self.skeleton_rig().targets[index];
        if let Some(limb) = target.limb_mut() {
            let pole = limb.pole_space.point_from_world(&self.evaluated_skeleton().solved, to);
            limb.reference = ElbowReference::Pole(pole);
            self.set_target(target);
        }
    }

    /// Keeps the dragged head at its height, unless the user constrains it otherwise.
    fn keep_head_level(&mut self) {
        if let Some((drag, _)) = self.editing.drag_mut() {
            drag.set_constraint(Some(Constraint::Plane(1)));
        }
    }

    /// Moves a head from where it was at the press through points in the world; back without points. A
    /// head with keys gets one at the playhead.
    pub(super) fn drag_head(&mut self, root: JointId, waypoints: &[Vec3]) {
        let before = self.editing.shown_before().skeleton_rig.clone();
        let to_skeleton = before.skeleton.transform().inverse();
        let points: Vec<Vec3> =
            waypoints.iter().map(|point| to_skeleton.transform_point3(*point)).collect();
        let channel = Channel::Offset(root);
        self.move_head(root, before, &points);
        if !points.is_empty() && self.document().keys.has(channel) {
            self.key(&[channel]);
        }
    }

    /// Sets one of the angles of the orientation that the target of a joint holds.
    pub(super) fn turn_target(&mut self, joint: JointId, axis: RotationAxis, angle: f32) {
        let Some(index) = self.skeleton_rig().target(joint) else { return };
        let mut target = self.skeleton_rig().targets[index];
        if let Some(angles) = target.limb_mut().and_then(|limb| limb.orientation.as_mut()) {
            angles[axis.index()] = angle;
            self.set_target(target);
        }
    }

    pub(super) fn turn_joint(&mut self, joint: JointId, axis: RotationAxis, angle: f32) {
        self.change_joint(joint, |joint| joint.rotation[axis.index()] = angle);
    }
}
