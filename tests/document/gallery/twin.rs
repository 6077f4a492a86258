//! An arm posed independently by the law of cosines in f64.

use glam::{DVec3, Vec3};
use ik_arm::document::{Arm, TwistReferenceKind};
use ik_arm::rig::LimbPart;

use crate::gallery::EXACT;

struct Twin {
    elbow: DVec3,
    hand: DVec3,
    /// L.
    length: f64,
}

/// In Root space.
fn twin(arm: &Arm) -> Twin {
    let (upper, lower) = (f64::from(arm.bones.upper()), f64::from(arm.bones.lower()));
    let (least, length) = ((upper - lower).abs(), upper + lower);
    let cursor = arm.cursor_in_root().as_dvec3();
    let distance = soften(cursor.length(), least, length, f64::from(arm.soft_reach.softness()));
    let forward = cursor.try_normalize().unwrap_or(arm.ik_state.pointer.direction.as_dvec3());
    let along = match distance {
        0.0 => 0.0,
        _ => (distance * distance + upper * upper - lower * lower) / (2.0 * distance),
    };
    let out = (upper * upper - along * along).max(0.0).sqrt();
    let (sin, cos) = f64::from(arm.twist).sin_cos();
    let outward = outward(arm, forward);
    let side = outward * cos + forward.cross(outward) * sin;
    Twin { elbow: forward * along + side * out, hand: forward * distance, length }
}

/// Softened distance d' for a Cursor at distance `d`.
fn soften(d: f64, least: f64, length: f64, softness: f64) -> f64 {
    let zone = softness * (length - least) / 2.0;
    let (near, far) = (least + zone, length - zone);
    match d {
        d if softness == 0.0 => d.clamp(least, length),
        d if d > far => far + zone * (1.0 - (-(d - far) / zone).exp()),
        d if d < near => least + zone * ((d - near) / zone).exp(),
        d => d,
    }
}

/// e₀. Straight up or down and along the pole it is the Limb's for the last pointer.
fn outward(arm: &Arm, forward: DVec3) -> DVec3 {
    let [x, y, z] = forward.to_array();
    let (sin_pitch, flat) = (y, x.hypot(z));
    let heading = arm.ik_state.pointer.heading.as_dvec2();
    let (cos_yaw, sin_yaw) = if flat == 0.0 { heading.into() } else { (x / flat, z / flat) };
    let limb = DVec3::new(-sin_pitch * cos_yaw, flat, -sin_pitch * sin_yaw);
    match arm.twist_reference {
        TwistReferenceKind::Up => limb,
        TwistReferenceKind::Pole => {
            let pole = arm.pole.as_dvec3();
            let aside = pole.reject_from_normalized(forward);
            if aside.length() > 1e-6 * pole.length() { aside.normalize() } else { limb }
        }
        // With the default FK pose, straight along x, FK is the stereographic map.
        TwistReferenceKind::Stereographic
        | TwistReferenceKind::Transport
        | TwistReferenceKind::Fk => {
            let k = (forward + DVec3::X).cross(DVec3::Y);
            k.cross(forward).normalize()
        }
    }
}

/// Compares hand and elbow with the f64 arm, in Root space and in the world, and checks limb
/// lengths.
pub fn check(arm: &Arm) {
    let (pose, twin) = (arm.pose(), twin(arm));
    let length = twin.length;
    let [elbow, hand] = [pose.elbow, pose.hand].map(Vec3::as_dvec3);
    within("the hand", hand.distance(twin.hand), EXACT * length);
    let angle = f64::from(pose.elbow_angle()).to_degrees();
    let elbow_error = if (1.0..=179.0).contains(&angle) { 1e-5 } else { 1e-3 };
    within("the elbow", elbow.distance(twin.elbow), elbow_error * length);
    check_limbs(arm, [DVec3::ZERO, elbow, hand], EXACT * length);

    let rig = arm.frames(&arm.solve(), &pose);
    let parts = [LimbPart::Root, LimbPart::Elbow, LimbPart::Hand].map(|part| rig.origin(part));
    let largest = parts.iter().map(|at| at.abs().max_element()).fold(0.0, f32::max);
    let coarse = 2.0 * f64::from(largest.next_up() - largest);
    let [root, elbow, hand] = parts.map(Vec3::as_dvec3);
    let error = EXACT * length + coarse;
    check_limbs(arm, [root, elbow, hand], error);
    within("the hand in the world", hand.distance(arm.root.as_dvec3() + twin.hand), error);
}

fn check_limbs(arm: &Arm, [root, elbow, hand]: [DVec3; 3], error: f64) {
    let (upper, lower) = (f64::from(arm.bones.upper()), f64::from(arm.bones.lower()));
    within("the upper limb", (elbow.distance(root) - upper).abs(), error);
    within("the lower limb", (hand.distance(elbow) - lower).abs(), error);
}

/// Fails if the error is above the bound or NaN.
pub fn within(what: &str, error: f64, bound: f64) {
    assert!(error <= bound, "{what} is off by {error:e}, more than {bound:e}");
}
