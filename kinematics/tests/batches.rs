//! Batches of arms: bit-identical to solving each arm alone, on all cores with the feature
//! `parallel` and on one without it.

mod common;

use glam::{DQuat, DVec3, Quat, Vec3};
use ik_arm_kinematics::batch::{
    ArmBatch, BatchArray, BatchBones, BatchError, BatchPositions, BatchRotations, BatchTwist,
    Points, PointsMut, QuaternionsMut,
};
use ik_arm_kinematics::fk;
use ik_arm_kinematics::rig::{self, CrowdArrays, Processor};
use ik_arm_kinematics::two_bone::TwoBone;

use common::Random;

/// A structure of arrays for the input and output of a batch.
struct Crowd {
    upper: Vec<f32>,
    lower: Vec<f32>,
    cursor: [Vec<f32>; 3],
    angle: Vec<f32>,
    cos: Vec<f32>,
    sin: Vec<f32>,
}

#[derive(Clone, PartialEq, Debug)]
struct Answer {
    elbow: [Vec<f32>; 3],
    hand: [Vec<f32>; 3],
    rotations: Option<[[Vec<f32>; 4]; 2]>,
}

impl Crowd {
    fn new(arms: impl Iterator<Item = (TwoBone, Vec3, f32)>) -> Self {
        let mut crowd = Self {
            upper: Vec::new(),
            lower: Vec::new(),
            cursor: Default::default(),
            angle: Vec::new(),
            cos: Vec::new(),
            sin: Vec::new(),
        };
        for (bones, cursor, angle) in arms {
            crowd.upper.push(bones.upper());
            crowd.lower.push(bones.lower());
            for (of, part) in crowd.cursor.iter_mut().zip(cursor.to_array()) {
                of.push(part);
            }
            crowd.angle.push(angle);
            crowd.cos.push(angle.cos());
            crowd.sin.push(angle.sin());
        }
        crowd
    }

    fn len(&self) -> usize {
        self.angle.len()
    }

    fn each(&self) -> BatchBones<'_> {
        BatchBones::Each { upper: &self.upper, lower: &self.lower }
    }

    fn turn(&self) -> BatchTwist<'_> {
        BatchTwist::CosSin { cos: &self.cos, sin: &self.sin }
    }

    fn points(&self) -> Points<'_> {
        let [x, y, z] = &self.cursor;
        Points { x, y, z }
    }

    fn arms(&self) -> ArmBatch<'_> {
        ArmBatch::new(self.each(), self.points(), self.turn()).expect("a batch")
    }

    fn bones(&self, arm: usize) -> TwoBone {
        TwoBone::new(self.upper[arm], self.lower[arm]).expect("lengths")
    }

    fn cursor(&self, arm: usize) -> Vec3 {
        point(&self.cursor, arm)
    }
}

impl Answer {
    fn none(arms: usize, turned: bool) -> Self {
        let of = || vec![f32::NAN; arms];
        let points = || [of(), of(), of()];
        let quaternions = || [of(), of(), of(), of()];
        Self {
            elbow: points(),
            hand: points(),
            rotations: turned.then(|| [quaternions(), quaternions()]),
        }
    }

    fn of(arms: &ArmBatch<'_>, turned: bool) -> Self {
        let mut answer = Self::none(arms.len(), turned);
        let (positions, rotations) = answer.room();
        arms.solve(positions, rotations).expect("room");
        answer
    }

    fn room(&mut self) -> (BatchPositions<'_>, Option<BatchRotations<'_>>) {
        let Self { elbow, hand, rotations } = self;
        let positions = BatchPositions { elbow: PointsMut::of(elbow), hand: PointsMut::of(hand) };
        let rotations = rotations.as_mut().map(|[upper, lower]| BatchRotations {
            upper: QuaternionsMut::of(upper),
            lower: QuaternionsMut::of(lower),
        });
        (positions, rotations)
    }

    fn append(&mut self, mut other: Self) {
        for (of, more) in self.arrays().into_iter().zip(other.arrays()) {
            of.append(more);
        }
    }

    fn arrays(&mut self) -> Vec<&mut Vec<f32>> {
        let Self { elbow, hand, rotations } = self;
        elbow.iter_mut().chain(hand).chain(rotations.iter_mut().flatten().flatten()).collect()
    }

    fn bits(&mut self) -> Vec<Vec<u32>> {
        self.arrays().into_iter().map(|of| of.iter().map(|x| x.to_bits()).collect()).collect()
    }
}

fn point(of: &[Vec<f32>; 3], arm: usize) -> Vec3 {
    Vec3::from_array([&of[0], &of[1], &of[2]].map(|of| of[arm]))
}

/// ArmBatch as they are posed: in reach, too far and too close.
fn plain(random: &mut Random) -> (TwoBone, Vec3, f32) {
    let mut length = || 10_f32.powf(random.within(-2.0..4.0));
    let bones = TwoBone::new(length(), length()).expect("lengths");
    let cursor = random.direction() * bones.outer_limit() * random.within(0.0..1.3);
    (bones, cursor, random.within(-7.0..7.0))
}

/// Numbers of any size in any array: most arms need the general solver.
fn any(random: &mut Random) -> (TwoBone, Vec3, f32) {
    let mut number = |least: f32, most: f32| match random.below(8) {
        0 => most,
        1 => least,
        2 => 1.0,
        _ => 2_f32.powf(random.within(-149.0..128.0)).clamp(least, most),
    };
    let bones = TwoBone::new(number(f32::from_bits(1), f32::MAX), number(1e-45, f32::MAX));
    let cursor = Vec3::new(number(0.0, f32::MAX), number(0.0, f32::MAX), number(0.0, f32::MAX));
    let signs = [(); 3].map(|()| if random.chance(0.5) { 1.0 } else { -1.0 });
    (bones.expect("lengths"), cursor * Vec3::from_array(signs), random.within(-100.0..100.0))
}

#[test]
fn a_batch_is_bit_identical_to_solving_each_arm_alone() {
    let mut random = Random(1);
    for kind in [plain, any] {
        for count in [0, 1, 7, 16, 17, 2_047, 2_048, 2_049, 10_000] {
            let crowd = Crowd::new((0..count).map(|_| kind(&mut random)));
            let by_turn = Answer::of(&crowd.arms(), false);
            let angles = BatchTwist::Angle(&crowd.angle);
            let by_angle = ArmBatch::new(crowd.each(), crowd.points(), angles).expect("a batch");
            for (answer, is_alone) in [(by_turn, false), (Answer::of(&by_angle, false), true)] {
                for arm in 0..count {
                    let alone = crowd.bones(arm).solve(crowd.cursor(arm), crowd.angle[arm]);
                    let turned_alike =
                        is_alone || crowd.angle[arm].sin_cos() == (crowd.sin[arm], crowd.cos[arm]);
                    assert!(turned_alike, "cosine and sine together are not those alone");
                    assert_eq!(bits(point(&answer.elbow, arm)), bits(alone.elbow), "{arm}");
                    assert_eq!(bits(point(&answer.hand, arm)), bits(alone.hand), "{arm}");
                }
            }
        }
    }
}

#[test]
fn shared_bone_lengths_are_bit_identical_to_lengths_per_arm() {
    let mut random = Random(2);
    for kind in [plain, any] {
        let (bones, _, _) = kind(&mut random);
        let crowd = Crowd::new((0..5_000).map(|_| {
            let (_, cursor, twist) = kind(&mut random);
            (bones, cursor, twist)
        }));
        let same =
            ArmBatch::new(BatchBones::Same(bones), crowd.points(), crowd.turn()).expect("a batch");
        for turned in [false, true] {
            let of_same = Answer::of(&same, turned).bits();
            assert_eq!(of_same, Answer::of(&crowd.arms(), turned).bits());
        }
    }
}

#[test]
fn splitting_a_batch_changes_no_bit() {
    let mut random = Random(3);
    let mut kinds = Random(4);
    // One arm in a thousand is not plain, so that some blocks are solved twice and others are not.
    let crowd = Crowd::new((0..20_000).map(|_| match kinds.below(1_000) {
        0 => any(&mut random),
        _ => plain(&mut random),
    }));
    for turned in [false, true] {
        let whole = Answer::of(&crowd.arms(), turned).bits();
        for longest in [3, 1_000, 5_000] {
            let mut parts = Answer::none(0, turned);
            let mut from = 0;
            while from < crowd.len() {
                let to = crowd.len().min(from + 1 + random.below(longest));
                let arms = ArmBatch::new(
                    BatchBones::Each {
                        upper: &crowd.upper[from..to],
                        lower: &crowd.lower[from..to],
                    },
                    Points {
                        x: &crowd.cursor[0][from..to],
                        y: &crowd.cursor[1][from..to],
                        z: &crowd.cursor[2][from..to],
                    },
                    BatchTwist::CosSin { cos: &crowd.cos[from..to], sin: &crowd.sin[from..to] },
                );
                parts.append(Answer::of(&arms.expect("a batch"), turned));
                from = to;
            }
            assert!(parts.bits() == whole, "in parts of at most {longest}");
        }
    }
}

#[cfg(feature = "parallel")]
#[test]
fn the_number_of_threads_changes_no_bit() {
    let mut random = Random(5);
    let crowd = Crowd::new((0..100_001).map(|_| plain(&mut random)));
    for turned in [false, true] {
        let whole = Answer::of(&crowd.arms(), turned).bits();
        for threads in [1, 2, 3, 7] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
            let mut answer = Answer::none(crowd.len(), turned);
            let (positions, rotations) = answer.room();
            pool.expect("threads")
                .install(|| crowd.arms().solve_on_all_cores(positions, rotations))
                .expect("room");
            assert!(answer.bits() == whole, "{threads} threads");
        }
    }
}

#[test]
fn hand_and_limb_errors_are_within_3e_7_of_the_arm_length() {
    let mut random = Random(6);
    let crowd = Crowd::new((0..100_000).map(|_| plain(&mut random)));
    let answer = Answer::of(&crowd.arms(), false);
    for arm in 0..crowd.len() {
        let [upper, lower] = [crowd.upper[arm], crowd.lower[arm]].map(f64::from);
        let length = upper + lower;
        let cursor = crowd.cursor(arm).as_dvec3();
        let (elbow, hand) =
            (point(&answer.elbow, arm).as_dvec3(), point(&answer.hand, arm).as_dvec3());
        let asked = cursor.length();
        let expected = cursor * (asked.clamp((upper - lower).abs(), length) / asked);
        let errors =
            [hand.distance(expected), elbow.length() - upper, elbow.distance(hand) - lower];
        for (what, error) in ["the hand", "the upper limb", "the lower limb"].iter().zip(errors) {
            assert!(error.abs() <= 3e-7 * length, "{what} of arm {arm} is off by {error:e}");
        }
    }
}

#[test]
fn rotations_agree_with_limb_positions_and_forward_kinematics() {
    let mut random = Random(7);
    let crowd = Crowd::new((0..20_000).map(|_| plain(&mut random)));
    let answer = Answer::of(&crowd.arms(), true);
    let [upper, lower] = answer.rotations.as_ref().expect("rotations");
    let mut worst = 0.0_f64;
    for arm in 0..crowd.len() {
        let [of_upper, of_lower] = [upper, lower]
            .map(|q| Quat::from_array([q[0][arm], q[1][arm], q[2][arm], q[3][arm]]).as_dquat());
        for rotation in [of_upper, of_lower] {
            assert!((rotation.length() - 1.0).abs() < 1e-6);
            assert!(rotation.w >= 0.0);
        }
        let bones = crowd.bones(arm);
        let [d1, d2] = [bones.upper(), bones.lower()].map(f64::from);
        let elbow = point(&answer.elbow, arm).as_dvec3();
        let hand = point(&answer.hand, arm).as_dvec3();
        let along = of_upper * DVec3::X * d1;
        assert!(along.distance(elbow) <= 1e-6 * (d1 + d2), "arm {arm}");
        let on = of_lower * DVec3::X * d2;
        assert!(on.distance(hand - elbow) <= 1e-6 * (d1 + d2), "arm {arm}");

        let pose = bones.solve(crowd.cursor(arm), crowd.angle[arm]);
        let (by_fk, lower_by_fk) = fk::limb_rotations(&pose);
        // The direction of a limb is less exact the shorter the limb is relative to the arm.
        for (mine, theirs, length) in [(of_upper, by_fk, d1), (of_lower, lower_by_fk, d2)] {
            let angle = mine.normalize().angle_between(DQuat::from_mat3(&theirs));
            let angle = angle.min((std::f64::consts::TAU - angle).abs());
            worst = worst.max(angle * length / (d1 + d2));
        }
    }
    assert!(worst <= 1e-6, "a limb's end is {worst:e} of the arm from where it should be");
}

#[test]
fn straight_and_folded_arms_and_cursors_without_a_direction_have_unit_rotations() {
    let bones = |upper, lower| TwoBone::new(upper, lower).expect("lengths");
    let cursors = [Vec3::ZERO, Vec3::X, -Vec3::X, Vec3::Y, -Vec3::Y, Vec3::Z, -Vec3::Z];
    let crowd = Crowd::new(cursors.into_iter().flat_map(|towards| {
        [0.1, 1.0, 2.0, 3.0, 4.0].into_iter().flat_map(move |far| {
            [(2.0, 1.0), (1.0, 2.0), (1.5, 1.5), (3.0, 1e-7), (3.0, 1e-45), (1e-30, 3.0)]
                .map(|(upper, lower)| bones(upper, lower))
                .into_iter()
                .flat_map(move |bones| [0.0, 1.0, 3.0].map(|twist| (bones, towards * far, twist)))
        })
    }));
    let answer = Answer::of(&crowd.arms(), true);
    for arm in 0..crowd.len() {
        for q in answer.rotations.as_ref().expect("rotations") {
            let q = DQuat::from_array([0, 1, 2, 3].map(|part| f64::from(q[part][arm])));
            assert!((q.length() - 1.0).abs() < 1e-6, "arm {arm}: {q}");
        }
    }
}

#[test]
fn invalid_arrays_are_refused_by_name() {
    let (three, two) = ([1.0; 3], [1.0; 2]);
    let bones = BatchBones::Same(TwoBone::new(2.0, 3.0).expect("lengths"));
    let cursor = Points { x: &three, y: &three, z: &three };
    let refused = |bones, cursor, twist| ArmBatch::new(bones, cursor, twist).expect_err("no batch");
    let len = |array| BatchError::Len { array, len: 2, arms: 3 };
    let turn = BatchTwist::CosSin { cos: &three, sin: &two };
    assert_eq!(
        refused(bones, Points { z: &two, ..cursor }, BatchTwist::Angle(&three)),
        len(BatchArray::CursorZ)
    );
    assert_eq!(refused(bones, cursor, BatchTwist::Angle(&two)), len(BatchArray::TwistAngle));
    assert_eq!(refused(bones, cursor, turn), len(BatchArray::TwistSin));
    let each = BatchBones::Each { upper: &three, lower: &two };
    assert_eq!(refused(each, cursor, BatchTwist::Angle(&three)), len(BatchArray::LowerLengths));
    let each = BatchBones::Each { upper: &three, lower: &[1.0, 0.0, f32::NAN] };
    assert_eq!(
        refused(each, cursor, BatchTwist::Angle(&three)).to_string(),
        "arm 1: lower length must be finite and above 0, got 0"
    );

    let arms = ArmBatch::new(bones, cursor, BatchTwist::Angle(&three)).expect("a batch");
    let mut answer = Answer::none(3, true);
    answer.rotations.as_mut().expect("rotations")[1][3].pop();
    let (positions, rotations) = answer.room();
    assert_eq!(arms.solve(positions, rotations), Err(len(BatchArray::LowerRotations)));
    assert!(answer.elbow[0][0].is_nan(), "nothing is solved then");
}

fn bits(v: Vec3) -> [u32; 3] {
    v.to_array().map(f32::to_bits)
}

#[test]
fn a_crowd_is_bit_identical_to_a_batch() {
    const ARMS: u32 = 5_000;
    let bones = TwoBone::new(200.0, 300.0).expect("lengths");
    let crowd = rig::Crowd { arms: ARMS, bones, time: 3.25, processor: Processor::Cpu };
    let mut arrays = CrowdArrays::default();
    arrays.resize(&crowd);
    arrays.set_targets(&crowd);
    arrays.solve(bones).expect("a batch");

    let [x, y, z] = &arrays.cursor;
    let twist = BatchTwist::CosSin { cos: &arrays.cos, sin: &arrays.sin };
    let arms = ArmBatch::new(BatchBones::Same(bones), Points { x, y, z }, twist).expect("a batch");
    let [mut elbow, mut hand] = [(); 2].map(|()| [(); 3].map(|()| vec![0.0; ARMS as usize]));
    let positions =
        BatchPositions { elbow: PointsMut::of(&mut elbow), hand: PointsMut::of(&mut hand) };
    arms.solve(positions, None).expect("room");

    let bits = |of: &[Vec<f32>; 3]| {
        of.each_ref().map(|all| all.iter().map(|x| x.to_bits()).collect::<Vec<_>>())
    };
    assert_eq!(bits(&arrays.elbow), bits(&elbow));
    assert_eq!(bits(&arrays.hand), bits(&hand));
    assert!(hand.iter().flatten().any(|coordinate| *coordinate != 0.0));
}
