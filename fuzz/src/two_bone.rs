use core::f32::consts::{PI, TAU};

use glam::Vec3;
use ik_arm::kinematics::fk::{Fk, blended};
use ik_arm::kinematics::ik::{Ik, IkSolution, IkState};
use ik_arm::kinematics::soft_reach::SoftReach;
use ik_arm::kinematics::twist::{Stereographic, TransportedFrame, TwistReference};
use ik_arm::kinematics::two_bone::{Pointer, Reach, TwoBone, TwoBonePose};

use super::bits::Bits;
use super::job::job;

/// The arm and the job of two bones, of any numbers: invalid input is refused, and valid input
/// gives a finite pose with the right limb lengths and a hand that matches the reported reach.
pub fn two_bone(data: &[u8]) {
    let bits = &mut Bits::new(data);
    if bits.coin() {
        return job(bits);
    }
    let (Some(bones), Some(soft_reach)) = (bones(bits), soft_reach(bits)) else { return };
    let cursors = [bits.finite_vector(), bits.finite_vector()];
    let twist = bits.finite();
    plain(bones, cursors, twist);
    let ik = Ik { bones, reference: reference(bits), soft_reach };
    let solved = solved_on(ik, cursors, twist);
    found_again(ik, &solved);
    forward(bits, bones, &solved.pose);
}

fn bones(bits: &mut Bits<'_>) -> Option<TwoBone> {
    let lengths = [bits.number(), bits.number()];
    let bones = TwoBone::new(lengths[0], lengths[1]);
    assert_eq!(bones.is_ok(), lengths.iter().all(|length| length.is_finite() && *length > 0.0));
    bones.ok()
}

fn soft_reach(bits: &mut Bits<'_>) -> Option<SoftReach> {
    let (softness, max_stretch, angle) = match bits.byte() {
        0..64 => return Some(SoftReach::default()),
        64..128 => (bits.number(), bits.number(), bits.number()),
        128.. => (bits.part(), 1.0 + bits.part(), PI * bits.part()),
    };
    let soft_reach = SoftReach::new(softness, max_stretch, angle);
    let can_be = (0.0..1.0).contains(&softness)
        && (1.0..=f32::MAX).contains(&max_stretch)
        && (0.0..PI).contains(&angle);
    assert_eq!(soft_reach.is_ok(), can_be);
    soft_reach.ok()
}

fn reference(bits: &mut Bits<'_>) -> TwistReference {
    match bits.below(4) {
        0 => TwistReference::Up,
        1 => TwistReference::Pole(bits.finite_vector()),
        2 => {
            let map = Stereographic::new(bits.finite_vector(), bits.finite_vector());
            TwistReference::Stereographic(map.unwrap_or_default())
        }
        _ => TwistReference::Transport,
    }
}

/// The original arm, first without and then with an earlier pose.
fn plain(bones: TwoBone, [first, second]: [Vec3; 2], twist: f32) {
    let mut last = Pointer::default();
    for cursor in [first, second] {
        let pose = bones.solve_from(cursor, twist, last);
        is_whole(&pose);
        has_its_lengths(&pose, bones, EXACT);
        let (asked, hand) = (cursor.as_dvec3().length(), pose.hand.as_dvec3().length());
        let [inner, outer] = limits(bones);
        let bound = EXACT * outer + TINY;
        match pose.reach {
            Some(Reach::Reached) => {
                assert_eq!(pose.hand, cursor);
                assert!(inner - bound <= asked && asked <= outer + bound, "{pose:?}");
            }
            Some(Reach::TooFar) => assert!(asked >= outer - bound, "{pose:?}"),
            Some(Reach::TooClose) => {
                assert!(asked <= inner + bound && hand >= inner - bound, "{pose:?}");
            }
            None => panic!("no reach: {pose:?}"),
        }
        last = pose.pointer;
    }
}

/// The arm with all options, from one cursor to the next.
fn solved_on(ik: Ik, [first, second]: [Vec3; 2], twist: f32) -> IkSolution {
    let one = ik.solve(first, twist, IkState::default());
    let two = ik.solve(second, twist, one.state());
    for (cursor, solved) in [(first, one), (second, two)] {
        let IkSolution { pose, transported, slope } = solved;
        is_whole(&pose);
        is_frame(transported);
        let most = ik.soft_reach.max_stretch();
        assert!((0.0..=most).contains(&slope), "{slope}");
        assert!((1.0..=most).contains(&pose.stretch), "{pose:?}");
        assert!(ik.reference.gain(pose.pointer) >= 0.0);
        has_its_lengths(&pose, ik.bones.stretched(pose.stretch), 2.0 * EXACT);
        let missed = pose.hand.as_dvec3().distance(cursor.as_dvec3());
        let length = limits(ik.bones)[1] * f64::from(pose.stretch);
        let is_there = missed <= 3.0 * REACHED * length + TINY;
        assert!(
            pose.reach != Some(Reach::Reached) || is_there,
            "{cursor} is off by {missed}: {pose:?}"
        );
    }
    two
}

/// The cursor and the twist of a pose give the pose again.
fn found_again(ik: Ik, solved: &IkSolution) {
    let pose = &solved.pose;
    let (cursor, twist) = ik.matching(pose, Some(solved.transported));
    assert!(cursor.is_finite() && (0.0..TAU).contains(&twist), "{cursor}, {twist}");
    let again = ik.solve(cursor, twist, solved.state()).pose;
    is_whole(&again);
    let length = limits(ik.bones)[1] * f64::from(pose.stretch);
    if length <= LARGEST {
        // A cursor of the least numbers has few digits to say where it is.
        let coarse = TINY / cursor.as_dvec3().length().max(TINY);
        let off = again.hand.as_dvec3().distance(pose.hand.as_dvec3());
        let bound = (REACHED + coarse) * length + TINY;
        assert!(off <= bound, "off by {off}: {again:?}, not {pose:?}");
    }
}

/// Angles of a pose, the pose of any angles, and blends of the two.
fn forward(bits: &mut Bits<'_>, bones: TwoBone, pose: &TwoBonePose) {
    let last = Fk { shoulder: bits.finite_vector(), bend: bits.finite(), stretch: 1.0 };
    let fk = Fk::matching(pose, last);
    assert!(fk.shoulder.is_finite() && fk.bend.is_finite() && fk.stretch.is_finite(), "{fk:?}");
    let again = fk.pose(bones, pose.pointer);
    is_whole(&again);
    let length = limits(bones)[1] * f64::from(pose.stretch);
    if length <= LARGEST {
        let off = again.hand.as_dvec3().distance(pose.hand.as_dvec3());
        assert!(off <= REACHED * length + TINY, "off by {off}: {again:?}, not {pose:?}");
    }
    let any = last.pose(bones, pose.pointer);
    is_whole(&any);
    has_its_lengths(&any, bones, EXACT);
    let between = blended(last, pose, bits.number(), bones, pose.hand);
    is_whole(&between);
    let stretched = bones.stretched(between.stretch);
    has_its_lengths(&between, stretched, 2.0 * EXACT);
}

/// Of the length: of a hand and of a limb, and of a hand that is reached.
const EXACT: f64 = 3e-7;
const REACHED: f64 = 1e-6;
/// A few steps of subnormal numbers.
const TINY: f64 = 4.0 * f32::from_bits(1) as f64;
/// Largest f32; longer results are clamped to it.
const LARGEST: f64 = f32::MAX as f64;

/// |δ| and L.
fn limits(bones: TwoBone) -> [f64; 2] {
    let [upper, lower] = [bones.upper(), bones.lower()].map(f64::from);
    [(upper - lower).abs(), upper + lower]
}

fn is_whole(pose: &TwoBonePose) {
    let TwoBonePose { elbow, hand, distance, along, out, pointer, .. } = pose;
    assert!(elbow.is_finite() && hand.is_finite(), "{pose:?}");
    assert!(distance.is_finite() && along.is_finite() && out.is_finite(), "{pose:?}");
    assert!(*distance >= 0.0 && *out >= 0.0, "{pose:?}");
    assert!(pointer.direction.is_normalized() && pointer.heading.is_normalized(), "{pose:?}");
    assert!((0.0..=PI).contains(&pose.shoulder_angle()), "{pose:?}");
    let angles = [pose.yaw(), pose.pitch(), pose.elbow_angle(), pose.twist, pose.stretch];
    assert!(angles.into_iter().all(f32::is_finite), "{pose:?}");
}

fn is_frame(TransportedFrame { direction, outward }: TransportedFrame) {
    assert!(direction.is_normalized() && outward.is_normalized(), "{direction}, {outward}");
    assert!(direction.dot(outward).abs() < 1e-5, "{direction}, {outward}");
}

fn has_its_lengths(pose: &TwoBonePose, bones: TwoBone, exact: f64) {
    let [_, length] = limits(bones);
    if length > LARGEST {
        return;
    }
    let [elbow, hand] = [pose.elbow, pose.hand].map(Vec3::as_dvec3);
    let limbs = [(elbow.length(), bones.upper()), (elbow.distance(hand), bones.lower())];
    for (limb, rest) in limbs {
        let off = (limb - f64::from(rest)).abs();
        assert!(off <= exact * length + TINY, "{limb} is not {rest}: {pose:?}");
    }
}
