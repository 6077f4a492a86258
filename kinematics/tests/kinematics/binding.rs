//! Joints that were placed in a mesh: weights by distances inside the body.

use glam::{Affine3A, Mat3, Vec3};
use ik_arm_kinematics::skeleton::{Joint, JointId, JointLimits, Skeleton};
use ik_arm_kinematics::skin::{
    BindError, Morph, SkinShape, SkinnedMesh, Skinning, TriangleMesh, VertexWeights,
};

use crate::common::Random;
use crate::common::skeletons::{chain, shake, transform, tree};

/// The body around the bones of a skeleton as a mesh that follows the first joint alone.
fn body(skeleton: &Skeleton, detail: f32) -> SkinnedMesh {
    let shape = SkinShape { detail, ..SkinShape::default() };
    loose(SkinnedMesh::from_bones(skeleton, &shape).expect("a body").mesh().clone(), skeleton)
}

/// A mesh that follows the first joint alone.
fn loose(mesh: TriangleMesh, skeleton: &Skeleton) -> SkinnedMesh {
    let weights = vec![VertexWeights::rigid(JointId::new(0)); mesh.positions.len()];
    let pose = skeleton.bind_pose_in_skeleton();
    let inverse_binds = skeleton.ids().map(|joint| pose.full(joint).inverse()).collect();
    SkinnedMesh::new(mesh, weights, inverse_binds).expect("a mesh")
}

/// Greatest change of a joint's weight along an edge.
fn greatest_jump(mesh: &SkinnedMesh) -> f32 {
    let weights = |vertex: u32| &mesh.weights()[vertex as usize];
    let jump = |[from, to]: [u32; 2]| {
        let (one, other) = (weights(from), weights(to));
        let joints = one.iter().chain(other.iter()).map(|(joint, _)| joint);
        joints.map(|joint| (one.of(joint) - other.of(joint)).abs()).fold(0.0, f32::max)
    };
    let edges = mesh.mesh().triangles.iter().flat_map(|[a, b, c]| [[*a, *b], [*b, *c], [*c, *a]]);
    edges.map(jump).fold(0.0, f32::max)
}

fn bone(name: &str, parent: Option<usize>, offset: Vec3, axis: Vec3, radius: f32) -> Joint {
    Joint { offset, radius, ..Joint::new(name, parent.map(JointId::new), axis) }
}

/// A palm with five fingers of three bones each side by side; between two fingers there is less than
/// half of their width.
fn hand() -> Skeleton {
    let mut joints = vec![bone("palm", None, Vec3::ZERO, Vec3::Y * 4.0, 0.5)];
    for finger in 0..5 {
        let across = Vec3::X * (finger as f32 - 2.0) * 1.4;
        let mut parent = 0;
        for phalanx in 0..3 {
            let offset = if phalanx == 0 { Vec3::Y * 4.0 + across } else { Vec3::Y * 1.6 };
            let name = format!("finger {finger} {phalanx}");
            joints.push(bone(&name, Some(parent), offset, Vec3::Y * 1.6, 0.5));
            parent = joints.len() - 1;
        }
    }
    Skeleton::from_joints(joints).expect("a hand")
}

#[test]
fn fingers_that_nearly_touch_follow_their_own_joints_alone() {
    let skeleton = hand();
    let mesh = body(&skeleton, 4.0);
    let bound = mesh.bound(&skeleton, Skinning::Linear).expect("bound");
    let finger_of = |joint: JointId| joint.index().checked_sub(1).map(|index| index / 3);
    let mut beyond_web = 0;
    for (position, weights) in bound.mesh().positions.iter().zip(bound.weights()) {
        // The body is one up to the first knuckles.
        if position.y < 6.2 {
            continue;
        }
        beyond_web += 1;
        let own = ((position.x / 1.4).round() + 2.0) as usize;
        for (joint, weight) in weights.iter() {
            assert_eq!(finger_of(joint), Some(own), "{position} follows {joint} by {weight}");
        }
    }
    assert!(beyond_web > 1000, "{beyond_web}");
    assert!(greatest_jump(&bound) <= 0.35, "{}", greatest_jump(&bound));
}

#[test]
fn thighs_that_nearly_touch_do_not_stick_together() {
    let up = Vec3::Y;
    let skeleton = Skeleton::from_joints(vec![
        bone("spine", None, up * 10.0, up * 6.0, 1.4),
        bone("left thigh", Some(0), Vec3::X * 1.05, -up * 5.0, 1.0),
        bone("left shin", Some(1), -up * 5.0, -up * 5.0, 0.7),
        bone("right thigh", Some(0), -Vec3::X * 1.05, -up * 5.0, 1.0),
        bone("right shin", Some(3), -up * 5.0, -up * 5.0, 0.7),
    ])
    .expect("legs");
    let bound = body(&skeleton, 6.0).bound(&skeleton, Skinning::Linear).expect("bound");
    for (position, weights) in bound.mesh().positions.iter().zip(bound.weights()) {
        // Below the crotch.
        if position.y < 7.5 && position.x.abs() > 0.02 {
            let others = if position.x > 0.0 { [3, 4] } else { [1, 2] };
            let stuck = others.map(|joint| weights.of(JointId::new(joint)));
            assert_eq!(stuck, [0.0; 2], "{position}: {weights:?}");
        }
    }
}

#[test]
fn weights_are_smooth_with_the_sum_1_and_own_in_the_middle_of_long_bones() {
    for seed in 0..40 {
        let mut random = Random(seed);
        let skeleton = chain(&mut random, 1 + seed as usize % 6, 4.0);
        let mesh = body(&skeleton, 2.0);
        let bound = mesh.bound(&skeleton, Skinning::Linear).expect("bound");
        let jump = greatest_jump(&bound);
        assert!(jump <= 0.35, "seed {seed}: {jump}");
        for weights in bound.weights() {
            let sum: f32 = weights.iter().map(|(_, weight)| weight).sum();
            assert!((sum - 1.0).abs() < 1e-6, "seed {seed}: {sum}");
        }
    }
    let tube = |index: usize| {
        let parent = index.checked_sub(1);
        let offset = if index == 0 { Vec3::ZERO } else { Vec3::Y * 7.0 };
        bone(&format!("{index}"), parent, offset, Vec3::Y * 7.0, 1.0)
    };
    let skeleton = Skeleton::from_joints((0..3).map(tube).collect()).expect("a tube");
    let bound = body(&skeleton, 3.0).bound(&skeleton, Skinning::Linear).expect("bound");
    let mut checked = 0;
    for (position, weights) in bound.mesh().positions.iter().zip(bound.weights()) {
        let (of, along) = ((position.y / 7.0).floor(), (position.y / 7.0).fract());
        if (0.0..3.0).contains(&of) && (1.0 / 3.0..2.0 / 3.0).contains(&along) {
            let own = weights.of(JointId::new(of as usize));
            assert!(own >= 0.95, "{position}: {own}");
            checked += 1;
        }
    }
    assert!(checked > 300, "{checked}");
}

#[test]
fn a_bound_mesh_stays_where_it_is_in_the_pose_in_which_it_is_bound() {
    for seed in 0..30 {
        let mut random = Random(100 + seed);
        let (mut skeleton, _) = tree(&mut random, 4, 4.0);
        let mesh = body(&skeleton, 1.5);
        shake(&mut random, &mut skeleton);
        skeleton.set_transform(transform(&mut random)).expect("finite");
        let morph = Morph {
            name: "wide".into(),
            vertices: vec![0, 3],
            offsets: vec![Vec3::X, Vec3::Y],
            normals: vec![Vec3::ZERO; 2],
        };
        let mesh = mesh.with_morphs(vec![morph]).expect("a morph target");
        // Spread twist measures rolls from the bind pose.
        let skinning = random.one_of(&[Skinning::Linear, Skinning::DualQuaternion]);
        let bound = mesh.bound(&skeleton, skinning).expect("bound");
        for weight in [0.0, 1.0] {
            let [before, after] = [&mesh, &bound].map(|mesh| {
                let mesh = mesh.morphed(&[weight]);
                mesh.posed(&mesh.pose(&skeleton), skinning)
            });
            let size = before.size();
            for (one, other) in before.positions.iter().zip(&after.positions) {
                assert!(one.distance(*other) < 1e-4 * size, "seed {seed}: {one}, {other}");
            }
            for (one, other) in before.normals.iter().zip(&after.normals) {
                assert!(one.distance(*other) < 1e-2, "seed {seed}: {one}, {other}");
            }
        }
    }
}

#[test]
fn vertices_at_one_place_have_the_same_weights() {
    let skeleton = chain(&mut Random(7), 3, 4.0);
    let welded = body(&skeleton, 2.0);
    let TriangleMesh { positions, normals, triangles, .. } = welded.mesh();
    // Each triangle with corners of its own, as where textures are cut.
    let corners = triangles.as_flattened().iter().map(|corner| *corner as usize);
    let apart = TriangleMesh {
        positions: corners.clone().map(|corner| positions[corner]).collect(),
        normals: corners.clone().map(|corner| normals[corner]).collect(),
        triangles: (0..triangles.len() as u32).map(|it| [3 * it, 3 * it + 1, 3 * it + 2]).collect(),
        ..TriangleMesh::default()
    };
    let one = welded.bound(&skeleton, Skinning::Linear).expect("bound");
    let other = loose(apart, &skeleton).bound(&skeleton, Skinning::Linear).expect("bound");
    for (vertex, corner) in corners.enumerate() {
        let (one, other) = (one.weights()[corner], other.weights()[vertex]);
        for (joint, weight) in one.iter() {
            assert!((other.of(joint) - weight).abs() < 1e-5, "{one:?}, {other:?}");
        }
    }
}

#[test]
fn a_button_follows_the_place_where_it_is() {
    let tube = |index: usize| {
        let offset = if index == 0 { Vec3::ZERO } else { Vec3::Y * 6.0 };
        bone(&format!("{index}"), index.checked_sub(1), offset, Vec3::Y * 6.0, 1.0)
    };
    let skeleton = Skeleton::from_joints((0..2).map(tube).collect()).expect("a tube");
    let mut mesh = body(&skeleton, 3.0).mesh().clone();
    let first = mesh.positions.len() as u32;
    // Seen by the second bone through the wall alone, outside of it.
    let button = [Vec3::ZERO, Vec3::X, Vec3::Z].map(|at| Vec3::new(1.05, 9.0, 0.0) + 0.1 * at);
    mesh.positions.extend(button);
    mesh.normals.extend([Vec3::Y; 3]);
    mesh.triangles.push([first, first + 1, first + 2]);
    let bound = loose(mesh, &skeleton).bound(&skeleton, Skinning::Linear).expect("bound");
    let nearest = (0..first as usize)
        .min_by(|one, other| {
            let apart = |vertex: &usize| bound.mesh().positions[*vertex].distance(button[0]);
            apart(one).total_cmp(&apart(other))
        })
        .expect("a vertex");
    assert_eq!(bound.weights()[first as usize], bound.weights()[nearest]);
    assert!(bound.weights()[first as usize].of(JointId::new(1)) > 0.95);
}

#[test]
fn meshes_of_any_size_place_and_shape_are_bound() {
    let skeleton = hand();
    let plain = body(&skeleton, 1.5);
    let expected = plain.bound(&skeleton, Skinning::Linear).expect("bound");
    for (size, away) in [(1e-18, 0.0), (1e18, 0.0), (1.0, 1e3), (1e-3, 1.0)] {
        let scaled = |joint: &Joint| Joint {
            offset: joint.offset * size
                + if joint.parent.is_none() { Vec3::X * away } else { Vec3::ZERO },
            axis: joint.axis * size,
            ..joint.clone()
        };
        let joints = skeleton.joints().iter().map(|joint| scaled(joint)).collect();
        let moved = Skeleton::from_joints(joints).expect("a hand");
        let mut mesh = plain.mesh().clone();
        mesh.positions.iter_mut().for_each(|at| *at = *at * size + Vec3::X * away);
        let bound = loose(mesh, &moved).bound(&moved, Skinning::Linear).expect("bound");
        let worst = bound.weights().iter().zip(expected.weights()).map(|(one, other)| {
            let apart = |(joint, weight): (JointId, f32)| (other.of(joint) - weight).abs();
            one.iter().map(apart).fold(0.0, f32::max)
        });
        let worst = worst.fold(0.0, f32::max);
        assert!(worst < 0.1, "size {size}, away {away}: {worst}");
    }
    // Triangles without an area, without triangles, bones outside, a flat mesh.
    let degenerate = TriangleMesh {
        positions: vec![Vec3::ZERO, Vec3::X, Vec3::X, Vec3::Y],
        normals: vec![Vec3::Y; 4],
        triangles: vec![[0, 1, 2], [0, 0, 0], [1, 2, 3], [0, 1, 3]],
        ..TriangleMesh::default()
    };
    let points = TriangleMesh { triangles: Vec::new(), ..degenerate.clone() };
    for mesh in [degenerate, points, TriangleMesh::default()] {
        let bound = loose(mesh, &skeleton).bound(&skeleton, Skinning::Linear).expect("bound");
        assert!(bound.weights().iter().all(|weights| weights.iter().count() > 0));
    }
    let empty = Skeleton::with_root("root");
    let refused = loose(TriangleMesh::default(), &empty).bound(&empty, Skinning::Linear);
    assert_eq!(refused, Err(BindError::NoBones));
}

#[test]
fn a_mesh_that_is_attached_again_stays_while_its_joint_goes_elsewhere() {
    let mut skeleton = Skeleton::with_root("root");
    let mesh = TriangleMesh {
        positions: vec![Vec3::X, Vec3::Y, Vec3::Z],
        normals: vec![Vec3::Y; 3],
        triangles: vec![[0, 1, 2]],
        ..TriangleMesh::default()
    };
    let mesh = loose(mesh, &skeleton);
    let before = skeleton.clone();
    let turned = |joint: &mut Joint| {
        joint.offset = Vec3::new(1.0, 2.0, 3.0);
        joint.rotation = Vec3::new(0.3, 0.2, 0.1);
        joint.frame = Mat3::IDENTITY;
        joint.limits = JointLimits::NONE;
    };
    skeleton.change(JointId::new(0), turned).expect("finite");
    let weights = mesh.weights().to_vec();
    let again = mesh.reattached(weights, [&before, &skeleton], Skinning::Linear).expect("attached");
    let [one, other] = [(&mesh, &before), (&again, &skeleton)]
        .map(|(mesh, skeleton)| mesh.posed(&mesh.pose(skeleton), Skinning::Linear));
    for (one, other) in one.positions.iter().zip(&other.positions) {
        assert!(one.distance(*other) < 1e-5, "{one}, {other}");
    }
    assert_ne!(again.inverse_binds(), [Affine3A::IDENTITY]);
}
