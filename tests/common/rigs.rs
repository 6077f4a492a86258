//! Random skeletons and targets, the same on every run.

// Each test, example and bench takes what it needs.
#![allow(dead_code)]

use std::f32::consts::PI;
use std::ops::Range;

use glam::{Affine3A, Mat3, Quat, Vec3};
use ik_arm::kinematics::chain_ik::TipTarget;
use ik_arm::kinematics::skeleton::{Joint, Limit, Skeleton};

/// SplitMix64.
pub struct Random(pub u64);

impl Random {
    pub fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    pub fn within(&mut self, range: Range<f32>) -> f32 {
        let share = (self.next() >> 40) as f32 / (1_u64 << 24) as f32;
        range.start + (range.end - range.start) * share
    }

    pub fn below(&mut self, bound: usize) -> usize {
        (self.next() % bound as u64) as usize
    }

    pub fn chance(&mut self, share: f32) -> bool {
        self.within(0.0..1.0) < share
    }

    pub fn vector(&mut self, size: f32) -> Vec3 {
        Vec3::from_array([(); 3].map(|()| self.within(-size..size)))
    }

    /// Uniform on the sphere.
    pub fn direction(&mut self) -> Vec3 {
        loop {
            let v = self.vector(1.0);
            if (0.01..1.0).contains(&v.length_squared()) {
                return v.normalize();
            }
        }
    }

    pub fn angles(&mut self) -> Vec3 {
        self.vector(PI)
    }

    pub fn rotation(&mut self) -> Mat3 {
        let Vec3 { x, y, z } = self.angles();
        Mat3::from_quat(Quat::from_euler(glam::EulerRot::ZYX, z, y, x))
    }

    pub fn limit(&mut self) -> Limit {
        let (min, max) = (self.within(-2.5..0.5), self.within(0.0..2.5));
        Limit { min, max: max.max(min) }
    }
}

/// A locked root and `joints` after each other, bones half to one and a half units long; straight
/// or crooked.
pub fn chain(random: &mut Random, joints: usize, unit: f32) -> Skeleton {
    let is_straight = random.chance(0.5);
    let mut skeleton = Skeleton::with_root("root");
    let mut offset = Vec3::ZERO;
    for index in 0..joints {
        let direction = if is_straight { Vec3::Y } else { random.direction() };
        let axis = direction * unit * random.within(0.5..1.5);
        let joint = Joint { offset, ..Joint::new(&format!("j{index}"), Some(index), axis) };
        skeleton.add(joint).expect("joint");
        offset = axis;
    }
    skeleton
}

/// A trunk that forks into `ends` branches of two to five joints, one after the other from any joint
/// before; one in five sits beside its parent's tip.
pub fn tree(random: &mut Random, ends: usize, unit: f32) -> (Skeleton, Vec<usize>) {
    let mut skeleton = chain(random, 2, unit);
    let mut tips = Vec::new();
    for _ in 0..ends {
        let mut parent = 1 + random.below(skeleton.joints().len() - 1);
        for _ in 0..2 + random.below(4) {
            parent = sprout(random, &mut skeleton, parent, unit);
        }
        tips.push(parent);
    }
    (skeleton, tips)
}

fn sprout(random: &mut Random, skeleton: &mut Skeleton, parent: usize, unit: f32) -> usize {
    let axis = random.direction() * unit * random.within(0.5..1.5);
    let tip = skeleton.joints()[parent].axis;
    let offset = if random.chance(0.2) { random.direction() * unit * 0.5 } else { tip };
    let name = skeleton.free_name("j");
    skeleton.add(Joint { offset, ..Joint::new(&name, Some(parent), axis) }).expect("joint")
}

/// Any forest that there can be: offsets, frames, limits, locked joints, points, several roots.
pub fn forest(random: &mut Random, joints: usize) -> Skeleton {
    let mut list = Vec::new();
    for index in 0..joints {
        let parent = (index > 0 && random.chance(0.9)).then(|| random.below(index));
        let axis = if random.chance(0.1) { Vec3::ZERO } else { random.vector(1.0) };
        let mut joint = Joint::new(&format!("j{index}"), parent, axis);
        joint.offset = random.vector(1.0);
        joint.rotation = random.angles();
        joint.locked = random.chance(0.15);
        if random.chance(0.5) {
            joint.frame = random.rotation();
        }
        for limit in &mut joint.limits {
            *limit = random.chance(0.2).then(|| random.limit());
        }
        list.push(joint);
    }
    Skeleton::from_joints(list).expect("forest")
}

/// Every joint that is not locked anywhere.
pub fn shake(random: &mut Random, skeleton: &mut Skeleton) {
    for joint in 0..skeleton.joints().len() {
        if !skeleton.joints()[joint].locked {
            skeleton.set_rotation(joint, random.angles()).expect("angles");
        }
    }
}

/// Where the tips are in some pose: together in reach.
pub fn reachable(random: &mut Random, skeleton: &Skeleton, tips: &[usize]) -> Vec<TipTarget> {
    let mut posed = skeleton.clone();
    shake(random, &mut posed);
    let target = |joint: &usize| TipTarget { joint: *joint, point: posed.tip(*joint), weight: 1.0 };
    tips.iter().map(target).collect()
}

/// Of bones and offsets, the root's own left out; the longest of these.
pub fn length(skeleton: &Skeleton, tips: &[usize]) -> f32 {
    let joints = skeleton.joints();
    let path = |tip: &usize| {
        let offsets: f64 = skeleton
            .ancestors(*tip)
            .filter(|joint| joints[*joint].parent.is_some())
            .map(|joint| joints[joint].offset.as_dvec3().length())
            .sum();
        (offsets + joints[*tip].axis.as_dvec3().length()) as f32
    };
    tips.iter().map(path).fold(0.0, f32::max)
}

/// Turned, moved, and scaled alike, unlike, or mirrored.
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
