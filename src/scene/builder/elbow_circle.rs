//! The circle of elbows: all places where the elbow of the arm could be with the hand where it is.

use core::f32::consts::TAU;

use glam::{Quat, Vec3};

use crate::document::{Arm, Posed};
use crate::kinematics::two_bone::TwoBonePose;
use crate::scene::{Colour, Label, LabelSide, Line, Scene};

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

/// Adds the circle with spokes to the twist reference's direction and to the elbow, and the arc of the
/// twist between them. Where FK has a part in the pose, the elbow has no circle.
pub(super) fn add(scene: &mut Scene, posed: &Posed) {
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

/// A circle around the Pointer. Angles are Socket twists: 0 is the direction of the twist reference.
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
