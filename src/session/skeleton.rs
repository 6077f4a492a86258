use glam::Vec3;

use super::Session;
use crate::document::{RigKind, SkeletonRig, Slither, Target};
use crate::kinematics::skeleton::{Joint, SkeletonError};
use crate::kinematics::solve::Options;

/// What actions do to the skeleton.
impl Session {
    /// Every change of the skeleton comes through here: what is not possible is said and changes
    /// nothing, and the pose follows.
    pub(super) fn edit_skeleton<T>(
        &mut self,
        change: impl FnOnce(&mut SkeletonRig) -> Result<T, SkeletonError>,
    ) -> Option<T> {
        let before = self.document.skeleton.clone();
        match change(&mut self.document.skeleton) {
            Ok(value) => {
                self.message = None;
                self.refresh_skeleton();
                Some(value)
            }
            Err(error) => {
                self.document.skeleton = before;
                self.say_impossible(&error.to_string());
                None
            }
        }
    }

    pub(super) fn refresh_skeleton(&mut self) {
        let count = self.document.skeleton.skeleton.joints().len();
        self.selection.retain(|joint| *joint < count);
        self.pointed = self.pointed.filter(|joint| *joint < count);
        self.skeleton_pose = self.document.skeleton.at(self.clock.time).pose();
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
            self.selection = vec![joint];
        }
    }

    pub(super) fn remove_joints(&mut self, joints: &[usize]) {
        let skeleton = &self.document.skeleton.skeleton;
        let parents = joints.iter().filter_map(|joint| skeleton.joint(*joint)?.parent);
        let parents: Vec<usize> = parents.collect();
        let moved = self.edit_skeleton(|rig| {
            let moved = rig.skeleton.remove(joints);
            rig.follow(&moved);
            Ok(moved)
        });
        let Some(moved) = moved else { return };
        self.selection =
            parents.iter().rev().find_map(|parent| moved.get(*parent)).into_iter().collect();
        self.refresh_skeleton();
    }

    pub(super) fn reparent(&mut self, joint: usize, parent: Option<usize>) {
        let moved = self.edit_skeleton(|rig| {
            let moved = rig.skeleton.reparent(joint, parent)?;
            rig.follow(&moved);
            Ok(moved)
        });
        if let Some(moved) = moved {
            self.selection = self.selection.iter().filter_map(|joint| moved.get(*joint)).collect();
            self.pointed = self.pointed.and_then(|joint| moved.get(joint));
        }
    }

    pub(super) fn bind_pose(&mut self) {
        self.edit_skeleton(|rig| {
            (0..rig.skeleton.joints().len())
                .try_for_each(|joint| rig.skeleton.set_rotation(joint, Vec3::ZERO))
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
            self.document.skeleton.solver = solver;
        } else {
            self.message =
                Some("Tolerance, damping, step and iterations must be above 0".to_owned());
        }
    }

    /// What is not seen waits.
    pub(super) fn show_rig(&mut self, rig: RigKind) {
        if rig == RigKind::Arm {
            self.clock.playing = false;
            self.race = None;
            if let Some(solving) = &mut self.solving {
                solving.running = false;
            }
        }
        self.document.rig = rig;
        self.message = None;
    }
}
