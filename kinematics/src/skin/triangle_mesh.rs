use glam::{Vec2, Vec3};

/// Triangles with vertex normals.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TriangleMesh {
    /// Positions of the vertices.
    pub positions: Vec<Vec3>,
    /// Unit normals of the vertices, as many as positions.
    pub normals: Vec<Vec3>,
    /// Texture coordinates of the vertices, origin at the upper left; empty or as many as positions.
    pub texture_coordinates: Vec<Vec2>,
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

    /// The first triangle that a ray meets, from either side; `None` if it meets none. `direction` may have
    /// any length.
    pub fn hit(&self, origin: Vec3, direction: Vec3) -> Option<MeshHit> {
        let hits = self.triangles.iter().filter_map(|corners| {
            let [a, b, c] = corners.map(|corner| self.positions[corner as usize]);
            let (along, shares) = meet(origin, direction, [a, b, c])?;
            Some(MeshHit { along, corners: *corners, shares })
        });
        hits.min_by(|one, other| one.along.total_cmp(&other.along))
    }
}

/// Distance along a ray at which it meets a triangle, and the barycentric coordinates there (T. Möller,
/// B. Trumbore, *Fast, minimum storage ray/triangle intersection*, 1997).
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
