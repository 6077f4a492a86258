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

impl TriangleMesh {
    /// Length of the diagonal of the bounding box of the positions; 0 without vertices.
    pub fn size(&self) -> f32 {
        let low = self.positions.iter().copied().reduce(Vec3::min);
        let high = self.positions.iter().copied().reduce(Vec3::max);
        low.zip(high).map_or(0.0, |(low, high)| low.distance(high))
    }
}
