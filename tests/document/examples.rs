//! The examples with targets: each does what its sentence says, at every frame.

use std::collections::BTreeMap;

use glam::{DQuat, DVec2, DVec3, Vec3, Vec3Swizzles};
use ik_arm::document::{Channel, Document};
use ik_arm::io::Example;
use ik_arm::kinematics::limb_ik::Limb;
use ik_arm::kinematics::skeleton::{Joint, JointId, Skeleton, SkeletonPose};
use ik_arm::rig::{EvaluatedSkeleton, TargetSpace};

use crate::common::Random;

/// Length of the figure's legs and of its arms, without feet and hands.
const LEG: f32 = 0.84;
const ARM: f32 = 0.54;

fn opened(name: &str) -> Document {
    let opened = Example::find(name).expect("there").open().expect("opens");
    assert_eq!(opened.warnings, []);
    opened.document
}

fn evaluated(document: &Document, time: f64) -> EvaluatedSkeleton {
    document.at(time).evaluated_skeleton().clone()
}

/// The skeleton at a time, with its joints by name.
struct Posed {
    time: f64,
    skeleton: Skeleton,
    pose: SkeletonPose,
}

impl Posed {
    fn new(document: &Document, time: f64) -> Self {
        let skeleton = Skeleton::clone(&evaluated(document, time).solved);
        Self { time, pose: skeleton.pose(), skeleton }
    }

    /// The poses of the timeline, four for each frame.
    fn all(document: &Document) -> Vec<Self> {
        let (from, to) = (document.timeline.start, document.timeline.end);
        let step = 0.25 / document.timeline.frame_rate;
        let count = ((to - from) / step).round() as usize;
        (0..=count).map(|index| Self::new(document, from + index as f64 * step)).collect()
    }

    fn id(&self, name: &str) -> JointId {
        self.skeleton.find(name).expect("a joint")
    }

    fn joint(&self, name: &str) -> &Joint {
        &self.skeleton[self.id(name)]
    }

    fn base(&self, name: &str) -> Vec3 {
        self.pose.base(self.id(name))
    }

    fn tip(&self, name: &str) -> Vec3 {
        self.pose.tip(self.id(name))
    }

    /// Angle about +y of the axis from one joint's base to another's, in radians.
    fn heading(&self, from: &str, to: &str) -> f32 {
        let axis = self.base(to) - self.base(from);
        (-axis.z).atan2(axis.x)
    }
}

fn assert_within_limits(posed: &Posed) {
    for (_, joint) in posed.skeleton.iter() {
        let clamped = joint.limits.project(joint.rotation);
        assert!(clamped.distance(joint.rotation) < 1e-5, "{} at {} s", joint.name, posed.time);
    }
}

fn assert_all_in_picture(document: &Document, poses: &[Posed], aspect: f32) {
    let projection = document.camera.projection(aspect);
    for posed in poses {
        for point in posed.pose.points() {
            let seen = projection.project(point).expect("before the eye");
            assert!(
                seen.abs().max_element() < 0.97,
                "{point} at {} s is seen at {seen}",
                posed.time
            );
        }
    }
}

/// Pearson's correlation of two series.
fn correlation(one: &[f32], other: &[f32]) -> f32 {
    let mean = |of: &[f32]| of.iter().sum::<f32>() / of.len() as f32;
    let (a, b) = (mean(one), mean(other));
    let sum = |of: &dyn Fn(f32, f32) -> f32| -> f32 {
        one.iter().zip(other).map(|(x, y)| of(x - a, y - b)).sum()
    };
    sum(&|x, y| x * y) / (sum(&|x, _| x * x) * sum(&|_, y| y * y)).sqrt()
}

// Human

#[test]
fn the_human_stands_at_its_targets_by_its_own_angles() {
    let human = opened("human");
    let EvaluatedSkeleton { fk, solved, targets, body_refused, .. } = evaluated(&human, 0.0);
    assert_eq!(body_refused, None);
    for joint in fk.ids() {
        assert!(fk.tip(joint).distance(solved.tip(joint)) < 1e-5, "{}", fk[joint].name);
    }
    let ends = ["right_hand", "left_hand", "left_foot", "right_foot"];
    let [limbs @ .., look] = &human.rig.targets[..] else { panic!("targets") };
    assert_eq!((limbs.len(), targets.len()), (ends.len(), ends.len() + 1));
    assert_eq!(fk[look.joint].name, "head");
    assert!(look.aim.is_some() && look.has_free_place() && look.is_posing());
    assert!(human.rig.has_reached_all(&evaluated(&human, 0.0)));
    for (target, end) in limbs.iter().zip(ends) {
        let limb = Limb::for_end(&fk, fk.find(end).expect("a joint")).expect("a limb");
        assert_eq!((target.joint, target.influence), (limb.lower, 1.0), "{end}");
        assert!(target.limb().is_some() && target.enabled, "{end}");
    }
    let posed = Posed::new(&human, 0.0);
    for foot in ["left_foot", "right_foot"] {
        // The ball of the toes, of radius 0.0231, is on the floor.
        assert!((0.0231..0.025).contains(&posed.tip(foot).y), "{foot}");
    }
    assert_within_limits(&posed);
}

#[test]
fn the_humans_hands_and_feet_stay_when_its_pelvis_moves() {
    let mut human = opened("human");
    human.rig.body_follows = false;
    let mut random = Random(15);
    let before = Posed::new(&human, 0.0);
    let pelvis = before.id("pelvis");
    let home = before.base("pelvis");
    let mut reached = 0;
    for _ in 0..500 {
        let point = home + random.vector(0.1) - Vec3::Y * 0.1;
        Channel::Offset(pelvis).set(&mut human, point);
        Channel::Rotation(pelvis).set(&mut human, random.vector(0.15));
        let after = Posed::new(&human, 0.0);
        assert!(after.base("pelvis").distance(point) < 1e-6);
        for (end, top, within) in [
            ("left_hand", "left_upper_arm", 0.18..ARM),
            ("right_hand", "right_upper_arm", 0.18..ARM),
            ("left_foot", "left_thigh", 0.27..LEG),
            ("right_foot", "right_thigh", 0.27..LEG),
        ] {
            let place = before.base(end);
            if within.contains(&after.base(top).distance(place)) {
                let moved = after.base(end).distance(place);
                assert!(moved < 1e-5 * ARM, "{end} moves by {moved} with the pelvis at {point}");
                reached += 1;
            }
        }
        assert_within_limits(&after);
    }
    assert!(reached > 1_900, "{reached} of 2,000");
}

// Walk

/// Times and places of a foot's stands: as long as heel and toe are at the heights of a flat foot.
fn stands(poses: &[Posed], foot: &str) -> Vec<Vec<(f64, Vec3, Vec3)>> {
    let heights = |posed: &Posed| (posed.base(foot).y, posed.tip(foot).y);
    let lowest = poses.iter().map(|it| heights(it).0).fold(f32::MAX, f32::min);
    let is_flat = |posed: &&Posed| {
        let (heel, toe) = heights(posed);
        heel < lowest + 5e-4 && (heel - toe - 0.06).abs() < 5e-4
    };
    let parts = poses.chunk_by(|one, other| is_flat(&one) == is_flat(&other));
    let standing = parts.filter(|part| part.first().is_some_and(|it| is_flat(&it)));
    let place = |posed: &Posed| (posed.time, posed.base(foot), posed.tip(foot));
    standing.map(|part| part.iter().map(place).collect()).collect()
}

#[test]
fn standing_feet_stay_where_they_are() {
    let walk = opened("walk");
    let poses = Posed::all(&walk);
    for foot in ["left_foot", "right_foot"] {
        let stands = stands(&poses, foot);
        assert!(stands.len() >= 2, "{foot} stands {} times", stands.len());
        for stand in &stands {
            let ((from, heel, toe), (to, ..)) = (stand[0], stand[stand.len() - 1]);
            assert!(to - from > 0.25, "{foot} stands from {from} to {to} s");
            for (time, now_heel, now_toe) in stand {
                let moved = heel.distance(*now_heel).max(toe.distance(*now_toe));
                assert!(moved < 1e-3 * LEG, "{foot} slides by {moved} until {time} s");
            }
        }
        let places: Vec<f32> = stands.iter().map(|stand| stand[0].1.z).collect();
        let strides = places.windows(2).map(|pair| pair[1] - pair[0]);
        assert!(strides.into_iter().all(|stride| stride > 1.0), "{foot}: {places:?}");
    }
}

#[test]
fn toes_stay_while_the_heel_rises_and_no_foot_is_below_the_floor() {
    let poses = Posed::all(&opened("walk"));
    let mut rising = 0;
    for foot in ["left_foot", "right_foot"] {
        for pair in poses.windows(2) {
            let [toe, next] = [0, 1].map(|index: usize| pair[index].tip(foot));
            assert!(toe.y > 0.028, "{foot}: {toe} at {} s", pair[0].time);
            assert!(pair[0].base(foot).y > 0.089, "{foot} at {} s", pair[0].time);
            let is_rising = pair[1].base(foot).y > pair[0].base(foot).y + 1e-3;
            // Above, the toes leave the floor.
            if is_rising && pair[1].base(foot).y < 0.2 && toe.y < 0.031 {
                rising += 1;
                assert!(toe.distance(next) < 2e-3, "{foot} slips at {} s", pair[0].time);
            }
        }
    }
    assert!(rising > 40, "{rising}");
}

#[test]
fn each_foot_steps_at_least_twice_past_the_other_and_the_knees_stay_bent_forwards() {
    let poses = Posed::all(&opened("walk"));
    let leads = |posed: &Posed| posed.base("left_foot").z > posed.base("right_foot").z;
    let changes: Vec<bool> = poses
        .windows(2)
        .filter(|pair| leads(&pair[0]) != leads(&pair[1]))
        .map(|pair| leads(&pair[1]))
        .collect();
    for left in [true, false] {
        let steps = changes.iter().filter(|is_left| **is_left == left).count();
        assert!(steps >= 2, "{changes:?}");
    }
    for posed in &poses {
        assert_within_limits(posed);
        for side in ["left", "right"] {
            let knee = posed.joint(&format!("{side}_shin")).rotation.x.to_degrees();
            assert!((5.0..80.0).contains(&knee), "{side} knee {knee} at {} s", posed.time);
            let [hip, knee, ankle] =
                ["thigh", "shin", "foot"].map(|bone| posed.base(&format!("{side}_{bone}")));
            let along = (knee - hip).dot(ankle - hip) / (ankle - hip).length_squared();
            let forward = knee - hip.lerp(ankle, along);
            let aside = forward.x.abs() / forward.length();
            assert!(forward.z > 0.0 && aside < 0.4, "{side} knee: {aside} at {} s", posed.time);
        }
    }
}

#[test]
fn the_pelvis_travels_and_bobs_at_a_steady_pace() {
    let poses = Posed::all(&opened("walk"));
    let pelvis: Vec<Vec3> = poses.iter().map(|posed| posed.base("pelvis")).collect();
    let count = pelvis.len() - 1;
    let travel = pelvis[count].z - pelvis[0].z;
    assert!(travel > 1.0, "{travel}");
    for (index, point) in pelvis.iter().enumerate() {
        let steady = pelvis[0].z + travel * index as f32 / count as f32;
        assert!((point.z - steady).abs() < 0.01, "{} s: {point}", poses[index].time);
    }
    let heights = || pelvis.iter().map(|point| point.y);
    let bob = heights().fold(f32::MIN, f32::max) - heights().fold(f32::MAX, f32::min);
    assert!((0.02..0.06).contains(&bob), "{bob}");
}

#[test]
fn arms_swing_against_the_legs_and_the_shoulders_against_the_hips() {
    let walk = opened("walk");
    let poses = Posed::all(&walk);
    let ahead = |joint: &'static str| -> Vec<f32> {
        poses.iter().map(|posed| posed.base(joint).z - posed.base("pelvis").z).collect()
    };
    for (hand, foot) in [("left_hand", "left_foot"), ("right_hand", "right_foot")] {
        let (hand, foot) = (ahead(hand), ahead(foot));
        let swing = hand.iter().copied().fold(f32::MIN, f32::max)
            - hand.iter().copied().fold(f32::MAX, f32::min);
        assert!(swing > 0.25, "{swing}");
        let together = correlation(&hand, &foot);
        assert!(together < -0.8, "{together}");
    }
    let heading = |left, right| -> Vec<f32> {
        poses.iter().map(|posed| posed.heading(right, left)).collect()
    };
    let shoulders = heading("left_upper_arm", "right_upper_arm");
    let together = correlation(&shoulders, &heading("left_thigh", "right_thigh"));
    assert!(together < -0.8, "{together}");
    let posed: Vec<JointId> = walk.rig.targets.iter().map(|it| it.joint).collect();
    assert_eq!(posed, ["left_shin", "right_shin"].map(|name| poses[0].id(name)));
}

// Wheel

#[test]
fn both_hands_stay_on_the_turning_wheel() {
    let wheel = opened("wheel");
    let mut random = Random(2);
    let start = Posed::new(&wheel, 0.0);
    let joint = start.id("wheel");
    let rim: Vec<JointId> = start.skeleton.children(joint).collect();
    let mut turned = 0.0_f32;
    for _ in 0..50 {
        let time = f64::from(random.within(0.0..4.0));
        let posed = Posed::new(&wheel, time);
        for hand in ["left_hand", "right_hand"] {
            let wrist = posed.base(hand);
            for bone in &rim {
                let distance = |of: &Posed, point: Vec3| point.distance(of.pose.tip(*bone));
                let moved = distance(&posed, wrist) - distance(&start, start.base(hand));
                assert!(moved.abs() < 1e-5 * ARM, "{hand} moves by {moved} at {time} s");
            }
            let grips = rim.iter().map(|bone| {
                let middle = (posed.pose.base(*bone) + posed.pose.tip(*bone)) / 2.0;
                middle.distance((wrist + posed.tip(hand)) / 2.0)
            });
            let grip = grips.fold(f32::MAX, f32::min);
            assert!(grip < 0.06, "{hand} is {grip} from the rim at {time} s");
        }
        for foot in ["left_foot", "right_foot"] {
            assert!(posed.base(foot).distance(start.base(foot)) < 1e-5 * LEG, "{foot}");
        }
        assert_within_limits(&posed);
        turned = turned.max(posed.joint("wheel").rotation.z.abs());
    }
    assert!(turned.to_degrees() > 45.0, "{turned}");
    for target in &wheel.rig.targets[..2] {
        assert_eq!(target.space, TargetSpace::Joint(joint));
    }
}

// Hands and feet

#[test]
fn hands_and_feet_of_all_examples_turn_as_their_targets_ask() {
    let mut checked = 0;
    for example in Example::ALL {
        let document = opened(example.name);
        let (from, to) = (document.timeline.start, document.timeline.end);
        for step in 0..=24 {
            let time = from + (to - from) * f64::from(step) / 24.0;
            let rig = document.at(time).into_document().rig;
            for (target, report) in rig.targets.iter().zip(&rig.evaluate(time).targets) {
                let is_posed = target.is_posing() && !target.is_blended();
                assert!(
                    !is_posed || !report.misses_rotation(),
                    "{} at {time} s: {report:?}",
                    example.name
                );
                checked += usize::from(report.rotation_error.is_some());
            }
        }
    }
    assert!(checked > 200, "{checked}");
}

// Table

#[test]
fn the_hand_rests_flat_on_the_table_while_the_shoulder_moves() {
    const REACH: f32 = 0.6;
    let poses = Posed::all(&opened("table"));
    let start = &poses[0];
    // The slats' axes are 0.026 below the table's top, as is the hand's above it.
    let top = start.base("table").y + 0.026;
    assert!((start.base("palm").y - top - 0.026).abs() < 5e-3);
    assert!((start.tip("palm").y - start.base("palm").y).abs() < 1e-3, "it is flat");
    let mut moved = 0.0_f32;
    for posed in &poses {
        moved = moved.max(posed.base("shoulder").distance(start.base("shoulder")));
        assert!(posed.base("palm").distance(start.base("palm")) < 1e-5 * REACH);
        assert!(posed.tip("palm").distance(start.tip("palm")) < 1e-5 * REACH);
        assert!(posed.base("forearm").y > top + 0.034, "the elbow is above the table");
        assert_within_limits(posed);
    }
    assert!(moved > 0.3, "{moved}");
}

// Pictures

#[test]
fn the_cameras_show_the_whole_motion() {
    // The narrowest viewport of the window is about square, and lower above an open timeline.
    for (name, aspect) in [("walk", 1.2), ("wheel", 1.0), ("table", 1.0)] {
        let document = opened(name);
        assert_all_in_picture(&document, &Posed::all(&document), aspect);
    }
}

// The human's body

/// The volume inside some closed surfaces, counted once where they overlap: by rays along z through
/// a square grid.
fn volume(positions: &[Vec3], triangles: &[[u32; 3]]) -> f64 {
    const RAYS: u32 = 160;
    let corners = |triangle: &[u32; 3]| triangle.map(|it| positions[it as usize].as_dvec3());
    let used = || triangles.iter().flat_map(corners);
    let low = used().reduce(DVec3::min).expect("a triangle") - 1e-3;
    let high = used().reduce(DVec3::max).expect("a triangle") + 1e-3;
    let cell = (high - low) / f64::from(RAYS);
    let mut crossings: Vec<Vec<(f64, i32)>> = vec![Vec::new(); (RAYS * RAYS) as usize];
    for [a, b, c] in triangles.iter().map(corners) {
        let [from, to] = [a.min(b).min(c), a.max(b).max(c)].map(|it| (it - low) / cell);
        let twice = (b - a).truncate().perp_dot((c - a).truncate());
        for column in from.x as u32..=to.x as u32 {
            for row in from.y as u32..=to.y as u32 {
                // Not in the middle of a cell, where symmetric bodies have edges.
                let place = DVec2::new(f64::from(column) + 0.437, f64::from(row) + 0.561);
                let at = low.truncate() + place * cell.truncate();
                let part = |from: DVec3, to: DVec3| {
                    (from.truncate() - at).perp_dot(to.truncate() - at) / twice
                };
                let parts = [part(b, c), part(c, a), part(a, b)];
                if parts.iter().all(|part| *part > 0.0) {
                    let z = parts[0] * a.z + parts[1] * b.z + parts[2] * c.z;
                    let ray = (column * RAYS + row) as usize;
                    crossings[ray].push((z, if twice < 0.0 { 1 } else { -1 }));
                }
            }
        }
    }
    let inside = |ray: &mut Vec<(f64, i32)>| {
        ray.sort_unstable_by(|one, other| one.0.total_cmp(&other.0));
        let (mut depth, mut length) = (0, 0.0);
        for pair in ray.windows(2) {
            depth += pair[0].1;
            length += if depth > 0 { pair[1].0 - pair[0].0 } else { 0.0 };
        }
        length
    };
    crossings.iter_mut().map(inside).sum::<f64>() * cell.x * cell.y
}

/// The triangles of each connected piece of a mesh, in the order of their first vertices.
fn bodies(triangles: &[[u32; 3]]) -> Vec<Vec<[u32; 3]>> {
    let corners = || triangles.iter().flatten().map(|corner| *corner as usize);
    let mut first: Vec<usize> = (0..=corners().max().expect("a triangle")).collect();
    loop {
        let before = first.clone();
        for triangle in triangles.iter().map(|triangle| triangle.map(|corner| corner as usize)) {
            let least = triangle.map(|corner| first[corner]).into_iter().min().expect("three");
            triangle.into_iter().for_each(|corner| first[corner] = least);
        }
        if first == before {
            break;
        }
    }
    let mut bodies: BTreeMap<usize, Vec<[u32; 3]>> = BTreeMap::new();
    for triangle in triangles {
        bodies.entry(first[triangle[0] as usize]).or_default().push(*triangle);
    }
    bodies.into_values().collect()
}

#[test]
fn the_humans_limbs_keep_their_volume_when_they_bend() {
    let human = opened("human");
    let skin = human.rig.skin.as_ref().expect("a skin");
    let mesh = &skin.mesh().expect("a mesh").mesh;
    let bodies = bodies(&mesh.mesh().triangles);
    assert_eq!(bodies.len(), human.skeleton().joints().len(), "one for each joint, in their order");
    for (joint, axis, above) in [
        ("left_forearm", Vec3::NEG_X, "left_upper_arm"),
        ("right_shin", Vec3::X, "right_thigh"),
        ("left_thigh", Vec3::NEG_X, "pelvis"),
        ("right_upper_arm", Vec3::NEG_Z, "right_shoulder"),
    ] {
        let mut skeleton = Skeleton::clone(human.skeleton());
        skeleton.ids().for_each(|id| skeleton.set_rotation(id, Vec3::ZERO).expect("finite"));
        let find = |name: &str| human.skeleton().find(name).expect("a joint");
        let moved = |id: JointId| human.skeleton().ancestors(id).any(|it| it == find(joint));
        let is_shown = |id: JointId| moved(id) || id == find(above);
        let shown = bodies.iter().zip(human.skeleton().ids()).filter(|(_, id)| is_shown(*id));
        let triangles: Vec<[u32; 3]> = shown.flat_map(|(body, _)| body.clone()).collect();
        let mut at = |bend: f32| {
            skeleton.set_rotation(find(joint), axis * bend.to_radians()).expect("finite");
            volume(&mesh.posed(&mesh.pose(&skeleton), skin.skinning).positions, &triangles)
        };
        let straight = at(0.0);
        for bend in [90.0, 140.0] {
            let ratio = at(bend) / straight;
            assert!((0.9..1.1).contains(&ratio), "{joint} by {bend}°: {ratio} of its volume");
        }
    }
}

/// The normals at the vertices of a mesh by its triangles alone, each by its area.
fn normals_of_faces(positions: &[DVec3], triangles: &[[u32; 3]]) -> Vec<DVec3> {
    let mut normals = vec![DVec3::ZERO; positions.len()];
    for corners in triangles.iter().map(|triangle| triangle.map(|corner| corner as usize)) {
        let [a, b, c] = corners.map(|corner| positions[corner]);
        corners.iter().for_each(|corner| normals[*corner] += (b - a).cross(c - a));
    }
    normals.into_iter().map(DVec3::normalize_or_zero).collect()
}

/// The normal of the surface that is farthest out on a line along x, through a point (y, z).
fn outermost(
    at: DVec2,
    positions: &[DVec3],
    normals: &[DVec3],
    triangles: &[[u32; 3]],
) -> Option<DVec3> {
    let hit = |triangle: &[u32; 3]| {
        let corners = triangle.map(|corner| corner as usize);
        let around = corners.map(|corner| positions[corner].yz() - at);
        let part = |one: usize| around[(one + 1) % 3].perp_dot(around[(one + 2) % 3]);
        let twice = part(0) + part(1) + part(2);
        let parts = [0, 1, 2].map(|one| part(one) / twice);
        let sum = |of: &[DVec3]| (0..3).map(|one| parts[one] * of[corners[one]]).sum::<DVec3>();
        parts.iter().all(|part| *part > 0.0).then(|| (sum(positions).x, sum(normals).normalize()))
    };
    let hits = triangles.iter().filter_map(hit);
    hits.max_by(|one, other| one.0.total_cmp(&other.0)).map(|(_, normal)| normal)
}

#[test]
fn the_humans_hip_bends_without_a_crease() {
    /// Distance in metres between neighbouring points, and how many there are in a row.
    const STEP: f64 = 0.004;
    const POINTS: usize = 31;
    let human = opened("human");
    let skin = human.rig.skin.as_ref().expect("a skin");
    let mesh = &skin.mesh().expect("a mesh").mesh;
    let mut skeleton = Skeleton::clone(human.skeleton());
    skeleton.ids().for_each(|id| skeleton.set_rotation(id, Vec3::ZERO).expect("finite"));
    let thigh = skeleton.find("left_thigh").expect("a joint");
    for (bend, back) in [(45_f32, 0.0), (45.0, 1.0), (90.0, 0.0), (90.0, 1.0)] {
        skeleton.set_rotation(thigh, Vec3::NEG_X * bend.to_radians()).expect("finite");
        let posed = mesh.posed(&mesh.pose(&skeleton), skin.skinning).positions;
        let from_below = DVec3::new(1.0, -1.0, -back).normalize();
        let view = DQuat::from_rotation_arc(from_below, DVec3::X);
        let positions: Vec<DVec3> = posed.iter().map(|at| view * at.as_dvec3()).collect();
        let hip = view * skeleton.pose().base(thigh).as_dvec3();
        let is_near = |corner: &u32| positions[*corner as usize].distance(hip) < 0.2;
        let triangles = mesh.mesh().triangles.iter().copied();
        let triangles: Vec<[u32; 3]> =
            triangles.filter(|triangle| triangle.iter().all(is_near)).collect();
        let normals = normals_of_faces(&positions, &triangles);
        let normal = |row: usize, column: usize| {
            let [row, column] = [row, column].map(|it| it as f64 - 0.5 * (POINTS - 1) as f64);
            let at = hip.yz() + STEP * DVec2::new(row, column);
            outermost(at, &positions, &normals, &triangles).expect("a surface")
        };
        let rows = (0..POINTS).map(|row| (0..POINTS).map(|it| normal(row, it)).collect());
        let rows: Vec<Vec<DVec3>> = rows.collect();
        let along = rows.iter().flat_map(|row| row.windows(2).map(|pair| pair[0].dot(pair[1])));
        let across = rows.windows(2).flat_map(|two| two[0].iter().zip(&two[1]));
        let sharpest = along.chain(across.map(|(one, next)| one.dot(*next))).fold(1.0, f64::min);

        let case = format!("bent by {bend}°, seen from {from_below}");
        assert!(sharpest > 0.85, "{case}: neighbours meet at an angle of cosine {sharpest}");
    }
}
