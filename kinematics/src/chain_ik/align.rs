//! Rotations about a centre that bring points as near as possible to their destinations.

use glam::{DMat3, DQuat, DVec3, Mat3A, Quat, Vec3, Vec3A};
use nalgebra::Matrix4;

use crate::skeleton::{JointAngles, JointLimits, RotationAxis, nearest_angles};
use crate::{normalize, rotation_between};

/// A point to be rotated and its destination, both relative to the centre of rotation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct PointPair {
    pub from: Vec3A,
    pub to: Vec3A,
    pub weight: f32,
}

/// Number of rotations by [`align`]: for several pairs, one is the best about one axis only; a few
/// come near the best of all.
pub(super) const ROTATIONS: usize = 3;

/// Rotation by the best angle about the axis of the total moment Σ w from × to; exact for a single
/// pair.
pub(super) fn align(pairs: &[PointPair]) -> Quat {
    if let [pair] = pairs {
        return rotation_between(pair.from, pair.to);
    }
    let moment: Vec3A = pairs.iter().map(|pair| pair.weight * pair.from.cross(pair.to)).sum();
    let Some(axis) = normalize(moment) else { return Quat::IDENTITY };
    Quat::from_axis_angle(axis.into(), best_angle(axis, pairs))
}

/// The rotation that brings points nearest to their destinations, of all rotations: that of the
/// greatest eigenvalue of Horn's matrix. Where several are as good, a small one.
///
/// # Source
///
/// B. Horn, *Closed-form solution of absolute orientation using unit quaternions*, 1987.
pub(super) fn align_best(pairs: &[PointPair]) -> Quat {
    /// Weight of the identity, relative to that of the pairs.
    const SMALL: f64 = 1e-6;
    let mut sums = DMat3::ZERO;
    let mut whole = 0.0;
    for PointPair { from, to, weight } in pairs {
        let (from, to) = (from.as_dvec3(), to.as_dvec3() * f64::from(*weight));
        sums += DMat3::from_cols(from * to.x, from * to.y, from * to.z);
        whole += from.length() * to.length();
    }
    let DMat3 { x_axis: x, y_axis: y, z_axis: z } = sums + DMat3::IDENTITY * (SMALL * whole);
    let trace = x.x + y.y + z.z;
    let skew = DVec3::new(z.y - y.z, x.z - z.x, y.x - x.y);
    #[rustfmt::skip]
    let horn = Matrix4::new(
        trace,  skew.x,              skew.y,              skew.z,
        skew.x, 2.0 * x.x - trace,   x.y + y.x,           z.x + x.z,
        skew.y, x.y + y.x,           2.0 * y.y - trace,   y.z + z.y,
        skew.z, z.x + x.z,           y.z + z.y,           2.0 * z.z - trace,
    );
    let eigen = horn.symmetric_eigen();
    let best = eigen.eigenvectors.column(eigen.eigenvalues.imax());
    let rotation = DQuat::from_xyzw(best[1], best[2], best[3], best[0]).as_quat();
    if rotation.is_finite() { rotation.normalize() } else { Quat::IDENTITY }
}

/// Sets each Euler angle in turn, x first, to its best value within its limits, which never
/// increases the weighted squared distance. Rotates the points `from` of the pairs and returns the
/// total rotation. With a `part` below 1, each angle changes by that part of its way alone.
///
/// A joint with a cone rotates by the best rotation of all, brought into the cone, then about its
/// bone, and then along the side of the cone.
///
/// `axes` are the rotation axes of the three angles before the call.
pub(super) fn align_within(
    limits: &JointLimits,
    axes: [Vec3A; 3],
    part: f32,
    angles: &mut Vec3,
    pairs: &mut [PointPair],
) -> Quat {
    if limits.as_cone().is_some() {
        return align_in_cone(limits, frame_of(axes, *angles), part, angles, pairs);
    }
    let mut whole = Quat::IDENTITY;
    for (about, axis) in RotationAxis::ALL.into_iter().zip(axes) {
        let best = best_angle(axis, pairs);
        let by = match limits.room(*angles, about) {
            Some(room) => {
                let from = angles[about.index()];
                angles[about.index()] += part * best_within(best, *room.start(), *room.end());
                *angles = limits.project(*angles);
                angles[about.index()] - from
            }
            None => {
                angles[about.index()] += part * best;
                part * best
            }
        };
        if by != 0.0 {
            let rotation = Quat::from_axis_angle(axis.into(), by);
            for pair in &mut *pairs {
                pair.from = rotation * pair.from;
            }
            whole = rotation * whole;
        }
    }
    whole
}

/// The rotation from a joint's frame to skeleton space, from the axes of its angles there.
fn frame_of([_, y_axis, z_axis]: [Vec3A; 3], angles: Vec3) -> Mat3A {
    // The second and the third axis are always across each other.
    let basis = |y: Vec3A, z: Vec3A| Mat3A::from_cols(y.cross(z), y, z);
    let own = JointAngles(angles).axes();
    basis(y_axis, z_axis) * basis(own.y_axis, own.z_axis).transpose()
}

/// [`align_within`] for a cone: by the best rotation of all, about the bone, and along the side of the
/// cone. `frame` is the rotation from the joint's frame to skeleton space.
fn align_in_cone(
    limits: &JointLimits,
    frame: Mat3A,
    part: f32,
    angles: &mut Vec3,
    pairs: &mut [PointPair],
) -> Quat {
    let mut turner = ConeTurner { limits, frame, angles, pairs, whole: Quat::IDENTITY };
    let best = match &*turner.pairs {
        [_] => align(turner.pairs),
        _ => align_best(turner.pairs),
    };
    turner.turn(Quat::IDENTITY.slerp(best, part));
    if let Some((bone, [least, most])) = limits.twist_room(*turner.angles) {
        let axis = frame * Vec3A::from(bone);
        let by = best_within(gentle_angle(axis, turner.pairs), least.min(0.0), most.max(0.0));
        turner.turn(Quat::from_axis_angle(axis.into(), part * by));
    }
    if let Some(axis) = turner.axis_along_side() {
        let by = best_angle(axis, turner.pairs);
        turner.turn(Quat::from_axis_angle(axis.into(), part * by));
    }
    turner.whole
}

/// Turns a joint within its cone.
struct ConeTurner<'a> {
    limits: &'a JointLimits,
    /// Rotation from the joint's frame to skeleton space.
    frame: Mat3A,
    angles: &'a mut Vec3,
    pairs: &'a mut [PointPair],
    /// The rotation of all turns.
    whole: Quat,
}

impl ConeTurner<'_> {
    /// Turns by a rotation, brought into the cone, and shortened until it does not increase the
    /// weighted squared distance.
    fn turn(&mut self, mut wanted: Quat) {
        const HALVINGS: u32 = 6;
        let own = JointAngles(*self.angles).matrix();
        let before = distance(self.pairs, Quat::IDENTITY);
        for _ in 0..HALVINGS {
            let turned = self.frame.transpose() * Mat3A::from_quat(wanted) * self.frame * own;
            let within = self.limits.project(nearest_angles(turned, *self.angles));
            let turned = JointAngles(within).matrix() * own.transpose();
            let turned = self.frame * turned * self.frame.transpose();
            let rotation = Quat::from_mat3a(&turned).normalize();
            if distance(self.pairs, rotation) < before {
                *self.angles = within;
                self.pairs.iter_mut().for_each(|pair| pair.from = rotation * pair.from);
                self.whole = rotation * self.whole;
                return;
            }
            wanted = Quat::IDENTITY.slerp(wanted, 0.5);
        }
    }

    /// The axis, in skeleton space, of the turn that lowers the distance most of those that do not
    /// lead out of the cone; `None` where no side of the cone is in the way.
    fn axis_along_side(&self) -> Option<Vec3A> {
        let axes = self.frame * JointAngles(*self.angles).axes();
        let moment = |it: &PointPair| it.weight * it.from.cross(it.to);
        let moment: Vec3A = self.pairs.iter().map(moment).sum();
        let mut by = Vec3::from(axes.transpose() * moment);
        let is_stopped = self.limits.hold(*self.angles, &mut by);
        normalize(axes * Vec3A::from(by)).filter(|_| is_stopped)
    }
}

/// As [`best_angle`], but small where all points are near the axis, so that a turn would hardly bring
/// them nearer.
fn gentle_angle(axis: Vec3A, pairs: &[PointPair]) -> f32 {
    /// Part of the lengths of the points below which their distances from the axis are small.
    const SMALL: f32 = 1e-2;
    let (a, b) = moments(axis, pairs);
    let lengths: f32 = pairs.iter().map(|it| it.weight * it.from.length() * it.to.length()).sum();
    angle_of_maximum(a + SMALL * lengths, b)
}

/// The weighted squared distance of points from their destinations after a rotation.
fn distance(pairs: &[PointPair], rotation: Quat) -> f32 {
    let of_pair = |it: &PointPair| it.weight * (rotation * it.from - it.to).length_squared();
    pairs.iter().map(of_pair).sum()
}

/// Angle of a rotation about `axis` that maximizes Σ w from·to.
fn best_angle(axis: Vec3A, pairs: &[PointPair]) -> f32 {
    let (a, b) = moments(axis, pairs);
    angle_of_maximum(a, b)
}

/// The angle θ that maximizes a cos θ + b sin θ; 0 if all angles are as good.
fn angle_of_maximum(a: f32, b: f32) -> f32 {
    if a == 0.0 && b == 0.0 { 0.0 } else { b.atan2(a) }
}

/// The factors a and b in Σ w from·to = a cos θ + b sin θ, up to a constant, after a rotation by θ.
fn moments(axis: Vec3A, pairs: &[PointPair]) -> (f32, f32) {
    let (mut a, mut b) = (0.0, 0.0);
    for PointPair { from, to, weight } in pairs {
        a += weight * (from.dot(*to) - axis.dot(*from) * axis.dot(*to));
        b += weight * axis.dot(from.cross(*to));
    }
    (a, b)
}

/// Of the angles from `least` to `most`, a range that contains 0, the one nearest to `best` on the
/// circle; 0 if no other angle is nearer.
fn best_within(best: f32, least: f32, most: f32) -> f32 {
    use core::f32::consts::TAU;
    // Gain or loss that rounding of the angle alone can cause.
    const ROUNDING: f32 = 1e-7;
    for angle in [best, best - TAU, best + TAU] {
        if (least..=most).contains(&angle) {
            return angle;
        }
    }
    let gain = |angle: f32| (angle - best).cos();
    let end = if gain(least) >= gain(most) { least } else { most };
    if gain(end) > gain(0.0) + ROUNDING { end } else { 0.0 }
}
