//! In a binary of its own, whose allocator counts.

#[path = "common/rigs.rs"]
mod rigs;

use allocation_counter::measure;
use ik_arm::kinematics::solve::{Method, Options, Solve};
use rigs::{Random, reachable, tree};

#[test]
fn iterations_after_the_first_allocate_nothing() {
    for method in Method::ALL.into_iter().filter(|method| *method != Method::TwoBone) {
        let mut random = Random(83);
        for is_limited in [false, true] {
            let (mut skeleton, tips) = tree(&mut random, 3, 1.0);
            for joint in 1..skeleton.joints().len() {
                let limits = [is_limited.then(|| random.limit()), None, None];
                skeleton.change(joint, |joint| joint.limits = limits).expect("limits");
            }
            let targets = reachable(&mut random, &skeleton, &tips);
            let options = Options { method, tolerance: Some(0.0), ..Options::default() };
            let mut solve = Solve::new(&skeleton, &targets, &options).expect("solve");
            solve.step();
            let counted = measure(|| {
                solve.run();
            });
            assert!(solve.report().iterations > 1);
            assert_eq!(counted.count_total, 0, "{method:?}, limits: {is_limited}");
        }
    }
}
