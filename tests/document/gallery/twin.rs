//! An arm posed independently by the law of cosines in f64.

use crate::common::arm::Arm;
use glam::{DVec3, Vec3};
use ik_arm::document::TwistReferenceKind;
use ik_arm::rig::LimbPart;

use crate::gallery::{EXACT, Frame};

struct Twin {
    /// `None` at the shoulder.
    hand: Option<DVec3>,
    /// `None` where the reference gives no direction.
    elbow: Option<DVec3>,
    /// Distance of the hand from the shoulder.
    distance: f64,
    /// L.
    length: f64,
}

/// In Root space.
fn twin(arm: &Arm) -> Twin {
    let (upper, lower) = (f64::from(arm.bones.upper()), f64::from(arm.bones.lower()));
    let (least, length) = ((upper - lower).abs(), upper + lower);
    let cursor = arm.cursor_in_root().as_dvec3();
    let distance = soften(cursor.length(), least, length, f64::from(arm.soft_reach.softness()));
    let along = match distance {
        0.0 => 0.0,
        _ => (distance * distance + upper * upper - lower * lower) / (2.0 * distance),
    };
    let out = (upper * upper - along * along).max(0.0).sqrt();
    let (sin, cos) = f64::from(arm.twist).sin_cos();
    let forward = cursor.try_normalize();
    let elbow = forward.and_then(|forward| {
        let outward = outward(arm, forward)?;
        let side = outward * cos + forward.cross(outward) * sin;
        Some(forward * along + side * out)
    });
    Twin { hand: forward.map(|forward| forward * distance), elbow, distance, length }
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

/// e₀; `None` straight up or down and along the pole.
fn outward(arm: &Arm, forward: DVec3) -> Option<DVec3> {
    let aside = |pole: DVec3| {
        let aside = pole.reject_from_normalized(forward);
        (aside.length() > 1e-6 * pole.length()).then(|| aside.normalize())
    };
    match arm.twist_reference {
        TwistReferenceKind::Up => aside(DVec3::Y),
        TwistReferenceKind::Pole => aside(arm.pole.as_dvec3()),
        // With the default FK pose, straight along x, FK is the stereographic map.
        TwistReferenceKind::Stereographic
        | TwistReferenceKind::Transport
        | TwistReferenceKind::Fk => {
            let k = (forward + DVec3::X).cross(DVec3::Y);
            k.cross(forward).try_normalize()
        }
    }
}

/// Compares hand and elbow with the f64 arm, in Root space and in the world, and checks limb
/// lengths.
pub fn check(arm: &Frame) {
    let (pose, twin) = (arm.pose(), twin(arm));
    let length = twin.length;
    let parts = [LimbPart::Root, LimbPart::Elbow, LimbPart::Hand];
    let parts = parts.map(|part| arm.frames.origin(part));
    let largest = parts.iter().map(|at| at.abs().max_element()).fold(0.0, f32::max);
    // 4 units in the last place of the largest coordinate in the world.
    let coarse = 4.0 * f64::from(largest.next_up() - largest);
    let error = EXACT * length + coarse;

    let [elbow, hand] = [pose.elbow, pose.hand].map(Vec3::as_dvec3);
    within("the distance", (hand.length() - twin.distance).abs(), error);
    if let Some(expected) = twin.hand {
        within("the hand", hand.distance(expected), error);
    }
    if let Some(expected) = twin.elbow {
        let angle = f64::from(pose.elbow_angle()).to_degrees();
        let part = if (1.0..=179.0).contains(&angle) { 1e-5 } else { 1e-3 };
        within("the elbow", elbow.distance(expected), part * length + 10.0 * coarse);
    }
    check_limbs(arm, [DVec3::ZERO, elbow, hand], error);

    let [root, elbow, hand] = parts.map(Vec3::as_dvec3);
    check_limbs(arm, [root, elbow, hand], error);
    if let Some(expected) = twin.hand {
        within("the hand in the world", hand.distance(arm.root.as_dvec3() + expected), error);
    }
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
