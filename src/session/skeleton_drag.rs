use glam::{Vec3, Vec3A};

use super::drag::DragKind;
use super::drag::{Drag, Grip};
use super::point_drag::{PointDrag, PointHandle};
use super::session::Session;
use super::turn_drag::{GripRing, TurnDrag};
use crate::document::Ray;
use crate::kinematics::chain_ik::{self, Method, SolveError, SolverOptions};
use crate::kinematics::skeleton::{JointId, Skeleton};

/// Iterations while something is dragged, in every frame: enough for a short way.
const ITERATIONS_OF_A_DRAG: u32 = 64;

/// What is dragged of a skeleton.
impl Session {
    pub(super) fn grab_target(
        &mut self,
        joint: JointId,
        handle: PointHandle,
        ray: Ray,
        forward: Vec3,
    ) {
        if let Some(target) = self.skeleton_rig().target(joint) {
            let at = self.skeleton_rig().targets[target].at(self.time());
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

    /// The ring about which a joint's angle x, y or z (0, 1, 2) turns, in the world; `None` where its
    /// limit leaves no room.
    pub fn ring(&self, joint: JointId, axis: usize) -> Option<GripRing> {
        let skeleton = &self.skeleton();
        let limit = skeleton.joint(joint)?.limits.get(axis)?;
        if limit.is_some_and(|limit| limit.min == limit.max) {
            return None;
        }
        let world = skeleton.transform_to_base(joint);
        let local = skeleton[joint].rotation_axis(axis);
        // A mirror turns every rotation around.
        let sign = world.matrix3.determinant().signum();
        let axis = (Vec3::from(world.matrix3 * Vec3A::from(local)) * sign).try_normalize()?;
        Some(GripRing { centre: world.translation.into(), axis })
    }

    /// A tenth of the grid.
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
        let mut target = self.skeleton_rig().targets[index];
        target.home = to - target.motion.offset(self.time());
        self.set_target(target);
        if self.preferences.follow
            && !self.is_running()
            && self.skeleton_rig().follow_path.is_none()
        {
            let goals = self.skeleton_rig().targets_at(self.time());
            let skeleton = self.skeleton().clone();
            self.solve_drag(skeleton, &goals, self.skeleton_rig().solver);
        }
    }

    /// The tip follows the pointer from the pose at the press; a root that is a point moves.
    fn drag_tip(&mut self, joint: JointId, to: Vec3, moved: Vec3) {
        if !self.is_editing() {
            return;
        }
        let before = self.editing.shown_before().skeleton().clone();
        let Some(held) = before.joint(joint) else { return };
        if held.parent.is_none() && held.axis == Vec3::ZERO {
            let (transform, offset) = (before.transform(), held.offset);
            let moved = transform.inverse().transform_vector3(moved);
            self.change_joint(joint, |joint| joint.offset = offset + moved);
            return;
        }
        let mut goals = self.skeleton_rig().targets_at(self.time());
        goals.retain(|goal| goal.joint != joint);
        goals.push(chain_ik::TipTarget { joint, point: to, weight: 1.0 });
        let mut solver = self.skeleton_rig().solver;
        if solver.method == Method::TwoBone {
            solver.method = Method::Fabrik;
        }
        self.solve_drag(before, &goals, solver);
    }

    /// Brings a skeleton to goals, from a pose, and shows it.
    fn solve_drag(
        &mut self,
        mut from: Skeleton,
        goals: &[chain_ik::TipTarget],
        solver: SolverOptions,
    ) {
        let options = SolverOptions { iterations: Some(ITERATIONS_OF_A_DRAG), ..solver };
        self.edit_document(|document| {
            chain_ik::solve(&mut from, goals, &options)?;
            *document.skeleton_mut() = from;
            Ok::<_, SolveError>(())
        });
    }

    pub(super) fn turn_joint(&mut self, joint: JointId, axis: usize, angle: f32) {
        self.change_joint(joint, |joint| joint.rotation[axis] = angle);
    }
}
