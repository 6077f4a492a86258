//! Random skeletons and targets, the same on every run.

use glam::{Affine3A, DMat3, DMat4, DVec3, Mat3, Vec3};
use ik_arm_kinematics::chain_ik::{ChainTarget, Effector, Method};
use ik_arm_kinematics::skeleton::{Joint, JointId, Limit, RotationAxis, Skeleton};

use super::Random;

/// All methods but the closed form, which needs two bones.
pub const ITERATIVE: [Method; 6] = [
    Method::TransposeFixed,
    Method::Transpose,
    Method::DampedLeastSquares,
    Method::Ccd,
    Method::Fabrik,
    Method::Relaxation,
];

/// A target of weight 1.
pub fn target(joint: JointId, point: Vec3) -> ChainTarget {
    ChainTarget::at(joint, point)
}

/// The point of its joint that a target brings to its place.
pub fn grip(target: &ChainTarget) -> Vec3 {
    match target.effector {
        Effector::Grip(point) => point,
        other => panic!("a grip, not {other:?}"),
    }
}

/// A locked root and a chain of `joints`, straight or crooked, with bones 0.5 to 1.5 units long.
pub fn chain(random: &mut Random, joints: usize, unit: f32) -> Skeleton {
    let is_straight = random.chance(0.5);
    let mut skeleton = Skeleton::with_root("root");
    let mut offset = Vec3::ZERO;
    for index in 0..joints {
        let direction = if is_straight { Vec3::Y } else { random.direction() };
        let axis = direction * unit * random.within(0.5..1.5);
        let joint = Joint { offset, ..Joint::new(&format!("j{index}"), Some(index.into()), axis) };
        skeleton.add(joint).expect("joint");
        offset = axis;
    }
    skeleton
}

/// A trunk and `ends` branches of two to five joints, each from any joint before it; one joint in
/// five is away from its parent's tip. Returns the skeleton and the last joint of each branch.
pub fn tree(random: &mut Random, ends: usize, unit: f32) -> (Skeleton, Vec<JointId>) {
    let mut skeleton = chain(random, 2, unit);
    let mut tips = Vec::new();
    for _ in 0..ends {
        let mut parent = JointId::new(1 + random.below(skeleton.joints().len() - 1));
        for _ in 0..2 + random.below(4) {
            parent = sprout(random, &mut skeleton, parent, unit);
        }
        tips.push(parent);
    }
    (skeleton, tips)
}

fn sprout(random: &mut Random, skeleton: &mut Skeleton, parent: JointId, unit: f32) -> JointId {
    let axis = random.direction() * unit * random.within(0.5..1.5);
    let tip = skeleton[parent].axis;
    let offset = if random.chance(0.2) { random.direction() * unit * 0.5 } else { tip };
    let name = skeleton.free_name("j");
    skeleton.add(Joint { offset, ..Joint::new(&name, Some(parent), axis) }).expect("joint")
}

/// Several trees with offsets, frames, limits, locked joints and bones of no length.
pub fn forest(random: &mut Random, joints: usize) -> Skeleton {
    let mut list = Vec::new();
    for index in 0..joints {
        let parent = (index > 0 && random.chance(0.9)).then(|| random.below(index).into());
        let axis = if random.chance(0.1) { Vec3::ZERO } else { random.vector(1.0) };
        let mut joint = Joint::new(&format!("j{index}"), parent, axis);
        joint.offset = random.vector(1.0);
        joint.rotation = random.angles();
        joint.locked = random.chance(0.15);
        if random.chance(0.5) {
            joint.frame = random.rotation();
        }
        for axis in RotationAxis::ALL {
            joint.limits.set_range(axis, random.chance(0.2).then(|| limit(random)));
        }
        list.push(joint);
    }
    Skeleton::from_joints(list).expect("forest")
}

pub fn limit(random: &mut Random) -> Limit {
    let (min, max) = (random.within(-2.5..0.5), random.within(0.0..2.5));
    Limit { min, max: max.max(min) }
}

/// Gives every joint that is not locked a random rotation.
pub fn shake(random: &mut Random, skeleton: &mut Skeleton) {
    for joint in skeleton.ids() {
        if !skeleton[joint].locked {
            skeleton.set_rotation(joint, random.angles()).expect("angles");
        }
    }
}

/// Targets that can all be reached at once: the tips of a random pose.
pub fn reachable(random: &mut Random, skeleton: &Skeleton, tips: &[JointId]) -> Vec<ChainTarget> {
    let mut posed = skeleton.clone();
    shake(random, &mut posed);
    let target = |joint: &JointId| ChainTarget::at(*joint, posed.tip(*joint));
    tips.iter().map(target).collect()
}

/// X of a joint's own space in f64, from the formula, in skeleton space.
pub fn space_f64(skeleton: &Skeleton, joint: JointId, angles: &[DVec3]) -> DMat4 {
    let Joint { parent, offset, frame, .. } = &skeleton[joint];
    let above = parent.map_or(DMat4::IDENTITY, |parent| space_f64(skeleton, parent, angles));
    let DVec3 { x, y, z } = angles[joint.index()];
    let turned = DMat3::from_rotation_z(z) * DMat3::from_rotation_y(y) * DMat3::from_rotation_x(x);
    let frame = frame.as_dmat3();
    let rotation = frame * turned * frame.transpose();
    above * DMat4::from_translation(offset.as_dvec3()) * DMat4::from_mat3(rotation)
}

/// Length of the longest chain from a root to one of the tips, without the root's own offset.
pub fn length(skeleton: &Skeleton, tips: &[JointId]) -> f32 {
    let path = |tip: &JointId| {
        let offsets: f64 = skeleton
            .ancestors(*tip)
            .filter(|joint| skeleton[*joint].parent.is_some())
            .map(|joint| skeleton[joint].offset.as_dvec3().length())
            .sum();
        (offsets + skeleton[*tip].axis.as_dvec3().length()) as f32
    };
    tips.iter().map(path).fold(0.0, f32::max)
}

/// A rotation and a translation with no scale, an even, an uneven or a mirroring one.
pub fn transform(random: &mut Random) -> Affine3A {
    let scale = match random.below(4) {
        0 => Vec3::ONE,
        1 => Vec3::splat(random.within(0.1..10.0)),
        2 => Vec3::new(-1.0, 1.0, 1.0) * random.within(0.1..10.0),
        _ => Vec3::from_array([(); 3].map(|()| random.within(0.3..3.0))),
    };
    let turned = random.rotation() * Mat3::from_diagonal(scale);
    Affine3A::from_mat3_translation(turned, random.vector(10.0))
}
