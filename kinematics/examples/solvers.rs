//! Prints success rate, time and error of each solver for random reachable targets:
//!
//! ```text
//! cargo run --release --example solvers
//! ```
//!
//! Everything but the times is the same on every run.

#[path = "../tests/common/mod.rs"]
mod common;

use std::time::Instant;

use common::Random;
use common::skeletons::{chain, length, reachable, shake, tree};
use ik_arm_kinematics::chain_ik::{ChainTarget, Method, Report, SolverOptions, solve};
use ik_arm_kinematics::skeleton::Skeleton;

/// Table columns, with one value per random case.
struct Outcome {
    report: Report,
    microseconds: f64,
    /// As a fraction of the chain's length.
    error: f32,
}

#[derive(Clone, Copy)]
enum Kind {
    Chain(usize),
    Tree(usize),
}

impl Kind {
    const ALL: [Self; 8] = [
        Self::Chain(2),
        Self::Chain(3),
        Self::Chain(10),
        Self::Chain(30),
        Self::Tree(2),
        Self::Tree(3),
        Self::Tree(4),
        Self::Tree(5),
    ];

    fn name(self) -> String {
        match self {
            Self::Chain(joints) => format!("chain of {joints}"),
            Self::Tree(targets) => format!("tree, {targets} targets"),
        }
    }

    /// A rig in its bind pose or any other, and targets that it can reach.
    fn case(self, random: &mut Random) -> (Skeleton, Vec<ChainTarget>) {
        let (mut skeleton, tips) = match self {
            Self::Chain(joints) => (chain(random, joints, 1.0), vec![joints.into()]),
            Self::Tree(targets) => tree(random, targets, 1.0),
        };
        let targets = reachable(random, &skeleton, &tips);
        if random.chance(0.5) {
            shake(random, &mut skeleton);
        }
        (skeleton, targets)
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    const CASES: usize = 1_000;
    println!("{CASES} random cases each; reached: within 1e-3 of the chain's length.\n");
    println!(
        "| solver | rig | reached % | within 1e-2 % | iterations (median) | (most) | µs (median) | \
         error (median) |"
    );
    println!("| --- | --- | ---: | ---: | ---: | ---: | ---: | ---: |");
    for method in Method::ALL {
        for kind in Kind::ALL {
            if method == Method::TwoBone && !matches!(kind, Kind::Chain(2)) {
                continue;
            }
            let mut random = Random(7);
            let outcomes: Result<Vec<_>, _> =
                (0..CASES).map(|_| outcome(method, kind.case(&mut random))).collect();
            print_row(method, kind, &outcomes?);
        }
    }
    Ok(())
}

fn outcome(
    method: Method,
    (mut skeleton, targets): (Skeleton, Vec<ChainTarget>),
) -> Result<Outcome, Box<dyn std::error::Error>> {
    let options = SolverOptions::new(method);
    let start = Instant::now();
    let report = solve(&mut skeleton, &targets, &options)?;
    let microseconds = start.elapsed().as_secs_f64() * 1e6;
    let tips: Vec<_> = targets.iter().map(|target| target.joint).collect();
    let error = report.error / length(&skeleton, &tips);
    Ok(Outcome { report, microseconds, error })
}

fn print_row(method: Method, kind: Kind, outcomes: &[Outcome]) {
    let within = |bound: f32| {
        let count = outcomes.iter().filter(|outcome| outcome.error <= bound).count();
        100.0 * count as f64 / outcomes.len() as f64
    };
    let most = outcomes.iter().map(|outcome| outcome.report.iterations).max().unwrap_or(0);
    println!(
        "| {} | {} | {:.1} | {:.1} | {} | {most} | {:.1} | {:.0e} |",
        method.name(),
        kind.name(),
        within(1e-3),
        within(1e-2),
        median(outcomes, |outcome| f64::from(outcome.report.iterations)),
        median(outcomes, |outcome| outcome.microseconds),
        median(outcomes, |outcome| f64::from(outcome.error)),
    );
}

fn median(outcomes: &[Outcome], of: impl Fn(&Outcome) -> f64) -> f64 {
    let mut values: Vec<_> = outcomes.iter().map(of).collect();
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(0.0)
}
