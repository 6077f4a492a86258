//! Steps of the methods that follow derivatives, against derivatives by finite differences in f64.

use std::f32::consts::PI;

use glam::{DVec3, Vec3};
use ik_arm_kinematics::chain_ik::{ChainSolver, ChainTarget, Method, SolverOptions};
use ik_arm_kinematics::skeleton::{JointId, Limit, RotationAxis, Skeleton};
use nalgebra::{DMatrix, DVector};

use crate::common::Random;
use crate::common::gradient::{angles_f64, to_skeleton_f64};
use crate::common::skeletons::{forest, space_f64, transform};

const CASES: usize = 300;

/// A problem with several targets near its pose, in f64 and in skeleton space.
struct Twin {
    skeleton: Skeleton,
    targets: Vec<ChainTarget>,
    angles: Vec<DVec3>,
}

impl Twin {
    /// Random trees with limits, locks, frames and bones without length, under a transform that may
    /// mirror and scale; targets are the tips of a pose nearby.
    fn random(random: &mut Random) -> Self {
        loop {
            let joints = 3 + random.below(9);
            let mut skeleton = forest(random, joints);
            skeleton.set_transform(transform(random)).expect("transform");
            for joint in skeleton.ids() {
                let limits = skeleton[joint].limits;
                let angle = |axis| match limits.range(axis) {
                    Some(Limit { min, max }) => min + (max - min) * random.within(0.1..0.9),
                    None => random.within(-PI..PI),
                };
                let angles = RotationAxis::ALL.map(angle);
                skeleton.set_rotation(joint, Vec3::from_array(angles)).expect("angles");
            }
            let mut near = skeleton.clone();
            for joint in skeleton.ids().filter(|joint| !skeleton[*joint].locked) {
                let angles = near[joint].rotation + random.vector(0.1);
                near.set_rotation(joint, angles).expect("angles");
            }
            let mut targets = Vec::new();
            for joint in skeleton.ids() {
                if random.chance(0.4) {
                    let weight = random.within(0.1..3.0);
                    targets.push(ChainTarget::at(joint, near.tip(joint)).with_weight(weight));
                }
            }
            let angles = angles_f64(&skeleton);
            if targets.len() > 1 {
                return Self { skeleton, targets, angles };
            }
        }
    }

    /// Weighted residuals √w (tip − target), with weights relative to the greatest.
    fn residuals(&self, angles: &[DVec3]) -> DVector<f64> {
        let to_skeleton = to_skeleton_f64(&self.skeleton);
        let each = self.targets.iter().zip(self.weights()).flat_map(|(target, weight)| {
            let axis = self.skeleton[target.joint].axis.as_dvec3();
            let tip = space_f64(&self.skeleton, target.joint, angles).transform_point3(axis);
            let point = to_skeleton.transform_point3(target.point.as_dvec3());
            ((tip - point) * weight.sqrt()).to_array()
        });
        DVector::from_iterator(3 * self.targets.len(), each)
    }

    fn weights(&self) -> Vec<f64> {
        let weights = self.targets.iter().map(|target| f64::from(target.weight));
        let heaviest = weights.clone().fold(0.0, f64::max);
        weights.map(|weight| weight / heaviest).collect()
    }

    fn cost(&self, angles: &[DVec3]) -> f64 {
        0.5 * self.residuals(angles).norm_squared()
    }

    /// Central difference of a function of all angles by each angle; 0 for angles that
    /// cannot change.
    fn differences<T>(&self, zero: T, of: impl Fn(&[DVec3]) -> T) -> Vec<T>
    where
        T: Clone + std::ops::Sub<Output = T> + std::ops::Div<f64, Output = T>,
    {
        const STEP: f64 = 1e-6;
        let mut angles = self.angles.clone();
        let mut all = Vec::new();
        for joint in self.skeleton.ids() {
            for about in RotationAxis::ALL {
                let axis = about.index();
                let mut at = |by: f64| {
                    angles[joint.index()][axis] = self.angles[joint.index()][axis] + by;
                    of(&angles)
                };
                let difference = (at(STEP) - at(-STEP)) / (2.0 * STEP);
                angles[joint.index()] = self.angles[joint.index()];
                let own = &self.skeleton[joint];
                let is_still = own.limits.is_fixed(about) || own.locked;
                all.push(if is_still { zero.clone() } else { difference });
            }
        }
        all
    }

    fn gradient(&self) -> Vec<f64> {
        self.differences(0.0, |angles| self.cost(angles))
    }

    /// Σ w r² in the bind pose over all joints that may turn.
    fn inertia(&self) -> f64 {
        let zero = vec![DVec3::ZERO; self.angles.len()];
        let space = |joint: JointId| space_f64(&self.skeleton, joint, &zero);
        let of_target = |(target, weight): (&ChainTarget, f64)| {
            let tip =
                space(target.joint).transform_point3(self.skeleton[target.joint].axis.as_dvec3());
            let turning =
                self.skeleton.ancestors(target.joint).filter(|id| !self.skeleton[*id].locked);
            let squares = turning.map(|id| tip.distance_squared(space(id).w_axis.truncate()));
            weight * squares.sum::<f64>()
        };
        self.targets.iter().zip(self.weights()).map(of_target).sum()
    }

    /// The angles after a step from the pose, clamped to limits.
    fn stepped(&self, step: &[f64]) -> Vec<DVec3> {
        let of_joint = |(id, angles): (JointId, &DVec3)| {
            let joint = &self.skeleton[id];
            let by = DVec3::from_slice(&step[3 * id.index()..]);
            if by == DVec3::ZERO {
                return *angles;
            }
            joint.limits.project((*angles + by).as_vec3()).as_dvec3()
        };
        self.skeleton.ids().zip(&self.angles).map(of_joint).collect()
    }

    /// The angles after one iteration of a solver.
    fn iterated(&self, options: SolverOptions) -> Vec<DVec3> {
        let options = options.with_tolerance(0.0);
        let mut solver = ChainSolver::new(&self.skeleton, &self.targets, &options).expect("solver");
        solver.step();
        let mut solved = self.skeleton.clone();
        solver.write(&mut solved);
        solved.joints().iter().map(|joint| joint.rotation.as_dvec3()).collect()
    }
}

fn farthest(one: &[DVec3], other: &[DVec3]) -> f64 {
    one.iter().zip(other).map(|(a, b)| (*a - *b).abs().max_element()).fold(0.0, f64::max)
}

#[test]
fn a_fixed_step_goes_along_the_gradient_of_the_cost() {
    let mut random = Random(89);
    let mut moved = 0;
    for _ in 0..CASES {
        let twin = Twin::random(&mut random);
        let (gradient, inertia) = (twin.gradient(), twin.inertia());
        // Angles beyond a few turns have fewer digits.
        if gradient.iter().any(|slope| slope.abs() > inertia) {
            continue;
        }
        let step: Vec<f64> = gradient.iter().map(|slope| -slope / inertia).collect();
        let off = farthest(
            &twin.iterated(SolverOptions::new(Method::TransposeFixed)),
            &twin.stepped(&step),
        );
        assert!(off <= 3e-6, "{off}");
        moved += usize::from(farthest(&twin.angles, &twin.stepped(&step)) > 1e-3);
    }
    assert!(moved > CASES / 2, "{moved}");
}

#[test]
fn the_first_variable_step_is_the_fixed_step_or_a_half_of_it_or_less() {
    let mut random = Random(97);
    let mut moved = 0;
    for _ in 0..CASES {
        let twin = Twin::random(&mut random);
        let (gradient, inertia) = (twin.gradient(), twin.inertia());
        // Angles beyond a few turns have fewer digits.
        if gradient.iter().any(|slope| slope.abs() > inertia) {
            continue;
        }
        let seen = twin.iterated(SolverOptions::new(Method::Transpose));
        let halved = |halvings: i32| {
            let step: Vec<f64> =
                gradient.iter().map(|slope| -slope / inertia * 0.5_f64.powi(halvings)).collect();
            farthest(&seen, &twin.stepped(&step))
        };
        let off = (0..6).map(halved).fold(f64::INFINITY, f64::min);
        assert!(off <= 3e-6, "{off}");
        moved += usize::from(farthest(&twin.angles, &seen) > 1e-3);
    }
    assert!(moved > CASES / 2, "{moved}");
}

#[test]
fn damped_least_squares_takes_the_step_of_its_equation() {
    const DAMPING: f64 = 0.5;
    let mut random = Random(101);
    let mut moved = 0;
    for _ in 0..CASES {
        let twin = Twin::random(&mut random);
        let residuals = twin.residuals(&twin.angles);
        let zero = DVector::zeros(residuals.len());
        let columns = twin.differences(zero, |angles| twin.residuals(angles));
        let jacobian = DMatrix::from_columns(&columns);
        let tips: Vec<_> = twin.targets.iter().map(|target| target.joint).collect();
        let length = f64::from(crate::common::skeletons::length(&twin.skeleton, &tips));
        // Longer residuals would be clamped.
        let is_clamped = |(row, weight): (&[f64], f64)| {
            DVec3::from_slice(row).length() > 0.29 * length * weight.sqrt()
        };
        if residuals.as_slice().chunks(3).zip(twin.weights()).any(is_clamped) {
            continue;
        }
        let seen = twin.iterated(SolverOptions::new(Method::DampedLeastSquares).with_damping(0.5));
        let off = (0..6).map(|raised| {
            let damping = DAMPING * length * 4.0_f64.powi(raised);
            let square = &jacobian * jacobian.transpose()
                + DMatrix::identity(residuals.len(), residuals.len()) * damping.powi(2);
            let forces = square.cholesky().expect("positive").solve(&residuals);
            let step = -(jacobian.transpose() * forces);
            farthest(&seen, &twin.stepped(step.as_slice()))
        });
        let off = off.fold(f64::INFINITY, f64::min);
        assert!(off <= 1e-5, "{off}");
        moved += usize::from(farthest(&twin.angles, &seen) > 1e-3);
    }
    assert!(moved > CASES / 3, "{moved}");
}
