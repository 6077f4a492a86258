use std::collections::HashMap;

use glam::{DVec3, Vec3};

use super::triangle_mesh::TriangleMesh;

/// A closed curve on a mesh: where a plane cuts it. The curve moves with the mesh.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshSection {
    /// Points on edges of the mesh, in order.
    points: Vec<EdgePoint>,
}

/// A point on an edge of a mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
struct EdgePoint {
    from: u32,
    to: u32,
    /// Fraction of the edge.
    share: f32,
}

impl MeshSection {
    /// The section by the plane through `point` across `normal`, both in the mesh's space; of several
    /// curves the one nearest to the point. `None` if the plane cuts no closed curve.
    pub fn new(mesh: &TriangleMesh, point: Vec3, normal: Vec3) -> Option<Self> {
        let height = |vertex: u32| (mesh.positions[vertex as usize] - point).dot(normal);
        let mut next: HashMap<(u32, u32), (u32, u32)> = HashMap::new();
        for corners in &mesh.triangles {
            let [mut enters, mut leaves] = [None, None];
            for side in 0..3 {
                let (from, to) = (corners[side], corners[(side + 1) % 3]);
                let edge = (from.min(to), from.max(to));
                match (height(from) < 0.0, height(to) < 0.0) {
                    (true, false) => enters = Some(edge),
                    (false, true) => leaves = Some(edge),
                    _ => {}
                }
            }
            if let (Some(enters), Some(leaves)) = (enters, leaves) {
                next.insert(enters, leaves);
            }
        }
        let at = |(from, to): (u32, u32)| {
            let (a, b) = (height(from), height(to));
            EdgePoint { from, to, share: a / (a - b) }
        };
        let mut starts: Vec<(u32, u32)> = next.keys().copied().collect();
        starts.sort_unstable();
        let mut nearest: Option<(f32, Self)> = None;
        for start in starts {
            let mut points = Vec::new();
            let mut edge = start;
            while let Some(following) = next.remove(&edge) {
                points.push(at(edge));
                edge = following;
            }
            let section = Self { points };
            if section.points.len() < 3 || edge != start {
                continue;
            }
            let apart = section.centre(&mesh.positions).distance(point);
            if nearest.as_ref().is_none_or(|(least, _)| apart < *least) {
                nearest = Some((apart, section));
            }
        }
        nearest.map(|(_, section)| section)
    }

    /// The vertices of the mesh that the curve depends on.
    pub fn vertices(&self) -> Vec<u32> {
        let mut vertices: Vec<u32> =
            self.points.iter().flat_map(|point| [point.from, point.to]).collect();
        vertices.sort_unstable();
        vertices.dedup();
        vertices
    }

    /// Area that the curve encloses: the length of its vector area, for a plane curve its plain area.
    /// `position` gives the positions of the vertices.
    pub fn area(&self, position: impl Fn(u32) -> Vec3) -> f32 {
        let at = |point: &EdgePoint| {
            position(point.from).as_dvec3().lerp(position(point.to).as_dvec3(), point.share.into())
        };
        let points: Vec<DVec3> = self.points.iter().map(at).collect();
        let Some(first) = points.first() else { return 0.0 };
        let sides = points.windows(2).map(|side| (side[0] - *first).cross(side[1] - *first));
        (0.5 * sides.sum::<DVec3>().length()) as f32
    }

    fn centre(&self, positions: &[Vec3]) -> Vec3 {
        let at = |point: &EdgePoint| {
            positions[point.from as usize].lerp(positions[point.to as usize], point.share)
        };
        self.points.iter().map(at).sum::<Vec3>() / self.points.len() as f32
    }
}
