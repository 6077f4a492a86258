use core::f32::consts::{PI, TAU};

use glam::{Mat3, Mat3A, Quat, Vec3};

use super::cone::Cone;
use super::joint::Joint;
use super::joint_angles::nearest_angles;
use super::limit::{Extreme, LimitEnd, RotationAxis, SwingAxis};
use super::limits::JointLimits;

/// The ends of the limits, with the other angles as they are.
impl Joint {
    /// The ends that can be moved: those of ranges that leave more than one angle, or of the cone.
    pub fn limit_ends(&self) -> impl Iterator<Item = LimitEnd> + use<> {
        let limits = self.limits;
        let ranges = RotationAxis::ALL.into_iter();
        let ranges =
            ranges.filter(move |axis| limits.range(*axis).is_some() && !limits.is_fixed(*axis));
        let of_ranges =
            ranges.flat_map(|axis| Extreme::BOTH.map(|extreme| LimitEnd::Range(axis, extreme)));
        let swing = |axis| Extreme::BOTH.map(|extreme| LimitEnd::Swing(axis, extreme));
        let of_cone =
            [swing(SwingAxis::X), swing(SwingAxis::Z), Extreme::BOTH.map(LimitEnd::Twist)];
        let has_cone = limits.as_cone().is_some();
        of_ranges.chain(of_cone.into_iter().flatten().filter(move |_| has_cone))
    }

    /// The angle of an end about its axis, in radians; `None` if the limits do not have the end.
    pub fn angle_of_end(&self, end: LimitEnd) -> Option<f32> {
        match end {
            LimitEnd::Range(axis, extreme) => Some(extreme.of(self.limits.range(axis)?)),
            LimitEnd::Twist(extreme) => Some(extreme.of(self.limits.as_cone()?.twist)),
            LimitEnd::Swing(axis, extreme) => {
                let Cone { x, z, .. } = self.limits.as_cone()?;
                let widest = if axis == SwingAxis::X { x } else { z };
                Some(if extreme == Extreme::Greatest { widest } else { -widest })
            }
        }
    }

    /// Euler angles of the joint at an end: those that it has with the angle of the end for its own,
    /// or, of a cone, a swing straight to the end with the twist that it has, or the swing that it
    /// has with the twist of the end; `None` as for [`Joint::angle_of_end`].
    pub fn angles_at_end(&self, end: LimitEnd) -> Option<Vec3> {
        let angle = self.angle_of_end(end)?;
        match end {
            LimitEnd::Range(axis, _) => {
                let mut angles = self.rotation;
                angles[axis.index()] = angle;
                Some(angles)
            }
            LimitEnd::Swing(axis, _) => self.limits.swung_about(axis, angle, self.rotation),
            LimitEnd::Twist(_) => self.limits.twisted(angle, self.rotation),
        }
    }

    /// The axis about which an end is moved, by greater angles against the clock: a unit vector in
    /// the space of the joint's base; `None` as for [`Joint::angle_of_end`], and without a bone.
    pub fn axis_of_end(&self, end: LimitEnd) -> Option<Vec3> {
        match end {
            LimitEnd::Range(axis, _) => {
                self.limits.range(axis)?;
                Some(self.rotation_axis(axis))
            }
            LimitEnd::Swing(axis, _) => Some(self.frame * self.limits.swing_axis(axis)?),
            LimitEnd::Twist(_) => {
                self.limits.as_cone()?;
                self.bone_at(self.rotation).try_normalize()
            }
        }
    }
}

impl JointLimits {
    /// These limits with an end at another angle about its axis, as far as the other end, a full
    /// turn and [`Cone::WIDEST`] let it go; these limits if they do not have the end.
    #[must_use]
    pub fn with_end(self, end: LimitEnd, angle: f32) -> Self {
        /// The narrowest cone, in radians: one degree.
        const NARROWEST: f32 = 0.017_453;
        match (end, self.as_cone()) {
            (LimitEnd::Range(axis, extreme), None) => {
                let range = self.range(axis).map(|it| extreme.moved_to(it, angle, f32::INFINITY));
                self.with_range(axis, range)
            }
            (LimitEnd::Twist(extreme), Some(cone)) => {
                let twist = extreme.moved_to(cone.twist, angle, TAU);
                self.with_cone(Cone { twist, ..cone })
            }
            (LimitEnd::Swing(axis, extreme), Some(cone)) => {
                let swing = if extreme == Extreme::Greatest { angle } else { -angle };
                let swing = swing.clamp(NARROWEST, Cone::WIDEST);
                self.with_cone(match axis {
                    SwingAxis::X => Cone { x: swing, ..cone },
                    SwingAxis::Z => Cone { z: swing, ..cone },
                })
            }
            _ => self,
        }
    }
}

/// The border of a joint's cone, found by [`JointLimits::contains`](super::JointLimits::contains)
/// alone.
impl Joint {
    /// The bone, in the space of the joint's base, with other Euler angles than the joint has.
    pub fn bone_at(&self, angles: Vec3) -> Vec3 {
        self.rotation_f64(angles).as_mat3() * self.axis
    }

    /// Euler angles with which the bone has swung from the middle of its cone by an angle in
    /// radians, with the twist in the middle of its range; `None` for a joint without a cone or a
    /// bone. The azimuth, in radians, is that of the swing's axis around the bone; it begins at the
    /// axis of the frame that is nearest to being across the bone.
    pub fn swung(&self, azimuth: f32, swing: f32) -> Option<Vec3> {
        let cone = self.limits.as_cone()?;
        let bone = (self.frame.transpose() * self.axis).try_normalize()?;
        let least =
            |one: &Vec3, other: &Vec3| one.dot(bone).abs().total_cmp(&other.dot(bone).abs());
        let start = Vec3::AXES.into_iter().min_by(least)?;
        let start = (start - bone * start.dot(bone)).try_normalize()?;
        let axis = Quat::from_axis_angle(bone, azimuth) * start;
        let twist = 0.5 * cone.twist.min + 0.5 * cone.twist.max;
        let turned = Mat3::from_axis_angle(axis, swing) * Mat3::from_axis_angle(bone, twist);
        let to_middle = Mat3A::from_quat(self.limits.turn_to_middle()?);
        Some(nearest_angles(to_middle * Mat3A::from(turned), self.rotation))
    }

    /// The greatest swing towards an azimuth that the cone allows, in radians; `None` as for
    /// [`Joint::swung`].
    pub fn most_swing(&self, azimuth: f32) -> Option<f32> {
        const HALVINGS: u32 = 16;
        let is_within = |swing: f32| {
            let angles = self.swung(azimuth, swing);
            angles.map(|angles| self.limits.contains(angles))
        };
        let (mut within, mut beyond) = (0.0, PI);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (within + beyond);
            match is_within(middle)? {
                true => within = middle,
                false => beyond = middle,
            }
        }
        Some(within)
    }
}
