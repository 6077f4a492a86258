//! Robot arms are asked for place and rotation of their flange: of random poses within their limits,
//! how many does each method reach, and in what time?
//!
//! Each pose is solved from the middle of the limits, alone and with up to fifty restarts from random
//! poses. Reached is 1e-4 of the arm's length and 1e-3 rad.
//! `cargo run --release --example robots -- 10000` takes 10,000 poses an arm.
//!
//! Dimensions are from the makers' data sheets. The protocol is that of P. Beeson, B. Ames, *TRAC-IK: An
//! open-source library for improved solving of generic inverse kinematics*, 2015.

use std::time::{Duration, Instant};

use glam::Quat;
use ik_arm_kinematics::chain_ik::{
    ChainSolver, ChainTarget, Method, OrientRefusal, Orientation, SolveError, SolverOptions,
};
use ik_arm_kinematics::skeleton::{Joint, JointId, Limit, RotationAxis, Skeleton, SkeletonError};

/// A hinge: where it is from the hinge before, its axis, and its limits in degrees.
type Hinge = ([f32; 3], RotationAxis, [f32; 2]);

/// An arm: its name, its hinges in the pose of zero angles, and the flange from the last one.
type Arm = (&'static str, &'static [Hinge], [f32; 3]);

use RotationAxis::{X, Y, Z};

const ARMS: [Arm; 4] = [
    (
        "Panda",
        &[
            ([0.0, 0.0, 0.333], Z, [-166.0, 166.0]),
            ([0.0, 0.0, 0.0], Y, [-101.0, 101.0]),
            ([0.0, 0.0, 0.316], Z, [-166.0, 166.0]),
            ([0.0825, 0.0, 0.0], Y, [4.0, 176.0]),
            ([-0.0825, 0.0, 0.384], Z, [-166.0, 166.0]),
            ([0.0, 0.0, 0.0], Y, [-215.0, 1.0]),
            ([0.088, 0.0, 0.0], Z, [-166.0, 166.0]),
        ],
        [0.0, 0.0, -0.107],
    ),
    (
        "iiwa14",
        &[
            ([0.0, 0.0, 0.36], Z, [-170.0, 170.0]),
            ([0.0, 0.0, 0.0], Y, [-120.0, 120.0]),
            ([0.0, 0.0, 0.0], Z, [-170.0, 170.0]),
            ([0.0, 0.0, 0.42], Y, [-120.0, 120.0]),
            ([0.0, 0.0, 0.0], Z, [-170.0, 170.0]),
            ([0.0, 0.0, 0.4], Y, [-120.0, 120.0]),
            ([0.0, 0.0, 0.0], Z, [-175.0, 175.0]),
        ],
        [0.0, 0.0, 0.126],
    ),
    (
        "UR5",
        &[
            ([0.0, 0.0, 0.089], Z, [-360.0, 360.0]),
            ([0.0, 0.0, 0.0], Y, [-360.0, 360.0]),
            ([0.425, 0.0, 0.0], Y, [-180.0, 180.0]),
            ([0.392, 0.0, 0.0], Y, [-360.0, 360.0]),
            ([0.0, 0.109, 0.0], Z, [-360.0, 360.0]),
            ([0.0, 0.0, -0.095], Y, [-360.0, 360.0]),
        ],
        [0.0, 0.082, 0.0],
    ),
    (
        "IRB120",
        &[
            ([0.0, 0.0, 0.0], Z, [-165.0, 165.0]),
            ([0.0, 0.0, 0.29], Y, [-110.0, 110.0]),
            ([0.0, 0.0, 0.27], Y, [-110.0, 70.0]),
            ([0.0, 0.0, 0.07], X, [-160.0, 160.0]),
            ([0.302, 0.0, 0.0], Y, [-120.0, 120.0]),
            ([0.0, 0.0, 0.0], X, [-400.0, 400.0]),
        ],
        [0.072, 0.0, 0.0],
    ),
];

const RESTARTS: usize = 50;

/// The arm with all hinges in the middle of their limits.
fn skeleton((_, hinges, flange): Arm) -> Result<Skeleton, SkeletonError> {
    let mut skeleton = Skeleton::with_root("base");
    let mut parent = JointId::new(0);
    for (index, (offset, axis, [min, max])) in hinges.iter().enumerate() {
        let next = hinges.get(index + 1).map_or(flange, |next| next.0);
        let mut joint = Joint::new(&format!("hinge {index}"), Some(parent), next.into());
        joint.offset = (*offset).into();
        for other in RotationAxis::ALL {
            joint.limits.set_range(other, Some(Limit { min: 0.0, max: 0.0 }));
        }
        let [min, max] = [min, max].map(|angle| angle.to_radians());
        joint.limits.set_range(*axis, Some(Limit { min, max }));
        joint.rotation[axis.index()] = 0.5 * (min + max);
        parent = skeleton.add(joint)?;
    }
    Ok(skeleton)
}

/// Numbers from 0 to 1, the same on every run.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f32 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        (self.0 >> 40) as f32 / (1_u64 << 24) as f32
    }

    /// A pose of an arm within its limits.
    fn pose(&mut self, skeleton: &Skeleton) -> Result<Skeleton, SkeletonError> {
        let mut posed = skeleton.clone();
        for (id, joint) in skeleton.iter() {
            let mut rotation = joint.rotation;
            for axis in RotationAxis::ALL {
                if let Some(Limit { min, max }) = joint.limits.range(axis) {
                    rotation[axis.index()] = min + (max - min) * self.next();
                }
            }
            posed.set_rotation(id, rotation)?;
        }
        Ok(posed)
    }
}

/// The target that a pose of an arm reaches.
fn target(posed: &Skeleton) -> ChainTarget {
    let hand = JointId::new(posed.joints().len() - 1);
    let rotation = Quat::from_mat3a(&posed.pose_in_skeleton().full(hand).matrix3);
    ChainTarget::at(hand, posed.tip(hand)).with_orientation(Orientation::Rotation(rotation))
}

/// Whether a pose is reached alone, and whether with restarts; and the time of the latter.
fn solve(
    skeleton: &Skeleton,
    target: ChainTarget,
    method: Method,
    random: &mut Random,
) -> Result<(bool, bool, Duration), SolveError> {
    let options = SolverOptions::new(method);
    let start = Instant::now();
    let mut solver = ChainSolver::new(skeleton, &[target], &options)?;
    let alone = solver.run().converged();
    let mut reached = alone;
    for _ in 0..RESTARTS {
        if reached {
            break;
        }
        let Ok(pose) = random.pose(skeleton) else { break };
        solver.begin_from(&pose);
        reached = solver.run().converged();
    }
    Ok((alone, reached, start.elapsed()))
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let poses: usize = std::env::args().nth(1).map_or(Ok(1000), |count| count.parse())?;
    println!(
        "{:8} {:16} {:>7} {:>9} {:>10} {:>9}",
        "arm", "method", "alone", "restarts", "median", "99 %"
    );
    for arm in ARMS {
        let skeleton = skeleton(arm)?;
        for method in Method::ALL {
            if method.refuses(OrientRefusal::Hinges) {
                continue;
            }
            let mut random = Random(38);
            let (mut alone, mut reached, mut times) = (0, 0, Vec::new());
            for _ in 0..poses {
                let target = target(&random.pose(&skeleton)?);
                let (first, last, time) = solve(&skeleton, target, method, &mut random)?;
                alone += usize::from(first);
                reached += usize::from(last);
                times.push(time);
            }
            times.sort_unstable();
            let percent = |count: usize| 100.0 * count as f64 / poses as f64;
            let [median, slow] =
                [poses / 2, poses * 99 / 100].map(|it| times[it].as_secs_f64() * 1e3);
            println!(
                "{:8} {:16} {:6.1}% {:8.1}% {median:7.3} ms {slow:6.2} ms",
                arm.0,
                method.name(),
                percent(alone),
                percent(reached)
            );
        }
    }
    Ok(())
}
