//! The limits of a joint: fans of the directions that its bone may have, with a needle for the one
//! that it has.

use core::f32::consts::{PI, TAU};

use glam::Vec3;

use crate::kinematics::skeleton::{JointId, RotationAxis, Skeleton};
use crate::scene::{Colour, Line, Scene};
use crate::session::LimitFan;

/// Radius of the border, as a fraction of the bone's length.
const THICKNESS: f32 = 0.012;
/// Opacity of the border and of spokes.
const BORDER: f32 = 0.9;
const SPOKES: f32 = 0.28;
/// Radians from one point of an arc to the next, and points from one spoke to the next.
const STEP: f32 = PI / 36.0;
const SPOKE: usize = 2;

/// Adds the limits of a joint of a posed skeleton: a fan for each range of an angle, or the cone
/// and a fan for its twist. A fan is red while the joint is at an end of it.
pub(super) fn add_joint_limits(scene: &mut Scene, posed: &Skeleton, joint: JointId) {
    let Some(fan) = LimitFan::of(posed, joint) else { return };
    match fan.joint.limits.as_cone() {
        Some(_) => fan.add_cone(scene),
        None => RotationAxis::ALL.into_iter().for_each(|axis| fan.add_range(scene, axis)),
    }
    fan.add_needle(scene, fan.base, Some(fan.point(fan.joint.rotation)));
}

impl LimitFan {
    /// Adds the fan of a range of an angle, with the other angles as they are.
    fn add_range(&self, scene: &mut Scene, axis: RotationAxis) {
        let limits = &self.joint.limits;
        let Some(range) = limits.range(axis).filter(|_| !limits.is_fixed(axis)) else { return };
        let is_blocked = limits.is_at_end(self.joint.rotation, axis);
        let own = scene.palette.axes[axis.index()];
        let colour = if is_blocked { scene.palette.danger() } else { own };
        let (size, angle) = (range.max - range.min, self.joint.rotation[axis.index()]);
        let with = |turn: f32| {
            let mut angles = self.joint.rotation;
            angles[axis.index()] = angle + turn;
            self.range_point(axis, angle + turn).filter(|_| limits.contains(angles))
        };
        // The ends are those of the limits; in between, what they contain is drawn.
        let first = range.min - angle;
        let count = (size.min(TAU) / STEP).ceil().max(1.0) as usize;
        let turns = (0..=count).map(|at| first + size.min(TAU) * at as f32 / count as f32);
        if !self.turns_about_bone(axis) {
            return self.add_arc(scene, turns.map(with), colour, self.base);
        }
        let centre = self.twist_centre();
        self.add_arc(scene, turns.map(with), colour, centre);
        self.add_needle(scene, centre, self.range_point(axis, angle));
    }

    /// Adds the border of the cone with spokes, and the fan of its twist.
    fn add_cone(&self, scene: &mut Scene) {
        let limits = &self.joint.limits;
        let mut blocks =
            RotationAxis::ALL.into_iter().map(|axis| limits.is_at_end(self.joint.rotation, axis));
        let is_blocked = blocks.any(|is_blocked| is_blocked);
        let colour = if is_blocked { scene.palette.danger() } else { scene.palette.accent };
        let count = (TAU / STEP) as usize;
        let border = (0..=count).map(|at| {
            let azimuth = at as f32 * STEP;
            let angles = self.joint.swung(azimuth, self.joint.most_swing(azimuth)?)?;
            Some(self.point(angles))
        });
        self.add_arc(scene, border, colour, self.base);
        self.add_twist(scene, colour);
    }

    /// Adds the fan of a cone's twist across the bone as it is, with a needle.
    fn add_twist(&self, scene: &mut Scene, colour: Colour) {
        let Some((cone, twist)) =
            self.joint.limits.as_cone().zip(self.joint.limits.twist(self.joint.rotation))
        else {
            return;
        };
        let centre = self.twist_centre();
        let size = (cone.twist.max - cone.twist.min).min(TAU);
        let count = (size / STEP).ceil().max(1.0) as usize;
        let turn = |at: usize| cone.twist.min + size * at as f32 / count as f32;
        self.add_arc(scene, (0..=count).map(|at| self.twist_point(turn(at))), colour, centre);
        self.add_needle(scene, centre, self.twist_point(twist));
    }

    /// Adds the needle of what the joint has.
    fn add_needle(&self, scene: &mut Scene, from: Vec3, to: Option<Vec3>) {
        let (radius, colour) = (THICKNESS * self.length(), scene.palette.text);
        to.into_iter().for_each(|to| scene.add_guide_solid(from, to, radius, radius, colour));
    }

    /// Adds the lines between points that follow each other, and spokes from a centre to some.
    fn add_arc(
        &self,
        scene: &mut Scene,
        points: impl Iterator<Item = Option<Vec3>>,
        colour: Colour,
        centre: Vec3,
    ) {
        let (border, spoke) = (colour.with_opacity(BORDER), colour.with_opacity(SPOKES));
        let radius = THICKNESS * self.length();
        let mut last = None;
        for (index, point) in points.enumerate() {
            if let Some((from, to)) = last.zip(point) {
                // Solids show through the skin.
                scene.add_guide_solid(from, to, radius, radius, border);
            }
            if let Some(to) = point.filter(|_| index.is_multiple_of(SPOKE)) {
                scene.lines.push(Line { from: centre, to, colour: spoke, dashed: false });
            }
            last = point;
        }
    }
}
