use glam::Vec3;

use crate::document::{Document, RigKind};
use crate::rig::ArmPart;
use crate::scene::{Ball, Colour, Line, Scene};
use crate::session::{OnionSkin, Overlays};

/// Radius of the dot of each frame on a trail, as a fraction of the rig's reach.
const DOT_RADIUS: f32 = 0.004;
/// Radius of an onion skin's bones, as a fraction of the rig's reach.
const BONE_RADIUS: f32 = 0.008;
/// Contrast of an opaque onion skin with the background, from 0 (the background's colour) to 1 (the
/// skin's plain colour).
const CONTRAST: f32 = 0.7;

/// Adds the trail of the hand or the selected joint, with a dot for every frame, and the onion
/// skins.
pub(super) fn add(scene: &mut Scene, document: &Document, overlays: &Overlays, reach: f32) {
    add_trail(scene, overlays, DOT_RADIUS * reach);
    for skin in &overlays.onion_skins {
        let plain = if skin.past { scene.palette.joint } else { scene.palette.accent };
        let colour = scene.palette.sky_top.mixed(plain, CONTRAST * skin.opacity);
        add_skin(scene, skin, document.rig, colour, BONE_RADIUS * reach);
    }
}

fn add_trail(scene: &mut Scene, overlays: &Overlays, radius: f32) {
    let colour = scene.palette.accent;
    for ends in overlays.trail.windows(2).filter(|ends| ends[0] != ends[1]) {
        let colour = colour.with_opacity(0.6);
        scene.lines.push(Line { from: ends[0], to: ends[1], colour, dashed: false });
    }
    let dots = overlays.trail.iter().map(|centre| Ball { centre: *centre, radius, colour });
    scene.balls.extend(dots);
}

fn add_skin(scene: &mut Scene, skin: &OnionSkin, rig: RigKind, colour: Colour, radius: f32) {
    let mut add = |base: Vec3, tip: Vec3| {
        if base != tip {
            scene.add_solid(base, tip, radius, radius, colour);
        }
        scene.balls.push(Ball { centre: tip, radius, colour });
    };
    match rig {
        RigKind::Arm => {
            let rig = skin.arm.rig(&skin.arm.pose());
            let [root, elbow, hand] =
                [ArmPart::Root, ArmPart::Elbow, ArmPart::Hand].map(|part| rig.origin(part));
            add(root, elbow);
            add(elbow, hand);
        }
        RigKind::Skeleton => {
            skin.pose.ids().for_each(|joint| add(skin.pose.base(joint), skin.pose.tip(joint)));
        }
    }
}
