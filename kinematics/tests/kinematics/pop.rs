//! Elbow pops and their causes.

use std::f64::consts::PI;

use glam::{DVec3, Vec3};
use ik_arm_kinematics::fk::Fk;
use ik_arm_kinematics::ik::{Ik, IkState};
use ik_arm_kinematics::pop::{ElbowStep, InputChange, PopCause, PosedLimb};
use ik_arm_kinematics::soft_reach::SoftReach;
use ik_arm_kinematics::twist::{Stereographic, TwistReference};
use ik_arm_kinematics::two_bone::{Pointer, TwoBone};
use proptest::prelude::*;

use crate::common::strategies::config;

fn map() -> TwistReference {
    TwistReference::Stereographic(Stereographic::default())
}

fn soft(softness: f32) -> SoftReach {
    SoftReach::new(softness, 1.0, 0.0).expect("a softening")
}

fn arm(reference: TwistReference, softness: f32) -> Ik {
    let bones = TwoBone::new(200.0, 300.0).expect("lengths");
    Ik { bones, reference, soft_reach: soft(softness) }
}

/// Moments of a drag: each pose continues from the one before.
fn moments(ik: Ik, cursors: impl IntoIterator<Item = Vec3>) -> Vec<PosedLimb> {
    let mut state = IkState::default();
    let poses = cursors.into_iter().map(|cursor| {
        let solved = ik.solve(cursor, 0.0, state);
        state = solved.state();
        PosedLimb {
            pose: solved.pose,
            cursor,
            ik,
            kind: ik.reference.kind(),
            twist: 0.0,
            pinned_root: None,
            influence: 1.0,
            fk: Fk::default(),
        }
    });
    poses.collect()
}

fn steps(ik: Ik, cursors: impl IntoIterator<Item = Vec3>) -> Vec<ElbowStep> {
    let moments = moments(ik, cursors);
    moments.windows(2).filter_map(|pair| ElbowStep::between(&pair[0], &pair[1])).collect()
}

fn pops(ik: Ik, cursors: impl IntoIterator<Item = Vec3>) -> Vec<PopCause> {
    steps(ik, cursors).into_iter().filter_map(|step| step.pop).collect()
}

/// There and back again.
fn line(from: Vec3, to: Vec3, steps: u16) -> impl Iterator<Item = Vec3> + Clone {
    let there = (0..=steps).chain((0..steps).rev());
    there.map(move |step| from.lerp(to, f32::from(step) / f32::from(steps)))
}

/// Past the vertical, about 4 degrees from it.
fn over_the_top() -> impl Iterator<Item = Vec3> + Clone {
    line(Vec3::new(150.0, 300.0, 20.0), Vec3::new(-150.0, 300.0, 20.0), 60)
}

#[test]
fn a_hand_that_passes_over_the_shoulder_pops_at_the_limbs_pole() {
    let pops = pops(arm(TwistReference::Up, 0.0), over_the_top());
    assert!(!pops.is_empty());
    let nearest = pops.iter().map(|pop| match pop {
        PopCause::Singular { nearest } => f64::from(*nearest),
        other => panic!("{other:?}"),
    });
    let nearest = nearest.fold(f64::INFINITY, f64::min);
    let expected = (20.0_f64 / 300.0).atan();
    assert!((nearest - expected).abs() < 1e-4, "{nearest}, not {expected}");
}

#[test]
fn the_same_pass_does_not_pop_with_stereographic_or_transport() {
    for reference in [map(), TwistReference::Transport] {
        assert_eq!(pops(arm(reference, 0.0), over_the_top()), [], "{reference:?}");
    }
}

#[test]
fn passing_the_pole_or_its_opposite_pops_there() {
    let pole = Vec3::new(100.0, 300.0, -100.0);
    let aside = pole.normalize().any_orthonormal_vector();
    for side in [1.0, -1.0] {
        let at = pole * side * 0.9 + pole.cross(aside).normalize() * 15.0;
        let pass = line(at - aside * 120.0, at + aside * 120.0, 50);
        let pops = pops(arm(TwistReference::Pole(pole), 0.0), pass.clone());
        let is_near =
            |pop: &PopCause| matches!(pop, PopCause::Singular { nearest } if *nearest < 0.5);
        assert!(!pops.is_empty() && pops.iter().all(is_near), "{side}: {pops:?}");
        let nearest = pops.iter().map(|pop| match pop {
            PopCause::Singular { nearest } => *nearest,
            _ => f32::INFINITY,
        });
        let expected = (15.0 / (0.9 * pole.length())).atan();
        assert!((nearest.fold(f32::INFINITY, f32::min) - expected).abs() < 1e-3, "{side}");
    }
}

#[test]
fn stereographic_pops_only_behind_and_transport_nowhere() {
    let behind = line(Vec3::new(-300.0, 60.0, 8.0), Vec3::new(-300.0, -60.0, 8.0), 40);
    let pops_of = |reference| pops(arm(reference, 0.0), behind.clone());
    let on_map = pops_of(map());
    let is_singular =
        |pop: &PopCause| matches!(pop, PopCause::Singular { nearest } if *nearest < 0.15);
    assert!(!on_map.is_empty() && on_map.iter().all(is_singular), "{on_map:?}");
    assert_eq!(pops_of(TwistReference::Transport), []);
    assert_eq!(pops_of(TwistReference::Up), []);
}

#[test]
fn a_hand_that_runs_into_the_outer_limit_pops_unless_it_is_soft() {
    let out = line(Vec3::new(420.0, 30.0, 0.0), Vec3::new(560.0, 40.0, 0.0), 28);
    let hard = pops(arm(map(), 0.0), out.clone());
    assert!(hard.len() >= 2 && hard.iter().all(|pop| *pop == PopCause::Straight), "{hard:?}");
    assert_eq!(pops(arm(map(), 0.25), out), []);
}

#[test]
fn a_hand_that_runs_into_the_inner_limit_pops_unless_it_is_soft() {
    let in_and_out = line(Vec3::new(170.0, 20.0, 0.0), Vec3::new(88.0, 10.0, 0.0), 28);
    let hard = pops(arm(map(), 0.0), in_and_out.clone());
    assert!(hard.len() >= 2 && hard.iter().all(|pop| *pop == PopCause::Folded), "{hard:?}");
    assert_eq!(pops(arm(map(), 0.25), in_and_out), []);
}

#[test]
fn a_cursor_that_passes_the_shoulder_pops_however_soft_the_arm_is() {
    let past = line(Vec3::new(95.0, 4.0, 7.0), Vec3::new(-95.0, 4.0, 7.0), 14);
    for softness in [0.0, 0.2, 0.9] {
        let pops = pops(arm(TwistReference::Transport, softness), past.clone());
        assert!(pops.contains(&PopCause::Shoulder), "{softness}: {pops:?}");
        let is_turn = |pop: &PopCause| matches!(pop, PopCause::Shoulder);
        assert!(pops.iter().all(is_turn), "{softness}: {pops:?}");
    }
}

#[test]
fn near_the_shoulder_the_pop_limit_stops_growing() {
    let bones = TwoBone::new(250.0, 250.0).expect("lengths");
    let limit = |distance: f32| {
        let ik = Ik { bones, ..arm(map(), 0.0) };
        let at = Vec3::X * distance;
        steps(ik, [at, at + Vec3::Y])[0].limit
    };
    assert_eq!([limit(10.0), limit(100.0), limit(125.0), limit(400.0)], [5.0, 5.0, 4.0, 2.0]);
}

#[test]
fn steps_within_rounding_are_ignored() {
    let x = Vec3::new(300.0, 0.0, 0.0);
    let found = |length: f32| steps(arm(map(), 0.0), [x, x + Vec3::Y * length]).len();
    assert_eq!([found(0.0), found(0.49), found(0.51)], [0, 0, 1]);
}

#[test]
fn every_input_change_except_the_cursors_has_its_own_name() {
    let ik = arm(TwistReference::Pole(Vec3::Y), 0.0);
    let moment = moments(ik, [Vec3::new(300.0, 50.0, 0.0)])[0];
    let before = PosedLimb { pinned_root: Some(Vec3::ZERO), influence: 0.5, ..moment };
    let with = |ik: Ik| PosedLimb { ik, ..before };
    let bones = TwoBone::new(200.0, 301.0).expect("lengths");
    let fk = Fk { bend: 1.25, ..before.fk };
    let changed = [
        (InputChange::Lengths, with(Ik { bones, ..ik })),
        (InputChange::TwistReference, with(Ik { reference: TwistReference::Up, ..ik })),
        (InputChange::Pole, with(Ik { reference: TwistReference::Pole(Vec3::X), ..ik })),
        (InputChange::SoftReach, with(Ik { soft_reach: soft(0.1), ..ik })),
        (InputChange::Influence, PosedLimb { influence: 0.25, ..before }),
        (InputChange::Angles, PosedLimb { fk, ..before }),
        (InputChange::Twist, PosedLimb { twist: 0.1, ..before }),
        (InputChange::Root, PosedLimb { pinned_root: Some(Vec3::Y), ..before }),
    ];
    assert_eq!(changed.map(|(change, _)| change), InputChange::ALL);
    for (change, after) in changed {
        assert_eq!(InputChange::between(&before, &after), Some(change));
    }
    assert_eq!(InputChange::between(&before, &before), None);
}

#[test]
fn settings_that_do_not_pose_the_arm_are_no_input_change() {
    let before = moments(arm(TwistReference::Up, 0.0), [Vec3::X])[0];
    let elsewhere = PosedLimb { cursor: Vec3::Y, ..before };
    let pinned = PosedLimb { pinned_root: Some(Vec3::Y), ..before };
    let turned = PosedLimb { fk: Fk { bend: 2.0, ..before.fk }, ..before };
    for after in [elsewhere, pinned, turned] {
        assert_eq!(InputChange::between(&before, &after), None);
    }
}

/// An independent arm with a twist reference in f64: the elbow by the law of cosines.
fn elbow(ik: &Ik, cursor: DVec3) -> DVec3 {
    let (upper, lower) = (f64::from(ik.bones.upper()), f64::from(ik.bones.lower()));
    let distance = cursor.length().clamp((upper - lower).abs(), upper + lower);
    let w = cursor.normalize();
    let cos = (upper * upper + distance * distance - lower * lower) / (2.0 * upper * distance);
    let towards = match ik.reference {
        TwistReference::Pole(pole) => pole.as_dvec3(),
        TwistReference::Stereographic(map) => {
            let k = (w - map.singular().as_dvec3()).cross(map.up().as_dvec3());
            k.cross(w)
        }
        _ => DVec3::Y,
    };
    let out = (towards - w * towards.dot(w)).normalize();
    w * (upper * cos) + out * (upper * (1.0 - cos * cos).max(0.0).sqrt())
}

fn cursors() -> impl Strategy<Value = Vec3> {
    (130.0..470.0_f64, -0.9..0.9_f64, -PI..PI).prop_map(|(distance, y, turn)| {
        let flat = (1.0 - y * y).sqrt();
        (DVec3::new(flat * turn.cos(), y, flat * turn.sin()) * distance).as_vec3()
    })
}

fn references() -> impl Strategy<Value = TwistReference> {
    prop_oneof![
        Just(TwistReference::Up),
        Just(TwistReference::Pole(Vec3::new(30.0, -250.0, 120.0))),
        Just(map()),
    ]
}

/// Returns whether the elbow is well-conditioned in f32 for this cursor.
fn is_well_conditioned(ik: &Ik, cursor: Vec3) -> bool {
    let pointer = Pointer::towards(cursor, Pointer::default());
    ik.reference.gain(pointer) < 10.0
}

proptest! {
    #![proptest_config(config(4000, 0x0009_0909))]

    #[test]
    fn the_ratio_is_that_of_the_same_arm_in_f64(
        reference in references(), from in cursors(), to in cursors()
    ) {
        let ik = arm(reference, 0.0);
        prop_assume!(is_well_conditioned(&ik, from) && is_well_conditioned(&ik, to));
        let (from64, to64) = (from.as_dvec3(), to.as_dvec3());
        let went = from64.distance(to64);
        let expected = elbow(&ik, from64).distance(elbow(&ik, to64)) / went;
        let step = steps(ik, [from, to])[0];
        let off = (f64::from(step.ratio) - expected).abs();
        prop_assert!(off < 1e-5 * 500.0 / went + 1e-6 * expected, "{} {expected}", step.ratio);
        // Both are reached, and farther out than a fifth of the outer limit.
        let limit = 2.0 * (200.0 / from64.length().min(to64.length())).max(1.0);
        prop_assert!((f64::from(step.limit) - limit).abs() < 1e-5, "{} {limit}", step.limit);
        prop_assert_eq!(step.pop.is_some(), step.ratio > step.limit);
    }

    #[test]
    fn turn_bend_and_swing_add_up_to_the_elbows_movement(
        reference in references(), softness in 0.0..0.9_f32, from in cursors(), to in cursors()
    ) {
        let moments = moments(arm(reference, softness), [from, to]);
        let step = ElbowStep::between(&moments[0], &moments[1]);
        prop_assume!(step.is_some());
        let step = step.expect("long enough");
        let moved = moments[1].pose.elbow - moments[0].pose.elbow;
        prop_assert!((step.turn + step.bend + step.swing).distance(moved) < 1e-3, "{step:?}");
    }

    #[test]
    fn an_arm_that_only_turns_has_no_swing_and_no_bend(from in cursors(), to in cursors()) {
        let to = to.normalize() * from.length();
        prop_assume!(from.distance(to) > 1.0 && from.dot(to) > -0.99 * from.dot(from));
        let step = steps(arm(TwistReference::Transport, 0.0), [from, to])[0];
        prop_assert!(step.swing.length() < 1e-3 && step.bend.length() < 1e-2, "{step:?}");
    }

    #[test]
    fn with_softness_one_quarter_no_arm_pops_at_either_limit(
        upper in 10.0..300.0_f32, lower in 10.0..300.0_f32, cursor in cursors(), count in 20..100_u16
    ) {
        let bones = TwoBone::new(upper, lower).expect("lengths");
        let ik = Ik { bones, reference: map(), soft_reach: soft(0.25) };
        let way = cursor.normalize();
        let (least, most) = (bones.inner_limit(), bones.outer_limit());
        let radial = line(way * least.max(1e-3 * most), way * (1.5 * most), count);
        prop_assert_eq!(pops(ik, radial), []);
    }

    #[test]
    fn where_stereographic_turns_slowly_a_soft_arm_does_not_pop(
        from in cursors(), to in cursors(), length in 1.0..40.0_f32
    ) {
        let from = Vec3::new(from.x.abs(), from.y, from.z);
        prop_assume!(from != to);
        let step = steps(arm(map(), 0.25), [from, from + (to - from).normalize() * length])[0];
        prop_assert_eq!(step.pop, None, "{:?}", step);
    }
}
