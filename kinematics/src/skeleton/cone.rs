use core::f64::consts::{PI, TAU};

use glam::{DMat3, DQuat, DVec2, DVec3, EulerRot, Mat3, Quat, Vec2, Vec3};

use super::joint_angles::nearest_angles_f64;
use super::limit::{Limit, SwingAxis};

/// A cone within which a bone may swing, and a range of its twist about itself.
///
/// Directions are those of the bone: y along it (of a joint without a bone, along the offset of its
/// first child), x the x-axis of the joint's frame less its part along y, and z = x × y. The rotation
/// R_z·R_y·R_x of the joint is a twist about y, then a swing about an axis across y, and then the
/// turn that brings y to the middle of the cone. The swing as a rotation vector is (s_x, s_z); it must
/// be inside the ellipse (s_x/x)² + (s_z/z)² ≤ 1.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Cone {
    /// Greatest swing about x, in radians, above 0 and at most [`Cone::WIDEST`].
    pub x: f32,
    /// Greatest swing about z, in radians, above 0 and at most [`Cone::WIDEST`].
    pub z: f32,
    /// Range of the twist about y in radians, at most a full turn wide.
    pub twist: Limit,
    /// Where the middle of the cone is: the swing about x and z, in radians, that brings the bone
    /// there from where it is with angles of 0; not longer than [`Cone::WIDEST`].
    #[cfg_attr(feature = "serde", serde(default))]
    pub middle: Vec2,
}

impl Cone {
    /// The greatest swing that a cone can allow, in radians: 170°. Beyond it, swings are too near to
    /// the opposite direction, which can be swung to about any axis.
    pub const WIDEST: f32 = 2.967_06;

    /// True if the angles are in their ranges.
    pub(super) fn is_valid(&self) -> bool {
        let is_swing = |angle: f32| angle > 0.0 && angle <= Self::WIDEST;
        let Limit { min, max } = self.twist;
        let is_twist = min.is_finite() && max.is_finite() && min <= max;
        let is_middle = self.middle.length() <= Self::WIDEST;
        let is_cone = is_swing(self.x) && is_swing(self.z) && is_middle;
        is_cone && is_twist && f64::from(max - min) <= TAU + 1e-6
    }

    /// The turn that brings the bone to the middle, with x, y and z of the cone as axes.
    fn to_middle(self) -> DQuat {
        swing(self.middle.as_dvec2())
    }
}

/// The cone of a joint with the directions of its bone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct BoneCone {
    pub cone: Cone,
    /// The directions x, y and z of the cone as columns, in the joint's frame.
    basis: DMat3,
}

/// A rotation as a swing after a twist.
#[derive(Clone, Copy, Debug, PartialEq)]
struct SwingTwist {
    /// Rotation vector of the swing: about x and z.
    swing: DVec2,
    /// About y, within half a turn of the middle of the cone's twist.
    twist: f64,
}

/// Greatest angle near which equivalent angles are chosen, in radians.
const MOST: f32 = 10.0;
/// Excess beyond the cone that counts as rounding, in radians.
const ROUNDING: f64 = 3e-6;

impl BoneCone {
    /// A cone about the y-axis of the frame.
    pub const fn new(cone: Cone) -> Self {
        Self { cone, basis: DMat3::IDENTITY }
    }

    /// Another cone around the same bone.
    pub fn with(self, cone: Cone) -> Self {
        Self { cone, ..self }
    }

    /// The cone of a joint with a frame, along a direction in the space of the joint.
    pub fn along(self, frame: Mat3, bone: Vec3) -> Self {
        let y = (frame.as_dmat3().transpose() * bone.as_dvec3()).normalize_or(DVec3::Y);
        let across = |axis: DVec3| (axis - y * axis.dot(y)).try_normalize();
        let is_clear = DVec3::X.cross(y).length() > 1e-3;
        let x = if is_clear { across(DVec3::X) } else { across(DVec3::Z) }.unwrap_or(DVec3::X);
        Self { basis: DMat3::from_cols(x, y, x.cross(y)), ..self }
    }

    pub fn contains(&self, angles: Vec3) -> bool {
        self.excess(angles.as_dvec3()).into_iter().all(|excess| excess <= ROUNDING)
    }

    /// The angles of the nearest swing and twist within the cone; `angles` if they are within.
    pub fn project(&self, angles: Vec3) -> Vec3 {
        if self.contains(angles) || !angles.is_finite() {
            return angles;
        }
        let SwingTwist { swing, twist } = self.split(angles.as_dvec3());
        let swing = nearest_in_ellipse(self.radii(), swing);
        let twist = twist.clamp(self.cone.twist.min.into(), self.cone.twist.max.into());
        // After more turns, angles are too coarse to be at the end of a cone.
        let near = if angles.abs().max_element() > MOST { angles % TAU as f32 } else { angles };
        self.angles_of(SwingTwist { swing, twist }, near)
    }

    /// The ends of the cone at which angles are and which a change `by` of them would cross, each as
    /// the unit vector of changes that lead straight out.
    pub fn crossed(&self, angles: Vec3, by: Vec3) -> [Option<Vec3>; 3] {
        const STEP: f64 = 1e-5;
        let at = angles.as_dvec3();
        let excess = self.excess(at);
        if excess.into_iter().all(|excess| excess < -ROUNDING) {
            return [None; 3];
        }
        let mut slopes = [DVec3::ZERO; 3];
        for axis in 0..3 {
            let step = DVec3::AXES[axis] * STEP;
            let (before, after) = (self.excess(at - step), self.excess(at + step));
            for (slope, (before, after)) in slopes.iter_mut().zip(before.into_iter().zip(after)) {
                slope[axis] = after - before;
            }
        }
        let crossed = |end: usize| {
            let out = slopes[end].try_normalize()?.as_vec3();
            (excess[end] >= -ROUNDING && out.dot(by) > 0.0).then_some(out)
        };
        [0, 1, 2].map(crossed)
    }

    /// Angles inside the cone at a fraction, from 0 to 1, of the way across it and of its twist.
    pub fn inside(&self, fraction: f32, near: Vec3) -> Vec3 {
        // Not at the ends, and along no axis of the ellipse.
        const PART: f64 = 0.6;
        let fraction = f64::from(fraction);
        let Limit { min, max } = self.cone.twist;
        let twist = f64::from(min) + fraction * f64::from(max - min);
        let swing = self.radii() * (PART * (2.0 * fraction - 1.0));
        self.angles_of(SwingTwist { swing, twist }, near)
    }

    /// Angles inside the cone, spread over its directions and twists: others for each number.
    pub fn spread(&self, number: u32, near: Vec3) -> Vec3 {
        const PART: f64 = 0.6;
        // The fractions of a sequence that fills a square evenly (Roberts, 2018).
        let [around, across] =
            [0.754_877_666, 0.569_840_291].map(|step| (f64::from(number) * step).fract());
        let Limit { min, max } = self.cone.twist;
        let twist = f64::from(min) + across * f64::from(max - min);
        let swing = self.radii() * DVec2::from_angle(TAU * around) * PART;
        self.angles_of(SwingTwist { swing, twist }, near)
    }

    /// The twist that angles give the bone.
    pub fn twist_of(&self, angles: Vec3) -> f32 {
        self.split(angles.as_dvec3()).twist as f32
    }

    /// An axis of the cone's swings, in the joint's frame.
    pub fn axis(&self, axis: SwingAxis) -> Vec3 {
        let of_cone = match axis {
            SwingAxis::X => DVec3::X,
            SwingAxis::Z => DVec3::Z,
        };
        (self.basis * (self.cone.to_middle() * of_cone)).as_vec3()
    }

    /// The turn that brings the bone to the middle, in the joint's frame.
    pub fn turn_to_middle(&self) -> Quat {
        let basis = DQuat::from_mat3(&self.basis);
        (basis * self.cone.to_middle() * basis.inverse()).as_quat()
    }

    /// Angles of a swing about an axis with the twist that angles have.
    pub fn swung_about(&self, axis: SwingAxis, by: f32, angles: Vec3) -> Vec3 {
        let SwingTwist { twist, .. } = self.split(angles.as_dvec3());
        let swing = match axis {
            SwingAxis::X => DVec2::X,
            SwingAxis::Z => DVec2::Y,
        };
        self.angles_of(SwingTwist { swing: swing * f64::from(by), twist }, angles)
    }

    /// Angles with another twist.
    pub fn twisted(&self, twist: f32, angles: Vec3) -> Vec3 {
        let SwingTwist { swing, .. } = self.split(angles.as_dvec3());
        self.angles_of(SwingTwist { swing, twist: twist.into() }, angles)
    }

    /// The bone's direction in the joint's frame, for angles, with the changes of the twist that the
    /// cone allows.
    pub fn twist_room(&self, angles: Vec3) -> (Vec3, [f32; 2]) {
        let own = rotation(angles.as_dvec3());
        let twist = self.split(angles.as_dvec3()).twist;
        let Limit { min, max } = self.cone.twist;
        let room = [f64::from(min) - twist, f64::from(max) - twist].map(|it| it as f32);
        ((own * self.basis.y_axis).as_vec3(), room)
    }

    /// The least cone that contains this one and angles.
    pub fn widened(&self, angles: Vec3) -> Cone {
        let SwingTwist { swing, twist } = self.split(angles.as_dvec3());
        let factor = (swing / self.radii()).length().max(1.0) as f32;
        let Cone { x, z, twist: Limit { min, max }, .. } = self.cone;
        let twist = twist as f32;
        Cone {
            x: (x * factor).min(Cone::WIDEST),
            z: (z * factor).min(Cone::WIDEST),
            twist: Limit { min: min.min(twist), max: max.max(twist) },
            ..self.cone
        }
    }

    /// The cone that contains this one and angles, widened by whole degrees, and the greatest
    /// increase of one of its angles.
    pub fn widened_by_degrees(&self, angles: Vec3) -> (Cone, f32) {
        let (Cone { x, z, twist: Limit { min, max }, .. }, to) = (self.cone, self.widened(angles));
        let more = |from: f32, to: f32| (to - from).to_degrees().ceil().to_radians().max(0.0);
        let by = [more(x, to.x), more(z, to.z), more(to.twist.min, min), more(max, to.twist.max)];
        let cone = Cone {
            x: (x + by[0]).min(Cone::WIDEST),
            z: (z + by[1]).min(Cone::WIDEST),
            twist: Limit { min: min - by[2], max: max + by[3] },
            ..self.cone
        };
        (cone, by.into_iter().fold(0.0, f32::max))
    }

    /// How far angles are beyond the ends of the cone, in radians: of the swing, of the greatest and
    /// of the least twist; negative inside.
    fn excess(&self, angles: DVec3) -> [f64; 3] {
        let SwingTwist { swing, twist } = self.split(angles);
        let radii = self.radii();
        let beyond = ((swing / radii).length() - 1.0) * radii.min_element();
        let Limit { min, max } = self.cone.twist;
        [beyond, twist - f64::from(max), f64::from(min) - twist]
    }

    fn radii(&self) -> DVec2 {
        DVec2::new(self.cone.x.into(), self.cone.z.into())
    }

    fn split(&self, angles: DVec3) -> SwingTwist {
        let basis = DQuat::from_mat3(&self.basis);
        let of_cone = basis.inverse() * rotation(angles) * basis;
        let DQuat { x, y, z, w } = self.cone.to_middle().inverse() * of_cone;
        let length = y.hypot(w);
        // The twist of a swing by half a turn is anything.
        let twist = if length > 0.0 { 2.0 * y.atan2(w) } else { 0.0 };
        let (sin, cos) = if length > 0.0 { (y / length, w / length) } else { (0.0, 1.0) };
        let vector = DVec2::new(cos * x + sin * z, cos * z - sin * x);
        let sine = vector.length();
        let ratio = if sine > 0.0 { 2.0 * sine.atan2(length) / sine } else { 2.0 };
        let Limit { min, max } = self.cone.twist;
        let middle = 0.5 * (f64::from(min) + f64::from(max));
        let turns = ((twist - middle + PI) / TAU).floor();
        SwingTwist { swing: vector * ratio, twist: twist - turns * TAU }
    }

    /// The angles of a swing and twist, of all equivalent ones those nearest to `near`.
    fn angles_of(&self, of: SwingTwist, near: Vec3) -> Vec3 {
        let swung = self.cone.to_middle() * swing(of.swing);
        let turned = DMat3::from_quat(swung * DQuat::from_rotation_y(of.twist));
        nearest_angles_f64(self.basis * turned * self.basis.transpose(), near)
    }
}

/// The rotation of a rotation vector about x and z.
fn swing(about: DVec2) -> DQuat {
    DQuat::from_scaled_axis(DVec3::new(about.x, 0.0, about.y))
}

fn rotation(angles: DVec3) -> DQuat {
    DQuat::from_euler(EulerRot::ZYX, angles.z, angles.y, angles.x)
}

/// The point of an ellipse, with the origin as its centre and radii along the axes, that is nearest
/// to a point; the point itself if it is inside.
fn nearest_in_ellipse(radii: DVec2, point: DVec2) -> DVec2 {
    const STEPS: u32 = 60;
    if (point / radii).length() <= 1.0 {
        return point;
    }
    // The nearest point is p r²/(r² + t) for the t ≥ 0 with which it is on the ellipse. The equation
    // is convex, so that Newton's steps from 0 never lead too far.
    let squares = radii * radii;
    let mut t = 0.0;
    for _ in 0..STEPS {
        let at = squares + t;
        let parts = radii * point / at;
        let excess = parts.length_squared() - 1.0;
        let slope = -2.0 * (parts * parts / at).element_sum();
        let step = -excess / slope;
        t += step;
        if step <= t * f64::EPSILON {
            break;
        }
    }
    squares * point / (squares + t)
}
