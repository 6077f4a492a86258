//! Skins made from the bones of random skeletons: closed, on the surface of the bones, smooth.

use std::collections::HashMap;

use glam::{DVec3, Quat, Vec3};
use ik_arm_kinematics::skeleton::{Joint, JointId, Skeleton, SkeletonPose};
use ik_arm_kinematics::skin::{
    Blob, BlobSphere, SkinShape, SkinShapeError, SkinnedMesh, Skinning, TriangleMesh, VertexWeights,
};

use crate::common::{Random, cases};

const TREES: usize = 200;

/// A skeleton of 1 to 60 joints with radii from 1 to 10, straight, crooked, folded or with joints
/// away from their parents' tips; one bone in ten has no length, one joint in thirty is another
/// root.
fn any_skeleton(random: &mut Random) -> Skeleton {
    #[derive(Clone, Copy, PartialEq)]
    enum Style {
        Straight,
        Crooked,
        Folded,
        Apart,
    }
    let style = random.one_of(&[Style::Straight, Style::Crooked, Style::Folded, Style::Apart]);
    let joints = 1 + random.below(60).min(random.below(60));
    let mut list: Vec<Joint> = Vec::new();
    for index in 0..joints {
        let parent = match index {
            0 => None,
            _ if random.chance(0.03) => None,
            _ if random.chance(0.7) => Some(index - 1),
            _ => Some(random.below(index)),
        };
        let above = parent.map(|parent| list[parent].axis);
        let direction = match (style, above.and_then(Vec3::try_normalize)) {
            (Style::Straight, _) => Vec3::Y,
            (Style::Folded, Some(above)) => (0.05 * random.direction() - above).normalize(),
            _ => random.direction(),
        };
        let length = if random.chance(0.1) { 0.0 } else { random.power_of_ten(0.0..0.8) as f32 };
        let name = format!("j{index}");
        let mut joint = Joint::new(&name, parent.map(JointId::new), direction * length);
        joint.radius = random.power_of_ten(0.0..1.0) as f32;
        joint.offset = match above {
            None => random.vector(30.0),
            Some(_) if style == Style::Apart && random.chance(0.3) => random.vector(10.0),
            Some(tip) => tip,
        };
        list.push(joint);
    }
    Skeleton::from_joints(list).expect("skeleton")
}

fn coarse() -> SkinShape {
    SkinShape { detail: SkinShape::LEAST_DETAIL, ..SkinShape::default() }
}

fn roots(skeleton: &Skeleton) -> usize {
    skeleton.joints().iter().filter(|joint| joint.parent.is_none()).count()
}

// Independent measures

/// Signed distance of the round cone from `base` to `tip`: the least over the spheres between its
/// ends, by golden-section search.
fn cone_distance(point: DVec3, ends: [(DVec3, f64); 2]) -> f64 {
    let [(base, base_radius), (tip, tip_radius)] = ends;
    let at =
        |t: f64| point.distance(base.lerp(tip, t)) - (base_radius + (tip_radius - base_radius) * t);
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..60 {
        let third = (high - low) * 0.381_966;
        if at(low + third) < at(high - third) { high -= third } else { low += third }
    }
    at(low).min(at(0.0)).min(at(1.0))
}

/// The bones of a skeleton whose joints all start at their parents' tips, as round cones.
fn cones(skeleton: &Skeleton) -> Vec<[(DVec3, f64); 2]> {
    let pose: SkeletonPose = skeleton.bind_pose_in_skeleton();
    let cone = |id: JointId| {
        let children: Vec<JointId> = skeleton.children(id).collect();
        let radius = f64::from(skeleton[id].radius);
        let tip_radius = match children[..] {
            [child] => f64::from(skeleton[child].radius),
            _ => radius,
        };
        [(pose.base(id).as_dvec3(), radius), (pose.tip(id).as_dvec3(), tip_radius)]
    };
    skeleton.ids().map(cone).collect()
}

/// For each vertex the connected piece of the mesh that it is in, in the order of their first vertices.
fn pieces_of_vertices(mesh: &SkinnedMesh) -> Vec<usize> {
    let mut neighbours: HashMap<u32, Vec<u32>> = HashMap::new();
    for [a, b, c] in &mesh.mesh().triangles {
        for (from, to) in [(a, b), (b, c), (c, a)] {
            neighbours.entry(*from).or_default().push(*to);
        }
    }
    let mut pieces = vec![usize::MAX; mesh.mesh().positions.len()];
    let mut count = 0;
    for vertex in 0..pieces.len() {
        let mut open = vec![vertex as u32];
        while let Some(vertex) = open.pop() {
            if pieces[vertex as usize] == usize::MAX {
                pieces[vertex as usize] = count;
                open.extend(&neighbours[&vertex]);
            }
        }
        count = count.max(1 + pieces[vertex]);
    }
    pieces
}

/// Number of connected pieces of a mesh.
fn pieces(mesh: &SkinnedMesh) -> usize {
    pieces_of_vertices(mesh).into_iter().max().map_or(0, |last| last + 1)
}

fn assert_is_closed(mesh: &SkinnedMesh, case: &str) {
    let mut directed: HashMap<(u32, u32), usize> = HashMap::new();
    for [a, b, c] in &mesh.mesh().triangles {
        for edge in [(*a, *b), (*b, *c), (*c, *a)] {
            *directed.entry(edge).or_default() += 1;
        }
    }
    for ((from, to), count) in &directed {
        assert_eq!(*count, 1, "{case}: edge {from}–{to} is passed {count} times in one direction");
        assert!(directed.contains_key(&(*to, *from)), "{case}: edge {from}–{to} has one face");
    }
}

fn assert_has_no_degenerate_face(mesh: &SkinnedMesh, case: &str) {
    for (index, triangle) in mesh.mesh().triangles.iter().enumerate() {
        let [a, b, c] = triangle.map(|corner| mesh.mesh().positions[corner as usize]);
        let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
        let height = (b - a).cross(c - a).length() / longest;
        assert!(height > 1e-4 * longest, "{case}: triangle {index} is {height:.1e} high");
    }
}

/// Greatest change of a joint's weight along an edge.
fn greatest_jump(mesh: &SkinnedMesh) -> f32 {
    let jump = |one: &VertexWeights, other: &VertexWeights| {
        let joints = one.iter().chain(other.iter()).map(|(joint, _)| joint);
        joints.map(|joint| (one.of(joint) - other.of(joint)).abs()).fold(0.0, f32::max)
    };
    let edges = mesh.mesh().triangles.iter().flat_map(|[a, b, c]| [(*a, *b), (*b, *c), (*c, *a)]);
    let weights = |vertex: u32| &mesh.weights()[vertex as usize];
    edges.map(|(from, to)| jump(weights(from), weights(to))).fold(0.0, f32::max)
}

// Tests

#[test]
fn skins_of_random_trees_are_closed_and_smooth_with_one_surface_for_each_tree() {
    for seed in 0..cases(TREES) as u64 {
        let skeleton = any_skeleton(&mut Random(seed));
        let mesh = SkinnedMesh::from_bones(&skeleton, &coarse()).expect("skin");
        let case = format!("seed {seed}, {} joints", skeleton.joints().len());
        assert_is_closed(&mesh, &case);
        assert_has_no_degenerate_face(&mesh, &case);
        assert_eq!(pieces(&mesh), roots(&skeleton), "{case}: pieces");
        let jump = greatest_jump(&mesh);
        assert!(jump <= 0.35, "{case}: a weight jumps by {jump}");
        for weights in mesh.weights() {
            let sum: f32 = weights.iter().map(|(_, weight)| weight).sum();
            assert!((sum - 1.0).abs() < 1e-6, "{case}: weights sum to {sum}");
        }
    }
}

#[test]
fn vertices_are_on_the_bones_or_outside_them_by_at_most_the_blend_of_two() {
    for seed in 0..40 {
        let mut random = Random(1000 + seed);
        let skeleton = crate::common::skeletons::chain(&mut random, 1 + seed as usize % 7, 4.0);
        let mesh = SkinnedMesh::from_bones(&skeleton, &SkinShape::default()).expect("skin");
        let cones: Vec<_> = cones(&skeleton).into_iter().filter(|[base, _]| base.1 > 0.0).collect();
        for (vertex, position) in mesh.mesh().positions.iter().enumerate() {
            let distances = cones.iter().map(|cone| cone_distance(position.as_dvec3(), *cone));
            let distance = distances.fold(f64::INFINITY, f64::min);
            let greatest = cones.iter().flatten().map(|end| end.1).fold(0.0, f64::max);
            let least = cones.iter().flatten().map(|end| end.1).fold(f64::INFINITY, f64::min);
            assert!(distance > -1e-3 * greatest, "seed {seed}: vertex {vertex} at {distance}");
            // The smooth minimum is lower by a quarter of its width, which is half a radius.
            let blend = 0.125 * least + 0.125 * (greatest - least);
            assert!(distance < blend + 1e-3 * greatest, "seed {seed}: {vertex} at {distance}");
        }
    }
}

/// Bones of one length and radius in line.
fn tube(bones: usize, length: f32, radius: f32) -> Skeleton {
    let bone = |index: usize| Joint {
        offset: if index == 0 { Vec3::ZERO } else { Vec3::Y * length },
        radius,
        ..Joint::new(
            &format!("bone {index}"),
            index.checked_sub(1).map(JointId::new),
            Vec3::Y * length,
        )
    };
    Skeleton::from_joints((0..bones).map(bone).collect()).expect("skeleton")
}

#[test]
fn a_straight_chain_of_one_radius_is_a_straight_tube() {
    for bones in 1..6 {
        let mesh =
            SkinnedMesh::from_bones(&tube(bones, 3.0, 0.5), &SkinShape::default()).expect("skin");
        let top = 3.0 * bones as f32;
        for position in mesh.mesh().positions.iter().filter(|at| at.y > 0.0 && at.y < top) {
            let radius = position.with_y(0.0).length();
            assert!(
                (radius / 0.5 - 1.0).abs() < 1e-3,
                "{bones} bones: radius {radius} at {position}"
            );
        }
    }
}

#[test]
fn the_middle_third_of_a_long_bone_follows_that_bone_alone() {
    let mesh = SkinnedMesh::from_bones(&tube(4, 3.1, 0.5), &SkinShape::default()).expect("skin");
    for (position, weights) in mesh.mesh().positions.iter().zip(mesh.weights()) {
        let along = position.y / 3.1;
        if (0.0..4.0).contains(&along) && (1.0 / 3.0..2.0 / 3.0).contains(&along.fract()) {
            let own = weights.of(JointId::new(along as usize));
            assert!(own >= 0.95, "{own} at {position}");
        }
    }
}

#[test]
fn weights_are_of_joints_within_two_steps_of_the_nearest_bone() {
    let mesh = SkinnedMesh::from_bones(&tube(8, 0.4, 0.5), &SkinShape::default()).expect("skin");
    for weights in mesh.weights() {
        let first = weights.first().index();
        assert!(weights.iter().all(|(joint, _)| joint.index().abs_diff(first) <= 2), "{weights:?}");
    }
}

#[test]
fn parallel_siblings_do_not_melt_together() {
    let mut joints = vec![Joint { radius: 1.0, ..Joint::new("palm", None, Vec3::Y * 2.0) }];
    for (index, x) in [-0.45_f32, 0.45].into_iter().enumerate() {
        let finger = Joint::new(&format!("finger {index}"), Some(0.into()), Vec3::Y * 4.0);
        joints.push(Joint { offset: Vec3::new(x, 2.0, 0.0), radius: 0.4, ..finger });
    }
    let skeleton = Skeleton::from_joints(joints).expect("skeleton");
    let mesh = SkinnedMesh::from_bones(&skeleton, &SkinShape::default()).expect("skin");
    let between = |at: &&Vec3| at.x.abs() < 0.04 && at.y > 3.2;
    assert_eq!(mesh.mesh().positions.iter().filter(between).count(), 0);
}

#[test]
fn blobs_are_part_of_the_surface_and_move_with_their_joint() {
    let skeleton = tube(2, 4.0, 0.5);
    let spheres = vec![
        BlobSphere { centre: Vec3::new(0.0, 2.0, 0.0), radius: 0.4 },
        BlobSphere { centre: Vec3::new(2.0, 2.0, 0.0), radius: 0.6 },
    ];
    let blob = Blob { joint: 1.into(), spheres };
    let shape = SkinShape { blobs: vec![blob], ..SkinShape::default() };
    let mesh = SkinnedMesh::from_bones(&skeleton, &shape).expect("skin");
    assert_is_closed(&mesh, "blob");
    assert_eq!(pieces(&mesh), 1);
    let farthest = mesh.mesh().positions.iter().map(|at| at.x).fold(0.0, f32::max);
    assert!((farthest - 2.6).abs() < 0.02, "{farthest}");
    for (position, weights) in mesh.mesh().positions.iter().zip(mesh.weights()) {
        assert!(position.x < 1.0 || weights.of(1.into()) == 1.0, "{weights:?} at {position}");
    }
}

/// Centres and radii of spheres along the Catmull–Rom spline through some spheres, over the lengths of
/// its chords. Between two spheres the radius stays between theirs: its slope at a sphere is that of
/// Catmull and Rom, at most three times the smaller of those to the neighbours, and 0 at an extreme.
fn swept(spheres: &[(DVec3, f64)], steps: usize) -> Vec<(DVec3, f64)> {
    let last = spheres.len() - 1;
    let chord = |span: usize| spheres[span].0.distance(spheres[span + 1].0);
    let slopes = |span: usize| {
        let (from, to) = (spheres[span], spheres[span + 1]);
        ((to.0 - from.0) / chord(span), (to.1 - from.1) / chord(span))
    };
    let slope = |at: usize| {
        if at == 0 || at == last {
            return slopes(at.min(last - 1));
        }
        let (before, after) = (slopes(at - 1), slopes(at));
        let [h, k] = [chord(at - 1), chord(at)];
        let mean = |a: f64, b: f64| (a * h + b * k) / (h + k);
        let most = 3.0 * before.1.abs().min(after.1.abs());
        let radius = match before.1 * after.1 > 0.0 {
            true => mean(before.1, after.1).clamp(-most, most),
            false => 0.0,
        };
        ((before.0 * h + after.0 * k) / (h + k), radius)
    };
    let at = |span: usize, s: f64| {
        let (from, to, h) = (spheres[span], spheres[span + 1], chord(span));
        let (m, n) = (slope(span), slope(span + 1));
        let [a, b, c, d] = [
            (1.0 + 2.0 * s) * (1.0 - s) * (1.0 - s),
            s * (1.0 - s) * (1.0 - s) * h,
            s * s * (3.0 - 2.0 * s),
            s * s * (s - 1.0) * h,
        ];
        (a * from.0 + b * m.0 + c * to.0 + d * n.0, a * from.1 + b * m.1 + c * to.1 + d * n.1)
    };
    let within = |span: usize| (0..=steps).map(move |step| (span, step as f64 / steps as f64));
    (0..last).flat_map(within).map(|(span, s)| at(span, s)).collect()
}

#[test]
fn a_blob_of_many_spheres_is_what_one_sphere_passes_through_on_a_curve() {
    for seed in 0..cases(20) as u64 {
        let mut random = Random(4000 + seed);
        let mut centre = Vec3::ZERO;
        let mut direction = random.direction();
        let spheres: Vec<BlobSphere> = (0..3 + random.below(5))
            .map(|_| {
                direction = (direction + 0.5 * random.direction()).normalize();
                centre += direction * random.within(1.5..4.0);
                BlobSphere { centre, radius: random.within(0.6..1.4) }
            })
            .collect();
        let wide = |it: &BlobSphere| (it.centre.as_dvec3(), f64::from(it.radius));
        let expected = swept(&spheres.iter().map(wide).collect::<Vec<_>>(), 400);
        let skeleton = Skeleton::with_root("root");
        let blobs = vec![Blob { joint: 0.into(), spheres }];
        let shape = SkinShape { blobs, ..SkinShape::default() };
        let mesh = SkinnedMesh::from_bones(&skeleton, &shape).expect("skin");
        assert_is_closed(&mesh, &format!("seed {seed}"));
        for position in &mesh.mesh().positions {
            let distances = expected.iter().map(|it| position.as_dvec3().distance(it.0) - it.1);
            let distance = distances.fold(f64::INFINITY, f64::min);
            // Round cones between points of a curve leave out at most its sagitta.
            assert!(distance.abs() < 0.03, "seed {seed}: {position} is {distance} outside");
        }
    }
}

#[test]
fn a_jointed_skin_has_a_closed_body_for_each_joint_that_moves_with_it_and_its_neighbours() {
    for seed in 0..cases(60) as u64 {
        let skeleton = any_skeleton(&mut Random(seed));
        let shape = SkinShape { is_jointed: true, ..coarse() };
        let mesh = SkinnedMesh::from_bones(&skeleton, &shape).expect("skin");
        let case = format!("seed {seed}, {} joints", skeleton.joints().len());
        assert_is_closed(&mesh, &case);
        assert_eq!(pieces(&mesh), skeleton.joints().len(), "{case}: bodies");
        let parent = |joint: JointId| skeleton[joint].parent;
        for (piece, weights) in pieces_of_vertices(&mesh).into_iter().zip(mesh.weights()) {
            let own = JointId::new(piece);
            for (joint, weight) in weights.iter() {
                let is_near =
                    joint == own || parent(joint) == Some(own) || parent(own) == Some(joint);
                assert!(is_near, "{case}: body {piece} follows {joint:?} by {weight}");
            }
        }
    }
}

#[test]
fn the_middle_of_a_body_of_a_jointed_skin_follows_its_joint_alone() {
    let (length, radius) = (3.0, 0.5);
    let skeleton = tube(3, length, radius);
    let shape = SkinShape { is_jointed: true, ..SkinShape::default() };
    let mesh = SkinnedMesh::from_bones(&skeleton, &shape).expect("skin");
    let rows = mesh.mesh().positions.iter().zip(pieces_of_vertices(&mesh)).zip(mesh.weights());
    for ((at, piece), weights) in rows {
        let along = at.y - piece as f32 * length;
        if along > 2.6 * radius && along < length - 2.6 * radius {
            assert_eq!(*weights, VertexWeights::rigid(JointId::new(piece)), "{at}");
        }
    }
}

/// The volume that closed triangles enclose.
fn volume(positions: &[Vec3], triangles: &[[u32; 3]]) -> f64 {
    let of = |triangle: &[u32; 3]| {
        let [a, b, c] = triangle.map(|corner| positions[corner as usize].as_dvec3());
        a.dot(b.cross(c)) / 6.0
    };
    triangles.iter().map(of).sum()
}

#[test]
fn a_jointed_skin_keeps_its_volume_however_far_it_bends() {
    for bend in [0.5_f32, 1.571, 2.443] {
        let mut skeleton = tube(3, 3.0, 0.5);
        let shape = SkinShape { is_jointed: true, ..SkinShape::default() };
        let mesh = SkinnedMesh::from_bones(&skeleton, &shape).expect("skin");
        let straight = volume(&mesh.mesh().positions, &mesh.mesh().triangles);
        skeleton.set_rotation(1.into(), Vec3::X * bend).expect("finite");
        skeleton.set_rotation(2.into(), Vec3::Z * bend).expect("finite");
        let posed = mesh.posed(&mesh.pose(&skeleton), Skinning::DualQuaternion);
        let ratio = volume(&posed.positions, &mesh.mesh().triangles) / straight;
        assert!((ratio - 1.0).abs() < 0.05, "{bend}: {ratio} of its volume");
    }
}

/// Least cosine of the angle between the normals of two bodies of a tube at points of their outer sides
/// that are close to each other.
fn sharpest_seam(mesh: &SkinnedMesh, along: Vec3, positions: &[Vec3], normals: &[Vec3]) -> f32 {
    const NEAR: f32 = 0.05;
    let pieces = pieces_of_vertices(mesh);
    // The round ends, past the plane across the middle of the bend, are inside the other body.
    let is_outside = |vertex: &usize| {
        let past = (mesh.mesh().positions[*vertex] - LENGTH * Vec3::Y).dot(along);
        if pieces[*vertex] == 0 { past < 0.5 * NEAR } else { past > -0.5 * NEAR }
    };
    let outside = (0..positions.len()).filter(is_outside);
    let (upper, lower): (Vec<usize>, Vec<usize>) = outside.partition(|vertex| pieces[*vertex] == 0);
    let pairs = upper.iter().flat_map(|one| lower.iter().map(|other| (*one, *other)));
    let close = pairs.filter(|(one, other)| positions[*one].distance(positions[*other]) < NEAR);
    close.map(|(one, other)| normals[one].dot(normals[other])).fold(1.0, f32::min)
}

/// The normals of a mesh by its triangles alone, each by its area.
fn normals_of_faces(positions: &[Vec3], triangles: &[[u32; 3]]) -> Vec<Vec3> {
    let mut normals = vec![Vec3::ZERO; positions.len()];
    for triangle in triangles {
        let [a, b, c] = triangle.map(|corner| positions[corner as usize]);
        triangle.iter().for_each(|corner| normals[*corner as usize] += (b - a).cross(c - a));
    }
    normals.into_iter().map(Vec3::normalize_or_zero).collect()
}

/// Length of each bone of [`jointed_tube`].
const LENGTH: f32 = 3.0;

/// A tube of two bones with a jointed skin.
fn jointed_tube(bend: f32) -> (Skeleton, SkinnedMesh) {
    let mut joints: Vec<Joint> =
        tube(2, LENGTH, 0.5).joints().iter().map(|it| Joint::clone(it)).collect();
    joints[1].axis = Quat::from_rotation_x(bend) * joints[1].axis;
    let skeleton = Skeleton::from_joints(joints).expect("skeleton");
    let shape = SkinShape { is_jointed: true, detail: 8.0, ..SkinShape::default() };
    let mesh = SkinnedMesh::from_bones(&skeleton, &shape).expect("skin");
    (skeleton, mesh)
}

#[test]
fn two_bodies_of_a_jointed_skin_have_nearly_one_normal_at_their_seam() {
    let (_, mesh) = jointed_tube(1.0);
    let along = Quat::from_rotation_x(0.5) * Vec3::Y;
    let TriangleMesh { positions, normals, triangles, .. } = mesh.mesh();
    let faces = normals_of_faces(positions, triangles);
    let bodies = sharpest_seam(&mesh, along, positions, &faces);
    assert!(bodies < 0.7, "the bodies meet at an angle: {bodies}");
    let seam = sharpest_seam(&mesh, along, positions, normals);
    assert!(seam > 0.9, "the normals do not: {seam}");
}

#[test]
fn a_jointed_limb_bends_without_a_crease() {
    let (mut skeleton, mesh) = jointed_tube(0.0);
    let triangles = &mesh.mesh().triangles;
    for bend in [0.25, 0.5, 1.0] {
        skeleton.set_rotation(1.into(), Vec3::X * bend).expect("finite");
        let posed = mesh.posed(&mesh.pose(&skeleton), Skinning::DualQuaternion);
        let faces = normals_of_faces(&posed.positions, triangles);
        let seam = sharpest_seam(&mesh, Vec3::Y, &posed.positions, &faces);

        assert!(seam > 0.9, "{bend}: the bodies meet at an angle of cosine {seam}");
    }
}

#[test]
fn the_same_skeleton_gives_the_same_skin_bit_for_bit() {
    let skeleton = any_skeleton(&mut Random(77));
    let skin = || SkinnedMesh::from_bones(&skeleton, &coarse()).expect("skin");
    assert_eq!(skin(), skin());
}

#[test]
fn a_skin_scales_with_its_skeleton_and_takes_far_and_tiny_ones() {
    let plain = SkinnedMesh::from_bones(&tube(2, 3.0, 0.5), &SkinShape::default()).expect("skin");
    for scale in [1e-6_f32, 1e6] {
        let scaled = tube(2, 3.0 * scale, 0.5 * scale);
        let scaled = SkinnedMesh::from_bones(&scaled, &SkinShape::default()).expect("skin");
        let ratio = scaled.mesh().size() / plain.mesh().size() / scale;
        assert!((ratio - 1.0).abs() < 1e-3, "{ratio}");
        assert_is_closed(&scaled, "scaled");
    }
}

#[test]
fn bones_of_very_different_sizes_get_a_mesh_of_bounded_size() {
    let mut joints =
        tube(3, 100.0, 20.0).joints().iter().map(|it| Joint::clone(it)).collect::<Vec<_>>();
    joints[2].radius = 1e-3;
    let skeleton = Skeleton::from_joints(joints).expect("skeleton");
    let mesh = SkinnedMesh::from_bones(&skeleton, &coarse()).expect("skin");
    assert!(mesh.mesh().positions.len() < 300_000, "{}", mesh.mesh().positions.len());
    assert_is_closed(&mesh, "thin");
    assert_eq!(pieces(&mesh), 1);
}

#[test]
fn what_cannot_become_a_skin_is_refused_with_the_reason() {
    let refused = |skeleton: &Skeleton, shape: SkinShape| {
        SkinnedMesh::from_bones(skeleton, &shape).expect_err("refused").to_string()
    };
    let tube = tube(2, 3.0, 0.5);
    assert_eq!(
        refused(&Skeleton::with_root("root"), SkinShape::default()),
        "a skin from bones needs a joint with a radius above 0, and there is none"
    );
    assert_eq!(
        refused(&tube, SkinShape { detail: 0.5, ..SkinShape::default() }),
        "skin detail must be from 1.2 to 16, got 0.5"
    );
    assert_eq!(
        refused(&tube, SkinShape { thickness: f32::NAN, ..SkinShape::default() }),
        "skin thickness must be finite and above 0, got NaN"
    );
    let blob = |joint: usize, radius| {
        let sphere = |centre, radius| BlobSphere { centre, radius };
        let spheres = vec![sphere(Vec3::ZERO, 1.0), sphere(Vec3::Y, radius)];
        Blob { joint: joint.into(), spheres }
    };
    let with = |blob| SkinShape { blobs: vec![blob], ..SkinShape::default() };
    assert_eq!(refused(&tube, with(blob(2, 1.0))), "the joint of blob 0 must be below 2, got 2");
    assert_eq!(
        refused(&tube, with(blob(0, 0.0))),
        "blob 0 must have spheres with finite centres, and finite radii above 0"
    );
    let none = Blob { joint: 0.into(), spheres: Vec::new() };
    assert_eq!(refused(&tube, with(none)), refused(&tube, with(blob(0, 0.0))));
    let many = vec![blob(0, 1.0); SkinShape::MOST_SPHERES];
    assert_eq!(
        refused(&tube, SkinShape { blobs: many, ..SkinShape::default() }),
        "the blobs of a skin must have at most 8192 spheres, got 16384"
    );
    let mut far = blob(0, 1.0);
    far.spheres[0].centre = Vec3::X * 1e30;
    let error = SkinnedMesh::from_bones(&tube, &with(far)).expect_err("refused");
    assert!(matches!(error, SkinShapeError::TooThin { .. }), "{error}");
    let huge = self::tube(2, 1.6e38, 1e38);
    let error = SkinnedMesh::from_bones(&huge, &SkinShape::default()).expect_err("refused");
    assert!(matches!(error, SkinShapeError::NotFinite(_)), "{error}");
}

// The pose in which a surface is made

/// The skeleton whose bind pose is the pose of another one.
fn baked(skeleton: &Skeleton) -> Skeleton {
    let pose = skeleton.pose_in_skeleton();
    let joint = |(id, own): (JointId, &Joint)| {
        let above = own.parent.map_or(Vec3::ZERO, |parent| pose.base(parent));
        let mut joint = Joint::new(&own.name, own.parent, pose.tip(id) - pose.base(id));
        joint.offset = pose.base(id) - above;
        joint.radius = own.radius;
        joint
    };
    Skeleton::from_joints(skeleton.iter().map(joint).collect()).expect("skeleton")
}

#[test]
fn a_skin_made_in_a_pose_is_around_the_bones_of_that_pose() {
    for seed in 0..cases(20) as u64 {
        let mut random = Random(seed);
        let mut skeleton = any_skeleton(&mut random);
        for joint in skeleton.ids() {
            skeleton.set_rotation(joint, random.vector(2.0)).expect("finite");
        }
        let pose: Vec<(JointId, Vec3)> =
            skeleton.iter().map(|(id, joint)| (id, joint.rotation)).collect();
        let mesh = SkinnedMesh::from_bones(&skeleton, &SkinShape { pose, ..coarse() });
        let mesh = mesh.expect("a skin");
        assert_is_closed(&mesh, &format!("seed {seed}"));
        let posed = mesh.posed(&mesh.pose(&skeleton), Skinning::Linear);
        let expected = SkinnedMesh::from_bones(&baked(&skeleton), &coarse()).expect("a skin");
        let size = expected.mesh().size();
        assert_eq!(posed.positions.len(), expected.mesh().positions.len(), "seed {seed}");
        for (found, expected) in posed.positions.iter().zip(&expected.mesh().positions) {
            assert!(found.distance(*expected) < 1e-4 * size, "seed {seed}: {found}, {expected}");
        }
    }
}

/// A figure whose arms lie along the neck in the bind pose, as in some motion capture, and stretch
/// to the sides in the pose that it has.
fn tangled_figure() -> Skeleton {
    let bone = |name: &str, parent: Option<usize>, offset: Vec3, length: f32| {
        let mut joint = Joint::new(name, parent.map(JointId::new), Vec3::Y * length);
        (joint.offset, joint.radius) = (offset, 4.0);
        joint
    };
    let mut joints = vec![
        bone("hips", None, Vec3::ZERO, 20.0),
        bone("chest", Some(0), Vec3::Y * 20.0, 30.0),
        bone("neck", Some(1), Vec3::Y * 30.0, 12.0),
        bone("head", Some(2), Vec3::Y * 12.0, 20.0),
    ];
    for (side, sign) in [("left", 1.0), ("right", -1.0)] {
        let shoulder = joints.len();
        let offset = Vec3::new(2.0 * sign, 26.0, 0.0);
        let mut upper = bone(&format!("{side} arm"), Some(1), offset, 28.0);
        upper.rotation = Vec3::new(0.0, 0.0, -sign * core::f32::consts::FRAC_PI_2);
        joints.push(upper);
        joints.push(bone(&format!("{side} forearm"), Some(shoulder), Vec3::Y * 28.0, 25.0));
        joints.push(bone(&format!("{side} hand"), Some(shoulder + 1), Vec3::Y * 25.0, 15.0));
    }
    Skeleton::from_joints(joints).expect("a figure")
}

/// The greatest number of steps in the tree between the joints that two ends of an edge follow most.
fn longest_bridge(skeleton: &Skeleton, mesh: &SkinnedMesh) -> usize {
    let steps = |one: JointId, other: JointId| {
        let above: Vec<JointId> = skeleton.ancestors(one).collect();
        let mut from_other = skeleton.ancestors(other).enumerate();
        let met = from_other
            .find_map(|(up, joint)| above.iter().position(|it| *it == joint).map(|down| up + down));
        met.unwrap_or(usize::MAX)
    };
    let heaviest = |vertex: u32| mesh.weights()[vertex as usize].first();
    let edges = mesh.mesh().triangles.iter().flat_map(|[a, b, c]| [(*a, *b), (*b, *c)]);
    edges.map(|(a, b)| steps(heaviest(a), heaviest(b))).max().unwrap_or_default()
}

#[test]
fn a_tangled_figure_gets_its_skin_where_its_bones_are_apart() {
    let figure = tangled_figure();
    let tied = SkinnedMesh::from_bones(&figure, &SkinShape::default()).expect("a skin");
    assert!(longest_bridge(&figure, &tied) > 3, "the bind pose ties hands and head together");
    let shape = SkinShape::default().with_bones_apart(&figure);
    assert!(!shape.pose.is_empty());
    let mesh = SkinnedMesh::from_bones(&figure, &shape).expect("a skin");
    assert_is_closed(&mesh, "tangled");
    let longest = longest_bridge(&figure, &mesh);
    assert!(longest <= 2, "an edge goes over {longest} joints");
}

#[test]
fn figures_whose_bones_are_apart_get_their_skin_in_the_bind_pose() {
    let mut figure = baked(&tangled_figure());
    assert!(SkinShape::default().with_bones_apart(&figure).pose.is_empty());
    for joint in figure.ids() {
        figure.set_rotation(joint, Vec3::splat(0.4)).expect("finite");
    }
    assert!(SkinShape::default().with_bones_apart(&figure).pose.is_empty());
}
