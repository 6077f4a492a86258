use glam::Vec3;

use super::{Ball, Colour, Line, Scene};
use crate::document::{Document, RigKind};
use crate::rig::Part;
use crate::session::{OnionSkin, Overlays};

/// A frame's dot, as a part of the rig's reach.
const DOT: f32 = 0.004;
/// How thick the bones of a skin are, as a part of the rig's reach.
const BONE: f32 = 0.008;
/// How far the colour of the nearest skin is from the background's.
const NEAREST: f32 = 0.7;

/// Adds the way of the hand or joint, with a dot for every frame, and the rig as it stands before and
/// after.
pub(super) fn add(scene: &mut Scene, document: &Document, overlays: &Overlays, reach: f32) {
    add_trail(scene, overlays, DOT * reach);
    for skin in &overlays.onion_skins {
        let plain = if skin.past { scene.palette.joint } else { scene.palette.accent };
        let colour = scene.palette.sky_top.mixed(plain, NEAREST * skin.opacity);
        add_skin(scene, skin, document.rig, colour, BONE * reach);
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
                [Part::Root, Part::Elbow, Part::Hand].map(|part| rig.origin(part));
            add(root, elbow);
            add(elbow, hand);
        }
        RigKind::Skeleton => {
            (0..skin.pose.len()).for_each(|joint| add(skin.pose.base(joint), skin.pose.tip(joint)));
        }
    }
}
