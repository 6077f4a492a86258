//! Guides of a limb: its Pointer, its limits, the circle of elbows, frames, and what its twist is
//! measured from.

use glam::{Mat3, Vec3};

use super::{figure, twist};
use crate::document::{Display, Overlay, Posed};
use crate::kinematics::skeleton::JointId;
use crate::rig::{LimbFrames, LimbPart};
use crate::scene::{Ball, Globe, Label, LabelSide, Line, Scene, Solid, SphereShell};
use crate::session::{Overlays, ShownLimb};

/// Part of the sky in the Pointer's colour, so that it stays behind the limbs.
const POINTER_FADED: f32 = 0.45;

/// Adds the guides of a limb that the display shows, and the figure that lights up.
pub(super) fn add_guides(
    scene: &mut Scene,
    limb: &LimbFrames,
    overlays: &Overlays,
    display: Display,
) {
    add_pointer_and_limits(scene, limb, display);
    if display.shows(Overlay::SingularityGlobe) {
        add_globe(scene, limb);
    }
    if display.shows(Overlay::Frames) {
        figure::add_frames(scene, limb);
    }
    if let Some(shown) = overlays.figure {
        figure::add(scene, limb, shown);
    }
    if let Some(poses) = overlays.twist_references {
        twist::add_references(scene, limb, poses);
    }
}

/// Radius of the ball where the Pointer meets the globe of gains, as a fraction of the globe's.
const BALL: f32 = 0.019;
/// Length and radius of the Pointer's arrowhead, likewise.
const HEAD: [f32; 2] = [0.036, 0.009];

/// Adds the globe of gains, with a ball in the colour of the present gain where the Pointer meets it.
fn add_globe(scene: &mut Scene, limb: &LimbFrames) {
    let (centre, radius) = (limb.origin(LimbPart::Root), limb.limits.outer);
    let axes = Mat3::from(limb.root.matrix3);
    let reference = limb.posed.ik.reference;
    scene.add_globe(Globe { centre, radius, reference, axes });
    let (palette, pointer) = (scene.palette, limb.pose().pointer);
    let colour = palette.gain(reference.gain(pointer)).with_opacity(1.0);
    let meets = centre + axes * pointer.direction * radius;
    let tip = limb.world(LimbPart::Pointer).transform_point3(Vec3::X * limb.pointer().length);
    let line = palette.guide.with_opacity(0.5);
    scene.lines.push(Line { from: tip, to: meets, colour: line, dashed: true });
    scene.balls.push(Ball { centre: meets, radius: BALL * radius, colour });
}

/// Adds the circles of elbows: that of the limb of the selected joint, with its twist, or else of
/// all limbs.
pub(super) fn add_circles(scene: &mut Scene, posed: &Posed, selected: Option<JointId>) {
    let document = posed.document();
    let rig = &document.rig;
    let is_of_limb = |joint: JointId| rig.limb_target_of(joint).is_some();
    let is_alone = rig.limb_targets().count() == 1;
    if is_alone || selected.is_some_and(is_of_limb) {
        if let Some(limb) = ShownLimb::frames(posed, selected) {
            twist::add_circle(scene, &limb, true);
        }
        return;
    }
    for limb in rig.limb_targets().filter_map(|target| posed.limb_frames(target.joint)) {
        twist::add_circle(scene, &limb, false);
    }
}

fn add_pointer_and_limits(scene: &mut Scene, limb: &LimbFrames, display: Display) {
    let palette = scene.palette;
    if display.shows(Overlay::Pointer) {
        let (transform, shape) = (limb.world(LimbPart::Pointer), limb.pointer());
        let colour = palette.guide.mixed(palette.sky_bottom, POINTER_FADED);
        scene.guide_solids.push(Solid { transform, shape, colour, winding: None });
        let mut tip = transform.transform_point3(Vec3::X * shape.length);
        // The ball is about where the Pointer ends.
        let has_ball = display.shows(Overlay::SingularityGlobe);
        let radius = if has_ball { BALL * limb.limits.outer } else { shape.tip_radius };
        if !has_ball {
            let [length, width] = HEAD.map(|part| part * limb.limits.outer);
            let axis = transform.transform_vector3(Vec3::X);
            let base = tip;
            tip += axis * length;
            scene.add_guide_solid(base, tip, width, 0.0, colour);
        }
        let label = Label::new(tip, radius, LabelSide::Below, palette.text);
        let name = if has_ball { "Limb's direction" } else { "Pointer" };
        scene.add_label(label, format_args!("{name}"));
    }
    for (overlay, part, radius) in [
        (Overlay::InnerLimit, LimbPart::InnerLimit, limb.limits.inner),
        (Overlay::OuterLimit, LimbPart::OuterLimit, limb.limits.outer),
    ] {
        if display.shows(overlay) && radius > 0.0 {
            let colour = palette.guide;
            scene.shells.push(SphereShell { centre: limb.origin(part), radius, colour });
        }
    }
}
