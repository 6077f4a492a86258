//! Centre of mass and support of a skeleton, against sums over slices and over all directions.

use std::f64::consts::PI;

use glam::{Affine3A, DVec3, Quat, Vec2, Vec3};
use ik_arm_kinematics::skeleton::{Balance, Joint, JointId, Skeleton};

use crate::common::Random;
use crate::common::skeletons::{chain, shake};

/// Volume and centre along x of the hull of two balls, summed over slices.
fn sliced(length: f64, base: f64, tip: f64) -> (f64, f64) {
    const SLICES: usize = 2000;
    let (start, end) = (-base, (length + tip).max(base));
    let width = (end - start) / SLICES as f64;
    let (mut volume, mut moment) = (0.0, 0.0);
    for slice in 0..SLICES {
        let x = start + (slice as f64 + 0.5) * width;
        let squared = |ball: usize| {
            let part = ball as f64 / SLICES as f64;
            (base + (tip - base) * part).powi(2) - (x - part * length).powi(2)
        };
        let area = PI * (0..=SLICES).map(squared).fold(0.0, f64::max);
        volume += area * width;
        moment += area * width * x;
    }
    (volume, moment / volume)
}

/// A chain with random radii in a random pose.
fn thick_chain(random: &mut Random, joints: usize) -> Skeleton {
    let mut skeleton = chain(random, joints, 1.0);
    for joint in skeleton.ids() {
        let radius = random.within(0.02..0.3);
        skeleton.change(joint, |joint| joint.radius = radius).expect("a radius");
    }
    shake(random, &mut skeleton);
    skeleton
}

#[test]
fn the_centre_of_mass_is_that_of_round_cones_summed_over_slices() {
    let mut random = Random(385);
    for case in 0..20 {
        let skeleton = thick_chain(&mut random, 3);
        let (mut total, mut moment) = (0.0, DVec3::ZERO);
        for (joint, it) in skeleton.iter() {
            let on_tip = skeleton.children(joint).map(|child| &skeleton.joints()[child.index()]);
            let radii = on_tip.filter(|child| child.offset == it.axis).map(|child| child.radius);
            let tip_radius = radii.fold(it.radius, f32::min);
            let length = f64::from(it.axis.length());
            let (volume, along) = sliced(length, f64::from(it.radius), f64::from(tip_radius));
            let [base, tip] = [skeleton.base(joint), skeleton.tip(joint)].map(Vec3::as_dvec3);
            total += volume;
            moment += volume * (base + (tip - base).normalize_or_zero() * along);
        }
        let centre = Balance::of(&skeleton).expect("mass").centre.as_dvec3();
        assert!(centre.distance(moment / total) < 1e-4, "{case}: {centre} {}", moment / total);
    }
}

#[test]
fn the_centre_of_mass_moves_turns_grows_and_mirrors_with_the_skeleton() {
    let mut random = Random(386);
    for case in 0..100 {
        let mut skeleton = thick_chain(&mut random, 6);
        let before = Balance::of(&skeleton).expect("mass").centre;
        let scale = Vec3::splat(random.within(0.2..4.0)) * Vec3::new(-1.0, 1.0, 1.0);
        let turn = Quat::from_axis_angle(random.direction(), random.within(-3.0..3.0));
        let shift = random.direction() * 3.0;
        let transform = Affine3A::from_scale_rotation_translation(scale, turn, shift);
        let old = skeleton.transform();
        skeleton.set_transform(transform * old).expect("a transform");
        let after = Balance::of(&skeleton).expect("mass").centre;
        assert!(after.distance(transform.transform_point3(before)) < 2e-5, "{case}: {after}");
    }
}

/// Adds a bone at the tip of another.
fn add(skeleton: &mut Skeleton, parent: JointId, axis: Vec3) -> JointId {
    let mut bone = Joint::new(&format!("{axis}"), Some(parent), axis);
    bone.offset = skeleton[parent].axis;
    skeleton.add(bone).expect("a bone")
}

#[test]
fn bones_without_radii_weigh_by_their_lengths() {
    let mut skeleton = Skeleton::with_root("root");
    let root = JointId::new(0);
    let long = add(&mut skeleton, root, Vec3::new(0.0, 3.0, 0.0));
    let short = add(&mut skeleton, long, Vec3::new(1.0, 0.0, 0.0));
    for joint in [root, long, short] {
        skeleton.change(joint, |joint| joint.radius = 0.0).expect("a radius");
    }
    let balance = Balance::of(&skeleton).expect("mass");
    // 3 at (0, 1.5) and 1 at (0.5, 3).
    assert!(balance.centre.distance(Vec3::new(0.125, 1.875, 0.0)) < 1e-6, "{balance:?}");
    assert_eq!(balance.support, [Vec2::ZERO], "the root is a point on the ground");
    assert!((balance.margin().expect("support") + 0.125).abs() < 1e-6, "{balance:?}");
    assert_eq!(Balance::of(&Skeleton::with_root("root")).and_then(|it| it.margin()), None);
}

#[test]
fn a_heel_stands_under_its_ankle_and_the_edge_is_as_far_as_in_every_direction() {
    const RADIUS: f32 = 0.02;
    let mut skeleton = Skeleton::with_root("root");
    let root = JointId::new(0);
    let shin = add(&mut skeleton, root, Vec3::new(0.0, -0.5, 0.0));
    let foot = add(&mut skeleton, shin, Vec3::new(0.0, -0.1, 0.25));
    skeleton.change(root, |joint| joint.offset.y = 0.6).expect("an offset");
    for joint in [root, shin, foot] {
        skeleton.change(joint, |joint| joint.radius = RADIUS).expect("a radius");
    }
    // The ankle is at the height 0.1, the toe and the heel on the ground.
    let balance = Balance::of(&skeleton).expect("mass");
    let mut random = Random(387);
    for case in 0..1000 {
        let angle = random.within(-3.0..3.0);
        let direction = Vec2::from_angle(angle);
        let farthest = balance.support.iter().map(|it| it.dot(direction)).fold(f32::MIN, f32::max);
        // Two discs, under the ankle and at the toe.
        let of_discs = (0.25 * direction.y).max(0.0) + RADIUS;
        let rim = RADIUS * (1.0 - (std::f32::consts::PI / 16.0).cos());
        assert!((farthest - of_discs).abs() <= rim + 1e-6, "{case}: {farthest} {of_discs}");
    }
    assert!(balance.margin().expect("it stands").abs() < 0.25);
}

#[test]
fn the_margin_is_the_distance_to_the_nearest_point_of_the_edge() {
    let mut random = Random(388);
    for case in 0..200 {
        let mut skeleton = thick_chain(&mut random, 5);
        let lowest = skeleton.pose().points().map(|point| point.y).fold(f32::MAX, f32::min);
        let down = Affine3A::from_translation(Vec3::new(0.0, -lowest, 0.0));
        let old = skeleton.transform();
        skeleton.set_transform(down * old).expect("a transform");
        let balance = Balance::of(&skeleton).expect("mass");
        let centre = balance.centre_on_ground();
        let along = |[from, to]: [Vec2; 2]| {
            (0..=500_u16).map(move |it| from.lerp(to, f32::from(it) / 500.0))
        };
        let edge = balance.edges().flat_map(along);
        let nearest = edge.map(|it| it.distance(centre)).fold(f32::MAX, f32::min);
        let margin = balance.margin().expect("the lowest point stands");
        assert!((margin.abs() - nearest).abs() < 1e-3, "{case}: {margin} {nearest}");
        // Inside, the corners surround the centre once; outside, they do not.
        let turns = balance.edges().map(|[from, to]| (from - centre).angle_to(to - centre));
        let turned: f32 = turns.sum();
        assert_eq!(margin > 0.0, turned.abs() > 1.0, "{case}: {margin} {turned}");
    }
}
