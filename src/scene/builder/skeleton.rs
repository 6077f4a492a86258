use glam::Vec3;

use super::drawn_skeleton::DrawnSkeleton;
use super::motion;
use super::skin::ShownSkin;
use super::solver::{self, InsideDrawing};
use super::targets;
use crate::document::{FollowPath, Overlay, PathKind, Posed, SkeletonRig, Target};
use crate::kinematics::Shared;
use crate::kinematics::skeleton::{Joint, JointId, SkeletonPose};
use crate::scene::{Line, Scene};
use crate::session::Overlays;

/// Number of lines of a drawn path, if its head has fewer keys.
const LINES: usize = 2048;
/// Greatest number of lines between two keys of a head.
const MOST_STEPS: usize = 16;

/// Buffers for intermediate results of a [`SceneBuilder`](super::SceneBuilder).
#[derive(Clone, Debug, Default)]
pub(super) struct Scratch {
    pub pose: SkeletonPose,
    pub fk_pose: SkeletonPose,
    /// For each joint the influence of the targets that turn it.
    pub influences: Vec<f32>,
    /// Distance of each joint from its root along offsets, in skeleton space.
    pub distances: Vec<f32>,
    /// Number of bones above each joint, not counting bones of zero length.
    pub depths: Vec<usize>,
    /// For each joint, true if it has no child.
    pub are_leaves: Vec<bool>,
    /// Joints that get a label.
    pub labelled: Vec<JointId>,
}

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
pub(super) fn add(scene: &mut Scene, posed: &Posed, overlays: &Overlays, scratch: &mut Scratch) {
    let (rig, display) = (&posed.document().skeleton_rig, posed.document().display);
    let Scratch { pose, fk_pose, influences, distances, depths, are_leaves, labelled } = scratch;
    let skeleton = &*rig.skeleton;
    posed.skeleton().write_pose(pose);
    read_tree(skeleton.joints(), depths, are_leaves);
    let reach = rig.reach_in(distances);
    let scale = skeleton.transform().matrix3.determinant().abs().cbrt();
    let joints = skeleton.joints();
    let drawn = DrawnSkeleton { joints, pose, depths, are_leaves, reach, scale };
    let skin = ShownSkin::new(rig, display);
    for joint in skeleton.ids() {
        if let Some(skin) = skin.filter(|skin| !skin.has_bones()) {
            skin.add_joint(scene, &drawn, joint, overlays, display);
            continue;
        }
        let colour = drawn.colour(scene, joint, overlays);
        drawn.add_bone(scene, joint, colour);
        drawn.add_link(scene, joint, scene.palette.joint);
        if display.shows(Overlay::Shadow) {
            drawn.add_shadow(scene, joint);
        }
    }
    if let Some(skin) = skin {
        skin.add(scene, posed.skeleton(), overlays, display);
    }
    for onion_skin in &overlays.onion_skins {
        let colour = motion::onion_skin_colour(scene, onion_skin);
        let thickness = |joint: JointId| Some(skin.as_ref()?.thickness(joint) * scale);
        drawn.posed(&onion_skin.pose).add_onion_skin(scene, colour, thickness);
    }
    let all = display.shows(Overlay::FkPose);
    if all || rig.targets.iter().any(Target::is_blended) {
        posed.evaluated_skeleton().fk.write_pose(fk_pose);
        rig.write_influences(influences);
        let is_blended = |influence: f32| influence > 0.0 && influence < 1.0;
        let is_shown = |joint: JointId| all || is_blended(influences[joint.index()]);
        drawn.add_fk_pose(scene, fk_pose, is_shown);
    }
    let accent = scene.palette.accent;
    for joint in overlays.concerned.iter().filter(|joint| joint.index() < joints.len()) {
        drawn.add_outline(scene, *joint, accent);
    }
    drawn.add_solver_ghosts(scene, &overlays.ghosts, display);
    if let (Some(view), Some(ghost)) = (&overlays.inside, overlays.ghosts.first()) {
        let (targets, selection) = (&ghost.targets[..], &overlays.selection[..]);
        InsideDrawing { view, targets, selection, reach }.add(scene);
    }
    if let Some(view) = &overlays.wiggle {
        solver::add_wiggle(scene, &drawn, skeleton, view);
    }
    if display.shows(Overlay::Cursor) {
        for (target, report) in rig.targets.iter().zip(posed.targets()) {
            drawn.add_target(scene, target, report);
            if target.enabled && target.is_moving() && !rig.leads_path(target) {
                targets::add_trail(scene, target, posed.skeleton(), posed.time());
            }
            if target.enabled && overlays.ghosts.is_empty() && !rig.leads_path(target) {
                let is_selected = overlays.selection.contains(&rig.end_of(target));
                let has_handles = overlays.has_handles && is_selected;
                drawn.add_gap(scene, target.joint, report.position, accent, has_handles);
            }
        }
    }
    if display.shows(Overlay::ElbowCircle) {
        rig.targets.iter().for_each(|target| drawn.add_elbow_circle(scene, target));
    }
    if display.shows(Overlay::Pointer) {
        rig.follow_paths.iter().for_each(|path| add_path(scene, rig, path, posed.time()));
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

/// Adds a path that a chain follows: one revolution of a ring, or the head's path through its keys.
/// The path of a target is drawn with the target.
fn add_path(scene: &mut Scene, rig: &SkeletonRig, path: &FollowPath, time: f64) {
    let to_world = rig.skeleton.transform();
    match path.kind {
        PathKind::Ring(ring) => {
            let height = rig.skeleton.joint(path.root).map_or(0.0, |head| head.offset.y);
            let head = ring.turns_at(time);
            add_curve(scene, || ring.trail(to_world, height, head, head + 1.0));
        }
        PathKind::Head => {
            let Some(track) = rig.head_tracks.get(&path.root) else { return };
            let knots = track.knots();
            let steps = (LINES / knots.len().max(1)).clamp(1, MOST_STEPS);
            for pair in knots.windows(2) {
                let (from, to) = (pair[0].time, pair[1].time);
                let time = move |step: usize| from + (to - from) * step as f64 / steps as f64;
                let at = |step| track.at(time(step));
                let points = || (0..=steps).filter_map(at);
                add_curve(scene, || points().map(|point| to_world.transform_point3(point)));
            }
        }
        PathKind::Target => {}
    }
}

/// Adds the lines between consecutive points.
fn add_curve<I: Iterator<Item = Vec3>>(scene: &mut Scene, points: impl Fn() -> I) {
    let colour = scene.palette.guide.with_opacity(0.35);
    let segments = points().zip(points().skip(1));
    scene.lines.extend(segments.map(|(from, to)| Line { from, to, colour, dashed: false }));
}
