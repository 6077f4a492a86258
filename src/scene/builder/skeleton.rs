use glam::Vec3;

use super::cylinders::{self, CylinderLimb};
use super::drawn_skeleton::DrawnSkeleton;
use super::joint_limits::add_joint_limits;
use super::skin::ShownSkin;
use super::solver::{self, InsideDrawing};
use crate::document::{
    FollowPath, Overlay, PathKind, Posed, ShownLength, SkeletonRig, Target, TwistReferenceKind,
};
use crate::kinematics::Shared;
use crate::kinematics::skeleton::{Balance, Joint, JointId, Skeleton, SkeletonPose};
use crate::kinematics::skin::Skinning;
use crate::rig::TargetReport;
use crate::scene::{Ball, Colour, Label, LabelSide, Line, Scene, SkinInstance};
use crate::session::{OnionSkin, Overlays, ShownRegion};

/// Number of lines of a drawn path, if its head has fewer keys.
const LINES: usize = 2048;
/// Greatest number of lines between two keys of a head.
const MOST_STEPS: usize = 16;

/// Maximum radius of a target's ball: as a fraction of the skeleton's reach, and as a multiple of
/// the radius of the bone that it moves, so that the ball hides no bones of a long chain.
const TARGET_RADIUS: (f32, f32) = (0.014, 1.6);
/// Opacity of the line from a limb's base to its target at full influence.
const POINTER_OPACITY: f32 = 0.45;
/// Duration in seconds and number of segments of a target's trail.
const TRAIL: (f64, usize) = (1.2, 48);

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
    /// For each joint, the number of its children.
    pub children: Vec<usize>,
    /// For each joint, the distance of the farthest tip below it from its root, along offsets.
    pub tips: Vec<f32>,
    /// For each joint of a hand, the joint of the palm.
    pub hands: Vec<Option<JointId>>,
    /// Joints that get a label.
    pub labelled: Vec<JointId>,
    /// For each joint, true if cylinders stand for it.
    pub cylinders: Vec<bool>,
    pub balance: Balance,
}

impl Scratch {
    /// The least height of a joint or a tip of the latest pose, in the world.
    pub fn lowest(&self) -> f32 {
        let ends = |joint| [self.pose.base(joint), self.pose.tip(joint)];
        self.pose.ids().flat_map(ends).map(|end| end.y).fold(f32::INFINITY, f32::min)
    }
}

/// Centre and radius of the ground, and width of a grid cell, in world units. The radius is the
/// skeleton's reach or the radius of its bounding sphere at time 0, whichever is larger.
pub(super) fn measure(rig: &SkeletonRig, scratch: &mut Scratch) -> (Vec3, f32, f32) {
    let reach = rig.reach_in(&mut scratch.distances);
    rig.skeleton.write_pose(&mut scratch.pose);
    let (centre, radius) = rig.bounds_with_reach(reach, &scratch.pose, 0.0);
    (Vec3 { y: 0.0, ..centre }, reach.max(radius), SkeletonRig::grid_cell_for(reach))
}

/// Part of the sky's colour in that of the pose of a frame by itself, from 0 to 1.
const BY_ITSELF_FADED: f32 = 0.3;

/// Adds the bones with their shadows, the ghosts of other solvers, the targets with their trails,
/// the followed path, and labels.
pub(super) fn add(scene: &mut Scene, posed: &Posed, overlays: &Overlays, scratch: &mut Scratch) {
    let (rig, display) = (&posed.document().rig, posed.document().display);
    let Scratch {
        pose,
        fk_pose,
        influences,
        distances,
        depths,
        children,
        tips,
        hands,
        labelled,
        cylinders,
        balance,
    } = scratch;
    let skeleton = &*rig.skeleton;
    posed.skeleton().write_pose(pose);
    read_tree(skeleton.joints(), depths, children);
    let reach = rig.reach_in(distances);
    let scale = skeleton.transform().matrix3.determinant().abs().cbrt();
    let joints = skeleton.joints();
    read_hands(skeleton, distances, children, tips, hands);
    let shows_stiffness = display.shows(Overlay::Stiffness);
    let drawn =
        DrawnSkeleton { joints, pose, depths, children, hands, reach, scale, shows_stiffness };
    let skin = ShownSkin::new(rig, display);
    cylinders.clear();
    cylinders.resize(joints.len(), false);
    let skin_of_limbs = skin.filter(|skin| !skin.has_bones()).map(|skin| skin.colour());
    for limb in CylinderLimb::all(posed) {
        limb.mark(skeleton, cylinders);
        limb.add(scene, posed, overlays, skin_of_limbs);
    }
    for joint in skeleton.ids().filter(|joint| !cylinders[joint.index()]) {
        if let Some(skin) = skin.filter(|skin| !skin.has_bones()) {
            skin.add_joint(scene, &drawn, joint, overlays, display);
            continue;
        }
        let colour = drawn.colour(scene, joint, overlays);
        drawn.add_bone(scene, joint, colour);
        drawn.add_link(scene, joint, scene.palette.joint);
        if display.shows(Overlay::Shadow) {
            scene.shadows.extend(drawn.shadow(joint, |joint| drawn.radii(joint)));
        }
    }
    if let Some(skin) = skin {
        skin.add(scene, posed.skeleton(), overlays, display);
    }
    for (index, onion_skin) in overlays.onion_skins.iter().enumerate() {
        match (&skin, &onion_skin.skin) {
            (Some(skin), Some(pose)) => {
                let colour = scene.palette.onion_skin(onion_skin);
                skin.add_in_pose(scene, pose.clone(), colour);
            }
            _ => {
                let colour = scene.palette.onion_skin_bones(onion_skin);
                drawn.posed(&onion_skin.pose).add_onion_skin(scene, colour);
            }
        }
        let last = if onion_skin.past { 0 } else { overlays.onion_skins.len() - 1 };
        add_name_of(scene, onion_skin, index == last, ABOVE_HEAD * drawn.reach);
    }
    let all = display.shows(Overlay::FkPose);
    if all || rig.targets.iter().any(Target::is_blended) {
        posed.evaluated_skeleton().fk.write_pose(fk_pose);
        rig.write_influences(influences);
        let is_blended = |influence: f32| influence > 0.0 && influence < 1.0;
        let is_shown = |joint: JointId| all || is_blended(influences[joint.index()]);
        drawn.add_fk_pose(scene, fk_pose, is_shown);
    }
    if display.shows(Overlay::ByItself) {
        posed.skeleton_by_itself().write_pose(fk_pose);
        let colour = scene.palette.accent.mixed(scene.palette.sky_top, BY_ITSELF_FADED);
        drawn.add_thin_pose(scene, fk_pose, colour, |_| true);
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
        let targets = rig.targets.iter().zip(posed.targets());
        // Cylinders have their targets; a free place has none.
        let is_drawn = |it: &Target| !cylinders[it.joint.index()] && !it.has_free_place();
        for (target, report) in targets.filter(|(it, _)| is_drawn(it)) {
            let is_of_limb = |it: &JointId| rig.limb_target_of(*it) == rig.target(target.joint);
            let has_pointer = overlays.selection.iter().any(is_of_limb);
            drawn.add_target(scene, target, report, has_pointer);
            if target.enabled && target.is_moving() && !rig.leads_path(target) {
                add_trail(scene, target, posed.skeleton(), posed.time());
            }
            if target.enabled && overlays.ghosts.is_empty() && !rig.leads_path(target) {
                let is_selected = overlays.selection.contains(&rig.end_of(target));
                let has_handles = overlays.has_handles && is_selected;
                drawn.add_gap(scene, target.joint, report.position, accent, has_handles);
            }
        }
    }
    let is_lit = |it: JointId| overlays.selection.contains(&it) || overlays.hovered == Some(it);
    for target in rig.targets.iter().filter(|it| it.is_posing() && is_lit(it.joint)) {
        if let Some([from, to]) = target.aim_line_in_world(posed.skeleton()) {
            let colour = scene.palette.accent;
            scene.lines.push(Line { from, to, colour, dashed: true });
        }
    }
    if display.shows(Overlay::Paths) {
        rig.follow_paths.iter().for_each(|path| add_path(scene, rig, path, posed.time()));
    }
    if shows_stiffness {
        drawn.add_stiffness(scene);
    }
    if display.shows(Overlay::Balance) {
        let goal = posed.evaluated_skeleton().balance.as_ref().and_then(|it| it.over);
        drawn.add_balance(scene, skeleton, goal, balance);
    }
    let selected = overlays.selection.last().filter(|_| display.shows(Overlay::JointLimits));
    if let Some(joint) = selected {
        add_joint_limits(scene, posed.skeleton(), *joint);
    }
    if let Some(region) = &overlays.reach_region {
        add_reach_region(scene, region);
    }
    let radius = |joint| match &skin {
        Some(skin) => drawn.radius(joint).max(skin.thickness(joint) * scale),
        None => drawn.radius(joint),
    };
    let has_name = |joint: JointId| !cylinders[joint.index()];
    drawn.add_labels(scene, overlays, labelled, has_name, radius);
}

/// Sets `depths` to the number of bones above each joint, not counting bones of zero length, and
/// `children` to the number of each joint's children.
fn read_tree(joints: &[Shared<Joint>], depths: &mut Vec<usize>, children: &mut Vec<usize>) {
    depths.clear();
    depths.resize(joints.len(), 0);
    children.clear();
    children.resize(joints.len(), 0);
    for (joint, parent) in joints.iter().map(|joint| joint.parent).enumerate() {
        if let Some(parent) = parent {
            let is_bone = joints[parent.index()].axis != Vec3::ZERO;
            depths[joint] = depths[parent.index()] + usize::from(is_bone);
            children[parent.index()] += 1;
        }
    }
}

/// Distance of a name from the highest tip of an onion skin, as a fraction of the figure's reach.
const ABOVE_HEAD: f32 = 0.07;

/// Says above an onion skin which frame it is, with the unit if it is the last one in its direction.
fn add_name_of(scene: &mut Scene, onion_skin: &OnionSkin, is_last: bool, clearance: f32) {
    let tips = onion_skin.pose.ids().map(|joint| onion_skin.pose.tip(joint));
    let Some(highest) = tips.max_by(|one, other| one.y.total_cmp(&other.y)) else { return };
    let sign = if onion_skin.past { '−' } else { '+' };
    let label = Label::new(highest, clearance, LabelSide::Over, scene.palette.text);
    let unit = if is_last { " frames" } else { "" };
    scene.add_label(label, format_args!("{sign}{}{unit}", onion_skin.frames));
}

/// Sets `hands` to the hand that each joint belongs to: below a joint with three or more children, if
/// no tip there is far from it. `distances` are those of the joints from their roots.
fn read_hands(
    skeleton: &Skeleton,
    distances: &[f32],
    children: &[usize],
    tips: &mut Vec<f32>,
    hands: &mut Vec<Option<JointId>>,
) {
    /// Length of a hand at most, as a fraction of the reach.
    const LENGTH: f32 = 0.25;
    tips.clear();
    tips.extend(distances.iter().zip(skeleton.joints()).map(|(at, it)| at + it.axis.length()));
    for (joint, it) in skeleton.iter().rev() {
        if let Some(parent) = it.parent {
            tips[parent.index()] = tips[parent.index()].max(tips[joint.index()]);
        }
    }
    let reach = tips.iter().copied().fold(0.0, f32::max);
    hands.clear();
    for (joint, it) in skeleton.iter() {
        let above = it.parent.and_then(|parent| hands[parent.index()]);
        let length = tips[joint.index()] - distances[joint.index()];
        let is_hand = children[joint.index()] >= 3 && length <= LENGTH * reach;
        hands.push(above.or(is_hand.then_some(joint)));
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

impl DrawnSkeleton<'_> {
    /// Adds a target as a ball; for a limb that it poses, the axis from the limb's base, if it is to
    /// be seen, and the pole.
    fn add_target(
        &self,
        scene: &mut Scene,
        target: &Target,
        report: &TargetReport,
        has_pointer: bool,
    ) {
        let at = report.position;
        let radius = self.target_radius(target.joint);
        let guide = scene.palette.guide;
        let colour = if target.enabled { guide } else { guide.with_opacity(0.35) };
        scene.guide_balls.push(Ball { centre: at, radius, colour });
        if target.is_pinned {
            cylinders::add_pin(scene, at, radius);
        }
        if !target.enabled {
            return;
        }
        if let Some(upper) = self.upper_of(target).filter(|_| target.is_posing()) {
            if has_pointer {
                let colour = guide.with_opacity(POINTER_OPACITY * target.influence);
                let from = self.pose.base(upper);
                scene.lines.push(Line { from, to: at, colour, dashed: false });
            }
            self.add_pole(scene, target, report, radius);
        }
    }

    fn target_radius(&self, joint: JointId) -> f32 {
        let (of_reach, of_bone) = TARGET_RADIUS;
        (of_reach * self.reach).min(of_bone * self.radius(joint))
    }

    /// Adds a line from a joint's tip to its target, labelled with their distance, unless the tip
    /// reaches the target.
    ///
    /// The label is clear of the target's handles if it has any.
    pub fn add_gap(
        &self,
        scene: &mut Scene,
        joint: JointId,
        at: Vec3,
        colour: Colour,
        has_handles: bool,
    ) {
        let (tip, radius) = (self.pose.tip(joint), self.target_radius(joint));
        let gap = tip.distance(at);
        if gap > 1.5 * radius {
            scene.lines.push(Line { from: tip, to: at, colour, dashed: true });
            let label = Label::new(at, radius, LabelSide::Above, colour);
            let label = if has_handles { label.clear_of_handles() } else { label };
            let shown = ShownLength { length: gap, decimals: residual_decimals(self.reach) };
            scene.add_label(label, format_args!("gap {shown}"));
        }
    }

    /// The upper joint of a limb's target.
    fn upper_of(&self, target: &Target) -> Option<JointId> {
        target.limb()?;
        let above = |joint: &JointId| self.joints[joint.index()].parent;
        let ancestors = std::iter::successors(above(&target.joint), above);
        ancestors.into_iter().find(|joint| !self.joints[joint.index()].locked)
    }

    /// Adds the pole as a ball, with a line from the elbow.
    fn add_pole(&self, scene: &mut Scene, target: &Target, report: &TargetReport, radius: f32) {
        let Some(pole) = report.pole else { return };
        let colour = scene.palette.twist_reference(TwistReferenceKind::Pole);
        scene.guide_balls.push(Ball { centre: pole, radius, colour });
        let from = self.pose.base(target.joint);
        scene.lines.push(Line { from, to: pole, colour: colour.with_opacity(0.6), dashed: true });
        let label = Label::new(pole, radius, LabelSide::Above, colour);
        scene.add_label(label, format_args!("Pole"));
    }
}

/// Number of decimals of a labelled distance, for a skeleton of this reach.
fn residual_decimals(reach: f32) -> usize {
    (2.0 - reach.log10().floor()).clamp(0.0, 6.0) as usize
}

/// Adds the recent path of a moving target in its present space, fading out with age.
fn add_trail(scene: &mut Scene, target: &Target, pose: &Skeleton, time: f64) {
    let to_world = target.present_space().to_world(pose);
    let (seconds, steps) = TRAIL;
    let seconds = seconds.min(f64::from(target.motion.period));
    let at = |step: usize| -> Vec3 {
        to_world.transform_point3(target.at(time - seconds * step as f64 / steps as f64))
    };
    let colour = scene.palette.accent;
    for step in 0..steps {
        let colour = colour.with_opacity(0.9 * (1.0 - step as f32 / steps as f32));
        scene.lines.push(Line { from: at(step), to: at(step + 1), colour, dashed: false });
    }
}

/// Adds the surface of a reach region, see-through.
fn add_reach_region(scene: &mut Scene, region: &ShownRegion) {
    const OPACITY: f32 = 0.16;
    const EDGES: f32 = 0.10;
    let colour = scene.palette.accent;
    scene.skins.push(SkinInstance {
        mesh: region.mesh.clone(),
        pose: region.pose.clone(),
        skinning: Skinning::Linear,
        offset: Vec3::ZERO,
        colour: colour.with_opacity(OPACITY),
        wireframe: Some(colour.with_opacity(EDGES)),
        weights_of: None,
    });
}
