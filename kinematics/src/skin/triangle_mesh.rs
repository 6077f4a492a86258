use std::collections::HashMap;

use glam::{DVec3, Vec2, Vec3};

/// Triangles with vertex normals.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TriangleMesh {
    /// Positions of the vertices.
    pub positions: Vec<Vec3>,
    /// Unit normals of the vertices, as many as positions.
    pub normals: Vec<Vec3>,
    /// Texture coordinates of the vertices, origin at the upper left; empty or as many as
    /// positions.
    pub texture_coordinates: Vec<Vec2>,
    /// Texture coordinates of the vertices for images of emission, if these are others; empty or as
    /// many as positions.
    pub emission_coordinates: Vec<Vec2>,
    /// Colours of the vertices as sRGB with opacity, which multiply those of materials; empty or as
    /// many as positions.
    pub colours: Vec<[u8; 4]>,
    /// Indices of the corners, counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
}

/// A point of a mesh that a ray meets.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeshHit {
    /// Distance along the ray, in lengths of its direction.
    pub along: f32,
    /// Indices of the triangle's corners.
    pub corners: [u32; 3],
    /// Barycentric coordinates of the point: the shares of the corners, with the sum 1.
    pub shares: [f32; 3],
}

impl TriangleMesh {
    /// Length of the diagonal of the bounding box of the positions; 0 without vertices.
    pub fn size(&self) -> f32 {
        let low = self.positions.iter().copied().reduce(Vec3::min);
        let high = self.positions.iter().copied().reduce(Vec3::max);
        low.zip(high).map_or(0.0, |(low, high)| low.distance(high))
    }

    /// The middle of the body that a ray enters: half way to the point where it leaves it again. Of a
    /// surface that it does not leave, the point where it meets it; `None` if it meets none.
    pub fn middle(&self, origin: Vec3, direction: Vec3) -> Option<Vec3> {
        let mut crossings: Vec<(f32, bool)> = Vec::new();
        for corners in &self.triangles {
            let [a, b, c] = corners.map(|corner| self.positions[corner as usize]);
            if let Some((along, _)) = meet(origin, direction, [a, b, c]) {
                crossings.push((along, (b - a).cross(c - a).dot(direction) < 0.0));
            }
        }
        crossings.sort_unstable_by(|one, other| one.0.total_cmp(&other.0));
        let (first, _) = *crossings.first()?;
        // Two triangles with a common edge can both be met: crossings at one place count once.
        let least = 1e-5 * first.abs();
        crossings.dedup_by(|next, kept| next.1 == kept.1 && next.0 - kept.0 <= least);
        let mut inside = 0;
        let leaves = crossings.iter().find(|(_, enters)| {
            inside += if *enters { 1 } else { -1 };
            inside <= 0
        });
        let last = leaves.map_or(first, |(along, _)| *along);
        Some(origin + direction * (0.5 * (first + last)))
    }

    /// The first triangle that a ray meets, from either side; `None` if it meets none. `direction`
    /// may have any length.
    pub fn hit(&self, origin: Vec3, direction: Vec3) -> Option<MeshHit> {
        let hits = self.triangles.iter().filter_map(|corners| {
            let [a, b, c] = corners.map(|corner| self.positions[corner as usize]);
            let (along, shares) = meet(origin, direction, [a, b, c])?;
            Some(MeshHit { along, corners: *corners, shares })
        });
        hits.min_by(|one, other| one.along.total_cmp(&other.along))
    }
}

/// Distance along a ray at which it meets a triangle, and the barycentric coordinates there (T.
/// Möller, B. Trumbore, *Fast, minimum storage ray/triangle intersection*, 1997).
fn meet(origin: Vec3, direction: Vec3, [a, b, c]: [Vec3; 3]) -> Option<(f32, [f32; 3])> {
    let (ab, ac) = (b - a, c - a);
    let across = direction.cross(ac);
    let determinant = ab.dot(across);
    if determinant == 0.0 {
        return None;
    }
    let from_a = origin - a;
    let of_b = from_a.dot(across) / determinant;
    let around = from_a.cross(ab);
    let of_c = direction.dot(around) / determinant;
    let along = ac.dot(around) / determinant;
    let is_inside = of_b >= 0.0 && of_c >= 0.0 && of_b + of_c <= 1.0 && along > 0.0;
    is_inside.then_some((along, [1.0 - of_b - of_c, of_b, of_c]))
}

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
    /// The section by the plane through `point` across `normal`, both in the mesh's space; of
    /// several curves the one nearest to the point. `None` if the plane cuts no closed curve.
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

    /// Area that the curve encloses: the length of its vector area, for a plane curve its plain
    /// area. `position` gives the positions of the vertices.
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
