use bytemuck::{Pod, Zeroable};
use glam::Vec3;

use super::Gpu;
use super::mesh::{self, MeshBuffers};

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
    let (vertices, indices) = cone_triangles(segments);
    MeshBuffers::new(gpu, "cone", &vertices, &indices)
}

fn cone_triangles(segments: u16) -> (Vec<SolidVertex>, Vec<u16>) {
    let rows: [(f32, f32, Option<f32>); 6] = [
        (0.0, 0.0, Some(-1.0)),
        (0.0, 1.0, Some(-1.0)),
        (0.0, 1.0, None),
        (1.0, 1.0, None),
        (1.0, 1.0, Some(1.0)),
        (1.0, 0.0, Some(1.0)),
    ];
    let vertices: Vec<_> = rows
        .into_iter()
        .flat_map(|(along, radius, cap)| {
            mesh::circle(segments).map(move |around| {
                let side = Vec3::new(0.0, around.x, -around.y);
                let normal = cap.map_or(side, |x| Vec3::X * x);
                SolidVertex { along, rim: side * radius, normal }
            })
        })
        .collect();
    let at = |index| position(&vertices[usize::from(index)]);
    let triangles = mesh::grid(rows.len() as u16 - 1, segments, at);
    (vertices, triangles)
}

/// Position of a vertex in a solid of length and radius 1.
fn position(vertex: &SolidVertex) -> Vec3 {
    Vec3::new(vertex.along, 0.0, 0.0) + vertex.rim
}

/// Mesh of a unit sphere.
pub(super) fn ball(gpu: &Gpu, segments: u16) -> MeshBuffers {
    let (points, indices) = mesh::sphere(segments);
    let vertices: Vec<_> = points
        .into_iter()
        .map(|point| SolidVertex { along: 0.0, rim: point, normal: point })
        .collect();
    MeshBuffers::new(gpu, "ball", &vertices, &indices)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cone_is_closed_and_faces_outwards() {
        let (vertices, indices) = cone_triangles(64);
        assert_eq!(indices.len() / 3, 4 * 64, "two fans and a side");
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
}
