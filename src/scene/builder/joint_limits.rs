//! The limits of a joint: fans of the directions that its bone may have, with a needle for the one
//! that it has.

use core::f32::consts::{PI, TAU};

use glam::{Mat3A, Vec3};

use super::drawn_skeleton::DrawnSkeleton;
use crate::kinematics::skeleton::{Joint, JointId, RotationAxis, Skeleton};
use crate::scene::{Colour, Line, Scene};

/// Radius of fans, as a fraction of the bone's length, and of the fan of a twist.
const RADIUS: f32 = 0.85;
const TWIST_RADIUS: f32 = 0.3;
/// Opacity of the border and of spokes.
const BORDER: f32 = 0.9;
const SPOKES: f32 = 0.28;
/// Radians from one point of an arc to the next, and points from one spoke to the next.
const STEP: f32 = PI / 36.0;
const SPOKE: usize = 2;

/// Where the fans of a joint are drawn.
struct Fan<'a> {
    joint: &'a Joint,
    base: Vec3,
    /// From the space of the joint's base to the world.
    to_world: Mat3A,
}

impl DrawnSkeleton<'_> {
    /// Adds the limits of a joint of a posed skeleton: a fan for each range of an angle, or the cone
    /// and a fan for its twist. A fan is red while the joint is at an end of it.
    pub fn add_joint_limits(&self, scene: &mut Scene, posed: &Skeleton, joint: JointId) {
        let Some(of) = posed.joint(joint).filter(|it| it.axis != Vec3::ZERO) else { return };
        let above = of.parent.map(|parent| self.pose.full(parent).matrix3);
        let to_world = above.unwrap_or(posed.transform().matrix3);
        let fan = Fan { joint: of, base: self.pose.base(joint), to_world };
        match of.limits.as_cone() {
            Some(_) => fan.add_cone(scene),
            None => RotationAxis::ALL.into_iter().for_each(|axis| fan.add_range(scene, axis)),
        }
        if of.limits.is_limited() {
            let needle = fan.point(of.rotation);
            let colour = scene.palette.text;
            scene.lines.push(Line { from: fan.base, to: needle, colour, dashed: false });
        }
    }
}

impl Fan<'_> {
    /// The point of a fan in the direction that the bone has with these angles.
    fn point(&self, angles: Vec3) -> Vec3 {
        let bone = Vec3::from(self.to_world * glam::Vec3A::from(self.joint.bone_at(angles)));
        self.base + bone * RADIUS
    }

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
            limits.contains(angles).then(|| self.point(angles))
        };
        // The ends are those of the limits; in between, what they contain is drawn.
        let first = range.min - angle;
        let count = (size.min(TAU) / STEP).ceil().max(1.0) as usize;
        let turns = (0..=count).map(|at| first + size.min(TAU) * at as f32 / count as f32);
        self.add_arc(scene, turns.map(with), colour, self.base);
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
        let bone = self.point(self.joint.rotation) - self.base;
        let Some(along) = bone.try_normalize() else { return };
        let across = along.any_orthonormal_vector() * (bone.length() * TWIST_RADIUS / RADIUS);
        let centre = self.base + bone * 0.5;
        let point = |turn: f32| centre + glam::Quat::from_axis_angle(along, turn) * across;
        let size = (cone.twist.max - cone.twist.min).min(TAU);
        let count = (size / STEP).ceil().max(1.0) as usize;
        let turn = |at: usize| cone.twist.min + size * at as f32 / count as f32;
        self.add_arc(scene, (0..=count).map(|at| Some(point(turn(at)))), colour, centre);
        let needle = point(twist);
        let colour = scene.palette.text;
        scene.lines.push(Line { from: centre, to: needle, colour, dashed: false });
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
        let mut last = None;
        for (index, point) in points.enumerate() {
            if let Some((from, to)) = last.zip(point) {
                scene.lines.push(Line { from, to, colour: border, dashed: false });
            }
            if let Some(to) = point.filter(|_| index.is_multiple_of(SPOKE)) {
                scene.lines.push(Line { from: centre, to, colour: spoke, dashed: false });
            }
            last = point;
        }
    }
}
