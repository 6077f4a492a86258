//! Compares poses that a solver tracks from frame to frame with poses solved from the FK pose in
//! each frame by itself:
//!
//! ```text
//! cargo run --release --example tracking [joints=10] [chains=40] [frames=240]
//! ```
//!
//! The target of each chain moves twice along a circle and a figure eight in random planes, with a
//! frame each 1/120 s. The tables list, over all frames, the largest step of a joint over the step
//! of the target, which is 1 at best; frames that miss a target which a fresh solve reaches; and
//! the distance of the joints after the second loop from those after the first, in lengths of the
//! chain. Everything but the times is the same on every run.

#[path = "../tests/common/mod.rs"]
mod common;

use std::f32::consts::TAU;
use std::time::Instant;

use common::Random;
use common::skeletons::{chain, limit};
use glam::Vec3;
use ik_arm_kinematics::chain_ik::{
    ChainSolver, ChainTarget, Method, SolveError, SolverOptions, solve,
};
use ik_arm_kinematics::skeleton::{JointId, JointLimits, Skeleton, SkeletonPose};

/// A chain of length 1 in its FK pose, and the path of its target.
struct Motion {
    fk: Skeleton,
    tip: JointId,
    centre: Vec3,
    /// Axes of the path's plane, as long as its radii.
    axes: [Vec3; 2],
    is_eight: bool,
    frames: usize,
}

#[derive(Clone, Copy)]
struct Kind {
    title: &'static str,
    is_limited: bool,
    /// Distance of the path's centre from the root, in lengths of the chain.
    distance: f32,
}

const KINDS: [Kind; 4] = [
    Kind { title: "free, within reach", is_limited: false, distance: 0.5 },
    Kind { title: "limited, within reach", is_limited: true, distance: 0.5 },
    Kind { title: "free, partly out of reach", is_limited: false, distance: 0.9 },
    Kind { title: "limited, partly out of reach", is_limited: true, distance: 0.9 },
];

#[derive(Default)]
struct Figures {
    ratios: Vec<f32>,
    holonomies: Vec<f32>,
    frames: usize,
    lost: usize,
    seconds: f64,
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let argument = |name: &str, default: usize| {
        let prefix = format!("{name}=");
        let found = std::env::args().find_map(|it| it.strip_prefix(&prefix)?.parse().ok());
        found.unwrap_or(default)
    };
    let (joints, chains) = (argument("joints", 10), argument("chains", 40));
    let frames = argument("frames", 240);
    println!("{chains} chains of {joints} joints, {frames} frames a loop\n");
    for kind in KINDS {
        println!("### {}\n", kind.title);
        println!(
            "| solver | each frame by itself: median, 90 %, most | tracked: median, 90 %, most | \
                  above 4 % | lost % | loop 1→2, 90 % | µs a step |"
        );
        println!("| --- | --- | --- | ---: | ---: | ---: | ---: |");
        for method in Method::ALL.into_iter().filter(|it| *it != Method::TwoBone || joints == 2) {
            let mut random = Random(11);
            let (mut alone, mut tracked) = (Figures::default(), Figures::default());
            for index in 0..chains {
                let motion = Motion::new(&mut random, joints, kind, index % 2 == 1, frames);
                let options = SolverOptions::new(method);
                motion.solve_alone(&options, &mut alone)?;
                motion.track(&options, &mut tracked)?;
            }
            println!(
                "| {method} | {} | {} | {:.2} | {:.2} | {:.3} | {:.1} |",
                alone.quantiles(),
                tracked.quantiles(),
                tracked.share_above(4.0),
                100.0 * tracked.lost as f32 / tracked.frames as f32,
                quantile(&mut tracked.holonomies, 0.9),
                1e6 * tracked.seconds / tracked.frames as f64,
            );
        }
        println!();
    }
    Ok(())
}

impl Motion {
    fn new(random: &mut Random, joints: usize, kind: Kind, is_eight: bool, frames: usize) -> Self {
        let mut fk = chain(random, joints, 1.0);
        let tip = JointId::new(joints);
        let length: f32 = fk.joints().iter().map(|joint| joint.axis.length()).sum();
        for joint in (1..=joints).map(JointId::new) {
            fk.change(joint, |it| {
                it.rotation = 0.25 * random.angles();
                if kind.is_limited {
                    it.limits = JointLimits::new([(); 3].map(|()| Some(limit(random))));
                    it.rotation = it.limits.project(it.rotation);
                }
            })
            .expect("finite angles");
        }
        let centre = kind.distance * length * random.direction();
        let x = random.direction();
        let y = x.cross(random.direction()).normalize();
        let axes = [x, y].map(|axis| 0.25 * length * axis);
        Self { fk, tip, centre, axes, is_eight, frames }
    }

    fn target(&self, frame: usize) -> ChainTarget {
        let angle = TAU * (frame % self.frames) as f32 / self.frames as f32;
        let (sin, cos) = angle.sin_cos();
        let y = if self.is_eight { sin * cos } else { sin };
        let point = self.centre + cos * self.axes[0] + y * self.axes[1];
        ChainTarget::at(self.tip, point)
    }

    fn length(&self) -> f32 {
        self.fk.joints().iter().map(|joint| joint.axis.length()).sum()
    }

    /// Adds the ratio of the largest step of a joint to the step of the target.
    fn compare(&self, frame: usize, poses: [&SkeletonPose; 2], figures: &mut Figures) {
        let step = self.target(frame).point.distance(self.target(frame - 1).point);
        figures.ratios.push(farthest(poses) / step);
        figures.frames += 1;
    }

    /// Solves each frame from the FK pose.
    fn solve_alone(
        &self,
        options: &SolverOptions,
        figures: &mut Figures,
    ) -> Result<(), SolveError> {
        let mut last: Option<SkeletonPose> = None;
        for frame in 0..2 * self.frames {
            let mut posed = self.fk.clone();
            solve(&mut posed, &[self.target(frame)], options)?;
            let pose = posed.pose();
            if let Some(last) = &last {
                self.compare(frame, [last, &pose], figures);
            }
            last = Some(pose);
        }
        Ok(())
    }

    /// Tracks two loops.
    fn track(&self, options: &SolverOptions, figures: &mut Figures) -> Result<(), SolveError> {
        let mut solver = ChainSolver::new(&self.fk, &[self.target(0)], options)?;
        solver.run();
        let mut posed = self.fk.clone();
        solver.write(&mut posed);
        let (mut last, mut after_one) = (posed.pose(), None);
        for frame in 1..=2 * self.frames {
            let start = Instant::now();
            let step = solver.track(&[self.target(frame)], &self.fk)?;
            figures.seconds += start.elapsed().as_secs_f64();
            solver.write(&mut posed);
            let pose = posed.pose();
            self.compare(frame, [&last, &pose], figures);
            if !step.report.converged() {
                let mut fresh = self.fk.clone();
                let report = solve(&mut fresh, &[self.target(frame)], options)?;
                figures.lost += usize::from(report.converged());
            }
            if frame == self.frames {
                after_one = Some(pose.clone());
            }
            last = pose;
        }
        let after_one = after_one.unwrap_or_default();
        figures.holonomies.push(farthest([&after_one, &last]) / self.length());
        Ok(())
    }
}

impl Figures {
    fn quantiles(&mut self) -> String {
        let [median, most_of, most] = [0.5, 0.9, 1.0].map(|part| quantile(&mut self.ratios, part));
        format!("{median:.2}, {most_of:.2}, {most:.1}")
    }

    fn share_above(&self, ratio: f32) -> f32 {
        let above = self.ratios.iter().filter(|it| **it > ratio).count();
        100.0 * above as f32 / self.ratios.len() as f32
    }
}

/// Largest distance between a joint or a tip in two poses.
fn farthest([one, other]: [&SkeletonPose; 2]) -> f32 {
    let distances = one.points().zip(other.points()).map(|(one, other)| one.distance(other));
    distances.fold(0.0, f32::max)
}

fn quantile(values: &mut [f32], part: f32) -> f32 {
    values.sort_by(f32::total_cmp);
    let last = values.len().saturating_sub(1);
    values.get((part * last as f32) as usize).copied().unwrap_or_default()
}
