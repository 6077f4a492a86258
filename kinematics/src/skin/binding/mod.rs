//! Weights for a mesh of any origin in which joints were placed.
//!
//! Each bone draws the surface by its distance *inside the body*: so two fingers or thighs that touch
//! do not stick together. See [`distances`]. Of two bones, the farther one has a weight that falls to
//! 0 where it is farther away than the nearest one by 1.2 local radii, as for skins from bones.

mod distances;
mod triangle_tree;
mod welded;

use glam::{Affine3A, DVec3, Vec3};

use super::from_bones::{falloff, smooth};
use super::{Morph, SkinError, SkinPose, SkinnedMesh, Skinning, TriangleMesh, VertexWeights};
use crate::skeleton::{Joint, JointId, Skeleton};
use distances::{BoneSegment, InsideDistances};
use welded::WeldedMesh;

impl SkinnedMesh {
    /// The mesh as it is on a posed skeleton, with new weights by the distances of its vertices from
    /// the bones inside the body. The pose becomes the one in which the mesh is attached.
    ///
    /// Weights change smoothly along the surface. Vertices that no bone reaches, such as those
    /// of a button, follow what the nearest vertices that are reached follow.
    ///
    /// # Errors
    ///
    /// [`BindError::NoBones`] if no joint has a bone, or if the pose has numbers that are not finite.
    pub fn bound(&self, skeleton: &Skeleton, skinning: Skinning) -> Result<Self, BindError> {
        let (mesh, morphs) = self.baked(skeleton, skinning);
        let weights = weights(&mesh, skeleton).ok_or(BindError::NoBones)?;
        Ok(attached(mesh, weights, skeleton)?.with_morphs(morphs)?)
    }

    /// The mesh as it is on the posed skeleton `from`, attached with these weights to the posed
    /// skeleton `to`, on which it is at the same place.
    ///
    /// # Errors
    ///
    /// [`SkinError`] if the lists do not fit, or a pose has numbers that are not finite.
    pub fn reattached(
        &self,
        weights: Vec<VertexWeights>,
        [from, to]: [&Skeleton; 2],
        skinning: Skinning,
    ) -> Result<Self, SkinError> {
        let (mesh, morphs) = self.baked(from, skinning);
        attached(mesh, weights, to)?.with_morphs(morphs)
    }

    /// The triangles and morph targets as they are on a posed skeleton, in skeleton space.
    fn baked(&self, skeleton: &Skeleton, skinning: Skinning) -> (TriangleMesh, Vec<Morph>) {
        let pose: SkinPose = self.pose(skeleton);
        let vertices = self.mesh().positions.iter().zip(self.weights()).zip(self.first_joints());
        let blends: Vec<Affine3A> = vertices
            .map(|((position, weights), first)| pose.blend(first, weights, *position, skinning))
            .collect();
        let mut mesh = self.mesh().clone();
        for ((position, normal), blend) in
            mesh.positions.iter_mut().zip(&mut mesh.normals).zip(&blends)
        {
            *position = blend.transform_point3(*position);
            *normal = super::skinned_mesh::posed_normal(blend.matrix3, *normal);
        }
        let turned = |morph: &Morph| {
            let linear = |vertex: &u32| blends[*vertex as usize].matrix3;
            let turn = |vectors: &[Vec3]| {
                morph.vertices.iter().zip(vectors).map(|(at, it)| linear(at) * *it).collect()
            };
            let (offsets, normals) = (turn(&morph.offsets), turn(&morph.normals));
            Morph { offsets, normals, ..morph.clone() }
        };
        (mesh, self.morphs().iter().map(turned).collect())
    }
}

/// A mesh in the space of a posed skeleton, attached to that pose.
fn attached(
    mesh: TriangleMesh,
    weights: Vec<VertexWeights>,
    skeleton: &Skeleton,
) -> Result<SkinnedMesh, SkinError> {
    let pose = skeleton.pose_in_skeleton();
    let inverse_bind = |(id, joint): (JointId, &Joint)| {
        let inverse = (pose.full(id) * joint.stretched(Affine3A::IDENTITY)).inverse();
        // A joint that makes the skin flat cannot be undone.
        if inverse.is_finite() { inverse } else { pose.full(id).inverse() }
    };
    SkinnedMesh::new(mesh, weights, skeleton.iter().map(inverse_bind).collect())
}

/// The weights of a mesh in the space of a posed skeleton; `None` for a skeleton without bones.
fn weights(mesh: &TriangleMesh, skeleton: &Skeleton) -> Option<Vec<VertexWeights>> {
    let pose = skeleton.pose_in_skeleton();
    let with_bones = skeleton.iter().filter(|(_, joint)| joint.axis != Vec3::ZERO);
    let bones: Vec<JointId> = with_bones.map(|(joint, _)| joint).collect();
    let unit = UnitBox::new(&mesh.positions);
    let ends =
        bones.iter().map(|joint| [pose.base(*joint), pose.tip(*joint)].map(|it| unit.of(it)));
    let segments: Vec<BoneSegment> = ends.map(|[base, tip]| BoneSegment { base, tip }).collect();
    if segments.is_empty() {
        return None;
    }
    let welded = WeldedMesh::new(mesh, |position| unit.of(position));
    let distances = InsideDistances::new(&welded, &segments);
    let at_point = |point: usize| {
        let (radius, near) = distances.at(point);
        let least = near.iter().map(|(_, distance)| *distance).fold(f32::INFINITY, f32::min);
        let weight = |(bone, distance): &(usize, f32)| {
            let far = f64::from((distance - least) / radius);
            (bones[*bone], falloff(far) as f32)
        };
        VertexWeights::heaviest_evenly(near.iter().map(weight))
    };
    let mut of_points: Vec<VertexWeights> = (0..welded.points.len()).map(at_point).collect();
    smooth(&mut of_points, &welded.edges);
    Some(welded.of_vertices.iter().map(|point| of_points[*point as usize]).collect())
}

/// The box of a mesh, in whose coordinates it has the size 1: so that meshes of any size are bound.
struct UnitBox {
    low: DVec3,
    size: f64,
}

impl UnitBox {
    fn new(positions: &[Vec3]) -> Self {
        let low = positions.iter().copied().reduce(Vec3::min).unwrap_or_default().as_dvec3();
        let high = positions.iter().copied().reduce(Vec3::max).unwrap_or_default().as_dvec3();
        let size = low.distance(high);
        Self { low, size: if size > 0.0 { size } else { 1.0 } }
    }

    /// A place in the coordinates of the box.
    fn of(&self, place: Vec3) -> Vec3 {
        ((place.as_dvec3() - self.low) / self.size).as_vec3()
    }
}

/// The reason why joints cannot be bound to a mesh.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum BindError {
    /// There is no imported mesh.
    #[error("there must be a mesh from a file, as in a .glb or .obj, that can follow the bones")]
    NoMesh,
    /// The skeleton has no bones.
    #[error("the skeleton must have a bone that the mesh can follow")]
    NoBones,
    /// The mesh cannot be attached.
    #[error(transparent)]
    Skin(#[from] SkinError),
}
