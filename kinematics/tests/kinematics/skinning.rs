//! Skinned meshes against independent formulations in f64.

use glam::{Affine3A, DMat3, DMat4, DQuat, DVec3, Mat3, Mat3A, Vec3};
use ik_arm_kinematics::skeleton::{Joint, JointId, JointLimits, Skeleton, SkinStretch};
use ik_arm_kinematics::skin::{
    SkinError, SkinShape, SkinnedMesh, Skinning, TriangleMesh, VertexWeights,
};
use nalgebra::Matrix3;

use crate::common::Random;
use crate::common::skeletons::{forest, shake, space_f64, transform};

const CASES: usize = 200;
const VERTICES: usize = 40;
/// Greatest difference from the twin, as a fraction of the size of mesh and pose.
const TOLERANCE: f64 = 1e-5;

/// A mesh with random weights on a random posed skeleton.
struct Case {
    skeleton: Skeleton,
    mesh: SkinnedMesh,
    size: f64,
}

impl Case {
    fn random(random: &mut Random, bind: impl Fn(&mut Random) -> Affine3A) -> Self {
        let joints = 1 + random.below(12);
        let mut skeleton = forest(random, joints);
        shake(random, &mut skeleton);
        skeleton.set_transform(transform(random)).expect("transform");
        for joint in skeleton.ids().collect::<Vec<_>>() {
            if random.chance(0.4) {
                let (scale, shear) = (Vec3::ONE + random.vector(0.7), random.vector(0.4));
                skeleton
                    .change(joint, |it| it.skin = SkinStretch { scale, shear })
                    .expect("finite");
            }
        }
        let pose = skeleton.bind_pose_in_skeleton();
        let attached = bind(random);
        let inverse_binds: Vec<Affine3A> =
            skeleton.ids().map(|joint| pose.full(joint).inverse() * attached).collect();
        let positions: Vec<Vec3> = (0..VERTICES).map(|_| random.vector(3.0)).collect();
        let normals = (0..VERTICES).map(|_| random.direction()).collect();
        let weights = (0..VERTICES)
            .map(|_| {
                let count = 1 + random.below(4);
                let pairs = (0..count)
                    .map(|_| (JointId::new(random.below(joints)), random.within(0.01..1.0)));
                VertexWeights::heaviest(pairs.collect::<Vec<_>>()).0
            })
            .collect();
        let mesh = TriangleMesh { positions, normals, ..TriangleMesh::default() };
        let mesh = SkinnedMesh::new(mesh, weights, inverse_binds).expect("mesh");
        let scale = skeleton.transform().matrix3.to_cols_array().map(f32::abs);
        let scale = scale.into_iter().fold(0.0_f32, f32::max).max(1.0);
        let attached = attached.matrix3.to_cols_array().map(f32::abs);
        let attached = attached.into_iter().fold(1.0_f32, f32::max);
        let length: f32 = skeleton.joints().iter().map(|joint| joint.offset.length()).sum();
        let size = f64::from(scale * (length + 10.0 * attached));
        Self { skeleton, mesh, size }
    }

    /// X_i in f64, in skeleton space.
    fn space(&self, joint: JointId) -> DMat4 {
        let angles: Vec<DVec3> =
            self.skeleton.joints().iter().map(|joint| joint.rotation.as_dvec3()).collect();
        space_f64(&self.skeleton, joint, &angles)
    }

    fn inverse_bind(&self, joint: JointId) -> DMat4 {
        DMat4::from(self.mesh.inverse_binds()[joint.index()].as_daffine3())
    }

    /// S_i in f64, by the images of the frame's axes.
    fn stretch(&self, joint: JointId) -> DMat4 {
        let Joint { skin: SkinStretch { scale, shear }, frame, .. } = &self.skeleton[joint];
        let (scale, shear, frame) = (scale.as_dvec3(), shear.as_dvec3(), frame.as_dmat3());
        let x = DVec3::new(scale.x, shear.x, 0.0);
        let y = DVec3::new(0.0, scale.y, 0.0);
        let z = DVec3::new(shear.y, shear.z, scale.z);
        let images = DMat3::from_cols(frame * x, frame * y, frame * z);
        DMat4::from_mat3(images * frame.inverse())
    }

    /// J_i in f64, in skeleton space.
    fn joint(&self, joint: JointId) -> DMat4 {
        self.space(joint) * self.stretch(joint) * self.inverse_bind(joint)
    }

    fn to_world(&self) -> DMat4 {
        DMat4::from(self.skeleton.transform().as_daffine3())
    }

    /// Compares positions and normals with a twin that gives the deformed position for a vertex,
    /// and the transform whose inverse transpose its normal has.
    fn compare(&self, skinning: Skinning, twin: impl Fn(&VertexWeights, DVec3) -> (DVec3, DMat3)) {
        let posed = self.mesh.posed(&self.mesh.pose(&self.skeleton), skinning);
        let to_world = self.to_world();
        for (vertex, weights) in self.mesh.weights().iter().enumerate() {
            let position = self.mesh.mesh().positions[vertex].as_dvec3();
            let (expected, linear) = twin(weights, position);
            let expected = to_world.transform_point3(expected);
            let error = posed.positions[vertex].as_dvec3().distance(expected) / self.size;
            assert!(error < TOLERANCE, "{skinning}: vertex {vertex} is {error:.1e} away");
            let linear = DMat3::from_mat4(to_world) * linear;
            let normal = self.mesh.mesh().normals[vertex].as_dvec3();
            // Where the mesh nearly collapses, rounding decides the normal.
            let shape = linear.determinant().abs()
                / linear.to_cols_array().map(f64::abs).into_iter().fold(0.0, f64::max).powi(3);
            if shape > 1e-2 {
                let expected = (linear.inverse().transpose() * normal).normalize();
                let error = posed.normals[vertex].as_dvec3().distance(expected);
                assert!(error < 1e-3, "{skinning}: normal {vertex} is off by {error:.1e}");
            }
        }
    }
}

/// Inverse bind transforms without scale, with an even one, and with an uneven or mirroring one.
fn any_bind(random: &mut Random) -> Affine3A {
    transform(random)
}

fn rigid_bind(random: &mut Random) -> Affine3A {
    Affine3A::from_mat3_translation(random.rotation(), random.vector(2.0))
}

#[test]
fn linear_blending_is_the_weighted_sum_of_the_joints_matrices() {
    let mut random = Random(1);
    for _ in 0..CASES {
        let case = Case::random(&mut random, any_bind);
        case.compare(Skinning::Linear, |weights, position| {
            let mut sum = DMat4::ZERO;
            let total: f64 = weights.iter().map(|(_, weight)| f64::from(weight)).sum();
            for (joint, weight) in weights.iter() {
                sum += case.joint(joint) * (f64::from(weight) / total);
            }
            (sum.transform_point3(position), DMat3::from_mat4(sum))
        });
    }
}

#[test]
fn dual_quaternion_blending_is_the_normalised_sum_of_the_joints_motions_after_their_scales() {
    let mut random = Random(2);
    for case in 0..CASES {
        let bind = if case % 2 == 0 { rigid_bind } else { any_bind };
        let case = Case::random(&mut random, bind);
        // Two rotations by nearly 180° against each other have no unique blend.
        let is_settled = |weights: &VertexWeights| {
            let rotations: Vec<DQuat> =
                weights.iter().map(|(joint, _)| parts(case.joint(joint)).0).collect();
            rotations.iter().all(|rotation| rotation.dot(rotations[0]).abs() > 1e-3)
        };
        if case.mesh.weights().iter().all(is_settled) {
            case.compare(Skinning::DualQuaternion, |weights, position| {
                dual_blend(&case, weights, position)
            });
        }
    }
}

/// Rotation, translation and scale of a transform, by singular values.
fn parts(transform: DMat4) -> (DQuat, DVec3, DMat3) {
    let linear = DMat3::from_mat4(transform);
    let columns = linear.to_cols_array();
    let svd = Matrix3::from_column_slice(&columns).svd(true, true);
    let (u, v) = (svd.u.expect("u"), svd.v_t.expect("v"));
    let mut rotation = u * v;
    if rotation.determinant() < 0.0 {
        rotation = -rotation;
    }
    let rotation = DMat3::from_cols_slice(rotation.as_slice());
    (DQuat::from_mat3(&rotation), transform.w_axis.truncate(), rotation.transpose() * linear)
}

/// A number a + εb with ε² = 0.
#[derive(Clone, Copy)]
struct Dual(f64, f64);

impl std::ops::Add for Dual {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self(self.0 + other.0, self.1 + other.1)
    }
}

impl std::ops::Mul for Dual {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        Self(self.0 * other.0, self.0 * other.1 + self.1 * other.0)
    }
}

impl Dual {
    fn inverse_root(self) -> Self {
        Self(self.0.powf(-0.5), -0.5 * self.1 * self.0.powf(-1.5))
    }
}

/// Quaternion product (x, y, z, w) of dual numbers.
fn product(a: [Dual; 4], b: [Dual; 4]) -> [Dual; 4] {
    let minus = Dual(-1.0, 0.0);
    let m = |i: usize, j: usize| a[i] * b[j];
    [
        m(3, 0) + m(0, 3) + m(1, 2) + minus * m(2, 1),
        m(3, 1) + m(1, 3) + m(2, 0) + minus * m(0, 2),
        m(3, 2) + m(2, 3) + m(0, 1) + minus * m(1, 0),
        m(3, 3) + minus * (m(0, 0) + m(1, 1) + m(2, 2)),
    ]
}

/// The blend as products of quaternions of dual numbers: q̂ v̂ q̂* with v̂ = 1 + ε·v, where *
/// conjugates both the quaternion and the dual numbers.
fn dual_blend(case: &Case, weights: &VertexWeights, position: DVec3) -> (DVec3, DMat3) {
    let mut scale = DMat3::ZERO;
    let mut sum = [Dual(0.0, 0.0); 4];
    let first = parts(case.joint(weights.first())).0;
    for (joint, weight) in weights.iter() {
        let weight = f64::from(weight);
        let (rotation, translation, joint_scale) = parts(case.joint(joint));
        scale += joint_scale * weight;
        let half = [translation.x, translation.y, translation.z].map(|t| Dual(0.0, 0.5 * t));
        let translate = [half[0], half[1], half[2], Dual(1.0, 0.0)];
        let rotate = rotation.to_array().map(|part| Dual(part, 0.0));
        let sign = if rotation.dot(first) < 0.0 { -weight } else { weight };
        for (total, part) in sum.iter_mut().zip(product(translate, rotate)) {
            *total = *total + Dual(sign, 0.0) * part;
        }
    }
    let norm = sum.into_iter().fold(Dual(0.0, 0.0), |total, part| total + part * part);
    let inverse = norm.inverse_root();
    let unit = sum.map(|part| part * inverse);
    let scaled = scale * position;
    let point = [Dual(0.0, scaled.x), Dual(0.0, scaled.y), Dual(0.0, scaled.z), Dual(1.0, 0.0)];
    let conjugate = |q: [Dual; 4]| {
        [Dual(-q[0].0, q[0].1), Dual(-q[1].0, q[1].1), Dual(-q[2].0, q[2].1), Dual(q[3].0, -q[3].1)]
    };
    let moved = product(product(unit, point), conjugate(unit));
    let rotation = DQuat::from_array(unit.map(|part| part.0));
    (DVec3::new(moved[0].1, moved[1].1, moved[2].1), DMat3::from_quat(rotation) * scale)
}

#[test]
fn spread_twist_gives_each_vertex_its_fraction_of_the_roll_of_the_bone() {
    let mut random = Random(3);
    for _ in 0..CASES {
        let case = Case::random(&mut random, any_bind);
        case.compare(Skinning::SpreadTwist, |weights, position| {
            let mut sum = DMat4::ZERO;
            for (joint, weight) in weights.iter() {
                sum += spread(&case, joint, position) * f64::from(weight);
            }
            (sum.transform_point3(position), DMat3::from_mat4(sum))
        });
    }
}

/// J of a joint whose rotation R = swing · roll(τ) is replaced by swing · roll(t·τ). The swing is
/// the least rotation that takes the bone to where R takes it, and the roll is what is left of R.
fn spread(case: &Case, joint: JointId, position: DVec3) -> DMat4 {
    let Joint { parent, offset, axis, .. } = case.skeleton[joint];
    let Some(axis) = axis.as_dvec3().try_normalize() else { return case.joint(joint) };
    let length = case.skeleton[joint].axis.as_dvec3().length();
    let bind = case.inverse_bind(joint);
    let space = |joint| case.space(joint);
    let above = parent.map_or(DMat4::IDENTITY, space) * DMat4::from_translation(offset.as_dvec3());
    let rotation = DMat3::from_mat4(above.inverse() * space(joint));
    let swing = DMat3::from_quat(DQuat::from_rotation_arc(axis, rotation * axis));
    let side = axis.any_orthonormal_vector();
    let (from, to) = (swing * side, rotation * side);
    let roll = from.cross(to).dot(rotation * axis).atan2(from.dot(to));
    let fraction = (bind.transform_point3(position).dot(axis) / length).clamp(0.0, 1.0);
    let part = swing * DMat3::from_axis_angle(axis, fraction * roll);
    above * DMat4::from_mat3(part) * case.stretch(joint) * bind
}

#[test]
fn in_the_pose_in_which_it_was_attached_a_mesh_stays() {
    let mut random = Random(4);
    for skinning in Skinning::ALL {
        for _ in 0..50 {
            let mut case = Case::random(&mut random, rigid_bind);
            let place = case.skeleton.transform();
            let unposed = case.skeleton.joints().iter().map(|joint| Joint {
                rotation: Vec3::ZERO,
                limits: JointLimits::NONE,
                skin: SkinStretch::NONE,
                ..Joint::clone(joint)
            });
            case.skeleton = Skeleton::from_joints(unposed.collect()).expect("skeleton");
            case.skeleton.set_transform(place).expect("transform");
            let root = JointId::new(0);
            let pose = case.skeleton.bind_pose_in_skeleton();
            let attached = pose.full(root) * case.mesh.inverse_binds()[0];
            let place = case.skeleton.transform() * attached;
            let posed = case.mesh.posed(&case.mesh.pose(&case.skeleton), skinning);
            for (posed, original) in posed.positions.iter().zip(&case.mesh.mesh().positions) {
                let error = f64::from(posed.distance(place.transform_point3(*original)));
                assert!(error < TOLERANCE * case.size, "{skinning}: {error:.1e}");
            }
        }
    }
}

/// Two bones in line with a skin, the second turned about their common axis.
fn twisted_forearm(angle: f32) -> (Skeleton, SkinnedMesh) {
    let bone = |name, parent, offset| Joint {
        offset,
        radius: 0.5,
        ..Joint::new(name, parent, Vec3::Y * 4.0)
    };
    let joints =
        vec![bone("upper", None, Vec3::ZERO), bone("lower", Some(0.into()), Vec3::Y * 4.0)];
    let mut skeleton = Skeleton::from_joints(joints).expect("skeleton");
    let mesh = SkinnedMesh::from_bones(&skeleton, &SkinShape::default()).expect("skin");
    skeleton.set_rotation(1.into(), Vec3::Y * angle).expect("rotation");
    (skeleton, mesh)
}

/// Area of the section of a mesh of triangles at a height.
fn section_area(mesh: &TriangleMesh, height: f32) -> f64 {
    let mut area = 0.0;
    for triangle in &mesh.triangles {
        let corners = triangle.map(|corner| mesh.positions[corner as usize].as_dvec3());
        let mut ends = [None, None];
        for side in 0..3 {
            let (from, to) = (corners[side], corners[(side + 1) % 3]);
            let (a, b) = (from.y - f64::from(height), to.y - f64::from(height));
            if (a < 0.0) != (b < 0.0) {
                ends[usize::from(a < 0.0)] = Some(from.lerp(to, a / (a - b)));
            }
        }
        if let [Some(from), Some(to)] = ends {
            area += 0.5 * (from.x * to.z - from.z * to.x);
        }
    }
    area.abs()
}

#[test]
fn a_forearm_twisted_by_180_degrees_collapses_only_under_linear_blending() {
    let (skeleton, mesh) = twisted_forearm(std::f32::consts::PI);
    let before = section_area(mesh.mesh(), 4.0);
    let kept = |skinning| section_area(&mesh.posed(&mesh.pose(&skeleton), skinning), 4.0) / before;
    assert!((0.95..1.05).contains(&(before / (std::f64::consts::PI * 0.25))), "{before}");
    assert!(kept(Skinning::Linear) < 0.1, "{}", kept(Skinning::Linear));
    assert!(kept(Skinning::DualQuaternion) > 0.9, "{}", kept(Skinning::DualQuaternion));
    assert!(kept(Skinning::SpreadTwist) > 0.95, "{}", kept(Skinning::SpreadTwist));
}

#[test]
fn spread_twist_turns_a_bone_little_by_little_up_to_all_of_its_roll_at_the_tip() {
    let (skeleton, mesh) = twisted_forearm(2.0);
    let posed = mesh.posed(&mesh.pose(&skeleton), Skinning::SpreadTwist);
    let own = mesh.weights().iter().map(|weights| weights.of(1.into()) == 1.0);
    let vertices = mesh.mesh().positions.iter().zip(&posed.positions).zip(own);
    for ((before, after), _) in vertices.filter(|(_, is_own)| *is_own) {
        let fraction = ((before.y - 4.0) / 4.0).clamp(0.0, 1.0);
        let expected = Mat3::from_rotation_y(2.0 * fraction) * *before;
        assert!(after.distance(expected) < 1e-4, "{before} to {after}, not {expected}");
    }
}

#[test]
fn a_mirrored_mesh_has_normals_and_triangles_that_face_outwards() {
    let (mut skeleton, mesh) = twisted_forearm(1.0);
    let mirror =
        Affine3A { matrix3: Mat3A::from_diagonal(Vec3::new(-1.0, 1.0, 1.0)), ..Affine3A::IDENTITY };
    skeleton.set_transform(mirror).expect("transform");
    for skinning in Skinning::ALL {
        let posed = mesh.posed(&mesh.pose(&skeleton), skinning);
        for triangle in &posed.triangles {
            let [a, b, c] = triangle.map(|corner| posed.positions[corner as usize]);
            let face = (b - a).cross(c - a);
            let normal = posed.normals[triangle[0] as usize];
            assert!(face.dot(normal) > 0.0, "{skinning}: {triangle:?}");
            assert!(normal.dot(a.with_y(0.0)) > -1e-3 || a.y < 0.0 || a.y > 8.0, "{skinning}");
        }
    }
}

#[test]
fn the_four_heaviest_weights_are_kept_and_the_cut_part_is_told() {
    let weights = (0..6).map(|joint| (JointId::new(joint), 1.0 + joint as f32));
    let (kept, cut) = VertexWeights::heaviest(weights);
    let joints: Vec<usize> = kept.iter().map(|(joint, _)| joint.index()).collect();
    assert_eq!(joints, [5, 4, 3, 2]);
    assert!((kept.iter().map(|(_, weight)| weight).sum::<f32>() - 1.0).abs() < 1e-6);
    assert!((cut - 3.0 / 21.0).abs() < 1e-6, "{cut}");
}

#[test]
fn weights_that_are_not_above_0_count_as_none() {
    let weights = [(3, f32::NAN), (2, -1.0), (1, 0.0), (4, f32::INFINITY)];
    let weights = weights.map(|(joint, weight)| (JointId::new(joint), weight));
    assert_eq!(VertexWeights::heaviest(weights), (VertexWeights::rigid(JointId::new(0)), 0.0));
}

#[test]
fn a_mesh_whose_lists_contradict_each_other_is_refused_with_the_reason() {
    let mesh = || TriangleMesh {
        positions: vec![Vec3::ZERO; 3],
        normals: vec![Vec3::Y; 3],
        triangles: vec![[0, 1, 2]],
        ..TriangleMesh::default()
    };
    let weights = vec![VertexWeights::rigid(JointId::new(0)); 3];
    let binds = vec![Affine3A::IDENTITY];
    assert!(SkinnedMesh::new(mesh(), weights.clone(), binds.clone()).is_ok());
    let refused = |mesh, weights: &[VertexWeights], binds: &[Affine3A]| {
        SkinnedMesh::new(mesh, weights.to_vec(), binds.to_vec()).expect_err("refused").to_string()
    };
    assert_eq!(
        refused(TriangleMesh { normals: vec![Vec3::Y], ..mesh() }, &weights, &binds),
        "normals must have one entry for each of the 3 vertices, got 1"
    );
    assert_eq!(
        refused(mesh(), &weights[..2], &binds),
        "weights must have one entry for each of the 3 vertices, got 2"
    );
    assert_eq!(
        refused(TriangleMesh { triangles: vec![[0, 1, 3]], ..mesh() }, &weights, &binds),
        "triangle 0 must have vertices below 3, got 3"
    );
    assert_eq!(
        refused(mesh(), &[VertexWeights::rigid(JointId::new(1)); 3], &binds),
        "vertex 0 must follow joints below 1, got 1"
    );
    let error =
        SkinnedMesh::new(mesh(), weights, vec![Affine3A::from_translation(Vec3::splat(f32::NAN))]);
    assert_eq!(error, Err(SkinError::Bind { joint: JointId::new(0) }));
}
