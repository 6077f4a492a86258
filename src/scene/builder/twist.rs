//! The arm's twist: the circle of elbows, and the same twist measured from other references.

use core::f32::consts::TAU;
use core::fmt::{self, Display, Formatter};

use glam::{Quat, Vec3};

use crate::document::{Arm, Posed, TwistReferenceKind};
use crate::kinematics::two_bone::TwoBonePose;
use crate::rig::ArmRig;
use crate::scene::{Ball, Colour, Label, LabelSide, Line, Scene};
use crate::session::{BodyPart, TwistReferencePose};

/// Radii of a ghost's limbs and of its elbow, on an arm of thickness 1.
const LIMB_RADIUS: f32 = 7.0;
const ELBOW_RADIUS: f32 = 13.0;

/// Angle in radians between two elbows below which they share a label, since two labels would
/// overlap.
const SHARED_LABEL_ANGLE: f32 = 20.0 * core::f32::consts::PI / 180.0;

/// Adds ghosts of the arm: thin arms with the same twist, each measured from another kind of twist
/// reference. Labels show the angles from the arm's elbow to those of the ghosts.
pub(super) fn add_references<const N: usize>(
    scene: &mut Scene,
    posed: &Posed,
    poses: [TwistReferencePose; N],
) {
    let (arm, own) = (posed.arm(), posed.arm_solution().pose);
    let mut ghosts = poses.map(|TwistReferencePose { kind, pose }| ReferenceGhost {
        twist_reference: kind,
        pose,
        turn: own.elbow_turn_to(&pose),
        is_own: kind == arm.twist_reference,
    });
    ghosts.sort_by(|a, b| a.turn.total_cmp(&b.turn));
    for ghost in ghosts.iter().filter(|ghost| !ghost.is_own) {
        ghost.add_limbs(scene, arm);
    }
    for group in ghosts.chunk_by(|a, b| b.turn - a.turn < SHARED_LABEL_ANGLE) {
        add_label(scene, arm, group);
    }
}

/// The arm posed with one of the kinds of twist reference.
struct ReferenceGhost {
    twist_reference: TwistReferenceKind,
    pose: TwoBonePose,
    /// Angle in radians about the Pointer from the arm's elbow to the ghost's elbow.
    turn: f32,
    is_own: bool,
}

impl ReferenceGhost {
    fn add_limbs(&self, scene: &mut Scene, arm: &Arm) {
        let thickness = ArmRig::thickness(arm.bones);
        let colour = scene.palette.twist_reference(self.twist_reference);
        let [elbow, hand] = [self.pose.elbow, self.pose.hand].map(|point| arm.root + point);
        let radius = LIMB_RADIUS * thickness;
        scene.add_solid(arm.root, elbow, radius, radius, colour);
        scene.add_solid(elbow, hand, radius, radius, colour);
        scene.balls.push(Ball { centre: elbow, radius: ELBOW_RADIUS * thickness, colour });
    }
}

/// Adds one label for ghosts with nearly the same elbow, like "Stereographic · Limb −17°". The
/// arm's own reference has no angle.
fn add_label(scene: &mut Scene, arm: &Arm, group: &[ReferenceGhost]) {
    let shown = group.iter().find(|ghost| ghost.is_own).or(group.last());
    let Some(ghost) = shown else { return };
    let (ball, colour) = if ghost.is_own {
        (BodyPart::JOINT_BALL, scene.palette.text)
    } else {
        (ELBOW_RADIUS, scene.palette.twist_reference(ghost.twist_reference))
    };
    let at = arm.root + ghost.pose.elbow;
    let clearance = ball * ArmRig::thickness(arm.bones);
    let label = Label::new(at, clearance, LabelSide::Above, colour);
    scene.add_label(label, format_args!("{}", GhostNames(group)));
}

/// Text of a shared label: the names of its references, the arm's own first.
struct GhostNames<'a>(&'a [ReferenceGhost]);

impl Display for GhostNames<'_> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let own = self.0.iter().filter(|ghost| ghost.is_own);
        let others = self.0.iter().filter(|ghost| !ghost.is_own);
        for (index, ghost) in own.chain(others).enumerate() {
            let between = if index > 0 { " · " } else { "" };
            write!(f, "{between}{}", ghost.twist_reference.name())?;
            if !ghost.is_own {
                let turn = ghost.turn.to_degrees().round();
                write!(f, " {}{:.0}°", if turn < 0.0 { '−' } else { '+' }, turn.abs())?;
            }
        }
        Ok(())
    }
}

const SEGMENTS: u16 = 96;
/// Radius of the arc of the twist, as a fraction of the circle's.
const ARC: f32 = 0.4;
/// Distance of the twist's label from the centre, as a fraction of the circle's radius.
const LABEL: f32 = 0.6;
/// Radius of the circle, as a fraction of the arm's length, from which it is drawn: the circle of a
/// straight or folded arm is a point.
const LEAST: f32 = 1e-3;
/// Twist in radians from which its arc is drawn.
const LEAST_TWIST: f32 = 1e-3;

/// Adds the circle with spokes to the twist reference's direction and to the elbow, and the arc of
/// the twist between them. Where FK has a part in the pose, the elbow has no circle.
pub(super) fn add_circle(scene: &mut Scene, posed: &Posed) {
    let (arm, pose) = (posed.arm(), posed.arm_pose());
    if arm.influence < 1.0 || pose.out < LEAST * arm.bones.outer_limit() {
        return;
    }
    let circle = ElbowCircle::new(arm, pose);
    let palette = scene.palette;
    let (guide, accent) = (palette.guide, palette.accent);
    let reference = palette.twist_reference(arm.twist_reference);
    circle.add_arc(scene, TAU, 1.0, guide);
    circle.add_spoke(scene, 0.0, reference, true);
    circle.add_spoke(scene, circle.twist, accent, false);
    if circle.twist > LEAST_TWIST {
        circle.add_arc(scene, circle.twist, ARC, accent);
        let at = circle.point(circle.twist / 2.0, LABEL);
        let label = Label::new(at, 0.0, LabelSide::Above, accent);
        scene.add_label(label, format_args!("twist {:.0}°", circle.twist.to_degrees()));
    }
}

/// A circle around the Pointer. Angles are Socket twists: 0 is the direction of the twist
/// reference.
struct ElbowCircle {
    centre: Vec3,
    axis: Vec3,
    /// From the centre to the point at twist 0.
    start: Vec3,
    twist: f32,
}

impl ElbowCircle {
    fn new(arm: &Arm, pose: &TwoBonePose) -> Self {
        let (axis, twist) = (pose.pointer.direction, arm.twist.rem_euclid(TAU));
        Self {
            centre: arm.root + axis * pose.along,
            axis,
            start: Quat::from_axis_angle(axis, -twist) * pose.outward() * pose.out,
            twist,
        }
    }

    /// The point at a twist; `part` is its distance from the centre as a fraction of the radius.
    fn point(&self, twist: f32, part: f32) -> Vec3 {
        self.centre + part * (Quat::from_axis_angle(self.axis, twist) * self.start)
    }

    fn add_spoke(&self, scene: &mut Scene, twist: f32, colour: Colour, dashed: bool) {
        scene.lines.push(Line { from: self.centre, to: self.point(twist, 1.0), colour, dashed });
    }

    /// Adds the arc from twist 0 to `end`.
    fn add_arc(&self, scene: &mut Scene, end: f32, part: f32, colour: Colour) {
        let count = (f32::from(SEGMENTS) * end / TAU).ceil().max(1.0) as u16;
        let point = |index: u16| self.point(end * f32::from(index) / f32::from(count), part);
        scene.lines.extend((0..count).map(|index| Line {
            from: point(index),
            to: point(index + 1),
            colour,
            dashed: false,
        }));
    }
}
