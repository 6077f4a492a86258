use std::sync::Arc;

use glam::{Affine3A, Mat3A, Vec3, Vec3A};

use super::morph::Morph;
use super::skin_pose::{SkinPose, Skinning};
use super::triangle_mesh::{MeshHit, TriangleMesh};
use super::vertex_weights::VertexWeights;
use crate::skeleton::{JointId, Skeleton};

/// A mesh whose vertices follow joints.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SkinnedMesh {
    mesh: TriangleMesh,
    weights: Vec<VertexWeights>,
    /// All have the same number of joints.
    bind_sets: Vec<BindSet>,
    morphs: Arc<[Morph]>,
}

/// The inverse bind transforms of some vertices. A mesh that is put together from several files or
/// parts can have been attached to the same joints in different poses.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BindSet {
    /// Number of vertices, which follow those of the set before.
    pub vertices: usize,
    /// For each joint the inverse bind transform B⁻¹, from mesh space to the joint's own space.
    pub inverse_binds: Vec<Affine3A>,
}

impl SkinnedMesh {
    /// Maximum number of vertices: graphics devices of any kind can hold as many.
    pub const MOST_VERTICES: usize = 2_500_000;
    /// Maximum number of triangles.
    pub const MOST_TRIANGLES: usize = 5_000_000;
    /// Maximum number of inverse bind transforms of all sets.
    pub const MOST_BINDS: usize = 1 << 16;

    /// A mesh with the weights of its vertices and, for each joint, the inverse bind transform B⁻¹
    /// from mesh space to the joint's own space.
    ///
    /// # Errors
    ///
    /// [`SkinError`] if the lists do not fit each other or are too long, or a number is not finite.
    pub fn new(
        mesh: TriangleMesh,
        weights: Vec<VertexWeights>,
        inverse_binds: Vec<Affine3A>,
    ) -> Result<Self, SkinError> {
        let vertices = mesh.positions.len();
        Self::with_bind_sets(mesh, weights, vec![BindSet { vertices, inverse_binds }])
    }

    /// [`SkinnedMesh::new`] with several sets of inverse bind transforms, one after the other for all
    /// vertices.
    ///
    /// # Errors
    ///
    /// As [`SkinnedMesh::new`].
    pub fn with_bind_sets(
        mesh: TriangleMesh,
        weights: Vec<VertexWeights>,
        bind_sets: Vec<BindSet>,
    ) -> Result<Self, SkinError> {
        let vertices = mesh.positions.len();
        let joints = bind_sets.first().map_or(0, |set| set.inverse_binds.len());
        for (list, most, got) in [
            ("vertices", Self::MOST_VERTICES, vertices),
            ("triangles", Self::MOST_TRIANGLES, mesh.triangles.len()),
            ("inverse bind transforms", Self::MOST_BINDS, bind_sets.len().saturating_mul(joints)),
        ] {
            if got > most {
                return Err(SkinError::TooMany { list, most, got });
            }
        }
        let or_none = |count: usize| if count == 0 { vertices } else { count };
        let lists = [
            ("normals", mesh.normals.len()),
            ("texture coordinates", or_none(mesh.texture_coordinates.len())),
            ("texture coordinates of emission", or_none(mesh.emission_coordinates.len())),
            ("colours", or_none(mesh.colours.len())),
            ("weights", weights.len()),
            ("sets of inverse bind transforms", bind_sets.iter().map(|set| set.vertices).sum()),
        ];
        for (list, got) in lists {
            if got != vertices {
                return Err(SkinError::Count { list, vertices, got });
            }
        }
        for (triangle, corners) in mesh.triangles.iter().enumerate() {
            if let Some(&got) = corners.iter().find(|corner| **corner as usize >= vertices) {
                return Err(SkinError::Triangle { triangle, vertices, got });
            }
        }
        if let Some(set) = bind_sets.iter().find(|set| set.inverse_binds.len() != joints) {
            return Err(SkinError::BindSet { joints, got: set.inverse_binds.len() });
        }
        for (vertex, weights) in weights.iter().enumerate() {
            if let Some((got, _)) = weights.iter().find(|(joint, _)| joint.index() >= joints) {
                return Err(SkinError::Joint { vertex, joints, got });
            }
        }
        for vectors in [&mesh.positions, &mesh.normals] {
            if let Some(vertex) = vectors.iter().position(|vector| !vector.is_finite()) {
                return Err(SkinError::NotFinite { vertex, got: vectors[vertex] });
            }
        }
        for coordinates in [&mesh.texture_coordinates, &mesh.emission_coordinates] {
            if let Some(vertex) = coordinates.iter().position(|vector| !vector.is_finite()) {
                let got = coordinates[vertex].extend(0.0);
                return Err(SkinError::NotFinite { vertex, got });
            }
        }
        for set in &bind_sets {
            if let Some(joint) = set.inverse_binds.iter().position(|bind| !bind.is_finite()) {
                return Err(SkinError::Bind { joint: JointId::new(joint) });
            }
        }
        Ok(Self { mesh, weights, bind_sets, morphs: [].into() })
    }

    /// The mesh with these morph targets instead of its own.
    ///
    /// # Errors
    ///
    /// [`SkinError`] if a morph target has lists of different lengths, vertices that do not exist
    /// or are not in ascending order, or a number that is not finite, or if there are too many.
    pub fn with_morphs(self, morphs: Vec<Morph>) -> Result<Self, SkinError> {
        let vertices = self.mesh.positions.len();
        let offsets = morphs.iter().map(|morph| morph.vertices.len()).sum();
        for (list, most, got) in [
            ("morph targets", Morph::MOST, morphs.len()),
            ("vertices moved by morph targets", Morph::MOST_OFFSETS, offsets),
        ] {
            if got > most {
                return Err(SkinError::TooMany { list, most, got });
            }
        }
        for (index, morph) in morphs.iter().enumerate() {
            let count = morph.vertices.len();
            let is_valid = [morph.offsets.len(), morph.normals.len()] == [count; 2]
                && morph.vertices.is_sorted_by(|one, next| one < next)
                && morph.vertices.last().is_none_or(|last| (*last as usize) < vertices)
                && morph.offsets.iter().chain(&morph.normals).all(|change| change.is_finite());
            if !is_valid {
                return Err(SkinError::Morph { index, vertices });
            }
        }
        Ok(Self { morphs: morphs.into(), ..self })
    }

    /// The morph targets.
    pub fn morphs(&self) -> &[Morph] {
        &self.morphs
    }

    /// The mesh in the shape that its morph targets give it with these weights; those without a
    /// weight have 0. Vertices that overflow stay.
    #[must_use]
    pub fn morphed(&self, weights: &[f32]) -> Self {
        let mut morphed = self.clone();
        let TriangleMesh { positions, normals, .. } = &mut morphed.mesh;
        let mut is_moved = vec![false; positions.len()];
        for (morph, weight) in self.morphs.iter().zip(weights).filter(|(_, weight)| **weight != 0.0)
        {
            morph.add(*weight, positions, normals);
            morph.vertices.iter().for_each(|vertex| is_moved[*vertex as usize] = true);
        }
        for vertex in (0..is_moved.len()).filter(|vertex| is_moved[*vertex]) {
            if !positions[vertex].is_finite() {
                positions[vertex] = self.mesh.positions[vertex];
            }
            normals[vertex] = normals[vertex].normalize_or(self.mesh.normals[vertex]);
        }
        morphed
    }

    /// The mesh as it was attached, in mesh space.
    pub fn mesh(&self) -> &TriangleMesh {
        &self.mesh
    }

    /// Weights of the vertices.
    pub fn weights(&self) -> &[VertexWeights] {
        &self.weights
    }

    /// The sets of inverse bind transforms, one after the other for all vertices.
    pub fn bind_sets(&self) -> &[BindSet] {
        &self.bind_sets
    }

    /// For each joint the inverse bind transform B⁻¹, from mesh space to the joint's own space, for
    /// the vertices of the first of the [sets](SkinnedMesh::bind_sets).
    pub fn inverse_binds(&self) -> &[Affine3A] {
        self.bind_sets.first().map_or(&[], |set| &set.inverse_binds)
    }

    /// For each vertex the set of its inverse bind transforms, as its index.
    pub fn sets_of_vertices(&self) -> impl Iterator<Item = usize> {
        let sets = self.bind_sets.iter().enumerate();
        sets.flat_map(|(set, BindSet { vertices, .. })| core::iter::repeat_n(set, *vertices))
    }

    /// For each vertex the index among [`SkinPose::joints`] of the first joint of its set.
    pub fn first_joints(&self) -> impl Iterator<Item = usize> {
        let joints = self.inverse_binds().len();
        self.sets_of_vertices().map(move |set| set * joints)
    }

    /// Position in the world of a vertex of the posed mesh.
    ///
    /// # Panics
    ///
    /// If there is no such vertex.
    pub fn posed_vertex(&self, pose: &SkinPose, skinning: Skinning, vertex: u32) -> Vec3 {
        let vertex = vertex as usize;
        let position = self.mesh.positions[vertex];
        let set = self.sets_of_vertices().nth(vertex).unwrap_or_default();
        let first = set * self.inverse_binds().len();
        let blend = pose.blend(first, &self.weights[vertex], position, skinning);
        pose.to_world().transform_point3(blend.transform_point3(position))
    }

    /// The joint with the greatest weight at a point of the mesh.
    pub fn heaviest_joint(&self, hit: &MeshHit) -> JointId {
        self.weights_at(hit).first()
    }

    /// The weights of the joints at a point of the mesh.
    pub fn weights_at(&self, hit: &MeshHit) -> VertexWeights {
        let weights = hit.corners.iter().zip(hit.shares).flat_map(|(corner, share)| {
            self.weights[*corner as usize]
                .iter()
                .map(move |(joint, weight)| (joint, weight * share))
        });
        VertexWeights::heaviest(weights).0
    }

    /// The same mesh with its joints renumbered: `joints[i]` is the new index of joint i, and the
    /// weights of joints without one go to their nearest ancestor that has one, or else to the new
    /// joint 0. `parents` are the parents of the old joints, which precede their children.
    #[must_use]
    pub fn renumbered(&self, joints: &[Option<JointId>], parents: &[Option<JointId>]) -> Self {
        let mut heirs: Vec<Option<JointId>> = Vec::with_capacity(parents.len());
        for (old, parent) in parents.iter().enumerate() {
            let of_parent = parent.and_then(|parent| heirs.get(parent.index()).copied().flatten());
            heirs.push(joints.get(old).copied().flatten().or(of_parent));
        }
        let heir = |joint: JointId| heirs.get(joint.index()).copied().flatten().unwrap_or_default();
        let of_heirs = |weights: &VertexWeights| {
            VertexWeights::heaviest(weights.iter().map(|(joint, weight)| (heir(joint), weight))).0
        };
        let count = joints.iter().flatten().map(|joint| joint.index() + 1).max().unwrap_or(1);
        let renumbered = |set: &BindSet| {
            let mut inverse_binds = vec![Affine3A::IDENTITY; count];
            for (joint, bind) in joints.iter().zip(&set.inverse_binds) {
                if let Some(joint) = joint {
                    inverse_binds[joint.index()] = *bind;
                }
            }
            BindSet { vertices: set.vertices, inverse_binds }
        };
        let weights = self.weights.iter().map(of_heirs).collect();
        let bind_sets = self.bind_sets.iter().map(renumbered).collect();
        Self { mesh: self.mesh.clone(), weights, bind_sets, morphs: self.morphs.clone() }
    }

    /// Memory in bytes, without that of the morph targets.
    pub fn bytes(&self) -> usize {
        let TriangleMesh {
            positions,
            normals,
            texture_coordinates,
            emission_coordinates,
            colours,
            triangles,
        } = &self.mesh;
        size_of_val(&positions[..])
            + size_of_val(&normals[..])
            + size_of_val(&texture_coordinates[..])
            + size_of_val(&emission_coordinates[..])
            + size_of_val(&colours[..])
            + size_of_val(&triangles[..])
            + size_of_val(&self.weights[..])
            + self.bind_sets.iter().map(|set| size_of_val(&set.inverse_binds[..])).sum::<usize>()
    }

    /// The motion that each joint of a posed skeleton gives to the mesh.
    pub fn pose(&self, skeleton: &Skeleton) -> SkinPose {
        let mut pose = SkinPose::default();
        self.write_pose(skeleton, &mut pose);
        pose
    }

    /// Writes [`SkinnedMesh::pose`] into an existing pose, reusing its memory.
    pub fn write_pose(&self, skeleton: &Skeleton, pose: &mut SkinPose) {
        pose.refill(self.bind_sets.iter().map(|set| &set.inverse_binds[..]), skeleton);
    }

    /// The mesh posed in the world, with the corners of its triangles counter-clockwise seen from
    /// outside also if the skeleton's transform mirrors.
    pub fn posed(&self, pose: &SkinPose, skinning: Skinning) -> TriangleMesh {
        let mut posed = self.mesh.clone();
        self.write_posed(pose, skinning, &mut posed.positions, &mut posed.normals);
        if pose.to_world().matrix3.determinant() < 0.0 {
            for [_, second, third] in &mut posed.triangles {
                core::mem::swap(second, third);
            }
        }
        posed
    }

    /// Writes the positions and unit normals of the mesh posed in the world into existing lists.
    pub fn write_posed(
        &self,
        pose: &SkinPose,
        skinning: Skinning,
        positions: &mut Vec<Vec3>,
        normals: &mut Vec<Vec3>,
    ) {
        positions.clear();
        normals.clear();
        let vertices = self.mesh.positions.iter().zip(&self.mesh.normals).zip(&self.weights);
        for (((position, normal), weights), first) in vertices.zip(self.first_joints()) {
            let blend = pose.to_world() * pose.blend(first, weights, *position, skinning);
            positions.push(blend.transform_point3(*position));
            normals.push(posed_normal(blend.matrix3, *normal));
        }
    }
}

/// A normal under the linear part of a transform: the inverse transpose, computed by cofactors so
/// that a collapsed mesh has normals too. Without a direction, the original normal.
pub(super) fn posed_normal(linear: Mat3A, normal: Vec3) -> Vec3 {
    let Mat3A { x_axis, y_axis, z_axis } = linear;
    let cofactors =
        Mat3A::from_cols(y_axis.cross(z_axis), z_axis.cross(x_axis), x_axis.cross(y_axis));
    let mirror = if x_axis.dot(y_axis.cross(z_axis)) < 0.0 { -1.0 } else { 1.0 };
    let posed = cofactors * Vec3A::from(normal) * mirror;
    posed.try_normalize().map_or(normal, Vec3::from)
}

/// A skinned mesh whose parts contradict each other.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SkinError {
    /// The lists of vertices have different lengths.
    #[error("{list} must have one entry for each of the {vertices} vertices, got {got}")]
    Count {
        /// The list with a different length.
        list: &'static str,
        /// Number of positions.
        vertices: usize,
        /// Length of the list.
        got: usize,
    },
    /// There are too many vertices or triangles.
    #[error("a skin must have at most {most} {list}, got {got}")]
    TooMany {
        /// The things of which there are too many.
        list: &'static str,
        /// The greatest number.
        most: usize,
        /// The number.
        got: usize,
    },
    /// A morph target has lists that do not fit each other or the mesh, or a number that is not
    /// finite.
    #[error(
        "morph target {index} must have a finite offset and normal for each of its vertices, which \
         must be ascending and below {vertices}"
    )]
    Morph {
        /// Index of the morph target.
        index: usize,
        /// Number of vertices of the mesh.
        vertices: usize,
    },
    /// A triangle has a vertex that does not exist.
    #[error("triangle {triangle} must have vertices below {vertices}, got {got}")]
    Triangle {
        /// Index of the triangle.
        triangle: usize,
        /// Number of vertices.
        vertices: usize,
        /// The vertex that does not exist.
        got: u32,
    },
    /// A vertex follows a joint without an inverse bind transform.
    #[error("vertex {vertex} must follow joints below {joints}, got {}", got.index())]
    Joint {
        /// Index of the vertex.
        vertex: usize,
        /// Number of inverse bind transforms.
        joints: usize,
        /// The joint that does not exist.
        got: JointId,
    },
    /// A position, a normal or a texture coordinate is not finite.
    #[error(
        "positions, normals and texture coordinates must be finite, got {got} at vertex {vertex}"
    )]
    NotFinite {
        /// Index of the vertex.
        vertex: usize,
        /// The value.
        got: glam::Vec3,
    },
    /// A set of inverse bind transforms has another number of joints than the first.
    #[error("all sets must have {joints} inverse bind transforms, as the first, got {got}")]
    BindSet {
        /// Number of transforms of the first set.
        joints: usize,
        /// Number of transforms of the other one.
        got: usize,
    },
    /// An inverse bind transform is not finite.
    #[error("the inverse bind transform of joint {} must be finite", joint.index())]
    Bind {
        /// The joint.
        joint: JointId,
    },
}
