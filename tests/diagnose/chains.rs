//! Targets of chains, on random rigs that have exactly one cause by construction.

use crate::common::Random;
use crate::common::skeletons::{chain, length, reachable, shake, transform, tree};
use glam::{Quat, Vec3};
use ik_arm::kinematics::chain_ik::{
    Method, Root, SolverOptions, Status, TipTarget, diagnose, solve,
};
use ik_arm::kinematics::diagnosis::{Boundary, Cause, Diagnosis, Remedy};
use ik_arm::kinematics::skeleton::{Joint, JointId, Limit, Skeleton};

use crate::{CASES, ENOUGH};

const ITERATIVE: [Method; 5] = [
    Method::TransposeFixed,
    Method::Transpose,
    Method::DampedLeastSquares,
    Method::Ccd,
    Method::Fabrik,
];

/// A skeleton with targets that it misses.
struct Rig {
    skeleton: Skeleton,
    targets: Vec<TipTarget>,
    options: SolverOptions,
}

impl Rig {
    fn new(skeleton: Skeleton, joint: JointId, point: Vec3, method: Method) -> Self {
        let targets = vec![target(joint, point)];
        Self { skeleton, targets, options: SolverOptions::new(method) }
    }

    /// Gives the rig a random transform; its targets move with it.
    fn moved(mut self, random: &mut Random) -> Self {
        let to_world = transform(random);
        self.skeleton.set_transform(to_world).expect("transform");
        for target in &mut self.targets {
            target.point = to_world.transform_point3(target.point);
        }
        self
    }

    fn stalls(&self) -> bool {
        let report = solve(&mut self.skeleton.clone(), &self.targets, &self.options);
        report.expect("solve").status == Status::Stalled
    }

    fn diagnose(&self) -> Vec<Diagnosis> {
        diagnose(&self.skeleton, &self.targets, &self.options).expect("diagnosis")
    }

    /// Length of the longest chain, in the world.
    fn reach(&self) -> f32 {
        let tips: Vec<_> = self.targets.iter().map(|target| target.joint).collect();
        let scale = self.skeleton.transform().matrix3.determinant().abs().cbrt();
        scale * length(&self.skeleton, &tips)
    }

    /// Distance of a joint's tip from its target after a remedy, by a solve of its own.
    fn residual_with(&self, remedy: &Remedy, joint: JointId) -> f32 {
        let (mut skeleton, mut targets, mut options) =
            (self.skeleton.clone(), self.targets.clone(), self.options);
        remedy.change_skeleton(&mut skeleton).expect("joints of the skeleton");
        remedy.change_targets(&mut targets);
        remedy.change_options(&mut options);
        solve(&mut skeleton, &targets, &options).expect("solve");
        let target = targets.iter().find(|target| target.joint == joint).expect("target");
        skeleton.tip(joint).distance(target.point)
    }
}

fn target(joint: JointId, point: Vec3) -> TipTarget {
    TipTarget { joint, point, weight: 1.0 }
}

/// Diagnoses rigs and counts those whose first cause is `cause`; checks the residuals of all remedies.
fn first_causes(cause: &str, mut rig: impl FnMut(&mut Random) -> Rig) {
    let mut random = Random(19);
    let mut others = Vec::new();
    let mut reached = 0;
    for case in 0..CASES {
        let rig = rig(&mut random);
        let found = rig.diagnose();
        assert!(!found.is_empty(), "case {case} of {cause} is reached");
        let first = &found[0];
        if first.cause.name() != cause {
            others.push((case, rig.options.method.name(), first.cause));
        }
        for diagnosis in &found {
            for tried in &diagnosis.remedies {
                let residual = rig.residual_with(&tried.remedy, diagnosis.target);
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

/// A chain of two to six joints after a locked root.
fn any_chain(random: &mut Random) -> (Skeleton, JointId) {
    let (joints, unit) = (2 + random.below(5), [1.0, 300.0][random.below(2)]);
    let skeleton = chain(random, joints, unit);
    (skeleton, JointId::new(joints))
}

#[test]
fn a_target_beyond_the_bones_is_out_of_reach() {
    first_causes("out_of_reach", |random| {
        let (mut skeleton, tip) = any_chain(random);
        shake(random, &mut skeleton);
        let distance = length(&skeleton, &[tip]) * random.within(1.02..4.0);
        let point = random.direction() * distance;
        let method = random.one_of(&ITERATIVE);
        let rig = Rig::new(skeleton, tip, point, method).moved(random);
        let found = &rig.diagnose()[0];
        if let Cause::OutOfReach { distance, longest, boundary, .. } = found.cause {
            assert!(distance > longest && boundary == Boundary::Bones);
        }
        rig
    });
}

#[test]
fn a_target_inside_the_hole_of_a_long_bone_is_out_of_reach() {
    first_causes("out_of_reach", |random| {
        let (mut skeleton, tip) = any_chain(random);
        let long = JointId::new(1 + random.below(tip.index()));
        let total = length(&skeleton, &[tip]);
        let axis = skeleton[long].axis.normalize() * 2.0 * total;
        skeleton.set_axis(long, axis).expect("axis");
        shake(random, &mut skeleton);
        let hole = 4.0 * total - length(&skeleton, &[tip]);
        let point = random.direction() * hole * random.within(0.1..0.97);
        Rig::new(skeleton, tip, point, random.one_of(&ITERATIVE)).moved(random)
    });
}

/// Distances from the base to the tip of two bones of these lengths that are bent by an angle.
fn bent_distance(upper: f32, lower: f32, angle: f32) -> f32 {
    (upper * upper + lower * lower + 2.0 * upper * lower * angle.cos()).sqrt()
}

/// Two bones in line after a root that turns freely; the second joint is a hinge about z from 0 to
/// `most`.
fn hinge(random: &mut Random, most: f32) -> (Skeleton, [f32; 2]) {
    let lengths = [random.within(0.5..2.0), random.within(0.5..2.0)];
    let mut skeleton = Skeleton::with_root("root");
    let upper = Joint::new("upper", Some(JointId::new(0)), Vec3::Y * lengths[0]);
    let upper = skeleton.add(upper).expect("joint");
    let fixed = Some(Limit { min: 0.0, max: 0.0 });
    let lower = Joint {
        offset: Vec3::Y * lengths[0],
        limits: [fixed, fixed, Some(Limit { min: 0.0, max: most })],
        ..Joint::new("lower", Some(upper), Vec3::Y * lengths[1])
    };
    skeleton.add(lower).expect("joint");
    (skeleton, lengths)
}

#[test]
fn a_target_nearer_than_an_elbow_may_bend_is_kept_off_by_limits() {
    first_causes("limits", |random| {
        let most = random.within(0.2..2.0);
        let (mut skeleton, [upper, lower]) = hinge(random, most);
        let rotation = random.angles();
        skeleton.set_rotation(JointId::new(1), rotation).expect("angles");
        let (least, nearest) = ((upper - lower).abs(), bent_distance(upper, lower, most));
        let distance = least + (nearest - least) * random.within(0.2..0.95);
        let point = random.direction() * distance;
        Rig::new(skeleton, JointId::new(2), point, random.one_of(&ITERATIVE)).moved(random)
    });
}

#[test]
fn a_target_nearer_than_a_stiff_chain_may_curl_is_kept_off_by_limits() {
    first_causes("limits", |random| {
        let joints = 3 + random.below(2);
        let mut skeleton = Skeleton::with_root("root");
        let mut offset = Vec3::ZERO;
        for index in 0..joints {
            let axis = Vec3::Y * random.within(0.5..1.5);
            let mut joint = Joint::new(&format!("j{index}"), Some(index.into()), axis);
            joint.offset = offset;
            if index > 0 {
                let most = random.within(0.02..0.09);
                joint.limits = [Some(Limit { min: -most, max: most }); 3];
            }
            skeleton.add(joint).expect("joint");
            offset = axis;
        }
        let tip = JointId::new(joints);
        let point = random.direction() * length(&skeleton, &[tip]) * random.within(0.5..0.8);
        Rig::new(skeleton, tip, point, random.one_of(&ITERATIVE)).moved(random)
    });
}

#[test]
fn a_target_that_a_locked_joint_forbids_is_kept_off_by_it() {
    first_causes("locked", |random| {
        let (mut skeleton, tip) = any_chain(random);
        // Half of the chains are in line, where no target pulls at the locked joints.
        if random.coin() {
            shake(random, &mut skeleton);
        }
        for joint in 2..=tip.index() {
            skeleton.change(joint.into(), |joint| joint.locked = true).expect("joint");
        }
        let distance = skeleton.tip(tip).distance(Vec3::ZERO);
        let reach = length(&skeleton, &[tip]);
        let at = loop {
            let at = random.within(0.3..0.95) * reach;
            if (at - distance).abs() > 0.1 * reach {
                break at;
            }
        };
        let hole = (2.0 * longest_bone(&skeleton) - reach).max(0.0);
        let at = at.max(hole * 1.05).min(0.98 * reach);
        let point = random.direction() * at;
        Rig::new(skeleton, tip, point, random.one_of(&ITERATIVE)).moved(random)
    });
}

fn longest_bone(skeleton: &Skeleton) -> f32 {
    skeleton.joints().iter().map(|joint| joint.axis.length()).fold(0.0, f32::max)
}

#[test]
fn targets_farther_apart_than_two_arms_span_conflict() {
    first_causes("conflict", |random| {
        let trunk = random.within(1.5..3.0);
        let arms = [random.within(0.4..1.0), random.within(0.4..1.0)];
        let mut skeleton = Skeleton::with_root("root");
        let trunk_joint = Joint::new("trunk", Some(JointId::new(0)), Vec3::Y * trunk);
        let trunk_joint = skeleton.add(trunk_joint).expect("joint");
        for (name, arm) in ["left", "right"].into_iter().zip(arms) {
            let joint = Joint::new(name, Some(trunk_joint), random.direction() * arm);
            skeleton.add(Joint { offset: Vec3::Y * trunk, ..joint }).expect("joint");
        }
        shake(random, &mut skeleton);
        let one = random.direction();
        let across = one.any_orthonormal_vector();
        // More than a right angle apart.
        let other = Quat::from_axis_angle(across, random.within(1.6..3.0)) * one;
        let targets = vec![
            target(JointId::new(2), one * (trunk + arms[0] * random.within(-0.5..0.9))),
            target(JointId::new(3), other * (trunk + arms[1] * random.within(-0.5..0.9))),
        ];
        let options = SolverOptions::new(random.one_of(&ITERATIVE));
        Rig { skeleton, targets, options }.moved(random)
    });
}

#[test]
fn a_solver_that_is_stopped_early_is_out_of_iterations() {
    first_causes("out_of_iterations", |random| {
        loop {
            let (mut skeleton, tips) = tree(random, 1, 1.0);
            shake(random, &mut skeleton);
            let targets = reachable(random, &skeleton, &tips);
            let options = SolverOptions::new(random.one_of(&ITERATIVE));
            let whole = solve(&mut skeleton.clone(), &targets, &options).expect("solve");
            if whole.status != Status::Converged || whole.iterations < 4 {
                continue;
            }
            let options = options.with_iterations(1 + random.below(2) as u32);
            return Rig { skeleton, targets, options }.moved(random);
        }
    });
}

/// A chain with limits and a target that it reaches within them, which a method misses.
fn missed(random: &mut Random) -> Rig {
    loop {
        let (mut skeleton, tip) = any_chain(random);
        for joint in 1..=tip.index() {
            let limits = [(); 3].map(|()| {
                let (min, max) = (random.within(-2.0..-0.1), random.within(0.1..2.0));
                random.chance(0.7).then_some(Limit { min, max })
            });
            skeleton.change(joint.into(), |joint| joint.limits = limits).expect("limits");
        }
        let targets = reachable(random, &skeleton, &[tip]);
        shake(random, &mut skeleton);
        let options = SolverOptions::new(random.one_of(&ITERATIVE));
        let rig = Rig { skeleton, targets, options }.moved(random);
        if rig.stalls() {
            return rig;
        }
    }
}

#[test]
fn a_solver_that_misses_a_target_within_the_limits_has_stalled() {
    first_causes("stalled", missed);
}

#[test]
fn a_joint_in_gimbal_lock_is_singular() {
    let mut tries = 0;
    first_causes("singular", |random| {
        loop {
            tries += 1;
            let rig = gimbal_locked(random).moved(random);
            if rig.stalls() {
                return rig;
            }
            assert!(tries < 10_000, "hardly any rig stalls");
        }
    });
    println!("{tries} rigs");
}

/// One bone at y = ±90°, where its angles x and z turn about one axis, with a target about the axis
/// that is lost.
fn gimbal_locked(random: &mut Random) -> Rig {
    let mut skeleton = Skeleton::with_root("root");
    let axis = random.direction() * random.within(0.5..2.0);
    let joint =
        Joint { frame: random.rotation(), ..Joint::new("bone", Some(JointId::new(0)), axis) };
    let bone = skeleton.add(joint).expect("joint");
    let right = core::f32::consts::FRAC_PI_2 * [1.0, -1.0][random.below(2)];
    let angles = Vec3::new(random.within(-3.0..3.0), right, random.within(-3.0..3.0));
    skeleton.set_rotation(bone, angles).expect("angles");
    let axes = [1, 2].map(|axis| skeleton[bone].rotation_axis(axis));
    let lost = axes[0].cross(axes[1]).normalize();
    let tip = axis.length() * random.direction().reject_from_normalized(lost).normalize();
    let axis = skeleton[bone].local_rotation().transpose() * tip;
    skeleton.set_axis(bone, axis).expect("axis");
    let point = Quat::from_axis_angle(lost, random.within(0.4..2.5)) * tip;
    Rig::new(skeleton, bone, point, random.one_of(&ITERATIVE[..3]))
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
    let targets = [target(JointId::new(3), Vec3::splat(100.0))];
    let options = SolverOptions::new(Method::Fabrik).with_root(Root::Free);
    assert_eq!(diagnose(&skeleton, &targets, &options), Ok(Vec::new()));
}

#[test]
fn a_locked_root_is_told_as_the_root_that_may_turn() {
    let joint = Joint::new("bone", None, Vec3::Y);
    let skeleton = Skeleton::from_joints(vec![joint]).expect("skeleton");
    let targets = [target(JointId::new(0), Vec3::X)];
    let options = SolverOptions::new(Method::Fabrik).with_root(Root::Locked);
    let found = diagnose(&skeleton, &targets, &options).expect("diagnosis");
    assert_eq!(found[0].cause, Cause::Locked);
    assert_eq!(found[0].remedies[0].remedy, Remedy::SetRoot(Root::Turns));
}
