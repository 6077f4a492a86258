//! Limbs as tapered cylinders with balls at their joints, with hands, targets, labels and shadows.

use glam::{Affine3A, Vec3};

use crate::document::{LengthFormat, Overlay, Posed, ShownLength, Target, TwistReferenceKind};
use crate::kinematics::limb_ik::Limb;
use crate::kinematics::skeleton::{JointId, Skeleton};
use crate::kinematics::two_bone::Reach;
use crate::rig::{LimbFrames, LimbPart};
use crate::scene::{Ball, Colour, Hand, Label, LabelSide, Line, Palette, Scene, Shadow, Solid};
use crate::session::Overlays;

/// Radius of the balls of target and pole, on a limb of thickness 1.
const TARGET_BALL: f32 = 11.0;

/// A limb that is drawn as cylinders.
pub(super) struct CylinderLimb<'a> {
    target: &'a Target,
    limb: Limb,
    /// The joint above the limb, if it is a point at the limb's base.
    root: Option<JointId>,
    frames: LimbFrames,
    thickness: f32,
}

impl<'a> CylinderLimb<'a> {
    /// The limbs of a posed document that are drawn as cylinders.
    pub fn all(posed: &'a Posed) -> impl Iterator<Item = Self> {
        let document = posed.document();
        let is_shown = document.display.shows(Overlay::Cylinders);
        let targets = document.rig.targets.iter().filter(move |_| is_shown);
        targets.filter_map(|target| Self::new(posed, target))
    }

    fn new(posed: &'a Posed, target: &'a Target) -> Option<Self> {
        let frames = posed.limb_frames(target.joint)?;
        let pose: &Skeleton = posed.skeleton();
        let limb = Limb::ending_at(pose, target.joint).ok()?;
        let is_base =
            |joint: &JointId| pose[*joint].is_root_point() && pose[limb.upper].offset == Vec3::ZERO;
        let root = pose[limb.upper].parent.filter(is_base);
        Some(Self { target, limb, root, thickness: frames.thickness(), frames })
    }

    /// Marks the joints that the cylinders stand for, in a list of all joints.
    pub fn mark(&self, skeleton: &Skeleton, marked: &mut [bool]) {
        let hand = self.limb.hand.filter(|hand| skeleton[*hand].axis == Vec3::ZERO);
        let ends = self.root.into_iter().chain(hand);
        let joints = self.limb.bones(skeleton).chain(ends);
        joints.for_each(|joint| marked[joint.index()] = true);
    }

    /// Adds the limb with its hand, its target, names and shadows, as the display shows them. The
    /// part under the mouse lights up; an end with handles has no name. A skin that stands for the
    /// limb has the colour `skin`, which the hand then has, too.
    pub fn add(&self, scene: &mut Scene, posed: &Posed, overlays: &Overlays, skin: Option<Colour>) {
        let (document, frames) = (posed.document(), &self.frames);
        let (display, rig) = (document.display, &document.rig);
        let has_hand = display.shows(Overlay::Hand);
        let colours = BodyColours { palette: scene.palette, overlays };
        if skin.is_none() {
            let roll = || rig.hand_roll(posed.skeleton(), self.target.joint);
            self.add_limbs(scene, has_hand.then(roll).flatten(), colours);
        }
        if let Some(turn) = rig.hand_rotation(posed.skeleton(), self.target.joint)
            && has_hand
        {
            let at = frames.origin(LimbPart::Hand);
            let transform = Affine3A::from_mat3_translation(turn.as_mat3(), at);
            let hand = self.limb.hand.unwrap_or(self.limb.lower);
            let colour = colours.of(Some(hand), skin.unwrap_or(scene.palette.joint));
            self.add_hand(scene, transform, colour, display.shows(Overlay::Shadow));
        }
        let is_posing = self.target.is_posing();
        if display.shows(Overlay::Cursor) && is_posing {
            self.add_target(scene, overlays.has_handles);
        }
        if let Some(pole) = posed.target_report(self.target.joint).and_then(|report| report.pole)
            && is_posing
        {
            self.add_pole(scene, pole);
        }
        if rig.sole_limb().is_some() {
            self.add_labels(scene, |part| match part {
                LimbPart::Elbow => display.shows(Overlay::TwistReferences),
                LimbPart::Hand => overlays.has_handles && is_posing,
                _ => false,
            });
        }
        if display.shows(Overlay::Shadow) {
            self.add_shadows(scene);
        }
    }

    /// Adds the two limbs. With a `roll`, the lower limb winds by that angle, in radians.
    fn add_limbs(&self, scene: &mut Scene, roll: Option<f32>, colours: BodyColours<'_>) {
        let (frames, palette) = (&self.frames, scene.palette);
        scene.solids.extend([
            Solid {
                transform: frames.world(LimbPart::UpperLimb),
                shape: frames.upper(),
                colour: colours.of(Some(self.limb.upper), palette.upper),
                winding: None,
            },
            Solid {
                transform: frames.world(LimbPart::LowerLimb),
                shape: frames.lower(),
                colour: colours.of(Some(self.limb.lower), palette.lower),
                winding: roll,
            },
        ]);
        let hand = self.limb.hand.or(Some(self.limb.lower));
        let joints = [
            (LimbPart::Root, LimbFrames::JOINT_BALL, self.root),
            (LimbPart::Elbow, LimbFrames::JOINT_BALL, None),
            (LimbPart::Hand, LimbFrames::WRIST_BALL, hand),
        ];
        scene.balls.extend(joints.map(|(part, radius, joint)| Ball {
            centre: frames.origin(part),
            radius: radius * self.thickness,
            colour: colours.of(joint, palette.joint),
        }));
    }

    /// Adds the hand, whose wrist has this transform to the world.
    fn add_hand(&self, scene: &mut Scene, transform: Affine3A, colour: Colour, has_shadow: bool) {
        let hand = Hand { transform, size: LimbFrames::HAND * self.thickness, colour };
        scene.hands.push(hand);
        if has_shadow {
            let [(base, base_radius), (tip, tip_radius)] = hand.ends();
            let limb = Shadow { base, base_radius, tip, tip_radius };
            scene.shadows.extend(limb.above_ground());
        }
    }

    fn add_target(&self, scene: &mut Scene, has_handles: bool) {
        let (centre, radius) = (self.frames.origin(LimbPart::Cursor), TARGET_BALL * self.thickness);
        scene.guide_balls.push(Ball { centre, radius, colour: scene.palette.guide });
        if self.target.is_pinned {
            add_pin(scene, centre, radius);
        }
        if self.frames.pose().reach != Some(Reach::Reached) {
            self.add_gap(scene, centre, has_handles);
        }
    }

    /// Adds the pole and a dashed line from the elbow to the pole.
    fn add_pole(&self, scene: &mut Scene, pole: Vec3) {
        let colour = scene.palette.twist_reference(TwistReferenceKind::Pole);
        let radius = TARGET_BALL * self.thickness;
        scene.guide_balls.push(Ball { centre: pole, radius, colour });
        let from = self.frames.origin(LimbPart::Elbow);
        scene.lines.push(Line { from, to: pole, colour, dashed: true });
        let label = Label::new(pole, radius, LabelSide::Above, colour);
        scene.add_label(label, format_args!("Pole"));
    }

    /// Adds a dashed line from the hand to a target out of reach, labelled with the length of the
    /// line.
    fn add_gap(&self, scene: &mut Scene, target: Vec3, has_handles: bool) {
        let hand = self.frames.origin(LimbPart::Hand);
        let colour = scene.palette.accent;
        scene.lines.push(Line { from: hand, to: target, colour, dashed: true });
        // The fingers are on the same line, beyond the hand.
        let line = [hand, target + (target - hand)];
        let [x, y, z] = Vec3::AXES.map(|axis| target + axis * hand.distance(target));
        let beside = |others: &[Vec3]| {
            let side = LabelSide::clear_of(others, target, &scene.camera);
            Label::new(target, TARGET_BALL * self.thickness, side, colour)
        };
        let label = if has_handles {
            beside(&[line[0], line[1], x, y, z]).clear_of_handles()
        } else {
            beside(&line)
        };
        let length = hand.distance(target);
        let decimals = LengthFormat::of_limb(self.frames.bones()).decimals();
        scene.add_label(label, format_args!("gap {}", ShownLength { length, decimals }));
    }

    /// Adds the names of the joints, clear of the limbs and the Pointer. If the elbow has the label
    /// of a twist reference, its name is left out, and so is that of a hand with handles.
    fn add_labels(&self, scene: &mut Scene, leaves_out: impl Fn(LimbPart) -> bool) {
        let colour = scene.palette.text;
        let [root, elbow, hand] = self.joints();
        // The hand goes on beyond the wrist, and the Pointer beyond the hand.
        let (fingers, pointer) = (hand + (hand - elbow), hand + (hand - root));
        let named = [
            (LimbPart::Root, root, LimbFrames::JOINT_BALL, [elbow, pointer], "Shoulder"),
            (LimbPart::Elbow, elbow, LimbFrames::JOINT_BALL, [root, hand], "Elbow"),
            (LimbPart::Hand, hand, LimbFrames::WRIST_BALL, [elbow, fingers], "Hand"),
        ];
        for (part, at, radius, others, name) in named {
            if !leaves_out(part) {
                let side = LabelSide::clear_of(&others, at, &scene.camera);
                let label = Label::new(at, radius * self.thickness, side, colour);
                scene.add_label(label, format_args!("{name}"));
            }
        }
    }

    fn add_shadows(&self, scene: &mut Scene) {
        let [root, elbow, hand] = self.joints();
        let (frames, thickness) = (&self.frames, self.thickness);
        let limbs = [
            (root, LimbFrames::JOINT_BALL, elbow, frames.upper().tip_radius / thickness),
            (elbow, frames.lower().base_radius / thickness, hand, LimbFrames::WRIST_BALL),
        ];
        scene.shadows.extend(limbs.into_iter().filter_map(
            |(base, base_radius, tip, tip_radius)| {
                let [base_radius, tip_radius] = [base_radius, tip_radius].map(|it| it * thickness);
                Shadow { base, base_radius, tip, tip_radius }.above_ground()
            },
        ));
    }

    /// Base, elbow and hand in the world.
    fn joints(&self) -> [Vec3; 3] {
        [LimbPart::Root, LimbPart::Elbow, LimbPart::Hand].map(|part| self.frames.origin(part))
    }
}

/// Adds a pin in a target's ball, to show that the target is pinned to the world.
pub(super) fn add_pin(scene: &mut Scene, target: Vec3, ball: f32) {
    /// Sizes for a ball of radius 1.
    const PIN: Vec3 = Vec3::new(-2.0, 5.636, 1.091);
    const PIN_RADIUS: f32 = 0.409;
    const PIN_HEAD: f32 = 1.182;
    let (colour, head) = (scene.palette.accent, target + PIN * ball);
    scene.add_guide_solid(target, head, 0.0, PIN_RADIUS * ball, colour);
    scene.guide_balls.push(Ball { centre: head, radius: PIN_HEAD * ball, colour });
}

/// Colours of the parts of a limb, which may be selected or under the mouse.
#[derive(Clone, Copy)]
struct BodyColours<'a> {
    palette: Palette,
    overlays: &'a Overlays,
}

impl BodyColours<'_> {
    fn of(&self, joint: Option<JointId>, colour: Colour) -> Colour {
        match joint {
            Some(joint) if self.overlays.selection.contains(&joint) => self.palette.accent,
            Some(joint) if self.overlays.hovered == Some(joint) => self.palette.lit(colour),
            _ => colour,
        }
    }
}
