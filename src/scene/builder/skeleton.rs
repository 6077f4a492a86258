use glam::Vec3;

use super::scratch::Scratch;
use super::shadow::above_ground;
use super::targets;
use crate::document::{Display, FollowPath, Overlay, SkeletonRig, Target};
use crate::kinematics::Shared;
use crate::kinematics::skeleton::{Joint, JointId, Skeleton, SkeletonPose};
use crate::scene::{Ball, Colour, Label, LabelSide, Line, Scene, Shadow};
use crate::session::Overlays;

/// Maximum radius of a bone: as a fraction of its length, and as a fraction of the skeleton's
/// reach.
const MAX_RADIUS: (f32, f32) = (0.45, 0.028);
/// Minimum of a bone's radius limit by reach, as a fraction of the bone's length, so that the first
/// bones of a new skeleton are as thick as they will be in the complete one.
const MIN_LIMIT: f32 = 0.07;
/// Maximum radius of a joint without a bone, as a fraction of the skeleton's reach.
const POINT_RADIUS: f32 = 0.02;
/// Ratio of the tip's radius to the base's radius of a slender bone.
const TAPER: f32 = 0.6;
/// Ratio of length to base radius above which a bone is slender and tapers. Shorter bones do not
/// taper, so that a chain of many forms one smooth body.
const SLENDER: f32 = 4.0;
/// Ratio of the radius of a ghost's bone to that of the skeleton's bone.
pub(super) const GHOST: f32 = 0.45;
/// Contrast of the FK pose with the background, from 0 to 1.
const FK_CONTRAST: f32 = 0.35;

/// Centre and radius of the ground, and width of a grid cell, in world units. The radius is the
/// skeleton's reach or the radius of its bounding sphere at time 0, whichever is larger.
pub(super) fn measure(rig: &SkeletonRig, scratch: &mut Scratch) -> (Vec3, f32, f32) {
    let reach = rig.reach_in(&mut scratch.distances);
    rig.skeleton.write_pose(&mut scratch.pose);
    let (centre, radius) = rig.bounds_with_reach(reach, &scratch.pose, 0.0);
    (Vec3 { y: 0.0, ..centre }, reach.max(radius), SkeletonRig::grid_cell_for(reach))
}

/// Adds the bones with their shadows, the ghosts of other solvers, the targets with their trails,
/// the followed path, and labels.
pub(super) fn add(
    scene: &mut Scene,
    rig: &SkeletonRig,
    overlays: &Overlays,
    display: Display,
    scratch: &mut Scratch,
) {
    let Scratch { pose, fk_pose, influences, distances, depths, are_leaves, labelled } = scratch;
    let skeleton = &*rig.skeleton;
    let evaluated = match &overlays.evaluated {
        Some(evaluated) => evaluated.clone(),
        None => Shared::from(rig.evaluate(overlays.time)),
    };
    evaluated.solved.write_pose(pose);
    read_tree(skeleton.joints(), depths, are_leaves);
    let reach = rig.reach_in(distances);
    let scale = skeleton.transform().matrix3.determinant().abs().cbrt();
    let joints = skeleton.joints();
    let drawn = DrawnSkeleton { joints, pose, depths, are_leaves, reach, scale };
    for joint in skeleton.ids() {
        let colour = drawn.colour(scene, joint, overlays);
        drawn.add_bone(scene, joint, colour);
        if display.shows(Overlay::Shadow) {
            drawn.add_shadow(scene, joint);
        }
    }
    let all = display.shows(Overlay::FkPose);
    if all || rig.targets.iter().any(Target::is_blended) {
        evaluated.fk.write_pose(fk_pose);
        rig.write_influences(influences);
        let is_blended = |influence: f32| influence > 0.0 && influence < 1.0;
        let is_shown = |joint: JointId| all || is_blended(influences[joint.index()]);
        drawn.add_fk_pose(scene, fk_pose, is_shown);
    }
    drawn.add_solver_ghosts(scene, &overlays.ghosts, display);
    if display.shows(Overlay::Cursor) {
        for (target, report) in rig.targets.iter().zip(&evaluated.targets) {
            drawn.add_target(scene, target, report);
            if target.enabled && target.is_moving() {
                targets::add_trail(scene, target, &evaluated.solved, overlays.time);
            }
            if target.enabled && overlays.ghosts.is_empty() {
                drawn.add_gap(scene, target.joint, report.position, scene.palette.accent);
            }
        }
    }
    if let Some(follow_path) = &rig.follow_path
        && display.shows(Overlay::Pointer)
    {
        add_follow_path(scene, follow_path, skeleton, overlays.time);
    }
    if display.shows(Overlay::Labels) {
        drawn.add_labels(scene, overlays, labelled);
    }
}

/// Sets `depths` to the number of bones above each joint, not counting bones of zero length, and
/// `are_leaves` to whether each joint has no children.
fn read_tree(joints: &[Shared<Joint>], depths: &mut Vec<usize>, are_leaves: &mut Vec<bool>) {
    depths.clear();
    depths.resize(joints.len(), 0);
    are_leaves.clear();
    are_leaves.resize(joints.len(), true);
    for (joint, parent) in joints.iter().map(|joint| joint.parent).enumerate() {
        if let Some(parent) = parent {
            let is_bone = joints[parent.index()].axis != Vec3::ZERO;
            depths[joint] = depths[parent.index()] + usize::from(is_bone);
            are_leaves[parent.index()] = false;
        }
    }
}

/// A posed skeleton with the sizes that its drawing depends on.
#[derive(Clone, Copy)]
pub(super) struct DrawnSkeleton<'a> {
    pub joints: &'a [Shared<Joint>],
    pub pose: &'a SkeletonPose,
    depths: &'a [usize],
    are_leaves: &'a [bool],
    /// Reach in world units.
    pub reach: f32,
    /// World units per unit of the skeleton.
    scale: f32,
}

impl<'a> DrawnSkeleton<'a> {
    /// The skeleton in another pose.
    pub fn posed<'b>(&self, pose: &'b SkeletonPose) -> DrawnSkeleton<'b>
    where
        'a: 'b,
    {
        DrawnSkeleton { pose, ..*self }
    }

    /// Radius of a bone at its base as drawn, in world units.
    pub fn radius(&self, joint: JointId) -> f32 {
        let length = self.pose.base(joint).distance(self.pose.tip(joint));
        let (of_length, of_reach) = MAX_RADIUS;
        let limit = match length {
            0.0 => POINT_RADIUS * self.reach,
            length => {
                let of_reach = (of_reach * self.reach).max(MIN_LIMIT * length);
                of_reach.min(of_length * length)
            }
        };
        (self.joints[joint.index()].radius * self.scale).clamp(0.25 * limit, limit)
    }

    fn tip_radius(&self, joint: JointId) -> f32 {
        let length = self.pose.base(joint).distance(self.pose.tip(joint));
        let radius = self.radius(joint);
        if length > SLENDER * radius { radius * TAPER } else { radius }
    }

    /// Colour of a bone. The limbs' colours alternate from parent to child; locked, hovered and
    /// selected joints have colours of their own.
    fn colour(&self, scene: &Scene, joint: JointId, overlays: &Overlays) -> Colour {
        let palette = &scene.palette;
        let plain = if self.depths[joint.index()].is_multiple_of(2) {
            palette.upper
        } else {
            palette.lower
        };
        let colour = match self.joints[joint.index()].locked {
            true => palette.joint,
            false => plain,
        };
        if overlays.selection.contains(&joint) {
            palette.accent
        } else if overlays.hovered == Some(joint) {
            colour.mixed(palette.guide, 0.3)
        } else {
            colour
        }
    }

    fn add_bone(&self, scene: &mut Scene, joint: JointId, colour: Colour) {
        let (base, tip, radius) = (self.pose.base(joint), self.pose.tip(joint), self.radius(joint));
        if base != tip {
            scene.add_solid(base, tip, radius, self.tip_radius(joint), colour);
        }
        let ball = if base == tip { colour } else { scene.palette.joint };
        scene.balls.push(Ball { centre: base, radius: radius * 1.1, colour: ball });
        if self.are_leaves[joint.index()] && base != tip {
            let colour = scene.palette.joint;
            scene.balls.push(Ball { centre: tip, radius: self.tip_radius(joint) * 1.1, colour });
        }
    }

    /// Adds the bones that `fk`, the FK pose, has elsewhere, for the joints that are to be shown.
    fn add_fk_pose(
        &self,
        scene: &mut Scene,
        fk: &SkeletonPose,
        is_shown: impl Fn(JointId) -> bool,
    ) {
        // Fraction of the reach.
        const APART: f32 = 1e-3;
        let colour = scene.palette.sky_top.mixed(scene.palette.joint, FK_CONTRAST);
        for joint in fk.ids().filter(|joint| is_shown(*joint)) {
            let (base, tip) = (fk.base(joint), fk.tip(joint));
            let apart =
                base.distance(self.pose.base(joint)).max(tip.distance(self.pose.tip(joint)));
            if apart > APART * self.reach {
                let radius = self.radius(joint) * GHOST;
                if base != tip {
                    scene.add_solid(base, tip, radius, radius, colour);
                }
                scene.balls.push(Ball { centre: tip, radius, colour });
            }
        }
    }

    fn add_shadow(&self, scene: &mut Scene, joint: JointId) {
        let (base, tip, radius) = (self.pose.base(joint), self.pose.tip(joint), self.radius(joint));
        let limb = Shadow { base, base_radius: radius, tip, tip_radius: self.tip_radius(joint) };
        scene.shadows.extend((base != tip).then(|| above_ground(limb)).flatten());
    }

    /// Adds the names of the selected joints and of the joint under the mouse.
    fn add_labels(&self, scene: &mut Scene, overlays: &Overlays, labelled: &mut Vec<JointId>) {
        labelled.clear();
        labelled.extend(overlays.selection.iter().copied().chain(overlays.hovered));
        labelled.sort_unstable();
        labelled.dedup();
        for joint in labelled.iter().copied().filter(|joint| joint.index() < self.joints.len()) {
            let middle = self.pose.base(joint).midpoint(self.pose.tip(joint));
            let label =
                Label::new(middle, self.radius(joint), LabelSide::Below, scene.palette.text);
            scene.add_label(label, format_args!("{}", self.joints[joint.index()].name));
        }
    }
}

/// Adds one revolution of the path that the skeleton follows.
fn add_follow_path(scene: &mut Scene, follow_path: &FollowPath, skeleton: &Skeleton, time: f64) {
    let height = skeleton.joints().first().map_or(0.0, |head| head.offset.y);
    let head = follow_path.turns_at(time);
    let curve = || follow_path.trail(skeleton.transform(), height, head, head + 1.0);
    let colour = scene.palette.guide.with_opacity(0.35);
    let segments = curve().zip(curve().skip(1));
    scene.lines.extend(segments.map(|(from, to)| Line { from, to, colour, dashed: false }));
}
