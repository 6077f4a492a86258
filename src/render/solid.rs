use bytemuck::{Pod, Zeroable};
use glam::{Mat3, Vec3};

use super::instances::Instances;
use super::mesh::{self, Mesh};
use super::{Gpu, pipeline};
use crate::scene::{Ball, Scene, Solid};

pub(super) const SHADER: &str = concat!(
    include_str!("../../shaders/view.wgsl"),
    include_str!("../../shaders/planes.wgsl"),
    include_str!("../../shaders/shell.wgsl"),
    include_str!("../../shaders/solid.wgsl"),
);

const SEGMENTS: u16 = 48;

#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct Vertex {
    along: f32,
    rim: Vec3,
    normal: Vec3,
}

#[repr(C)]
#[derive(Clone, Copy, PartialEq, Pod, Zeroable, Debug)]
struct Instance {
    x: Vec3,
    length: f32,
    y: Vec3,
    base_radius: f32,
    z: Vec3,
    tip_radius: f32,
    origin: Vec3,
    colour: [f32; 4],
}

const _: () = assert!(size_of::<Vertex>() == 28);
const _: () = assert!(size_of::<Instance>() == 76);

/// Draws tapered cylinders and balls, and those that show through what hides them.
#[derive(Debug)]
pub(super) struct Solids {
    visible: wgpu::RenderPipeline,
    hidden: wgpu::RenderPipeline,
    cone: Mesh,
    ball: Mesh,
    cones: Instances<Instance>,
    balls: Instances<Instance>,
    guide_cones: Instances<Instance>,
    guide_balls: Instances<Instance>,
}

impl Solids {
    pub fn new(gpu: &Gpu, view: &wgpu::BindGroupLayout) -> Self {
        let vertex = wgpu::vertex_attr_array![0 => Float32, 1 => Float32x3, 2 => Float32x3];
        let instance = wgpu::vertex_attr_array![
            3 => Float32x4, 4 => Float32x4, 5 => Float32x4, 6 => Float32x3, 7 => Float32x4
        ];
        let buffers = [
            wgpu::VertexBufferLayout {
                array_stride: size_of::<Vertex>() as u64,
                step_mode: wgpu::VertexStepMode::Vertex,
                attributes: &vertex,
            },
            wgpu::VertexBufferLayout {
                array_stride: size_of::<Instance>() as u64,
                step_mode: wgpu::VertexStepMode::Instance,
                attributes: &instance,
            },
        ];
        let pipeline = |label, fragment, depth, opaque| {
            pipeline::build(
                gpu,
                &pipeline::Kind {
                    label,
                    shader: SHADER,
                    fragment,
                    layouts: &[view],
                    buffers: &buffers,
                    topology: wgpu::PrimitiveTopology::TriangleList,
                    cull: Some(wgpu::Face::Back),
                    depth,
                    opaque,
                },
            )
        };
        Self {
            visible: pipeline("solid", "fragment", wgpu::CompareFunction::Greater, true),
            hidden: pipeline(
                "solid, hidden",
                "fragment_hidden",
                wgpu::CompareFunction::Less,
                false,
            ),
            cone: cone(gpu),
            ball: ball(gpu),
            cones: Instances::new("cones"),
            balls: Instances::new("balls"),
            guide_cones: Instances::new("guide cones"),
            guide_balls: Instances::new("guide balls"),
        }
    }

    pub fn upload(&mut self, gpu: &Gpu, scene: &Scene) {
        self.cones.upload(gpu, scene.solids.iter().map(Instance::of_solid));
        self.balls.upload(gpu, scene.balls.iter().map(Instance::of_ball));
        self.guide_cones.upload(gpu, scene.guide_solids.iter().map(Instance::of_solid));
        self.guide_balls.upload(gpu, scene.guide_balls.iter().map(Instance::of_ball));
    }

    pub fn draw(&self, pass: &mut wgpu::RenderPass<'_>) {
        pass.set_pipeline(&self.visible);
        draw(pass, &self.cone, &self.cones);
        draw(pass, &self.ball, &self.balls);
        draw(pass, &self.cone, &self.guide_cones);
        draw(pass, &self.ball, &self.guide_balls);
    }

    /// After everything opaque: the guides, where they are behind it.
    pub fn draw_hidden(&self, pass: &mut wgpu::RenderPass<'_>) {
        pass.set_pipeline(&self.hidden);
        draw(pass, &self.cone, &self.guide_cones);
        draw(pass, &self.ball, &self.guide_balls);
    }
}

fn draw(pass: &mut wgpu::RenderPass<'_>, mesh: &Mesh, instances: &Instances<Instance>) {
    if let Some((buffer, count)) = instances.get() {
        mesh.draw(pass, buffer, count);
    }
}

impl Instance {
    fn of_solid(solid: &Solid) -> Self {
        let axes = Mat3::from(solid.place.matrix3);
        Self {
            x: axes.x_axis,
            length: solid.shape.length,
            y: axes.y_axis,
            base_radius: solid.shape.base_radius,
            z: axes.z_axis,
            tip_radius: solid.shape.tip_radius,
            origin: solid.place.translation.into(),
            colour: solid.colour.channels(),
        }
    }

    fn of_ball(ball: &Ball) -> Self {
        Self {
            x: Vec3::X,
            length: 0.0,
            y: Vec3::Y,
            base_radius: ball.radius,
            z: Vec3::Z,
            tip_radius: ball.radius,
            origin: ball.centre,
            colour: ball.colour.channels(),
        }
    }
}

/// Side and two caps. Rows run from the base's middle over its rim and the tip's rim to its middle,
/// rims twice for the edges.
fn cone(gpu: &Gpu) -> Mesh {
    let (vertices, indices) = cone_triangles();
    Mesh::new(gpu, "cone", &vertices, &indices)
}

fn cone_triangles() -> (Vec<Vertex>, Vec<u16>) {
    let rows: [(f32, f32, Option<f32>); 6] = [
        (0.0, 0.0, Some(-1.0)),
        (0.0, 1.0, Some(-1.0)),
        (0.0, 1.0, None),
        (1.0, 1.0, None),
        (1.0, 1.0, Some(1.0)),
        (1.0, 0.0, Some(1.0)),
    ];
    let vertices = rows
        .into_iter()
        .flat_map(|(along, radius, cap)| {
            mesh::circle(SEGMENTS).map(move |around| {
                let side = Vec3::new(0.0, around.x, -around.y);
                let normal = cap.map_or(side, |x| Vec3::X * x);
                Vertex { along, rim: side * radius, normal }
            })
        })
        .collect();
    (vertices, mesh::grid(rows.len() as u16 - 1, SEGMENTS))
}

fn ball(gpu: &Gpu) -> Mesh {
    let (points, indices) = mesh::sphere(SEGMENTS);
    let vertices: Vec<_> =
        points.into_iter().map(|point| Vertex { along: 0.0, rim: point, normal: point }).collect();
    Mesh::new(gpu, "ball", &vertices, &indices)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cone_is_closed_and_faces_outwards() {
        let (vertices, indices) = cone_triangles();
        let corners = |vertex: &Vertex| Vec3::new(vertex.along, 0.0, 0.0) + vertex.rim;
        let mut volume = 0.0;
        for triangle in indices.chunks_exact(3) {
            let [a, b, c] = [0, 1, 2].map(|corner| vertices[usize::from(triangle[corner])]);
            let normal = (corners(&b) - corners(&a)).cross(corners(&c) - corners(&a));
            assert!(normal.dot(a.normal) >= -1e-6, "{triangle:?} faces inwards");
            volume += corners(&a).dot(normal) / 6.0;
        }
        let cylinder = core::f32::consts::PI;
        assert!((volume - cylinder).abs() < 0.01 * cylinder, "volume {volume}");
    }
}
