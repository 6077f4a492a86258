//! Random rigs that miss their targets for exactly one cause, by construction.

use core::f32::consts::FRAC_PI_2;

use glam::{Quat, Vec3};
use ik_arm_kinematics::chain_ik::{ChainTarget, Method, SolverOptions, Status, solve};
use ik_arm_kinematics::skeleton::{Joint, JointId, Limit, RotationAxis, Skeleton};

use super::Random;
use super::skeletons::{ITERATIVE, chain, length, reachable, shake, target, transform, tree};

/// A skeleton with targets that it misses.
pub struct MissedTargets {
    pub skeleton: Skeleton,
    pub targets: Vec<ChainTarget>,
    pub options: SolverOptions,
}

impl MissedTargets {
    pub fn new(skeleton: Skeleton, joint: JointId, point: Vec3, method: Method) -> Self {
        let targets = vec![target(joint, point)];
        Self { skeleton, targets, options: SolverOptions::new(method) }
    }

    /// Gives the rig a random transform; its targets move with it.
    pub fn moved(mut self, random: &mut Random) -> Self {
        let to_world = transform(random);
        self.skeleton.set_transform(to_world).expect("transform");
        for target in &mut self.targets {
            target.point = to_world.transform_point3(target.point);
        }
        self
    }

    pub fn stalls(&self) -> bool {
        let report = solve(&mut self.skeleton.clone(), &self.targets, &self.options);
        report.expect("solve").status == Status::Stalled
    }

    /// Length of the longest chain, in the world.
    pub fn reach(&self) -> f32 {
        let tips: Vec<_> = self.targets.iter().map(|target| target.joint).collect();
        let scale = self.skeleton.transform().matrix3.determinant().abs().cbrt();
        scale * length(&self.skeleton, &tips)
    }
}

/// A chain of two to six joints after a locked root.
fn any_chain(random: &mut Random) -> (Skeleton, JointId) {
    let (joints, unit) = (2 + random.below(5), [1.0, 300.0][random.below(2)]);
    let skeleton = chain(random, joints, unit);
    (skeleton, JointId::new(joints))
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
        limits: [fixed, fixed, Some(Limit { min: 0.0, max: most })].into(),
        ..Joint::new("lower", Some(upper), Vec3::Y * lengths[1])
    };
    skeleton.add(lower).expect("joint");
    (skeleton, lengths)
}

fn longest_bone(skeleton: &Skeleton) -> f32 {
    skeleton.joints().iter().map(|joint| joint.axis.length()).fold(0.0, f32::max)
}

/// A chain with a target farther away than its bones are long.
pub fn too_far(random: &mut Random) -> MissedTargets {
    let (mut skeleton, tip) = any_chain(random);
    shake(random, &mut skeleton);
    let distance = length(&skeleton, &[tip]) * random.within(1.02..4.0);
    let point = random.direction() * distance;
    let method = random.one_of(&ITERATIVE);
    MissedTargets::new(skeleton, tip, point, method).moved(random)
}

/// A chain with one long bone and a target nearer to its base than the others fold back.
pub fn inside_a_hole(random: &mut Random) -> MissedTargets {
    let (mut skeleton, tip) = any_chain(random);
    let long = JointId::new(1 + random.below(tip.index()));
    let total = length(&skeleton, &[tip]);
    let axis = skeleton[long].axis.normalize() * 2.0 * total;
    skeleton.set_axis(long, axis).expect("axis");
    shake(random, &mut skeleton);
    let hole = 4.0 * total - length(&skeleton, &[tip]);
    let point = random.direction() * hole * random.within(0.1..0.97);
    MissedTargets::new(skeleton, tip, point, random.one_of(&ITERATIVE)).moved(random)
}

/// A hinged elbow with a target nearer than it may bend.
pub fn stiff_elbow(random: &mut Random) -> MissedTargets {
    let most = random.within(0.2..2.0);
    let (mut skeleton, [upper, lower]) = hinge(random, most);
    let rotation = random.angles();
    skeleton.set_rotation(JointId::new(1), rotation).expect("angles");
    let (least, nearest) = ((upper - lower).abs(), bent_distance(upper, lower, most));
    let distance = least + (nearest - least) * random.within(0.2..0.95);
    let point = random.direction() * distance;
    MissedTargets::new(skeleton, JointId::new(2), point, random.one_of(&ITERATIVE)).moved(random)
}

/// A chain of joints that hardly bend, with a target nearer than it may curl.
pub fn stiff_chain(random: &mut Random) -> MissedTargets {
    let joints = 3 + random.below(2);
    let mut skeleton = Skeleton::with_root("root");
    let mut offset = Vec3::ZERO;
    for index in 0..joints {
        let axis = Vec3::Y * random.within(0.5..1.5);
        let mut joint = Joint::new(&format!("j{index}"), Some(index.into()), axis);
        joint.offset = offset;
        if index > 0 {
            let most = random.within(0.02..0.09);
            joint.limits = [Some(Limit { min: -most, max: most }); 3].into();
        }
        skeleton.add(joint).expect("joint");
        offset = axis;
    }
    let tip = JointId::new(joints);
    let point = random.direction() * length(&skeleton, &[tip]) * random.within(0.5..0.8);
    MissedTargets::new(skeleton, tip, point, random.one_of(&ITERATIVE)).moved(random)
}

/// A chain of which only the first joint may turn, with a target at another distance.
pub fn locked(random: &mut Random) -> MissedTargets {
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
    MissedTargets::new(skeleton, tip, point, random.one_of(&ITERATIVE)).moved(random)
}

/// Two arms on a trunk, with targets farther apart than the arms span.
pub fn apart(random: &mut Random) -> MissedTargets {
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
    MissedTargets { skeleton, targets, options }.moved(random)
}

/// A chain whose solver is stopped after one or two iterations.
pub fn cut_short(random: &mut Random) -> MissedTargets {
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
        return MissedTargets { skeleton, targets, options }.moved(random);
    }
}

/// A chain with limits and a target that it reaches within them, which a method misses.
pub fn stalled(random: &mut Random) -> MissedTargets {
    loop {
        let (mut skeleton, tip) = any_chain(random);
        for joint in 1..=tip.index() {
            let limits = [(); 3].map(|()| {
                let (min, max) = (random.within(-2.0..-0.1), random.within(0.1..2.0));
                random.chance(0.7).then_some(Limit { min, max })
            });
            skeleton.change(joint.into(), |joint| joint.limits = limits.into()).expect("limits");
        }
        let targets = reachable(random, &skeleton, &[tip]);
        shake(random, &mut skeleton);
        let options = SolverOptions::new(random.one_of(&ITERATIVE));
        let rig = MissedTargets { skeleton, targets, options }.moved(random);
        if rig.stalls() {
            return rig;
        }
    }
}

/// One bone at y = ±90°, where its angles x and z turn about one axis, with a target about the axis
/// that is lost.
fn in_gimbal_lock(random: &mut Random) -> MissedTargets {
    let mut skeleton = Skeleton::with_root("root");
    let axis = random.direction() * random.within(0.5..2.0);
    let joint =
        Joint { frame: random.rotation(), ..Joint::new("bone", Some(JointId::new(0)), axis) };
    let bone = skeleton.add(joint).expect("joint");
    let right = FRAC_PI_2 * [1.0, -1.0][random.below(2)];
    let angles = Vec3::new(random.within(-3.0..3.0), right, random.within(-3.0..3.0));
    skeleton.set_rotation(bone, angles).expect("angles");
    let axes = [RotationAxis::Y, RotationAxis::Z].map(|axis| skeleton[bone].rotation_axis(axis));
    let lost = axes[0].cross(axes[1]).normalize();
    let tip = axis.length() * random.direction().reject_from_normalized(lost).normalize();
    let axis = skeleton[bone].local_rotation().transpose() * tip;
    skeleton.set_axis(bone, axis).expect("axis");
    let point = Quat::from_axis_angle(lost, random.within(0.4..2.5)) * tip;
    MissedTargets::new(skeleton, bone, point, random.one_of(&ITERATIVE[..3]))
}

/// A bone in gimbal lock that a method does not get out of.
pub fn gimbal_locked(random: &mut Random) -> MissedTargets {
    loop {
        let rig = in_gimbal_lock(random).moved(random);
        if rig.stalls() {
            return rig;
        }
    }
}
