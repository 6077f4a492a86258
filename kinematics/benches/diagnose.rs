//! Time to find out why a target is not reached, and of the solve that missed it, for rigs of each
//! cause.

#[path = "../tests/common/mod.rs"]
mod common;

use core::hint::black_box;

use common::Random;
use common::missed_targets::{self, MissedTargets};
use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use ik_arm_kinematics::chain_ik::{diagnose, solve};

type Cause = (&'static str, fn(&mut Random) -> MissedTargets);

const CAUSES: [Cause; 9] = [
    ("too_far", missed_targets::too_far),
    ("inside_a_hole", missed_targets::inside_a_hole),
    ("stiff_elbow", missed_targets::stiff_elbow),
    ("stiff_chain", missed_targets::stiff_chain),
    ("locked", missed_targets::locked),
    ("apart", missed_targets::apart),
    ("cut_short", missed_targets::cut_short),
    ("stalled", missed_targets::stalled),
    ("gimbal_locked", missed_targets::gimbal_locked),
];

/// Each measurement goes through the same 100 rigs.
fn causes(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("why");
    group.sample_size(10);
    for (name, rig) in CAUSES {
        let mut random = Random(19);
        let rigs: Vec<_> = (0..100).map(|_| rig(&mut random)).collect();
        group.bench_function(BenchmarkId::new("solve", name), |bencher| {
            bencher.iter(|| {
                for MissedTargets { skeleton, targets, options } in &rigs {
                    let _ = black_box(solve(&mut skeleton.clone(), targets, options));
                }
            });
        });
        group.bench_function(BenchmarkId::new("diagnose", name), |bencher| {
            bencher.iter(|| {
                for MissedTargets { skeleton, targets, options } in &rigs {
                    let _ = black_box(diagnose(skeleton, targets, options));
                }
            });
        });
    }
    group.finish();
}

criterion_group!(benches, causes);
criterion_main!(benches);
