use glam::Vec3;

/// A morph target, also called blend shape or shape key: a shape towards which a mesh can be
/// changed before its joints move it. With the weights w, the position of a vertex is p + Σ w·Δp.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Morph {
    /// Name, for example of an expression of the face.
    pub name: String,
    /// The vertices that it moves, ascending.
    pub vertices: Vec<u32>,
    /// For each of these vertices Δp, in mesh space, at the weight 1.
    pub offsets: Vec<Vec3>,
    /// For each of these vertices the change of its normal at the weight 1.
    pub normals: Vec<Vec3>,
}

impl Morph {
    /// Maximum number of morph targets of a mesh.
    pub const MOST: usize = 1_024;
    /// Maximum number of vertices that all morph targets of a mesh move together.
    pub const MOST_OFFSETS: usize = 10_000_000;

    /// Adds the changes at a weight.
    pub(super) fn add(&self, weight: f32, positions: &mut [Vec3], normals: &mut [Vec3]) {
        let changes = self.offsets.iter().zip(&self.normals);
        for (vertex, (offset, normal)) in self.vertices.iter().zip(changes) {
            positions[*vertex as usize] += weight * *offset;
            normals[*vertex as usize] += weight * *normal;
        }
    }
}
