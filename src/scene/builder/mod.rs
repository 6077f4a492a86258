//! Fills a scene from a document, with one file for each group of parts.

mod balance;
mod cylinders;
mod drawn_skeleton;
mod figure;
mod joint_limits;
mod limb;
mod skeleton;
mod skin;
mod solver;
mod twist;

use glam::Vec3;

use super::{Ball, Line, Palette, Planes, Scene, Shadow};
use crate::document::{Overlay, Posed, Theme};
use crate::rig::LimbPart;
use crate::session::{Overlays, ShownLimb, Trail};
use skeleton::Scratch;

/// Fills scenes from documents. The builder owns the buffers for intermediate results, so that
/// refilling a scene allocates nothing once all buffers are large enough.
#[derive(Clone, Debug, Default)]
pub struct SceneBuilder {
    scratch: Scratch,
}

impl Scene {
    /// The scene of a posed document with its overlays.
    pub fn new(posed: &Posed, overlays: &Overlays, theme: Theme) -> Self {
        SceneBuilder::default().build(posed, overlays, theme)
    }
}

impl SceneBuilder {
    /// Returns the scene of a posed document with its overlays.
    pub fn build(&mut self, posed: &Posed, overlays: &Overlays, theme: Theme) -> Scene {
        let document = posed.document();
        let mut scene = Scene::empty(document.camera, document.display, theme);
        self.refill(&mut scene, posed, overlays, theme);
        scene
    }

    /// Replaces the contents of a scene by those that [`build`](Self::build) returns, reusing its
    /// memory.
    pub fn refill(&mut self, scene: &mut Scene, posed: &Posed, overlays: &Overlays, theme: Theme) {
        scene.clear();
        let document = posed.document();
        let display = document.display;
        let limb = posed.measured_frames();
        let (centre, reach, cell) = match &limb {
            Some(limb) => {
                let reach = limb.bones().outer_limit();
                (limb.origin(LimbPart::Root), reach, document.grid_cell())
            }
            None => skeleton::measure(&document.rig, &mut self.scratch),
        };
        scene.camera = document.camera;
        scene.palette = Palette::new(theme);
        scene.has_labels = display.shows(Overlay::Labels);
        if let Some(crowd) = overlays.crowd {
            if Scene::CROWD_RADII.contains(&crowd.bounds().1) {
                scene.planes = Planes::around_crowd(&crowd, display);
                scene.crowd = Some(crowd);
            }
            return;
        }
        let ground_reach = limb.map_or(reach, |limb| reach.max(limb.limits.outer));
        scene.planes = Planes::around(centre, ground_reach, cell, display);
        if display.shows(Overlay::Axes) {
            let has_body = display.shows(Overlay::Skin) && document.rig.skin.is_some();
            add_axes(scene, reach, has_body);
        }
        skeleton::add(scene, posed, overlays, &mut self.scratch);
        scene.planes.clear(self.scratch.lowest(), reach);
        if display.shows(Overlay::ElbowCircle) {
            limb::add_circles(scene, posed, overlays.selection.last().copied());
        }
        if let Some(limb) = ShownLimb::frames(posed, overlays.selection.last().copied()) {
            limb::add_guides(scene, &limb, overlays, display);
        }
        add_trail(scene, &overlays.trail, reach);
        if display.shows(Overlay::Shadow) {
            add_shadow_of_trail(scene, &overlays.trail, reach);
        }
        scene.spare_skin_pose = None;
        scene.remove_non_finite();
    }
}

/// Adds lines along the world's axes, which fade out a little outside the rig. Arrowheads belong to
/// handles. A body that stands on the floor has no y axis, which would look like a rod that holds it.
fn add_axes(scene: &mut Scene, reach: f32, has_body: bool) {
    /// Length of an axis as a multiple of the rig's reach.
    const LENGTH: f32 = 1.1;
    /// Number of lines of an axis, which get fainter.
    const STEPS: u8 = 12;
    /// Opacities at the origin of the positive and the negative half.
    const HALVES: [(f32, f32); 2] = [(1.0, 0.75), (-1.0, 0.25)];
    let axes = Vec3::AXES.into_iter().zip(scene.palette.axes);
    for (axis, colour) in axes.filter(|(axis, _)| !has_body || *axis != Vec3::Y) {
        // No y axis below the floor.
        let halves = HALVES.into_iter().filter(|(sign, _)| *sign > 0.0 || axis != Vec3::Y);
        for (sign, opacity) in halves {
            let end = axis * (sign * LENGTH * reach);
            for step in 0..STEPS {
                let [from, to] = [step, step + 1].map(|at| f32::from(at) / f32::from(STEPS));
                let colour = colour.with_opacity(opacity * (1.0 - from));
                scene.lines.push(Line { from: end * from, to: end * to, colour, dashed: false });
            }
        }
    }
}

/// Adds the trail of the hand or the selected joint, with a dot for every frame, a ball for every
/// key, and arrowheads between keys. What is far is faint.
fn add_trail(scene: &mut Scene, trail: &Trail, reach: f32) {
    // Radii of a key, of a dot and of the tube between two dots, as fractions of the rig's reach.
    const KEY_RADIUS: f32 = 0.012;
    const DOT_RADIUS: f32 = 0.0045;
    const TUBE_RADIUS: f32 = 0.003;
    // Part of the sky in the colour of the farthest point.
    const FADED: f32 = 0.4;
    let palette = scene.palette;
    let view = scene.camera.projection(1.0);
    let depth = |at: Vec3| view.forward.dot(at - view.eye);
    let depths = trail.points.iter().map(|(_, at)| depth(*at));
    let [near, far] = depths.fold([f32::INFINITY, f32::NEG_INFINITY], |[near, far], depth| {
        [near.min(depth), far.max(depth)]
    });
    let colour = |at: Vec3| {
        let part = if far > near { (depth(at) - near) / (far - near) } else { 0.0 };
        palette.accent.mixed(palette.sky_bottom, FADED * part)
    };
    let [key, dot, tube] = [KEY_RADIUS, DOT_RADIUS, TUBE_RADIUS].map(|part| part * reach);
    for ends in trail.points.windows(2).filter(|ends| ends[0].1 != ends[1].1) {
        let [(_, from), (_, to)] = [ends[0], ends[1]];
        scene.add_guide_solid(from, to, tube, tube, colour(from));
    }
    let dots = trail.points.iter();
    let dots = dots.map(|(_, at)| Ball { centre: *at, radius: dot, colour: colour(*at) });
    scene.balls.extend(dots);
    let keys = trail.keys.iter();
    let keys = keys.map(|(_, at)| Ball { centre: *at, radius: key, colour: palette.accent });
    scene.balls.extend(keys);
    for keys in trail.keys.windows(2) {
        add_arrowhead(scene, trail, [keys[0], keys[1]], reach);
    }
}

/// Adds the shadow of a trail, which shows where in depth the trail is.
fn add_shadow_of_trail(scene: &mut Scene, trail: &Trail, reach: f32) {
    // Radius of what casts it, as a fraction of the rig's reach: wider than the trail, whose shadow would be
    // too faint.
    const RADIUS: f32 = 0.008;
    // Greatest number of parts, and points of the trail in one of them.
    const PARTS: usize = 64;
    const PART: usize = 4;
    let radius = RADIUS * reach;
    let points = &trail.points;
    let part = points.len().div_ceil(PARTS).max(PART);
    for from in (0..points.len()).step_by(part) {
        let to = (from + part).min(points.len() - 1);
        let [base, tip] = [from, to].map(|index| points[index].1);
        let cast = Shadow { base, base_radius: radius, tip, tip_radius: radius };
        scene.shadows.extend(cast.above_ground().filter(|_| base != tip));
    }
}

/// Adds an arrowhead to a trail half-way between two keys, if they are far enough apart for it.
fn add_arrowhead(
    scene: &mut Scene,
    trail: &Trail,
    [(start, from), (end, to)]: [(f64, Vec3); 2],
    reach: f32,
) {
    // Length and radius as fractions of the rig's reach, and least distance of the keys in lengths.
    const LENGTH: f32 = 0.036;
    const RADIUS: f32 = 0.011;
    const APART: f32 = 3.0;
    let length = LENGTH * reach;
    let middle = 0.5 * (start + end);
    let next = trail.points.partition_point(|(time, _)| *time <= middle);
    let (before, after) = trail.points.split_at(next);
    let (Some((_, at)), Some((_, next))) = (before.last(), after.first()) else { return };
    if let Some(along) = (*next - *at).try_normalize()
        && from.distance(to) > APART * length
    {
        let colour = scene.palette.accent;
        scene.add_guide_solid(*at, *at + along * length, RADIUS * reach, 0.0, colour);
    }
}
