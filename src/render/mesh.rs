use core::f32::consts::{PI, TAU};

use bytemuck::{Pod, Zeroable};
use glam::{Vec2, Vec3};

use super::Gpu;
use crate::scene::hand_mesh;

/// Triangles on the device, counter-clockwise as seen from outside.
#[derive(Debug)]
pub(super) struct MeshBuffers {
    vertices: wgpu::Buffer,
    indices: wgpu::Buffer,
    count: u32,
}

impl MeshBuffers {
    pub fn new<V: Pod>(gpu: &Gpu, label: &str, vertices: &[V], indices: &[u16]) -> Self {
        Self {
            vertices: gpu.filled_buffer(label, vertices, wgpu::BufferUsages::VERTEX),
            indices: gpu.filled_buffer(label, indices, wgpu::BufferUsages::INDEX),
            count: indices.len() as u32,
        }
    }

    pub fn draw(&self, pass: &mut wgpu::RenderPass<'_>, instances: &wgpu::Buffer, count: u32) {
        pass.set_vertex_buffer(0, self.vertices.slice(..));
        pass.set_vertex_buffer(1, instances.slice(..));
        pass.set_index_buffer(self.indices.slice(..), wgpu::IndexFormat::Uint16);
        pass.draw_indexed(0..self.count, 0, 0..count);
    }

    pub fn triangles(&self) -> u32 {
        self.count / 3
    }
}

/// Points on a unit circle, `segments` + 1 of them: the last equals the first.
pub(super) fn circle(segments: u16) -> impl Iterator<Item = Vec2> + Clone {
    (0..=segments)
        .map(move |i| Vec2::from_angle(TAU * f32::from(i % segments) / f32::from(segments)))
}

/// A unit sphere: its vertices, which are also its normals, and the vertex indices of its
/// triangles.
pub(super) fn sphere(segments: u16) -> (Vec<Vec3>, Vec<u16>) {
    let rings = segments / 2;
    let points: Vec<_> = (0..=rings)
        .flat_map(|ring| {
            let level = Vec2::from_angle(PI * f32::from(ring) / f32::from(rings));
            circle(segments)
                .map(move |around| Vec3::new(level.y * around.x, level.x, -level.y * around.y))
        })
        .collect();
    let triangles = grid(rings, segments, |index| points[usize::from(index)]);
    (points, triangles)
}

/// Vertex indices of the triangles between successive rows of vertices. As seen from outside, the
/// rows run from top to bottom and the vertices of a row from left to right; the last vertex of a
/// row repeats the first. Triangles without area are left out.
pub(super) fn grid(rows: u16, columns: u16, position: impl Fn(u16) -> Vec3) -> Vec<u16> {
    const MIN_DISTANCE: f32 = 1e-6;
    let has_area = |[a, b, c]: &[u16; 3]| {
        let [a, b, c] = [*a, *b, *c].map(&position);
        a.distance(b) > MIN_DISTANCE && b.distance(c) > MIN_DISTANCE && c.distance(a) > MIN_DISTANCE
    };
    let point = |row: u16, column: u16| row * (columns + 1) + column;
    (0..rows)
        .flat_map(|row| (0..columns).map(move |column| (row, column)))
        .flat_map(|(row, column)| {
            let (left, right) = (point(row, column), point(row, column + 1));
            let (below_left, below_right) = (point(row + 1, column), point(row + 1, column + 1));
            [[left, below_left, right], [right, below_left, below_right]]
        })
        .filter(has_area)
        .flatten()
        .collect()
}

/// Vertex of a solid of length and radius 1.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
pub(super) struct SolidVertex {
    along: f32,
    rim: Vec3,
    normal: Vec3,
}

const _: () = assert!(size_of::<SolidVertex>() == 28);

/// Mesh of a cone of length and radius 1, which its instances taper: a side and two caps. Rows of
/// vertices run from the centre of the base over both rims to the centre of the tip. Each rim has
/// two rows, with the normals of the cap and of the side.
pub(super) fn cone(gpu: &Gpu, segments: u16) -> MeshBuffers {
    let (vertices, indices) = cone_triangles(segments, 1);
    MeshBuffers::new(gpu, "cone", &vertices, &indices)
}

/// The same with as many rows as a cone needs that winds.
pub(super) fn wound_cone(gpu: &Gpu) -> MeshBuffers {
    let (vertices, indices) = cone_triangles(64, 24);
    MeshBuffers::new(gpu, "cone that winds", &vertices, &indices)
}

/// A side of `steps` rows of triangles.
fn cone_triangles(segments: u16, steps: u16) -> (Vec<SolidVertex>, Vec<u16>) {
    let base = [(0.0, 0.0, Some(-1.0)), (0.0, 1.0, Some(-1.0))];
    let side = (0..=steps).map(|step| (f32::from(step) / f32::from(steps), 1.0, None));
    let tip = [(1.0, 1.0, Some(1.0)), (1.0, 0.0, Some(1.0))];
    let rows: Vec<(f32, f32, Option<f32>)> = base.into_iter().chain(side).chain(tip).collect();
    let vertices: Vec<_> = rows
        .iter()
        .flat_map(|&(along, radius, cap)| {
            circle(segments).map(move |around| {
                let side = Vec3::new(0.0, around.x, -around.y);
                let normal = cap.map_or(side, |x| Vec3::X * x);
                SolidVertex { along, rim: side * radius, normal }
            })
        })
        .collect();
    let at = |index| position(&vertices[usize::from(index)]);
    let triangles = grid(rows.len() as u16 - 1, segments, at);
    (vertices, triangles)
}

/// Position of a vertex in a solid of length and radius 1.
fn position(vertex: &SolidVertex) -> Vec3 {
    Vec3::new(vertex.along, 0.0, 0.0) + vertex.rim
}

/// Mesh of a unit sphere.
pub(super) fn ball(gpu: &Gpu, segments: u16) -> MeshBuffers {
    let (points, indices) = sphere(segments);
    let vertices: Vec<_> = points
        .into_iter()
        .map(|point| SolidVertex { along: 0.0, rim: point, normal: point })
        .collect();
    MeshBuffers::new(gpu, "ball", &vertices, &indices)
}

/// Mesh of a hand of size 1.
pub(super) fn hand(gpu: &Gpu) -> MeshBuffers {
    let mesh = hand_mesh();
    let points = mesh.positions.iter().zip(&mesh.normals);
    let vertices: Vec<_> = points
        .map(|(rim, normal)| SolidVertex { along: 0.0, rim: *rim, normal: *normal })
        .collect();
    let indices: Vec<u16> = mesh.triangles.as_flattened().iter().map(|it| *it as u16).collect();
    MeshBuffers::new(gpu, "hand", &vertices, &indices)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cone_is_closed_and_faces_outwards() {
        for steps in [1, 24] {
            check_cone(steps);
        }
    }

    fn check_cone(steps: u16) {
        let (vertices, indices) = cone_triangles(64, steps);
        let sides = 2 * usize::from(steps) * 64;
        assert_eq!(indices.len() / 3, 2 * 64 + sides, "two fans and a side");
        let mut volume = 0.0;
        for triangle in indices.chunks_exact(3) {
            let [a, b, c] = [0, 1, 2].map(|corner| vertices[usize::from(triangle[corner])]);
            let normal = (position(&b) - position(&a)).cross(position(&c) - position(&a));
            assert!(normal.dot(a.normal) >= -1e-6, "{triangle:?} faces inwards");
            volume += position(&a).dot(normal) / 6.0;
        }
        let cylinder = core::f32::consts::PI;
        assert!((volume - cylinder).abs() < 0.01 * cylinder, "volume {volume}");
    }

    #[test]
    fn a_sphere_is_round_and_faces_outwards() {
        let (points, indices) = sphere(32);
        assert_eq!(indices.len() / 3, 2 * 32 * 15, "the poles are fans");
        assert!(points.iter().all(|point| (point.length() - 1.0).abs() < 1e-6));
        for triangle in indices.chunks_exact(3) {
            let [a, b, c] = [0, 1, 2].map(|corner| points[usize::from(triangle[corner])]);
            let normal = (b - a).cross(c - a);
            assert!(normal.dot(a + b + c) >= -1e-6, "{triangle:?} faces inwards");
        }
    }
}
