//! The half-edge mesh of a skeleton, with the weights of its vertices.

use std::collections::HashMap;

use glam::{Affine3A, Vec2, Vec3};

use super::file::Js3dMesh;
use crate::io::json::{FieldError, FieldWarnings, JsonPath};
use crate::io::packed;
use crate::kinematics::skeleton::{JointId, Skeleton};
use crate::kinematics::skin::{SkinnedMesh, TriangleMesh, VertexWeights};
use crate::rig::FileMesh;

/// Reads a mesh in the space of its skeleton. `order` has the joint of each bone of the file, and
/// `at` is the path of the mesh.
///
/// The weights are those of the file. If it has none, each bone weighs by the share max(0, 1 − d/r)
/// of its radius r that is left at the distance d from it, as in Scotty3D. Vertices without weights
/// follow the nearest bone, with a warning.
pub fn read(
    mesh: &Js3dMesh,
    skeleton: &Skeleton,
    order: &[JointId],
    at: &JsonPath,
    warnings: &mut FieldWarnings,
) -> Result<FileMesh, FieldError> {
    const FORMAT: &str = "s3d-hm-1";
    if mesh.format != FORMAT {
        let reason = format!("must be {FORMAT:?}, got {:?}", mesh.format);
        return Err(FieldError::new(at.clone().key("FORMAT"), reason));
    }
    let positions = points(&mesh.positions, &at.clone().key("vertex_positions"))?;
    let edges = HalfEdges::new(mesh, positions.len(), at)?;
    let listed = listed_weights(mesh, positions.len(), order, at)?;
    if positions.len() > SkinnedMesh::MOST_VERTICES {
        let (most, got) = (SkinnedMesh::MOST_VERTICES, positions.len());
        let reason = format!("must have at most {most} entries, got {got}");
        return Err(FieldError::new(at.clone().key("vertex_positions"), reason));
    }
    let by_distance = BoneDistances::new(skeleton);
    let mut loose = 0;
    let weights: Vec<VertexWeights> = positions
        .iter()
        .enumerate()
        .map(|(vertex, position)| {
            let weights = match &listed {
                Some(listed) => listed[vertex].clone(),
                None => by_distance.weights(*position),
            };
            let has_weights = weights.iter().any(|(_, weight)| *weight > 0.0);
            loose += usize::from(!has_weights);
            if has_weights {
                VertexWeights::heaviest(weights).0
            } else {
                VertexWeights::rigid(by_distance.nearest(*position))
            }
        })
        .collect();
    if loose > 0 {
        let all = positions.len();
        let reason =
            format!("{loose} of {all} vertices have no weights; they follow the nearest bone");
        warnings.push(at.clone(), reason);
    }
    let (mesh, of_vertex) = edges.mesh(&positions);
    let weights = of_vertex.into_iter().map(|vertex| weights[vertex]).collect();
    let mesh = SkinnedMesh::new(mesh, weights, by_distance.to_joints)
        .map_err(|error| FieldError::new(at.clone(), error.to_string()))?;
    let parents = skeleton.joints().iter().map(|joint| joint.parent).collect();
    Ok(FileMesh { mesh, parents, parts: Vec::new() })
}

/// The half-edges of a mesh. All indices are valid.
struct HalfEdges {
    nexts: Vec<usize>,
    /// For each half-edge the vertex from which it goes; `None` for one that no vertex has.
    vertices: Vec<Option<usize>>,
    coordinates: Vec<Vec2>,
    normals: Vec<Vec3>,
    /// A half-edge of each face, without holes.
    faces: Vec<usize>,
}

impl HalfEdges {
    fn new(mesh: &Js3dMesh, positions: usize, at: &JsonPath) -> Result<Self, FieldError> {
        let at = |key: &str| at.clone().key(key);
        let nexts = wholes(&mesh.nexts, &at("halfedge_nexts"))?;
        let count = nexts.len();
        if count % 2 == 1 {
            let reason = format!("must have an even number of entries, got {count}");
            return Err(FieldError::new(at("halfedge_nexts"), reason));
        }
        let starts = wholes(&mesh.vertices, &at("vertex_halfedges"))?;
        let mut faces = wholes(&mesh.faces, &at("face_halfedges"))?;
        let lists =
            [("halfedge_nexts", &nexts), ("vertex_halfedges", &starts), ("face_halfedges", &faces)];
        for (key, list) in lists {
            if let Some(edge) = list.iter().find(|edge| **edge >= count) {
                let reason = format!("must be below {count}, the number of half-edges, got {edge}");
                return Err(FieldError::new(at(key), reason));
            }
        }
        let holes = bytes(&mesh.boundaries, "bool", &at("face_boundaries"))?;
        let is_hole =
            |face: usize| holes.get(face / 8).is_some_and(|byte| byte >> (7 - face % 8) & 1 == 1);
        let mut face = 0..;
        faces.retain(|_| face.next().is_some_and(|face| !is_hole(face)));
        if positions != starts.len() {
            let reason = format!(
                "must have {} entries like vertex_halfedges, got {positions}",
                starts.len()
            );
            return Err(FieldError::new(at("vertex_positions"), reason));
        }
        Ok(Self {
            vertices: origins(&nexts, &starts),
            coordinates: rows(&mesh.coordinates, "vec2", &at("halfedge_corner_uvs"))?
                .into_iter()
                .map(Vec2::from_array)
                .collect(),
            normals: points(&mesh.normals, &at("halfedge_corner_normals"))?,
            nexts,
            faces,
        })
    }

    /// The half-edges around the face with the half-edge `start`; none if they do not lead back to
    /// it, or another face has one of them. `is_used` marks those of the faces so far.
    fn around(&self, start: usize, is_used: &mut [bool]) -> Vec<usize> {
        let mut edges = Vec::new();
        let mut edge = start;
        while !is_used[edge] {
            is_used[edge] = true;
            edges.push(edge);
            edge = self.nexts[edge];
        }
        if edge == start { edges } else { Vec::new() }
    }

    /// Triangles with a vertex for each different corner, and for each of these the vertex of the
    /// file.
    fn mesh(&self, positions: &[Vec3]) -> (TriangleMesh, Vec<usize>) {
        let mut mesh = TriangleMesh::default();
        let mut of_vertex = Vec::new();
        let mut known = HashMap::new();
        let mut is_used = vec![false; self.nexts.len()];
        for face in &self.faces {
            let edges = self.around(*face, &mut is_used);
            let corners: Option<Vec<usize>> =
                edges.iter().map(|edge| self.vertices[*edge]).collect();
            let Some(corners) = corners else { continue };
            let flat = newell(corners.iter().map(|corner| positions[*corner]));
            let added = edges.iter().zip(&corners).map(|(edge, corner)| {
                let normal = self.normals.get(*edge).copied().unwrap_or_default();
                let normal = normal.try_normalize().unwrap_or(flat);
                let coordinates = self.coordinates.get(*edge).copied();
                let coordinates = coordinates.filter(|at| at.is_finite()).unwrap_or_default();
                // Scotty3D has the origin at the lower left.
                let coordinates = Vec2::new(coordinates.x, 1.0 - coordinates.y);
                let bits = normal.to_array().into_iter().chain(coordinates.to_array());
                let key: (usize, Vec<u32>) = (*corner, bits.map(f32::to_bits).collect());
                *known.entry(key).or_insert_with(|| {
                    mesh.positions.push(positions[*corner]);
                    mesh.normals.push(normal);
                    mesh.texture_coordinates.push(coordinates);
                    of_vertex.push(*corner);
                    of_vertex.len() as u32 - 1
                })
            });
            let corners: Vec<u32> = added.collect();
            if let [first, others @ ..] = &corners[..] {
                let fan = others.windows(2).map(|pair| [*first, pair[0], pair[1]]);
                mesh.triangles.extend(fan.filter(|[a, b, c]| a != b && b != c && c != a));
            }
        }
        (mesh, of_vertex)
    }
}

/// For each half-edge the vertex from which it goes. From a half-edge, the next one after its other
/// side goes from the same vertex.
fn origins(nexts: &[usize], starts: &[usize]) -> Vec<Option<usize>> {
    let mut origins = vec![None; nexts.len()];
    for (vertex, start) in starts.iter().enumerate() {
        let mut edge = *start;
        while origins[edge].is_none() {
            origins[edge] = Some(vertex);
            edge = nexts[edge ^ 1];
        }
    }
    origins
}

/// The normal of a polygon (M. Newell); upwards for one without area.
fn newell(corners: impl Iterator<Item = Vec3> + Clone) -> Vec3 {
    let nexts = corners.clone().cycle().skip(1);
    let sum: Vec3 = corners.zip(nexts).map(|(corner, next)| corner.cross(next)).sum();
    sum.normalize_or(Vec3::Y)
}

/// The joints that a vertex follows, with their weights.
type BoneWeights = Vec<(JointId, f32)>;

/// The weights of the file by vertex, each with the joint of its bone; `None` if it has none at
/// all.
fn listed_weights(
    mesh: &Js3dMesh,
    vertices: usize,
    order: &[JointId],
    at: &JsonPath,
) -> Result<Option<Vec<BoneWeights>>, FieldError> {
    let ends = wholes(&mesh.weight_ends, &at.clone().key("vertex_bone_weight_ends"))?;
    let at_bones = at.clone().key("bone_weight_bones");
    let bones = wholes(&mesh.weight_bones, &at_bones)?;
    let weights: Vec<[f32; 1]> =
        rows(&mesh.weights, "float", &at.clone().key("bone_weight_weights"))?;
    if bones.is_empty() {
        return Ok(None);
    }
    let mut listed = Vec::with_capacity(vertices);
    let mut start = 0;
    for vertex in 0..vertices {
        let end = ends.get(vertex).copied().unwrap_or(start);
        let range = start..end;
        let (Some(bones), Some(weights)) = (bones.get(range.clone()), weights.get(range)) else {
            let reason = format!("must rise to at most {}, got {end}", bones.len());
            let at = at.clone().key("vertex_bone_weight_ends");
            return Err(FieldError::new(at, reason));
        };
        let joint = |bone: &usize| {
            order.get(*bone).copied().ok_or_else(|| {
                let reason = super::bones::index_rule(order.len(), *bone);
                FieldError::new(at_bones.clone(), reason)
            })
        };
        let joints: Vec<JointId> = bones.iter().map(joint).collect::<Result<_, _>>()?;
        listed.push(joints.into_iter().zip(weights.iter().map(|[weight]| *weight)).collect());
        start = end;
    }
    Ok(Some(listed))
}

/// Bones in the bind pose, for weights by distance.
struct BoneDistances<'a> {
    skeleton: &'a Skeleton,
    /// From skeleton space to the joints' own spaces.
    to_joints: Vec<Affine3A>,
}

impl<'a> BoneDistances<'a> {
    fn new(skeleton: &'a Skeleton) -> Self {
        let pose = skeleton.bind_pose_in_skeleton();
        let to_joints = skeleton.ids().map(|joint| pose.full(joint).inverse()).collect();
        Self { skeleton, to_joints }
    }

    fn weights(&self, point: Vec3) -> BoneWeights {
        let weight =
            |joint| (joint, 1.0 - self.distance(joint, point) / self.skeleton[joint].radius);
        self.skeleton.ids().map(weight).filter(|(_, weight)| *weight > 0.0).collect()
    }

    fn nearest(&self, point: Vec3) -> JointId {
        let distance = |joint: &JointId| self.distance(*joint, point);
        let nearest = self.skeleton.ids().min_by(|a, b| distance(a).total_cmp(&distance(b)));
        nearest.unwrap_or_default()
    }

    fn distance(&self, joint: JointId, point: Vec3) -> f32 {
        self.skeleton[joint].distance(self.to_joints[joint.index()].transform_point3(point))
    }
}

/// Decodes a list like `uint32:AgAAAA` of the type `kind`; a missing list is empty.
fn bytes(text: &str, kind: &str, at: &JsonPath) -> Result<Vec<u8>, FieldError> {
    let error = |reason| FieldError::new(at.clone(), reason);
    if text.is_empty() {
        return Ok(Vec::new());
    }
    match text.split_once(':') {
        Some((found, data)) if found == kind => packed::decode_base64(data).map_err(error),
        _ => Err(error(format!("must begin with \"{kind}:\""))),
    }
}

/// Rows of `N` floats of a list of the type `kind`.
fn rows<const N: usize>(
    text: &str,
    kind: &str,
    at: &JsonPath,
) -> Result<Vec<[f32; N]>, FieldError> {
    Ok(packed::floats(&bytes(text, kind, at)?).as_chunks().0.to_vec())
}

fn points(text: &str, at: &JsonPath) -> Result<Vec<Vec3>, FieldError> {
    Ok(rows(text, "vec3", at)?.into_iter().map(Vec3::from_array).collect())
}

fn wholes(text: &str, at: &JsonPath) -> Result<Vec<usize>, FieldError> {
    let numbers = packed::wholes(&bytes(text, "uint32", at)?);
    Ok(numbers.into_iter().map(|number| number as usize).collect())
}
