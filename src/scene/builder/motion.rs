use crate::document::RigKind;
use crate::scene::{Ball, Colour, Line, Scene};
use crate::session::{OnionSkin, Overlays};

/// Radius of the dot of each frame on a trail, as a fraction of the rig's reach.
const DOT_RADIUS: f32 = 0.004;
/// Radius of the limbs in an onion skin of the arm, as a fraction of its reach.
const BONE_RADIUS: f32 = 0.008;
/// Contrast of an opaque onion skin with the background, from 0 (the background's colour) to 1 (the
/// skin's plain colour).
const CONTRAST: f32 = 0.7;

/// Adds the trail of the hand or the selected joint, with a dot for every frame, and the onion
/// skins of the arm. Those of a figure are added with the figure, whose sizes they have.
pub(super) fn add(scene: &mut Scene, rig: RigKind, overlays: &Overlays, reach: f32) {
    add_trail(scene, overlays, DOT_RADIUS * reach);
    if rig == RigKind::Arm {
        for skin in &overlays.onion_skins {
            let colour = onion_skin_colour(scene, skin);
            add_arm(scene, skin, colour, BONE_RADIUS * reach);
        }
    }
}

/// The colour of an onion skin: fainter the farther it is from the playhead.
pub(super) fn onion_skin_colour(scene: &Scene, skin: &OnionSkin) -> Colour {
    let plain = if skin.past { scene.palette.joint } else { scene.palette.accent };
    scene.palette.sky_top.mixed(plain, CONTRAST * skin.opacity)
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

fn add_arm(scene: &mut Scene, skin: &OnionSkin, colour: Colour, radius: f32) {
    let [root, elbow, hand] = skin.arm;
    for (base, tip) in [(root, elbow), (elbow, hand)] {
        if base != tip {
            scene.add_solid(base, tip, radius, radius, colour);
        }
        scene.balls.push(Ball { centre: tip, radius, colour });
    }
}
