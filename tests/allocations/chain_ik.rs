//! In a binary of its own, whose allocator counts.

use allocation_counter::measure;
use glam::Vec3;
use ik_arm::kinematics::batch::{
    ArmBatch, BatchBones, BatchPositions, BatchRotations, BatchTwist, Points, PointsMut,
    QuaternionsMut,
};
use ik_arm::kinematics::chain_ik::{ChainSolver, Method, SolverOptions};
use ik_arm::kinematics::skeleton::JointId;
use ik_arm::kinematics::two_bone::TwoBone;

use crate::common::Random;
use crate::common::skeletons::{limit, reachable, tree};

#[test]
fn iterations_after_the_first_allocate_nothing() {
    for method in Method::ALL.into_iter().filter(|method| *method != Method::TwoBone) {
        let mut random = Random(83);
        for is_limited in [false, true] {
            let (mut skeleton, tips) = tree(&mut random, 3, 1.0);
            for joint in 1..skeleton.joints().len() {
                let limits = [is_limited.then(|| limit(&mut random)), None, None];
                skeleton
                    .change(JointId::new(joint), |joint| joint.limits = limits.into())
                    .expect("limits");
            }
            let targets = reachable(&mut random, &skeleton, &tips);
            let options = SolverOptions::new(method).with_tolerance(0.0);
            let mut solve = ChainSolver::new(&skeleton, &targets, &options).expect("solve");
            solve.step();
            let counted = measure(|| {
                solve.run();
            });
            assert!(solve.report().iterations > 1);
            assert_eq!(counted.count_total, 0, "{method:?}, limits: {is_limited}");
        }
    }
}

#[test]
fn steps_of_a_track_after_the_first_allocate_nothing() {
    for method in Method::ALL.into_iter().filter(|method| *method != Method::TwoBone) {
        let mut random = Random(84);
        for is_limited in [false, true] {
            let (mut fk, tips) = tree(&mut random, 3, 1.0);
            for joint in (1..fk.joints().len()).map(JointId::new) {
                let limits = [is_limited.then(|| limit(&mut random)), None, None];
                fk.change(joint, |joint| joint.limits = limits.into()).expect("limits");
            }
            let mut targets = reachable(&mut random, &fk, &tips);
            let mut solver =
                ChainSolver::new(&fk, &targets, &SolverOptions::new(method)).expect("a solver");
            solver.run();
            let steps: Vec<_> = (0..20_u8)
                .map(|step| {
                    targets.iter_mut().for_each(|target| target.point += Vec3::splat(0.01));
                    let first = JointId::new(1);
                    let turned = fk[first].rotation + 0.01 * f32::from(step);
                    fk.set_rotation(first, turned).expect("finite");
                    fk.change(first, |joint| joint.axis *= 1.01).expect("finite");
                    (targets.clone(), fk.clone())
                })
                .collect();
            let (first, others) = steps.split_first().expect("steps");
            solver.track(&first.0, &first.1).expect("a step");
            let mut moved = 0.0;
            let counted = measure(|| {
                for (targets, fk) in others {
                    moved += solver.track(targets, fk).expect("a step").joint_motion;
                }
            });
            assert!(moved > 0.0);
            assert_eq!(counted.count_total, 0, "{method}, limits: {is_limited}");
        }
    }
}

#[test]
fn a_batch_allocates_nothing() {
    let arms = 10_000;
    let (cursor, angle) = (vec![100.0; arms], vec![1.0; arms]);
    let places = || [(); 3].map(|()| vec![0.0; arms]);
    let turns = || [(); 4].map(|()| vec![0.0; arms]);
    let (mut elbow, mut hand, mut upper, mut lower) = (places(), places(), turns(), turns());
    let counted = measure(|| {
        let bones = BatchBones::Same(TwoBone::new(200.0, 300.0).expect("lengths"));
        let points = Points { x: &cursor, y: &cursor, z: &cursor };
        let arms = ArmBatch::new(bones, points, BatchTwist::Angle(&angle)).expect("a batch");
        let places =
            BatchPositions { elbow: PointsMut::of(&mut elbow), hand: PointsMut::of(&mut hand) };
        let rotations = BatchRotations {
            upper: QuaternionsMut::of(&mut upper),
            lower: QuaternionsMut::of(&mut lower),
        };
        arms.solve(places, Some(rotations)).expect("room");
    });
    assert_eq!(counted.count_total, 0);
    assert_eq!(hand[0][arms - 1], 100.0);
}
