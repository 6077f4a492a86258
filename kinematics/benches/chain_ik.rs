//! Time of a solver run by each method, from bind poses to reachable targets, and time of
//! one iteration.

#[path = "../tests/common/mod.rs"]
mod common;

use core::hint::black_box;

use common::Random;
use common::skeletons::{chain, reachable};
use criterion::{BatchSize, BenchmarkId, Criterion, criterion_group, criterion_main};
use ik_arm_kinematics::chain_ik::{ChainSolver, ChainTarget, Method, SolverOptions, solve};
use ik_arm_kinematics::skeleton::{JointId, Skeleton};

const METHODS: [Method; 6] = [
    Method::TransposeFixed,
    Method::Transpose,
    Method::DampedLeastSquares,
    Method::Ccd,
    Method::Fabrik,
    Method::Relaxation,
];

/// Chains in their bind pose, each with a target from a random one.
fn cases(joints: usize) -> Vec<(Skeleton, [ChainTarget; 1])> {
    let mut random = Random(7);
    let case = |_| {
        let skeleton = chain(&mut random, joints, 1.0);
        let target = reachable(&mut random, &skeleton, &[JointId::new(joints)])[0];
        (skeleton, [target])
    };
    (0..64).map(case).collect()
}

/// Whole runs, setup and writing the skeleton included; tolerance 1e-4 of the chain's length.
fn whole(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("chain_ik");
    for joints in [2, 10, 30, 100] {
        let cases = cases(joints);
        for method in METHODS {
            let options = SolverOptions::new(method);
            let mut next = cases.iter().cycle();
            group.bench_function(BenchmarkId::new(method.name(), joints), |bencher| {
                bencher.iter_batched_ref(
                    || next.next().cloned(),
                    |case| {
                        let Some((skeleton, targets)) = case else { return };
                        let _ = black_box(solve(skeleton, black_box(&targets[..]), &options));
                    },
                    BatchSize::SmallInput,
                );
            });
        }
    }
    group.finish();
}

/// The first iteration without setup.
fn iteration(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("iteration");
    for joints in [10, 20, 40, 80] {
        let (skeleton, [mut target]) = cases(joints).swap_remove(0);
        target.point *= 0.5;
        for method in METHODS {
            let options = SolverOptions::new(method).with_tolerance(0.0);
            let Ok(solve) = ChainSolver::new(&skeleton, &[target], &options) else { continue };
            group.bench_function(BenchmarkId::new(method.name(), joints), |bencher| {
                bencher.iter_batched_ref(
                    || solve.clone(),
                    |solve| black_box(solve.step()),
                    BatchSize::SmallInput,
                );
            });
        }
    }
    group.finish();
}

criterion_group!(benches, whole, iteration);
criterion_main!(benches);
