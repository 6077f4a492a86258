use glam::{Affine3A, Vec3};

use crate::document::{
    Arm, Display, LengthFormat, Overlay, Posed, ShownLength, TwistReferenceKind,
};
use crate::kinematics::two_bone::{Reach, TwoBonePose};
use crate::rig::{LimbFrames, LimbPart};
use crate::scene::{Ball, Colour, Label, LabelSide, Line, Palette, Scene, Shadow, Solid};
use crate::session::{BodyPart, OnionSkin, Overlays};

/// Sizes on an arm of thickness 1.
const CURSOR_BALL: f32 = 11.0;
const POLE_BALL: f32 = 11.0;
const PIN: Vec3 = Vec3::new(-22.0, 62.0, 12.0);
const PIN_RADIUS: f32 = 4.5;
const PIN_HEAD: f32 = 13.0;
/// Radius of the limbs in an onion skin, as a fraction of the arm's reach.
const ONION_SKIN_RADIUS: f32 = 0.008;

/// Adds the arm with its Cursor, labels and shadows, as the display shows them. The part under the
/// mouse lights up; a hand with handles has no label.
pub(super) fn add(scene: &mut Scene, posed: &Posed, overlays: &Overlays) {
    let (arm, pose, display) = (posed.arm(), posed.arm_pose(), posed.document().display);
    let rig = posed.arm_frames();
    let thickness = rig.thickness();
    let has_hand = display.shows(Overlay::Hand);
    let colours = BodyColours { palette: scene.palette, hovered: overlays.hovered };
    add_limbs(scene, &rig, thickness, has_hand.then(|| arm.roll(pose)), colours);
    if has_hand {
        add_hand(scene, arm, pose, thickness, colours.of(BodyPart::Hand));
    }
    if display.shows(Overlay::Cursor) && arm.uses_ik() {
        add_cursor(scene, arm.cursor_in_world(), thickness);
        if arm.is_pinned() {
            add_pin(scene, arm.cursor_in_world(), thickness);
        }
        if pose.reach != Some(Reach::Reached) {
            add_gap(scene, &rig, arm, thickness, overlays.has_handles);
        }
    }
    if arm.twist_reference == TwistReferenceKind::Pole && arm.uses_ik() {
        add_pole(scene, &rig, arm.root + arm.pole, thickness, display);
    }
    if display.shows(Overlay::Labels) {
        add_labels(scene, &rig, thickness, |part| match part {
            LimbPart::Elbow => display.shows(Overlay::TwistReferences),
            LimbPart::Hand => overlays.has_handles && arm.uses_ik(),
            _ => false,
        });
    }
    if display.shows(Overlay::Shadow) {
        add_shadows(scene, &rig, thickness);
    }
}

/// Adds the onion skins of the arm. Those of a figure are added with the figure, whose sizes they
/// have.
pub(super) fn add_onion_skins(scene: &mut Scene, skins: &[OnionSkin], reach: f32) {
    let radius = ONION_SKIN_RADIUS * reach;
    for skin in skins {
        let colour = scene.palette.onion_skin(skin);
        let [root, elbow, hand] = skin.arm;
        for (base, tip) in [(root, elbow), (elbow, hand)] {
            if base != tip {
                scene.add_solid(base, tip, radius, radius, colour);
            }
            scene.balls.push(Ball { centre: tip, radius, colour });
        }
    }
}

/// Colours of the parts of the arm, of which one may be under the mouse.
#[derive(Clone, Copy)]
struct BodyColours {
    palette: Palette,
    hovered: Option<BodyPart>,
}

impl BodyColours {
    fn of(&self, part: BodyPart) -> Colour {
        let colour = match part {
            BodyPart::UpperLimb => self.palette.upper,
            BodyPart::LowerLimb => self.palette.lower,
            BodyPart::Root | BodyPart::Hand | BodyPart::Joint(_) => self.palette.joint,
        };
        if self.hovered == Some(part) { self.palette.lit(colour) } else { colour }
    }
}

/// Adds the two limbs. With a `roll`, stripes wind along the lower limb by that angle, in radians.
fn add_limbs(
    scene: &mut Scene,
    rig: &LimbFrames,
    thickness: f32,
    roll: Option<f32>,
    colours: BodyColours,
) {
    scene.solids.extend([
        Solid {
            transform: rig.world(LimbPart::UpperLimb),
            shape: rig.upper(),
            colour: colours.of(BodyPart::UpperLimb),
            stripes: None,
        },
        Solid {
            transform: rig.world(LimbPart::LowerLimb),
            shape: rig.lower(),
            colour: colours.of(BodyPart::LowerLimb),
            stripes: roll,
        },
    ]);
    let joints = [
        (LimbPart::Root, BodyPart::JOINT_BALL, colours.of(BodyPart::Root)),
        (LimbPart::Elbow, BodyPart::JOINT_BALL, colours.palette.joint),
        (LimbPart::Hand, BodyPart::WRIST_BALL, colours.of(BodyPart::Hand)),
    ];
    scene.balls.extend(joints.map(|(part, radius, colour)| Ball {
        centre: rig.origin(part),
        radius: radius * thickness,
        colour,
    }));
}

fn add_hand(scene: &mut Scene, arm: &Arm, pose: &TwoBonePose, thickness: f32, colour: Colour) {
    let rotation = arm.hand_rotation(pose).as_mat3();
    let transform = Affine3A::from_mat3_translation(rotation, arm.root + pose.hand);
    scene.add_hand(transform, BodyPart::HAND * thickness, colour);
}

fn add_cursor(scene: &mut Scene, centre: Vec3, thickness: f32) {
    let (radius, colour) = (CURSOR_BALL * thickness, scene.palette.guide);
    scene.guide_balls.push(Ball { centre, radius, colour });
}

/// Adds a pin in the Cursor, to show that the Cursor is pinned to the world.
fn add_pin(scene: &mut Scene, cursor: Vec3, thickness: f32) {
    let colour = scene.palette.accent;
    let head = cursor + PIN * thickness;
    scene.add_guide_solid(cursor, head, 0.0, PIN_RADIUS * thickness, colour);
    scene.guide_balls.push(Ball { centre: head, radius: PIN_HEAD * thickness, colour });
}

/// Adds the pole and a dashed line from the elbow to the pole.
fn add_pole(scene: &mut Scene, rig: &LimbFrames, pole: Vec3, thickness: f32, display: Display) {
    let (radius, colour) =
        (POLE_BALL * thickness, scene.palette.twist_reference(TwistReferenceKind::Pole));
    scene.guide_balls.push(Ball { centre: pole, radius, colour });
    scene.lines.push(Line { from: rig.origin(LimbPart::Elbow), to: pole, colour, dashed: true });
    if display.shows(Overlay::Labels) {
        let label = Label::new(pole, radius, LabelSide::Above, colour);
        scene.add_label(label, format_args!("Pole"));
    }
}

/// Adds a dashed line from the hand to a Cursor out of reach, labelled with the length of the line.
fn add_gap(scene: &mut Scene, rig: &LimbFrames, arm: &Arm, thickness: f32, has_handles: bool) {
    let (hand, cursor) = (rig.origin(LimbPart::Hand), arm.cursor_in_world());
    let colour = scene.palette.accent;
    scene.lines.push(Line { from: hand, to: cursor, colour, dashed: true });
    // The fingers are on the same line, beyond the hand.
    let line = [hand, cursor + (cursor - hand)];
    let [x, y, z] = Vec3::AXES.map(|axis| cursor + axis * hand.distance(cursor));
    let beside = |others: &[Vec3]| {
        let side = LabelSide::clear_of(others, cursor, &scene.camera);
        Label::new(cursor, CURSOR_BALL * thickness, side, colour)
    };
    let label = if has_handles {
        beside(&[line[0], line[1], x, y, z]).clear_of_handles()
    } else {
        beside(&line)
    };
    let length = hand.distance(cursor);
    let decimals = LengthFormat::of_limb(rig.bones()).decimals();
    scene.add_label(label, format_args!("{}", ShownLength { length, decimals }));
}

/// Adds the names of the joints, clear of the limbs and the Pointer. If the elbow has the label of
/// a twist reference, its name is left out, and so is that of a hand with handles.
fn add_labels(
    scene: &mut Scene,
    rig: &LimbFrames,
    thickness: f32,
    leaves_out: impl Fn(LimbPart) -> bool,
) {
    let colour = scene.palette.text;
    let [root, elbow, hand] =
        [LimbPart::Root, LimbPart::Elbow, LimbPart::Hand].map(|part| rig.origin(part));
    // The hand goes on beyond the wrist, and the Pointer beyond the hand.
    let (fingers, pointer) = (hand + (hand - elbow), hand + (hand - root));
    let named = [
        (LimbPart::Root, root, BodyPart::JOINT_BALL, [elbow, pointer], "Root"),
        (LimbPart::Elbow, elbow, BodyPart::JOINT_BALL, [root, hand], "Elbow"),
        (LimbPart::Hand, hand, BodyPart::WRIST_BALL, [elbow, fingers], "Hand"),
    ];
    for (part, at, radius, others, name) in named {
        if !leaves_out(part) {
            let side = LabelSide::clear_of(&others, at, &scene.camera);
            let label = Label::new(at, radius * thickness, side, colour);
            scene.add_label(label, format_args!("{name}"));
        }
    }
}

fn add_shadows(scene: &mut Scene, rig: &LimbFrames, thickness: f32) {
    let [root, elbow, hand] =
        [LimbPart::Root, LimbPart::Elbow, LimbPart::Hand].map(|part| rig.origin(part));
    let limbs = [
        (root, BodyPart::JOINT_BALL, elbow, rig.upper().tip_radius / thickness),
        (elbow, rig.lower().base_radius / thickness, hand, BodyPart::WRIST_BALL),
    ];
    scene.shadows.extend(limbs.into_iter().filter_map(|(base, base_radius, tip, tip_radius)| {
        Shadow {
            base,
            base_radius: base_radius * thickness,
            tip,
            tip_radius: tip_radius * thickness,
        }
        .above_ground()
    }));
}
