//! Twist references: direction of the elbow, gain and transport.

use std::f64::consts::PI;

use glam::{DVec3, Vec3};
use ik_arm_kinematics::twist::{
    Stereographic, TransportedFrame, TwistReference, angle_from_limb, remeasured,
};
use ik_arm_kinematics::two_bone::{Pointer, TwoBone};
use proptest::prelude::*;

use crate::common::strategies::{config, uniform_directions};

fn pointer(w: DVec3) -> Pointer {
    Pointer::towards(w.as_vec3(), Pointer::default())
}

const POLE: Vec3 = Vec3::new(30.0, -250.0, 120.0);

fn stateless() -> [TwistReference; 3] {
    [
        TwistReference::Up,
        TwistReference::Pole(POLE),
        TwistReference::Stereographic(Stereographic::default()),
    ]
}

/// e₀ by the formulas, in f64.
fn twin(reference: TwistReference, w: DVec3) -> DVec3 {
    match reference {
        // Up, as far as the Pointer lets it.
        TwistReference::Up => (DVec3::Y - w * w.y).normalize(),
        TwistReference::Pole(pole) => {
            let pole = pole.as_dvec3();
            (pole - w * pole.dot(w)).normalize()
        }
        TwistReference::Stereographic(map) => {
            let k = (w - map.singular().as_dvec3()).cross(map.up().as_dvec3());
            k.cross(w).normalize()
        }
        TwistReference::Transport => unreachable!("it has no formula of its own"),
    }
}

/// Signed angle from `from` to `to` about `w`.
fn turn(from: DVec3, to: DVec3, w: DVec3) -> f64 {
    w.dot(from.cross(to)).atan2(from.dot(to))
}

/// Parallel transport in f64: the least turn, by Rodrigues' formula.
fn transported(e: DVec3, from: DVec3, to: DVec3) -> DVec3 {
    let axis = from.cross(to);
    let (sin, cos) = (axis.length(), from.dot(to));
    if sin == 0.0 {
        return e;
    }
    let axis = axis / sin;
    e * cos + axis.cross(e) * sin + axis * axis.dot(e) * (1.0 - cos)
}

proptest! {
    #![proptest_config(config(2000, 0x0051_1e1e))]

    #[test]
    fn every_reference_is_a_unit_vector_at_right_angles_to_the_pointer(w in uniform_directions()) {
        let pointer = pointer(w);
        let last = TransportedFrame::new(pointer);
        for reference in stateless().into_iter().chain([TwistReference::Transport]) {
            let outward = reference.outward(pointer, Some(last));
            prop_assert!((outward.length() - 1.0).abs() < 1e-6, "{reference:?}");
            prop_assert!(outward.dot(pointer.direction).abs() < 1e-6, "{reference:?}");
        }
    }

    #[test]
    fn every_reference_agrees_with_its_formula(w in uniform_directions()) {
        let pointer = pointer(w);
        for reference in stateless() {
            if reference.gain(pointer) < 1e3 {
                let expected = twin(reference, pointer.direction.as_dvec3());
                let found = reference.outward(pointer, None).as_dvec3();
                prop_assert!(found.distance(expected) < 1e-3, "{reference:?}: {found}");
            }
        }
    }

    #[test]
    fn the_gain_is_the_largest_turn_relative_to_transport_per_turn_of_the_pointer(w in uniform_directions()) {
        const STEP: f64 = 1e-5;
        for reference in stateless() {
            let gain = f64::from(reference.gain(pointer(w)));
            if gain > 100.0 {
                continue;
            }
            let (u, v) = w.any_orthonormal_pair();
            let worst = (0..360).map(|step| {
                let (sin, cos) = (f64::from(step) * PI / 180.0).sin_cos();
                let aside = u * cos + v * sin;
                let to = w * STEP.cos() + aside * STEP.sin();
                let moved = transported(twin(reference, w), w, to);
                turn(moved, twin(reference, to), to).abs() / STEP
            });
            let worst = worst.fold(0.0, f64::max);
            let off = (gain - worst).abs();
            prop_assert!(off < 1e-3 * (1.0 + gain * gain), "{reference:?}: {gain}, not {worst}");
        }
    }

    #[test]
    fn transport_is_the_least_turn(w in uniform_directions(), to in uniform_directions()) {
        let from = TransportedFrame::new(pointer(w));
        let transported = from.to(to.as_vec3());
        if w.dot(to) > -0.999 {
            let expected = self::transported(from.outward.as_dvec3(), w, to);
            prop_assert!(transported.outward.as_dvec3().distance(expected) < 1e-3);
        }
        prop_assert!((transported.outward.length() - 1.0).abs() < 1e-6);
        prop_assert!(transported.outward.dot(to.as_vec3()).abs() < 1e-6);
    }

    #[test]
    fn a_closed_loop_turns_the_transported_direction_by_its_solid_angle(
        a in uniform_directions(), b in uniform_directions(), c in uniform_directions()
    ) {
        // Not near half turns, where the least turn is not defined.
        prop_assume!(a.dot(b) > -0.9 && b.dot(c) > -0.9 && c.dot(a) > -0.9);
        let start = TransportedFrame::new(pointer(a));
        let end = start.to(b.as_vec3()).to(c.as_vec3()).to(a.as_vec3());
        let turned = turn(start.outward.as_dvec3(), end.outward.as_dvec3(), a);
        // Van Oosterom and Strackee.
        let solid = 2.0 * a.dot(b.cross(c)).atan2(1.0 + a.dot(b) + b.dot(c) + c.dot(a));
        let off = (turned - solid + PI).rem_euclid(2.0 * PI) - PI;
        prop_assert!(off.abs() < 2e-5, "{turned}, not {solid}");
    }

    #[test]
    fn changing_the_reference_keeps_the_elbow(
        w in uniform_directions(), twist in 0.0..std::f32::consts::TAU, length in 150.0..450.0_f64
    ) {
        let (arm, pointer) = (TwoBone::new(200.0, 300.0).expect("lengths"), pointer(w));
        let cursor = (w * length).as_vec3();
        let last = Some(TransportedFrame::new(pointer));
        let all = stateless().into_iter().chain([TwistReference::Transport]);
        let angles: Vec<f32> = all.map(|reference| reference.angle(pointer, last)).collect();
        let elbow = arm.solve(cursor, twist + angles[0]).elbow;
        for from in &angles {
            let twist = remeasured(twist, angles[0], *from);
            for to in &angles {
                let again = remeasured(twist, *from, *to);
                prop_assert!((0.0..std::f32::consts::TAU).contains(&again));
                let moved = arm.solve(cursor, again + to).elbow.distance(elbow);
                prop_assert!(moved < 5e-3, "moved by {moved}");
            }
        }
    }
}

#[test]
fn a_stereographic_elbow_is_up_when_the_hand_is_in_front() {
    let map = TwistReference::Stereographic(Stereographic::default());
    assert_eq!(map.outward(Pointer::default(), None), Vec3::Y);
    assert_eq!(map.gain(Pointer::default()), 0.0);
}

#[test]
fn singular_directions_have_an_infinite_gain_and_use_the_transported_direction() {
    let transported = TransportedFrame { direction: Vec3::X, outward: Vec3::Z };
    for (reference, w) in [
        (TwistReference::Pole(POLE), POLE),
        (TwistReference::Pole(POLE), -POLE),
        (TwistReference::Pole(Vec3::ZERO), Vec3::X),
        (TwistReference::Stereographic(Stereographic::default()), Vec3::NEG_X),
    ] {
        let pointer = Pointer::towards(w, Pointer::default());
        assert_eq!(reference.gain(pointer), f32::INFINITY, "{reference:?} at {w}");
        let expected = transported.to(pointer.direction).outward;
        assert_eq!(reference.outward(pointer, Some(transported)), expected, "{reference:?} at {w}");
        assert_eq!(reference.outward(pointer, None), pointer.limb_frame().y_axis);
    }
    for w in [Vec3::Y, Vec3::NEG_Y] {
        let pointer = Pointer::towards(w, Pointer::default());
        assert_eq!(TwistReference::Up.gain(pointer), f32::INFINITY);
        assert!(TwistReference::Up.outward(pointer, None).is_finite());
    }
}

#[test]
fn transport_to_the_opposite_pointer_keeps_the_direction() {
    let transported = TransportedFrame { direction: Vec3::X, outward: Vec3::Z };
    assert_eq!(transported.to(Vec3::NEG_X).outward, Vec3::Z);
    assert_eq!(transported.to(Vec3::X).outward, Vec3::Z);
}

#[test]
fn transport_without_movement_changes_no_bit() {
    for cursor in [Vec3::new(0.3, 0.9, -0.4), Vec3::new(-250.0, 1.0, 3.0), Vec3::Y] {
        let transported = TransportedFrame::new(Pointer::towards(cursor, Pointer::default()));
        assert_eq!(transported.to(transported.direction), transported);
    }
}

#[test]
fn stereographic_is_as_exact_beside_its_singular_direction_as_elsewhere() {
    for aside in [1e-2, 1e-3, 1e-4_f32] {
        // Two directions that are the same but for the rounding of their lengths.
        let w = Vec3::new(-1.0, aside, 0.7 * aside).normalize();
        let longer =
            Pointer { direction: w * (1.0 + f32::EPSILON), heading: pointer(w.as_dvec3()).heading };
        let map = TwistReference::Stereographic(Stereographic::default());
        let same = Pointer { direction: w, ..longer };
        let apart = map.outward(longer, None).distance(map.outward(same, None));
        assert!(f64::from(apart) < 1e-6 / f64::from(aside), "{apart} at {aside}");
    }
}

#[test]
fn stereographic_needs_two_directions() {
    assert_eq!(Stereographic::new(Vec3::ZERO, Vec3::Y), None);
    assert_eq!(Stereographic::new(Vec3::Y, Vec3::NEG_Y * 3.0), None);
    let map = Stereographic::new(Vec3::new(0.0, 0.0, -2.0), Vec3::new(0.0, 1.0, 5.0));
    let map = map.expect("two directions");
    assert_eq!((map.singular(), map.up()), (Vec3::NEG_Z, Vec3::Y));
}

#[test]
fn the_limb_reference_is_the_y_axis_of_the_limb_frame() {
    let pointer = Pointer::towards(Vec3::new(1.0, 2.0, -0.5), Pointer::default());
    assert_eq!(TwistReference::Up.angle(pointer, None), 0.0);
    let limb = pointer.limb_frame();
    assert_eq!(angle_from_limb(pointer, limb.y_axis), 0.0);
    assert!((angle_from_limb(pointer, limb.z_axis) - std::f32::consts::FRAC_PI_2).abs() < 1e-6);
}
