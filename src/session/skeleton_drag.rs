use glam::{Vec3, Vec3A};

use super::drag::{Drag, DragKind, Grip};
use super::point_drag::{PointDrag, PointHandle};
use super::session::Session;
use super::turn_drag::{GripRing, TurnDrag};
use crate::document::Ray;
use crate::kinematics::chain_ik::{self, Method, SolveError, SolverOptions, TipTarget};
use crate::kinematics::skeleton::{JointId, Skeleton};

/// Maximum number of iterations per frame of a drag.
const ITERATIONS_OF_A_DRAG: u32 = 64;

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

    pub(super) fn grab_tip(
        &mut self,
        joint: JointId,
        handle: PointHandle,
        ray: Ray,
        forward: Vec3,
    ) {
        if joint.index() < self.skeleton_pose().len() && self.skeleton_rig().follow_path.is_none() {
            let tip = self.skeleton_pose().tip(joint);
            self.grab_point(Grip::Tip(joint, handle), handle, tip, ray, forward);
        }
    }

    fn grab_point(&mut self, grip: Grip, handle: PointHandle, at: Vec3, ray: Ray, forward: Vec3) {
        let drag = PointDrag::new(handle, at, Vec3::ZERO, forward, ray).with_step(self.snap());
        self.begin_edit(Some(Drag { grip, kind: DragKind::Point(drag) }));
    }

    pub(super) fn grab_ring(&mut self, joint: JointId, axis: usize, ray: Ray) {
        let Some(ring) = self.ring(joint, axis) else { return };
        let start = self.skeleton()[joint].rotation[axis];
        let drag = TurnDrag::new(ring, start, ray);
        self.begin_edit(Some(Drag { grip: Grip::Ring(joint, axis), kind: DragKind::Turn(drag) }));
    }

    /// The ring, in world space, of a joint's angle about x, y or z (0, 1, 2). `None` if a limit
    /// fixes the angle, or if there is no such joint or axis.
    pub fn ring(&self, joint: JointId, axis: usize) -> Option<GripRing> {
        let skeleton = &self.skeleton();
        let limit = skeleton.joint(joint)?.limits.get(axis)?;
        if limit.is_some_and(|limit| limit.min == limit.max) {
            return None;
        }
        // The ring is at the joint as posed by the targets, and turns the joint's own angle.
        let (pose, parent) = (self.skeleton_pose(), skeleton[joint].parent);
        let above = parent.map_or(skeleton.transform(), |parent| pose.full(parent)).matrix3;
        let local = skeleton[joint].rotation_axis(axis);
        // A mirrored transform reverses every rotation.
        let sign = above.determinant().signum();
        let axis = (Vec3::from(above * Vec3A::from(local)) * sign).try_normalize()?;
        Some(GripRing { centre: pose.base(joint), axis })
    }

    /// Step of snapping in world units: a tenth of a cell of the grid.
    pub(super) fn snap(&self) -> f32 {
        self.shown().grid_cell() * 0.1
    }

    pub(super) fn drag_skeleton(&mut self, grip: Grip, to: Vec3, moved: Vec3) {
        match grip {
            Grip::Target(joint, _) => self.drag_target(joint, to),
            Grip::Tip(joint, _) => self.drag_tip(joint, to, moved),
            _ => {}
        }
    }

    fn drag_target(&mut self, joint: JointId, to: Vec3) {
        let Some(index) = self.skeleton_rig().target(joint) else { return };
        let target = self.skeleton_rig().targets[index];
        self.set_target(target.placed(&self.evaluated_skeleton().solved, self.time(), to));
        if self.preferences.follow
            && !self.is_running()
            && self.skeleton_rig().follow_path.is_none()
        {
            let targets = self.skeleton_rig().targets_at(self.time());
            let skeleton = self.skeleton().clone();
            self.solve_drag(skeleton, &targets, self.skeleton_rig().solver);
        }
    }

    /// Solves, from the pose at the press, for the tip of `joint` at `to` in world space. A root
    /// without a bone is moved by `moved` instead.
    fn drag_tip(&mut self, joint: JointId, to: Vec3, moved: Vec3) {
        if !self.is_editing() {
            return;
        }
        let before = self.editing.shown_before().skeleton().clone();
        let Some(dragged) = before.joint(joint) else { return };
        if dragged.parent.is_none() && dragged.axis == Vec3::ZERO {
            let (transform, offset) = (before.transform(), dragged.offset);
            let moved = transform.inverse().transform_vector3(moved);
            self.change_joint(joint, |joint| joint.offset = offset + moved);
            return;
        }
        let mut targets = self.skeleton_rig().targets_at(self.time());
        targets.retain(|target| target.joint != joint);
        targets.push(TipTarget { joint, point: to, weight: 1.0 });
        let mut solver = self.skeleton_rig().solver;
        if solver.method == Method::TwoBone {
            solver.method = Method::Fabrik;
        }
        self.solve_drag(before, &targets, solver);
    }

    /// Solves a skeleton for targets and commits the pose.
    fn solve_drag(&mut self, mut from: Skeleton, targets: &[TipTarget], solver: SolverOptions) {
        let options = SolverOptions { iterations: Some(ITERATIONS_OF_A_DRAG), ..solver };
        self.edit_document(|document| {
            chain_ik::solve(&mut from, targets, &options)?;
            *document.skeleton_mut() = from;
            Ok::<_, SolveError>(())
        });
    }

    pub(super) fn turn_joint(&mut self, joint: JointId, axis: usize, angle: f32) {
        self.change_joint(joint, |joint| joint.rotation[axis] = angle);
    }
}
