//! The limits of a joint in the world: the fans of the directions that its bone may have, and the
//! ends that can be dragged.

use glam::{Mat3A, Quat, Vec3, Vec3A};

use super::turn::GripRing;
use crate::document::{Overlay, Posed};
use crate::kinematics::skeleton::{Joint, JointId, Limit, LimitEnd, RotationAxis, Skeleton};

/// Where the fans of a posed joint are.
pub struct LimitFan {
    /// The joint in its pose.
    pub joint: Joint,
    /// Its base, in the world.
    pub base: Vec3,
    /// From the space of the joint's base to the world.
    to_world: Mat3A,
}

impl LimitFan {
    /// Radius of fans, as a fraction of the bone's length, and of the fan of a twist.
    const RADIUS: f32 = 0.85;
    const TWIST_RADIUS: f32 = 0.3;

    /// The fans of a joint in a pose; `None` for a joint without a bone or without limits.
    pub fn of(posed: &Skeleton, joint: JointId) -> Option<Self> {
        let of = posed.joint(joint).filter(|it| it.axis != Vec3::ZERO && it.limits.is_limited())?;
        let above = of.parent.map_or(posed.transform(), |parent| posed.full_transform(parent));
        Some(Self { joint: of.clone(), base: posed.base(joint), to_world: above.matrix3 })
    }

    /// The fans of the joint whose limits are shown with handles.
    pub fn shown(posed: &Posed, joint: JointId) -> Option<Self> {
        let is_shown = posed.document().display.shows(Overlay::JointLimits);
        Self::of(posed.skeleton(), joint).filter(|_| is_shown)
    }

    /// The point of a fan in the direction that the bone has with these angles.
    pub fn point(&self, angles: Vec3) -> Vec3 {
        let bone = Vec3::from(self.to_world * Vec3A::from(self.joint.bone_at(angles)));
        self.base + bone * Self::RADIUS
    }

    /// Length of the bone in the world.
    pub fn length(&self) -> f32 {
        (self.point(self.joint.rotation) - self.base).length() / Self::RADIUS
    }

    /// The centre of the fans of turns about the bone, across the bone as it is.
    pub fn twist_centre(&self) -> Vec3 {
        self.base.midpoint(self.point(self.joint.rotation))
    }

    /// The point of the fan of a cone's twist; `None` for a bone without a length in the world.
    pub fn twist_point(&self, twist: f32) -> Option<Vec3> {
        let along = (self.point(self.joint.rotation) - self.base).try_normalize()?;
        Some(self.point_around(self.side() * along, twist))
    }

    /// The point of the fan of a range for an angle about an axis; `None` for an axis without a
    /// length in the world.
    pub fn range_point(&self, axis: RotationAxis, angle: f32) -> Option<Vec3> {
        if self.turns_about_bone(axis) {
            return Some(self.point_around(self.axis(self.joint.rotation_axis(axis))?, angle));
        }
        let mut angles = self.joint.rotation;
        angles[axis.index()] = angle;
        Some(self.point(angles))
    }

    /// Points along the fan of a range; none for an axis without a range, and for a fixed angle.
    pub fn range_arc(&self, axis: RotationAxis) -> impl Iterator<Item = Vec3> {
        const POINTS: u8 = 24;
        let limits = self.joint.limits;
        let range = limits.range(axis).filter(|_| !limits.is_fixed(axis));
        range.into_iter().flat_map(move |Limit { min, max }| {
            let angle = move |at| min + (max - min) * f32::from(at) / f32::from(POINTS);
            (0..=POINTS).filter_map(move |at| self.range_point(axis, angle(at)))
        })
    }

    /// True if an angle turns the bone almost about itself, so that its fan is across the bone.
    pub fn turns_about_bone(&self, axis: RotationAxis) -> bool {
        /// Sine of the angle between the axis and the bone.
        const NEARLY: f32 = 0.35;
        let bone = self.joint.bone_at(self.joint.rotation);
        let across = self.joint.rotation_axis(axis).cross(bone);
        across.length() < NEARLY * bone.length()
    }

    /// The point of a fan across the bone, about a unit axis in the world.
    fn point_around(&self, axis: Vec3, angle: f32) -> Vec3 {
        let across = axis.any_orthonormal_vector() * (self.length() * Self::TWIST_RADIUS);
        self.twist_centre() + Quat::from_axis_angle(axis, angle) * across
    }

    /// The ends of the limits, where they are in the world.
    pub fn ends(&self) -> impl Iterator<Item = (LimitEnd, Vec3)> {
        self.joint.limit_ends().filter_map(|end| Some((end, self.end(end)?)))
    }

    fn end(&self, end: LimitEnd) -> Option<Vec3> {
        let angle = self.joint.angle_of_end(end)?;
        match end {
            LimitEnd::Twist(_) => self.twist_point(angle),
            LimitEnd::Range(axis, _) => self.range_point(axis, angle),
            LimitEnd::Swing(..) => Some(self.point(self.joint.angles_at_end(end)?)),
        }
    }

    /// The circle on which an end is dragged.
    pub fn ring(&self, end: LimitEnd) -> Option<GripRing> {
        let axis = self.axis(self.joint.axis_of_end(end)?)?;
        let is_across = match end {
            LimitEnd::Twist(_) => true,
            LimitEnd::Range(axis, _) => self.turns_about_bone(axis),
            LimitEnd::Swing(..) => false,
        };
        Some(GripRing { centre: if is_across { self.twist_centre() } else { self.base }, axis })
    }

    /// An axis of a turn in the space of the joint's base, in the world.
    fn axis(&self, local: Vec3) -> Option<Vec3> {
        (Vec3::from(self.to_world * Vec3A::from(local)) * self.side()).try_normalize()
    }

    /// −1 in a mirror, which reverses every rotation.
    fn side(&self) -> f32 {
        self.to_world.determinant().signum()
    }
}
