//! Targets of chains, on random rigs that have exactly one cause by construction.

use glam::Vec3;
use ik_arm_kinematics::chain_ik::{ChainTarget, Method, Root, SolverOptions, diagnose, solve};
use ik_arm_kinematics::diagnosis::{Boundary, Cause, Remedy};
use ik_arm_kinematics::skeleton::{Joint, JointId, Skeleton};

use crate::common::Random;
use crate::common::missed_targets::{self, MissedTargets};
use crate::common::skeletons::{chain, reachable, shake, tree};
use crate::diagnose::{CASES, ENOUGH};

/// Distance of a joint's tip from its target after a remedy, by a solve of its own.
fn residual_with(rig: &MissedTargets, remedy: &Remedy, joint: JointId) -> f32 {
    let (mut skeleton, mut targets, mut options) =
        (rig.skeleton.clone(), rig.targets.clone(), rig.options);
    remedy.change_skeleton(&mut skeleton).expect("joints of the skeleton");
    remedy.change_targets(&mut targets);
    remedy.change_options(&mut options);
    solve(&mut skeleton, &targets, &options).expect("solve");
    let target = targets.iter().find(|target| target.joint == joint).expect("target");
    skeleton.tip(joint).distance(target.point)
}

/// Diagnoses rigs and counts those whose first cause is `cause`; checks the residuals of all
/// remedies.
fn first_causes(cause: &str, mut rig: impl FnMut(&mut Random) -> MissedTargets) {
    let mut random = Random(19);
    let mut others = Vec::new();
    let mut reached = 0;
    for case in 0..CASES {
        let rig = rig(&mut random);
        let found = diagnose(&rig.skeleton, &rig.targets, &rig.options).expect("diagnosis");
        assert!(!found.is_empty(), "case {case} of {cause} is reached");
        let first = &found[0];
        if first.cause.name() != cause {
            others.push((case, rig.options.method.name(), first.cause));
        }
        for diagnosis in &found {
            for tried in &diagnosis.remedies {
                let residual = residual_with(&rig, &tried.remedy, diagnosis.target);
                let told = tried.residual;
                assert!(
                    (residual - told).abs() <= 1e-3 * rig.reach(),
                    "{cause} {case}: {:?} leaves {residual}, not {told}",
                    tried.remedy
                );
                assert!(told < diagnosis.residual, "{:?} does not help", tried.remedy);
            }
        }
        let tolerance = 1.01e-4 * rig.reach();
        reached += usize::from(first.residual_with_remedy() <= tolerance);
    }
    let right = CASES - others.len();
    println!("{cause}: {right} of {CASES} right, {reached} remedied; others: {others:?}");
    assert!(right >= ENOUGH, "{right} of {CASES} are {cause}; others: {others:?}");
    assert!(reached >= ENOUGH, "{reached} of {CASES} remedies of {cause} reach the target");
}

#[test]
fn a_target_beyond_the_bones_is_out_of_reach() {
    first_causes("out_of_reach", missed_targets::too_far);
}

#[test]
fn a_target_inside_the_hole_of_a_long_bone_is_out_of_reach() {
    first_causes("out_of_reach", missed_targets::inside_a_hole);
}

#[test]
fn a_target_nearer_than_an_elbow_may_bend_is_kept_off_by_limits() {
    first_causes("limits", missed_targets::stiff_elbow);
}

#[test]
fn a_target_nearer_than_a_stiff_chain_may_curl_is_kept_off_by_limits() {
    first_causes("limits", missed_targets::stiff_chain);
}

#[test]
fn a_target_that_a_locked_joint_forbids_is_kept_off_by_it() {
    first_causes("locked", missed_targets::locked);
}

#[test]
fn targets_farther_apart_than_two_arms_span_conflict() {
    first_causes("conflict", missed_targets::apart);
}

#[test]
fn a_solver_that_is_stopped_early_is_out_of_iterations() {
    first_causes("out_of_iterations", missed_targets::cut_short);
}

#[test]
fn a_solver_that_misses_a_target_within_the_limits_has_stalled() {
    first_causes("stalled", missed_targets::stalled);
}

#[test]
fn a_joint_in_gimbal_lock_is_singular() {
    first_causes("singular", missed_targets::gimbal_locked);
}

#[test]
fn the_evidence_of_reach_are_the_lengths_of_the_bones() {
    let mut random = Random(6);
    for _ in 0..CASES {
        let rig = missed_targets::too_far(&mut random);
        let found = diagnose(&rig.skeleton, &rig.targets, &rig.options).expect("diagnosis");
        let Cause::OutOfReach { distance, longest, boundary, .. } = found[0].cause else {
            panic!("{:?}", found[0].cause)
        };
        assert!(distance > longest && boundary == Boundary::Bones);
        assert!((longest - rig.reach()).abs() <= 1e-5 * rig.reach(), "{longest} {}", rig.reach());
    }
}

#[test]
fn reached_targets_have_no_cause() {
    let mut random = Random(3);
    for _ in 0..CASES {
        let (mut skeleton, tips) = tree(&mut random, 2, 1.0);
        shake(&mut random, &mut skeleton);
        let targets = reachable(&mut random, &skeleton, &tips);
        let options = SolverOptions::new(Method::DampedLeastSquares);
        if solve(&mut skeleton.clone(), &targets, &options).expect("solve").converged() {
            assert_eq!(diagnose(&skeleton, &targets, &options), Ok(Vec::new()));
        }
    }
}

#[test]
fn a_free_root_puts_no_target_out_of_reach() {
    let mut skeleton = chain(&mut Random(5), 3, 1.0);
    skeleton.set_rotation(JointId::new(1), Vec3::splat(0.3)).expect("angles");
    let targets = [tip_target(JointId::new(3), Vec3::splat(100.0))];
    let options = SolverOptions::new(Method::Fabrik).with_root(Root::Free);
    assert_eq!(diagnose(&skeleton, &targets, &options), Ok(Vec::new()));
}

#[test]
fn a_locked_root_is_told_as_the_root_that_may_turn() {
    let joint = Joint::new("bone", None, Vec3::Y);
    let skeleton = Skeleton::from_joints(vec![joint]).expect("skeleton");
    let targets = [tip_target(JointId::new(0), Vec3::X)];
    let options = SolverOptions::new(Method::Fabrik).with_root(Root::Locked);
    let found = diagnose(&skeleton, &targets, &options).expect("diagnosis");
    assert_eq!(found[0].cause, Cause::Locked);
    assert_eq!(found[0].remedies[0].remedy, Remedy::SetRoot(Root::Turns));
}

fn tip_target(joint: JointId, point: Vec3) -> ChainTarget {
    ChainTarget::at(joint, point)
}
