//! Orientations that targets ask for: a rotation, or an aim.
//!
//! The missing turn of a joint is a rotation vector: its direction is the axis of the turn, its
//! length φ the angle, at most π. For a rotation it leads from the joint's rotation to the wanted
//! one. For an aim with the direction d of the joint's axis and the direction d* from the joint's
//! base o to the point, r away, it is along d × d*. The cost of it is ½ w ℓ² φ², which compares it
//! with distances by the length ℓ, a quarter of the chain's.
//!
//! A turn of a joint with base b about a unit vector a, per radian, takes from the missing turn
//!
//! ```text
//! rotation   a
//! aim        a − (a·d) d + (d* × v)/r        v = a × (o − b), the velocity of o
//! ```
//!
//! The transpose of these columns is a wrench: a moment m on the joint and, for an aim, the force
//! m × d*/r at o.

use glam::{Quat, Vec3A};

use super::problem::{EndEffector, Wanted};

/// The turn that a joint misses, and how it changes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct MissingTurn {
    /// The rotation vector, in skeleton space.
    pub turn: Vec3A,
    /// w ℓ².
    pub stiffness: f32,
    /// The base o of an aim.
    pub at: Vec3A,
    /// d of an aim; zero for a rotation.
    axis: Vec3A,
    /// d*/r of an aim; zero for a rotation.
    lever: Vec3A,
}

impl MissingTurn {
    /// The turn that the joint of an end effector misses whose link has the orientation G and this
    /// base; `None` if no orientation is wanted.
    #[inline(never)]
    pub fn new(effector: &EndEffector, orientation: Quat, base: Vec3A) -> Option<Self> {
        let orienting = effector.orientation?;
        let stiffness = orienting.stiffness;
        Some(match orienting.wanted {
            Wanted::Rotation(wanted) => Self {
                turn: rotation_vector(wanted * orientation.inverse()),
                stiffness,
                at: Vec3A::ZERO,
                axis: Vec3A::ZERO,
                lever: Vec3A::ZERO,
            },
            Wanted::Aim { axis, point } => {
                let at = base + orientation * effector.space.translation;
                let axis = orientation * axis;
                let (sight, distance) = (point - at).normalize_and_length();
                // Of a point at the base, no direction is better than another.
                let lever = if distance > 0.0 { sight / distance } else { Vec3A::ZERO };
                let turn = if distance > 0.0 { turn_between(axis, sight) } else { Vec3A::ZERO };
                Self { turn, stiffness, at, axis, lever }
            }
        })
    }

    /// ½ w ℓ² φ².
    pub fn cost(&self) -> f64 {
        0.5 * f64::from(self.stiffness) * f64::from(self.turn.length()).powi(2)
    }

    /// What a turn about a unit vector `axis` through `base` takes from the missing turn, per
    /// radian.
    pub fn column(&self, axis: Vec3A, base: Vec3A) -> Vec3A {
        self.taken(axis, axis.cross(self.at - base))
    }

    /// What a spin of the joint and a velocity of its base take from the missing turn.
    pub fn taken(&self, spin: Vec3A, velocity: Vec3A) -> Vec3A {
        spin - self.axis * spin.dot(self.axis) + self.lever.cross(velocity)
    }

    /// What velocities of the base along x, y and z take from the missing turn.
    pub fn of_velocity(&self) -> [Vec3A; 3] {
        [Vec3A::X, Vec3A::Y, Vec3A::Z].map(|unit| self.lever.cross(unit))
    }

    /// The force, the moment, and the point at which the force acts, that are the transpose of
    /// [`MissingTurn::column`] for a moment.
    pub fn wrench(&self, moment: Vec3A) -> (Vec3A, Vec3A, Vec3A) {
        let across = moment - self.axis * moment.dot(self.axis);
        (moment.cross(self.lever), across, self.at)
    }

    /// A bound of the length of [`MissingTurn::column`] for a link with this base.
    pub fn longest_column(&self, base: Vec3A) -> f32 {
        1.0 + self.lever.length() * (self.at - base).length()
    }
}

/// The rotation vector of a rotation, at most π long.
fn rotation_vector(rotation: Quat) -> Vec3A {
    let rotation = if rotation.w < 0.0 { -rotation } else { rotation };
    let (sine, cosine) = (rotation.xyz().length(), rotation.w);
    // The ratio of the angle to the sine of its half.
    let ratio = if sine > 0.0 { 2.0 * sine.atan2(cosine) / sine } else { 2.0 };
    Vec3A::from(rotation.xyz() * ratio)
}

/// The shortest turn from a direction to another; between opposite ones, about any axis across.
fn turn_between(from: Vec3A, to: Vec3A) -> Vec3A {
    let across = from.cross(to);
    let angle = across.length().atan2(from.dot(to));
    match across.try_normalize() {
        Some(axis) => axis * angle,
        None if angle > 1.0 => from.any_orthonormal_vector() * angle,
        None => Vec3A::ZERO,
    }
}
