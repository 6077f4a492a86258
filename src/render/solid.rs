use bytemuck::{Pod, Zeroable};
use glam::{Mat3, Vec3};

use super::instances::Instances;
use super::mesh::{self, Mesh};
use super::{Gpu, pipeline};
use crate::scene::{Ball, Scene, Solid};

pub(super) const SHADER: &str = concat!(
    include_str!("../../shaders/view.wgsl"),
    include_str!("../../shaders/planes.wgsl"),
    include_str!("../../shaders/solid.wgsl"),
);

/// How finely solids are divided, from the thinnest on screen to the thickest.
const LEVELS: [Level; 8] = [
    Level { segments: 10, radius: 3.0 },
    Level { segments: 14, radius: 6.0 },
    Level { segments: 20, radius: 14.0 },
    Level { segments: 26, radius: 26.0 },
    Level { segments: 32, radius: 48.0 },
    Level { segments: 48, radius: 105.0 },
    Level { segments: 64, radius: 190.0 },
    Level { segments: 128, radius: f32::INFINITY },
];

/// A division around, and the radius in pixels up to which no corner shows with it: it stands out
/// r·(1 − cos(π/n)), about a quarter of a pixel.
struct Level {
    segments: u16,
    radius: f32,
}

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
    /// 1 or 0: whether there are any; how they wind.
    stripes: [f32; 2],
}

const _: () = assert!(size_of::<Vertex>() == 28);
const _: () = assert!(size_of::<Instance>() == 84);

/// Draws tapered cylinders and balls, and those that show through what hides them.
#[derive(Debug)]
pub(super) struct Solids {
    visible: wgpu::RenderPipeline,
    hidden: wgpu::RenderPipeline,
    levels: [Meshes; LEVELS.len()],
}

/// What is drawn at one level: the meshes and what is in their shape.
#[derive(Debug)]
struct Meshes {
    cone: Mesh,
    ball: Mesh,
    cones: Instances<Instance>,
    balls: Instances<Instance>,
    guide_cones: Instances<Instance>,
    guide_balls: Instances<Instance>,
}

impl Solids {
    /// Cones, balls, and those of the guides, at each level.
    pub const LISTS: usize = 4 * LEVELS.len();

    pub fn new(gpu: &Gpu, view: &wgpu::BindGroupLayout) -> Self {
        let vertex = wgpu::vertex_attr_array![0 => Float32, 1 => Float32x3, 2 => Float32x3];
        let instance = wgpu::vertex_attr_array![
            3 => Float32x4, 4 => Float32x4, 5 => Float32x4, 6 => Float32x3, 7 => Float32x4,
            8 => Float32x2
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
            levels: LEVELS.map(|level| Meshes::new(gpu, level.segments)),
        }
    }

    /// How many bytes were sent. `size` is the picture's, in pixels.
    pub fn upload(&mut self, gpu: &Gpu, scene: &Scene, size: (u32, u32)) -> u64 {
        let (width, height) = (size.0 as f32, size.1 as f32);
        let projection = scene.camera.projection(width / height);
        let level_of = |instance: &Instance| {
            let pixels = height / 2.0 / projection.half_height_at(instance.origin);
            let radius = instance.base_radius.max(instance.tip_radius) * pixels;
            // What is beside or behind the eye has no size there; it may come near.
            let radius = if radius > 0.0 { radius } else { f32::INFINITY };
            LEVELS.iter().position(|level| radius <= level.radius)
        };
        let mut sent = 0;
        for (index, level) in self.levels.iter_mut().enumerate() {
            let here = |instance: &Instance| level_of(instance) == Some(index);
            let cones = scene.solids.iter().map(Instance::of_solid).filter(here);
            let balls = scene.balls.iter().map(Instance::of_ball).filter(here);
            let guide_cones = scene.guide_solids.iter().map(Instance::of_solid).filter(here);
            let guide_balls = scene.guide_balls.iter().map(Instance::of_ball).filter(here);
            sent += level.cones.upload(gpu, cones);
            sent += level.balls.upload(gpu, balls);
            sent += level.guide_cones.upload(gpu, guide_cones);
            sent += level.guide_balls.upload(gpu, guide_balls);
        }
        sent
    }

    /// How many are drawn; guides are drawn twice.
    pub fn triangles(&self) -> u32 {
        self.levels.iter().map(Meshes::triangles).sum()
    }

    pub fn draw(&self, pass: &mut wgpu::RenderPass<'_>) {
        pass.set_pipeline(&self.visible);
        for level in self.levels.iter().rev() {
            draw(pass, &level.cone, &level.cones);
        }
        for level in self.levels.iter().rev() {
            draw(pass, &level.ball, &level.balls);
            level.draw_guides(pass);
        }
    }

    /// After everything opaque: the guides, where they are behind it.
    pub fn draw_hidden(&self, pass: &mut wgpu::RenderPass<'_>) {
        pass.set_pipeline(&self.hidden);
        for level in &self.levels {
            level.draw_guides(pass);
        }
    }
}

impl Meshes {
    fn new(gpu: &Gpu, segments: u16) -> Self {
        Self {
            cone: cone(gpu, segments),
            ball: ball(gpu, segments),
            cones: Instances::new("cones"),
            balls: Instances::new("balls"),
            guide_cones: Instances::new("guide cones"),
            guide_balls: Instances::new("guide balls"),
        }
    }

    fn triangles(&self) -> u32 {
        let cones = self.cones.count() + 2 * self.guide_cones.count();
        let balls = self.balls.count() + 2 * self.guide_balls.count();
        cones * self.cone.triangles() + balls * self.ball.triangles()
    }

    fn draw_guides(&self, pass: &mut wgpu::RenderPass<'_>) {
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
        let winding = solid.stripes.filter(|winding| winding.is_finite());
        Self {
            x: axes.x_axis,
            length: solid.shape.length,
            y: axes.y_axis,
            base_radius: solid.shape.base_radius,
            z: axes.z_axis,
            tip_radius: solid.shape.tip_radius,
            origin: solid.place.translation.into(),
            colour: solid.colour.channels(),
            stripes: winding.map_or([0.0, 0.0], |winding| [1.0, winding]),
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
            stripes: [0.0, 0.0],
        }
    }
}

/// Side and two caps. Rows run from the base's middle over its rim and the tip's rim to its middle,
/// rims twice for the edges.
fn cone(gpu: &Gpu, segments: u16) -> Mesh {
    let (vertices, indices) = cone_triangles(segments);
    Mesh::new(gpu, "cone", &vertices, &indices)
}

fn cone_triangles(segments: u16) -> (Vec<Vertex>, Vec<u16>) {
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
                Vertex { along, rim: side * radius, normal }
            })
        })
        .collect();
    let place = |index| corner(&vertices[usize::from(index)]);
    let triangles = mesh::grid(rows.len() as u16 - 1, segments, place);
    (vertices, triangles)
}

/// Where a vertex of a solid of length and radius 1 is.
fn corner(vertex: &Vertex) -> Vec3 {
    Vec3::new(vertex.along, 0.0, 0.0) + vertex.rim
}

fn ball(gpu: &Gpu, segments: u16) -> Mesh {
    let (points, indices) = mesh::sphere(segments);
    let vertices: Vec<_> =
        points.into_iter().map(|point| Vertex { along: 0.0, rim: point, normal: point }).collect();
    Mesh::new(gpu, "ball", &vertices, &indices)
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
            let normal = (corner(&b) - corner(&a)).cross(corner(&c) - corner(&a));
            assert!(normal.dot(a.normal) >= -1e-6, "{triangle:?} faces inwards");
            volume += corner(&a).dot(normal) / 6.0;
        }
        let cylinder = core::f32::consts::PI;
        assert!((volume - cylinder).abs() < 0.01 * cylinder, "volume {volume}");
    }
}
