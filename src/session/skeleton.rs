use glam::Vec3;

use super::Session;
use crate::document::{Channel, Document, RigKind, SkeletonRig, Slither, Target};
use crate::kinematics::skeleton::{Joint, Limit, SkeletonError};
use crate::kinematics::solve::Options;

/// What actions do to the skeleton.
impl Session {
    /// Every change of the skeleton comes through here.
    pub(super) fn edit_skeleton<T>(
        &mut self,
        change: impl FnOnce(&mut SkeletonRig) -> Result<T, SkeletonError>,
    ) -> Option<T> {
        self.edit_document(|document| change(&mut document.skeleton))
    }

    pub(super) fn say_impossible(&mut self, why: &str) {
        let mut letters = why.chars();
        let first = letters.next().map(|letter| letter.to_uppercase().to_string());
        self.message = Some(format!("{}{}", first.unwrap_or_default(), letters.as_str()));
    }

    pub(super) fn change_joint(&mut self, joint: usize, change: impl FnOnce(&mut Joint)) {
        self.edit_skeleton(|rig| rig.skeleton.change(joint, change));
    }

    /// A joint on the tip of `parent`, with its bone ending at `tip` (world) or going on like the
    /// parent's; on nothing, a new root that is a point.
    pub(super) fn add_joint(&mut self, parent: Option<usize>, tip: Option<Vec3>) {
        let added = self.edit_skeleton(|rig| {
            let skeleton = &mut rig.skeleton;
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
            let radius = if above.radius > 0.0 { above.radius * 0.9 } else { joint.radius };
            skeleton.add(Joint { offset: above.axis, radius, ..joint })
        });
        if let Some(joint) = added {
            self.select(vec![joint]);
        }
    }

    pub(super) fn remove_joints(&mut self, joints: &[usize]) {
        let skeleton = &self.skeleton().skeleton;
        let parents = joints.iter().filter_map(|joint| skeleton.joint(*joint)?.parent);
        let parents: Vec<usize> = parents.collect();
        let selected = self.selected_in_timeline();
        let moved = self.edit_document(|document| {
            let moved = document.skeleton.skeleton.remove(joints);
            document.follow(&moved);
            Ok::<_, SkeletonError>(moved)
        });
        let Some(moved) = moved else { return };
        self.follow_keys(&moved, selected);
        let left = parents.iter().rev().find_map(|parent| moved.get(*parent));
        self.select(left.into_iter().collect());
    }

    pub(super) fn reparent(&mut self, joint: usize, parent: Option<usize>) {
        let selected = self.selected_in_timeline();
        let before = self.selection.clone();
        let moved = self.edit_document(|document| {
            let moved = document.skeleton.skeleton.reparent(joint, parent)?;
            document.follow(&moved);
            Ok::<_, SkeletonError>(moved)
        });
        if let Some(moved) = moved {
            self.follow_keys(&moved, selected);
            self.pointed = self.pointed.and_then(|joint| moved.get(joint));
            self.select(before.iter().filter_map(|joint| moved.get(*joint)).collect());
        }
    }

    pub(super) fn set_limit(&mut self, joint: usize, axis: usize, limit: Option<Limit>) {
        if axis < 3 {
            self.change_joint(joint, |joint| joint.limits[axis] = limit);
        } else {
            self.message = Some(format!("A joint has angles 0, 1 and 2, not {axis}"));
        }
    }

    pub(super) fn bind_pose(&mut self) {
        self.edit_skeleton(|rig| {
            (0..rig.skeleton.joints().len())
                .try_for_each(|joint| rig.skeleton.set_rotation(joint, Vec3::ZERO))
        });
    }

    pub(super) fn set_translation(&mut self, to: Vec3) {
        self.edit_skeleton(|rig| {
            let mut transform = rig.skeleton.transform();
            transform.translation = to.into();
            rig.skeleton.set_transform(transform)
        });
    }

    /// Puts a target where the joint's tip is.
    pub(super) fn add_target(&mut self, joint: usize) {
        if joint >= self.skeleton_pose.len() || self.skeleton().target(joint).is_some() {
            return;
        }
        let home = self.skeleton_pose.tip(joint);
        let radius = self.skeleton().circle();
        self.edit_skeleton(|rig| {
            rig.targets.push(Target::new(joint, home, radius));
            Ok(())
        });
    }

    /// Changes the target of the joint that it names.
    pub(super) fn set_target(&mut self, target: Target) {
        let (motion, weight) = (target.motion, target.weight);
        let above_0 = |value: f32| value.is_finite() && value > 0.0;
        if !target.home.is_finite() {
            let home = target.home;
            self.message = Some(format!("A target must be at finite numbers, not {home}"));
        } else if !above_0(weight) {
            self.message = Some(format!("A weight must be a finite number above 0, not {weight}"));
        } else if !(above_0(motion.period) && motion.radius.is_finite()) {
            self.message = Some("A target needs a period above 0 and a finite radius".to_owned());
        } else if let Some(index) = self.skeleton().target(target.joint) {
            self.edit_skeleton(|rig| {
                rig.targets[index] = target;
                Ok(())
            });
        }
    }

    pub(super) fn set_slither(&mut self, slither: Option<Slither>) {
        let is_possible = |it: &Slither| {
            let lengths = it.radius.is_finite() && it.amplitude.is_finite();
            lengths && it.period.is_finite() && it.period > 0.0
        };
        if slither.as_ref().is_none_or(is_possible) {
            self.edit_skeleton(|rig| {
                rig.slither = slither;
                Ok(())
            });
        } else {
            self.message = Some("A way needs a period above 0 and finite lengths".to_owned());
        }
    }

    pub(super) fn set_solver(&mut self, solver: Options) {
        let above_0 = |value: f32| value.is_finite() && value > 0.0;
        let is_possible = above_0(solver.damping)
            && above_0(solver.step)
            && solver.tolerance.is_none_or(above_0)
            && solver.iterations.is_none_or(|iterations| iterations > 0);
        if is_possible {
            self.edit_skeleton(|rig| {
                rig.solver = solver;
                Ok(())
            });
        } else {
            self.message =
                Some("Tolerance, damping, step and iterations must be above 0".to_owned());
        }
    }

    /// Takes a target away, with its keys.
    pub(super) fn remove_target(&mut self, joint: usize) {
        self.edit_document(|document| {
            document.skeleton.targets.retain(|target| target.joint != joint);
            document.keys.clear(Channel::Target(joint));
            document.keys.clear(Channel::Enabled(joint));
            Ok::<_, SkeletonError>(())
        });
    }

    /// What is not seen waits.
    pub(super) fn show_rig(&mut self, rig: RigKind) {
        if rig == RigKind::Arm {
            self.race = None;
            self.stop_run();
        }
        self.commit(Document { rig, ..self.shown.clone() });
        self.message = None;
    }
}
