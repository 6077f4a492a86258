use glam::Vec3;

use super::body_part::BodyPart;
use super::session::{ASPECT, Session};
use crate::document::{Channel, Document, PathKind, RigKind, SkeletonRig, Target};
use crate::kinematics::chain_ik::SolverOptions;
use crate::kinematics::skeleton::{
    Joint, JointId, JointRemap, Limit, RotationAxis, Skeleton, SkeletonError,
};

/// Edits of the skeleton.
impl Session {
    /// Changes a copy of the skeleton and commits it. After an error, reports it and returns
    /// `None`.
    pub(super) fn edit_skeleton<T>(
        &mut self,
        change: impl FnOnce(&mut SkeletonRig) -> Result<T, SkeletonError>,
    ) -> Option<T> {
        self.edit_document(|document| change(&mut document.skeleton_rig))
    }

    pub(super) fn change_joint(&mut self, joint: JointId, change: impl FnOnce(&mut Joint)) {
        self.edit_skeleton(|rig| rig.skeleton_mut().change(joint, change));
    }

    /// Adds a child at the tip of `parent` and selects it. The child's bone ends at `tip` in world
    /// space; if `tip` is `None`, it continues the parent's bone. Without a parent, adds a root
    /// without a bone.
    pub(super) fn add_joint(&mut self, parent: Option<JointId>, tip: Option<Vec3>) {
        let added = self.edit_skeleton(|rig| {
            let skeleton = rig.skeleton_mut();
            let Some(parent) = parent else {
                let name = skeleton.free_name("root");
                let root = Joint { locked: true, ..Joint::new(&name, None, Vec3::ZERO) };
                return skeleton.add(root);
            };
            let above = skeleton.joint(parent).ok_or(SkeletonError::NoJoint(parent))?.clone();
            let axis = match tip {
                Some(tip) => {
                    let from_world = skeleton.full_transform(parent).inverse();
                    from_world.transform_point3(tip) - above.axis
                }
                None => skeleton.next_axis(parent),
            };
            let joint = Joint::new(&skeleton.free_name("joint"), Some(parent), axis);
            let radius = radius_of_next(skeleton, parent, joint.radius);
            skeleton.add(Joint { offset: above.axis, radius, ..joint })
        });
        if let Some(joint) = added {
            self.select(vec![joint]);
        }
    }

    /// Adds a child to the selected joint; without a selection, to the joint with the highest
    /// index; without joints, to a new root.
    pub(super) fn add_next_joint(&mut self, tip: Option<Vec3>) {
        if self.next_parent().is_none() {
            self.add_joint(None, None);
        }
        if let Some(parent) = self.next_parent() {
            self.add_joint(Some(parent), tip);
            self.keep_in_view();
        }
    }

    fn next_parent(&self) -> Option<JointId> {
        self.selected().or(self.skeleton_pose().ids().next_back())
    }

    /// Base of the next joint that would be added, in world space.
    pub fn next_base(&self) -> Vec3 {
        let origin = self.skeleton().transform().translation.into();
        self.next_parent().map_or(origin, |parent| self.skeleton_pose().tip(parent))
    }

    /// Frames the whole rig if the tip of the selected joint is near the edge of the picture or
    /// outside.
    fn keep_in_view(&mut self) {
        const EDGE: f32 = 0.9;
        let Some(joint) = self.selected() else { return };
        let projection = self.settled_camera().projection(ASPECT);
        let tip = projection.project(self.skeleton_pose().tip(joint));
        if tip.is_none_or(|tip| tip.abs().max_element() > EDGE) {
            let camera = self.framing_all();
            if camera.is_valid() {
                self.glide_to(camera);
            }
        }
    }

    /// Deletes joints by `delete` and selects the last of their parents that remains.
    pub(super) fn delete_joints(
        &mut self,
        joints: &[JointId],
        delete: fn(&mut Document, &[JointId]) -> Result<JointRemap, SkeletonError>,
    ) {
        let skeleton = &self.skeleton();
        let parents = joints.iter().filter_map(|joint| skeleton.joint(*joint)?.parent);
        let parents: Vec<JointId> = parents.collect();
        let selected = self.selected_in_timeline();
        let moved = self.edit_document(|document| delete(document, joints));
        let Some(moved) = moved else { return };
        self.remap_keys(&moved, selected);
        let left = parents.iter().rev().find_map(|parent| moved.get(*parent));
        self.select(left.into_iter().collect());
    }

    pub(super) fn reparent(&mut self, joint: JointId, parent: Option<JointId>) {
        let selected = self.selected_in_timeline();
        let before = self.selection().to_vec();
        let moved = self.edit_document(|document| {
            let moved = document.skeleton_mut().reparent(joint, parent)?;
            document.remap_joints(&moved);
            Ok::<_, SkeletonError>(moved)
        });
        if let Some(moved) = moved {
            self.remap_keys(&moved, selected);
            let hovered = self.hovered().and_then(|joint| moved.get(joint));
            self.selection.set_hovered(hovered.map(BodyPart::Joint));
            self.select(before.iter().filter_map(|joint| moved.get(*joint)).collect());
        }
    }

    pub(super) fn set_limit(&mut self, joint: JointId, axis: RotationAxis, limit: Option<Limit>) {
        self.change_joint(joint, |joint| joint.limits.set_range(axis, limit));
    }

    pub(super) fn bind_pose(&mut self) {
        self.edit_skeleton(|rig| {
            let mut joints = rig.skeleton.ids();
            joints.try_for_each(|joint| rig.skeleton_mut().set_rotation(joint, Vec3::ZERO))
        });
    }

    pub(super) fn set_translation(&mut self, to: Vec3) {
        self.edit_skeleton(|rig| {
            let mut transform = rig.skeleton.transform();
            transform.translation = to.into();
            rig.skeleton_mut().set_transform(transform)
        });
    }

    /// Turns the skeleton so that y points up in place of z, and frames it. Other animations of its file
    /// will be turned, too.
    pub(super) fn turn_y_up(&mut self) {
        self.discard_unkeyed_edits();
        self.refresh();
        self.edit_keys(Document::turn_y_up);
        self.files.take_z_as_up();
        if self.rig() == RigKind::Skeleton {
            self.glide_to(self.framing_all());
        }
    }

    /// Adds a target for a joint that has none.
    pub(super) fn add_target(&mut self, joint: JointId) {
        let pose = &self.evaluated_skeleton().solved;
        let Some(target) = self.skeleton_rig().new_target(joint, pose) else { return };
        if !target.home.is_finite() {
            let home = target.home;
            return self.fail(format!("The position of a target must be finite, got {home}"));
        }
        self.edit_skeleton(|rig| {
            rig.targets.push(target);
            Ok(())
        });
    }

    /// Matches the FK pose and a target, at the playhead.
    pub(super) fn match_target(
        &mut self,
        joint: JointId,
        matched: fn(&mut SkeletonRig, usize, f64),
    ) {
        let Some(index) = self.skeleton_rig().target(joint) else { return };
        let time = self.time();
        self.edit_skeleton(|rig| {
            matched(rig, index, time);
            Ok(())
        });
    }

    /// Converts a target and its keys, for the pose at the playhead.
    pub(super) fn convert_target(&mut self, convert: impl FnOnce(&mut Document, f64)) {
        let time = self.time();
        self.edit_document(|document| {
            convert(document, time);
            Ok::<_, SkeletonError>(())
        });
    }

    /// Replaces the target of a joint.
    pub(super) fn set_target(&mut self, target: Target) {
        let (motion, weight) = (target.motion, target.weight);
        let above_0 = |value: f32| value.is_finite() && value > 0.0;
        if !target.home.is_finite() {
            let home = target.home;
            self.fail(format!("The position of a target must be finite, got {home}"));
        } else if !above_0(weight) {
            self.fail(format!("The weight of a target must be finite and above 0, got {weight}"));
        } else if !(above_0(motion.period) && motion.radius.is_finite()) {
            self.fail("The path of a target must have a period above 0 and a finite radius");
        } else if !(0.0..=1.0).contains(&target.influence) {
            let influence = target.influence;
            self.fail(format!("The influence of a target must be from 0 to 1, got {influence}"));
        } else if !target.has_finite_kind() {
            self.fail("The twist, pole and orientation of a limb's target must be finite");
        } else if let Some(index) = self.skeleton_rig().target(target.joint) {
            self.edit_skeleton(|rig| {
                rig.targets[index] = target;
                Ok(())
            });
        }
    }

    pub(super) fn set_follow_path(&mut self, root: JointId, kind: Option<PathKind>) {
        if self.skeleton_rig().root_of(root) != Some(root) {
            self.fail(format!("The joint of a path must be a root, got joint {root}"));
        } else if kind.as_ref().is_none_or(PathKind::is_valid) {
            self.edit_skeleton(|rig| {
                rig.follow_paths = rig.with_path(root, kind);
                Ok(())
            });
        } else {
            self.fail("The path to follow must have a period above 0 and finite lengths");
        }
    }

    pub(super) fn set_head(&mut self, root: JointId, to: Vec3) {
        if self.skeleton_rig().root_of(root) == Some(root) {
            self.move_head(root, self.skeleton_rig().clone(), &[to]);
        } else {
            self.fail(format!("A head must be a root, got joint {root}"));
        }
    }

    /// Moves the head of a chain of `before` through points of skeleton space, and writes the joints
    /// that follow a path to the shown skeleton.
    pub(super) fn move_head(&mut self, root: JointId, mut before: SkeletonRig, points: &[Vec3]) {
        if let Some(wrong) = points.iter().find(|point| !point.is_finite()) {
            return self.fail(format!("The position of the head must be finite, got {wrong}"));
        }
        let has_keys = before.head_tracks.contains_key(&root);
        before.pull_head(root, points);
        let moved = before.path_joints(root).take(if has_keys { 1 } else { usize::MAX });
        self.edit_skeleton(|rig| {
            let count = rig.skeleton.joints().len();
            for joint in moved.filter(|joint| joint.index() < count) {
                let Joint { offset, rotation, .. } = before.skeleton[joint];
                rig.skeleton_mut().write_local(joint, |joint| {
                    (joint.offset, joint.rotation) = (offset, rotation);
                });
            }
            Ok(())
        });
    }

    pub(super) fn set_solver(&mut self, solver: SolverOptions) {
        let above_0 = |value: f32| value.is_finite() && value > 0.0;
        let is_valid = above_0(solver.damping)
            && above_0(solver.step)
            && solver.tolerance.is_none_or(above_0)
            && solver.iterations.is_none_or(|iterations| iterations > 0);
        if is_valid {
            self.edit_skeleton(|rig| {
                rig.solver = solver;
                Ok(())
            });
        } else {
            self.fail("Tolerance, damping, step and iterations must be above 0");
        }
    }

    /// Removes the target of a joint, with its keys.
    pub(super) fn remove_target(&mut self, joint: JointId) {
        self.edit_document(|document| {
            document.skeleton_rig.targets.retain(|target| target.joint != joint);
            Channel::of_target(joint).into_iter().for_each(|it| document.keys.clear(it));
            Ok::<_, SkeletonError>(())
        });
    }

    /// Shows the arm or the skeleton.
    pub(super) fn show_rig(&mut self, rig: RigKind) {
        self.view.drop();
        self.end_glide();
        let mut after = self.shown().clone();
        after.show(rig);
        self.commit(after);
        self.shell.clear_message();
    }
}

/// Radius of a new child of `parent`: nine tenths of the largest radius of `parent` and its
/// ancestors, so that the bones of a skeleton are about equally thick, but at most 2.5 times `own`,
/// the default radius for the child's length.
fn radius_of_next(skeleton: &Skeleton, parent: JointId, own: f32) -> f32 {
    const TAPER: f32 = 0.9;
    const THICKEST: f32 = 2.5;
    let above = skeleton.ancestors(parent).filter_map(|joint| skeleton.joint(joint));
    let thickest = above.map(|joint| joint.radius).fold(0.0, f32::max);
    if thickest > 0.0 && own > 0.0 { (TAPER * thickest).min(THICKEST * own) } else { own }
}
