use glam::Vec3;

use super::scratch::Scratch;
use super::shadow::above_ground;
use super::{Ball, Colour, Label, Line, Scene, Shadow, Side, Words};
use crate::document::{Display, FollowPath, Overlay, SkeletonRig, Target, TargetPath};
use crate::kinematics::skeleton::{Joint, Skeleton, SkeletonPose};
use crate::session::Overlays;

/// A bone is drawn no thicker than this part of its length, and this part of the skeleton's reach,
/// whatever its radius is.
const THICKEST: (f32, f32) = (0.45, 0.028);
/// But a bone's reach never makes it more slender than this part of its length, so that the first
/// bones of a new skeleton are as thick as they will be when it is complete.
const SLENDEREST: f32 = 0.07;
/// A joint that is a point is drawn as large as this part of the skeleton's reach at most.
const POINT: f32 = 0.02;
/// How much a slender bone tapers to its tip; one that is shorter than so many of its radii does not,
/// so that many of them make one smooth body.
const TAPER: f32 = 0.6;
const SLENDER: f32 = 4.0;
/// Ghosts are as thin beside a bone as this.
const GHOST: f32 = 0.45;
/// A target's ball, as a part of the skeleton's reach.
const TARGET: f32 = 0.014;
/// How many seconds a target's trail is long, and how finely it is drawn.
const TRAIL: (f64, usize) = (1.2, 48);

/// Where the ground's middle is, how far the skeleton reaches, and how wide a grid's cells are.
pub(super) fn stage(rig: &SkeletonRig, scratch: &mut Scratch) -> (Vec3, f32, f32) {
    let reach = rig.reach_in(&mut scratch.distances);
    rig.skeleton.write_pose(&mut scratch.pose);
    let (centre, radius) = rig.bounds_with(reach, &scratch.pose, 0.0);
    (Vec3 { y: 0.0, ..centre }, reach.max(radius), SkeletonRig::cell(reach))
}

/// Adds the bones, targets with their trails and gaps, ghosts, and the bones' shadows.
pub(super) fn add(scene: &mut Scene, rig: &SkeletonRig, overlays: &Overlays, display: Display) {
    let mut scratch = core::mem::take(&mut scene.scratch);
    let Scratch { pose, distances, depths, are_leaves, named } = &mut scratch;
    let skeleton = &*rig.skeleton;
    rig.write_pose(overlays.time, pose);
    read_tree(skeleton.joints(), depths, are_leaves);
    let reach = rig.reach_in(distances);
    let scale = skeleton.transform().matrix3.determinant().abs().cbrt();
    let joints = skeleton.joints();
    let figure = Figure { joints, pose, depths, are_leaves, reach, scale };
    for joint in 0..joints.len() {
        let colour = figure.colour(scene, joint, overlays);
        figure.add_bone(scene, joint, colour);
        if display.shows(Overlay::Shadow) {
            figure.add_shadow(scene, joint);
        }
    }
    for ghost in &overlays.ghosts {
        let colour = scene.palette.method(ghost.method);
        Figure { pose: &ghost.pose, ..figure }.add_ghost(scene, colour);
    }
    if display.shows(Overlay::Cursor) {
        for target in &rig.targets {
            figure.add_target(scene, target, overlays);
        }
    }
    if let Some(follow_path) = &rig.follow_path
        && display.shows(Overlay::Pointer)
    {
        add_way(scene, follow_path, skeleton, overlays.time);
    }
    if display.shows(Overlay::Labels) {
        figure.add_labels(scene, overlays, named);
    }
    scene.scratch = scratch;
}

/// Goes through all joints: how many bones are above each, where points do not count, and whether
/// nothing hangs from it.
fn read_tree(joints: &[Joint], depths: &mut Vec<usize>, are_leaves: &mut Vec<bool>) {
    depths.clear();
    depths.resize(joints.len(), 0);
    are_leaves.clear();
    are_leaves.resize(joints.len(), true);
    for (joint, parent) in joints.iter().map(|joint| joint.parent).enumerate() {
        if let Some(parent) = parent {
            let is_bone = joints[parent].axis != Vec3::ZERO;
            depths[joint] = depths[parent] + usize::from(is_bone);
            are_leaves[parent] = false;
        }
    }
}

/// A posed skeleton with the measures that it is drawn by.
#[derive(Clone, Copy)]
struct Figure<'a> {
    joints: &'a [Joint],
    pose: &'a SkeletonPose,
    depths: &'a [usize],
    are_leaves: &'a [bool],
    /// In the world.
    reach: f32,
    /// From the skeleton's units to the world's.
    scale: f32,
}

impl Figure<'_> {
    /// How thick a bone is drawn where it begins.
    fn radius(&self, joint: usize) -> f32 {
        let length = self.pose.base(joint).distance(self.pose.tip(joint));
        let (of_length, of_reach) = THICKEST;
        let thickest = match length {
            0.0 => POINT * self.reach,
            length => {
                let of_reach = (of_reach * self.reach).max(SLENDEREST * length);
                of_reach.min(of_length * length)
            }
        };
        (self.joints[joint].radius * self.scale).clamp(0.25 * thickest, thickest)
    }

    fn tip_radius(&self, joint: usize) -> f32 {
        let length = self.pose.base(joint).distance(self.pose.tip(joint));
        let radius = self.radius(joint);
        if length > SLENDER * radius { radius * TAPER } else { radius }
    }

    /// Bones take turns in the limbs' colours from parent to child; the accent says selected.
    fn colour(&self, scene: &Scene, joint: usize, overlays: &Overlays) -> Colour {
        let palette = &scene.palette;
        let plain =
            if self.depths[joint].is_multiple_of(2) { palette.upper } else { palette.lower };
        let colour = match self.joints[joint].locked {
            true => palette.joint,
            false => plain,
        };
        if overlays.selection.contains(&joint) {
            palette.accent
        } else if overlays.pointed == Some(joint) {
            colour.mixed(palette.guide, 0.3)
        } else {
            colour
        }
    }

    fn add_bone(&self, scene: &mut Scene, joint: usize, colour: Colour) {
        let (base, tip, radius) = (self.pose.base(joint), self.pose.tip(joint), self.radius(joint));
        if base != tip {
            scene.add_solid(base, tip, radius, self.tip_radius(joint), colour);
        }
        let ball = if base == tip { colour } else { scene.palette.joint };
        scene.balls.push(Ball { centre: base, radius: radius * 1.1, colour: ball });
        if self.are_leaves[joint] && base != tip {
            let colour = scene.palette.joint;
            scene.balls.push(Ball { centre: tip, radius: self.tip_radius(joint) * 1.1, colour });
        }
    }

    fn add_ghost(&self, scene: &mut Scene, colour: Colour) {
        for joint in 0..self.pose.len() {
            let (base, tip) = (self.pose.base(joint), self.pose.tip(joint));
            let radius = self.radius(joint) * GHOST;
            if base != tip {
                scene.add_solid(base, tip, radius, radius, colour);
            }
            scene.balls.push(Ball { centre: tip, radius, colour });
        }
    }

    fn add_shadow(&self, scene: &mut Scene, joint: usize) {
        let (base, tip, radius) = (self.pose.base(joint), self.pose.tip(joint), self.radius(joint));
        let limb = Shadow { base, base_radius: radius, tip, tip_radius: self.tip_radius(joint) };
        scene.shadows.extend((base != tip).then(|| above_ground(limb)).flatten());
    }

    /// A ball where the target is, its trail, and the gap to the tip that does not reach it.
    fn add_target(&self, scene: &mut Scene, target: &Target, overlays: &Overlays) {
        let at = target.at(overlays.time);
        let tip = self.pose.tip(target.joint);
        let radius = TARGET * self.reach;
        let (guide, accent) = (scene.palette.guide, scene.palette.accent);
        let colour = if target.enabled { guide } else { guide.with_opacity(0.35) };
        scene.guide_balls.push(Ball { centre: at, radius, colour });
        if !target.enabled {
            return;
        }
        add_trail(scene, target, overlays.time);
        let gap = tip.distance(at);
        if gap > 1.5 * radius {
            scene.lines.push(Line { from: tip, to: at, colour: accent, dashed: true });
            let (clearance, side, words) = (radius, Side::Above, Words::default());
            let label = Label { at, clearance, side, words, colour: accent };
            let decimals = residual_decimals(self.reach);
            scene.add_label(label, format_args!("{gap:.decimals$}"));
        }
    }

    /// The name of what is selected or pointed at.
    fn add_labels(&self, scene: &mut Scene, overlays: &Overlays, named: &mut Vec<usize>) {
        named.clear();
        named.extend(overlays.selection.iter().copied().chain(overlays.pointed));
        named.sort_unstable();
        named.dedup();
        for joint in named.iter().copied().filter(|joint| *joint < self.joints.len()) {
            let label = Label {
                at: self.pose.base(joint).midpoint(self.pose.tip(joint)),
                clearance: self.radius(joint),
                side: Side::Below,
                words: Words::default(),
                colour: scene.palette.text,
            };
            scene.add_label(label, format_args!("{}", self.joints[joint].name));
        }
    }
}

/// With how many digits behind the point a distance is written for a skeleton of such a reach.
fn residual_decimals(reach: f32) -> usize {
    (2.0 - reach.log10().floor()).clamp(0.0, 6.0) as usize
}

/// Where a moving target has just been, fading.
fn add_trail(scene: &mut Scene, target: &Target, time: f64) {
    if target.motion.path == TargetPath::Still {
        return;
    }
    let (seconds, steps) = TRAIL;
    let seconds = seconds.min(f64::from(target.motion.period));
    let at = |step: usize| target.at(time - seconds * step as f64 / steps as f64);
    let colour = scene.palette.accent;
    for step in 0..steps {
        let colour = colour.with_opacity(0.9 * (1.0 - step as f32 / steps as f32));
        scene.lines.push(Line { from: at(step), to: at(step + 1), colour, dashed: false });
    }
}

/// The way before a snake's head and behind its tail, once around.
fn add_way(scene: &mut Scene, follow_path: &FollowPath, skeleton: &Skeleton, time: f64) {
    let height = skeleton.joints().first().map_or(0.0, |head| head.offset.y);
    let head = follow_path.head(time);
    let way = || follow_path.trail(skeleton.transform(), height, head, head + 1.0);
    let colour = scene.palette.guide.with_opacity(0.35);
    let pieces = way().zip(way().skip(1));
    scene.lines.extend(pieces.map(|(from, to)| Line { from, to, colour, dashed: false }));
}
