use std::collections::HashMap;

use glam::Vec3;

use crate::skin::TriangleMesh;

/// A mesh whose vertices at the same place are one point: many meshes have several vertices where
/// texture coordinates or normals change.
pub struct WeldedMesh {
    /// For each vertex its point.
    pub of_vertices: Vec<u32>,
    pub points: Vec<Vec3>,
    /// The points of each triangle, without triangles that have two corners at one point.
    pub triangles: Vec<[u32; 3]>,
    /// The edges, each once.
    pub edges: Vec<[u32; 2]>,
    /// For each point, where its neighbours begin in `neighbours`, and the end of the list.
    starts: Vec<u32>,
    neighbours: Vec<u32>,
}

impl WeldedMesh {
    /// Welds a mesh, whose places become those that `place` gives them.
    pub fn new(mesh: &TriangleMesh, place: impl Fn(Vec3) -> Vec3) -> Self {
        let mut points = Vec::new();
        let mut known: HashMap<[u32; 3], u32> = HashMap::new();
        let mut weld = |at: &Vec3| {
            // Adding 0 makes 0 of −0.
            let bits = (*at + Vec3::ZERO).to_array().map(f32::to_bits);
            *known.entry(bits).or_insert_with(|| {
                points.push(place(*at));
                (points.len() - 1) as u32
            })
        };
        let of_vertices: Vec<u32> = mesh.positions.iter().map(&mut weld).collect();
        let welded =
            mesh.triangles.iter().map(|corners| corners.map(|it| of_vertices[it as usize]));
        let triangles: Vec<[u32; 3]> =
            welded.filter(|[a, b, c]| a != b && b != c && c != a).collect();
        let sides = triangles.iter().flat_map(|[a, b, c]| [[*a, *b], [*b, *c], [*c, *a]]);
        let mut edges: Vec<[u32; 2]> =
            sides.map(|[from, to]| [from.min(to), from.max(to)]).collect();
        edges.sort_unstable();
        edges.dedup();
        let mut starts = vec![0; points.len() + 1];
        for end in edges.iter().flatten() {
            starts[*end as usize + 1] += 1;
        }
        for point in 0..points.len() {
            starts[point + 1] += starts[point];
        }
        let mut next = starts.clone();
        let mut neighbours = vec![0; 2 * edges.len()];
        for [one, other] in &edges {
            for (from, to) in [(*one, *other), (*other, *one)] {
                neighbours[next[from as usize] as usize] = to;
                next[from as usize] += 1;
            }
        }
        Self { of_vertices, points, triangles, edges, starts, neighbours }
    }

    /// The points at the other ends of a point's edges.
    pub fn neighbours(&self, point: usize) -> &[u32] {
        &self.neighbours[self.starts[point] as usize..self.starts[point + 1] as usize]
    }
}
