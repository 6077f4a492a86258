use bytemuck::{Pod, Zeroable};
use glam::{Mat3, Vec3};

use super::Gpu;
use super::instances::InstanceBuffer;
use super::mesh::{MeshBuffers, SolidVertex, ball, cone, hand, wound_cone};
use super::pipeline::{PipelineDescriptor, PipelineOutput};
use crate::scene::{Ball, Hand, Scene, Solid};

pub(super) const SHADER: &str =
    concat!(include_str!("../../shaders/view.wgsl"), include_str!("../../shaders/solid.wgsl"),);

/// Levels of detail from the thinnest solids on screen to the thickest.
const LODS: [DetailLevel; 8] = [
    DetailLevel { segments: 10, max_radius: 3.0 },
    DetailLevel { segments: 14, max_radius: 6.0 },
    DetailLevel { segments: 20, max_radius: 14.0 },
    DetailLevel { segments: 26, max_radius: 26.0 },
    DetailLevel { segments: 32, max_radius: 48.0 },
    DetailLevel { segments: 48, max_radius: 105.0 },
    DetailLevel { segments: 64, max_radius: 190.0 },
    DetailLevel { segments: 128, max_radius: f32::INFINITY },
];

/// Number of segments n around a solid, and the maximum radius r in pixels of the solids that are
/// drawn with them. Up to a finite r the outline deviates from a circle by at most
/// r·(1 − cos(π/n)), less than a quarter of a pixel, so that no corner is visible.
struct DetailLevel {
    segments: u16,
    max_radius: f32,
}

#[repr(C)]
#[derive(Clone, Copy, PartialEq, Pod, Zeroable, Debug)]
struct SolidInstance {
    x: Vec3,
    length: f32,
    y: Vec3,
    base_radius: f32,
    z: Vec3,
    tip_radius: f32,
    origin: Vec3,
    colour: [f32; 4],
    /// 1 if it winds, else 0; then the winding in radians.
    winding: [f32; 2],
    /// Least radius of the thicker end on screen, in points.
    least_radius: f32,
}

const _: () = assert!(size_of::<SolidInstance>() == 88);

/// Least radii on screen, in points, so that what is far away or thin can be seen.
const LEAST_CONE: f32 = 0.8;
const LEAST_BALL: f32 = 1.2;
const LEAST_GUIDE_BALL: f32 = 3.5;

/// Draws tapered cylinders and balls. Guides also show faintly through the surfaces that hide them.
#[derive(Debug)]
pub(super) struct Solids {
    visible: wgpu::RenderPipeline,
    hidden: wgpu::RenderPipeline,
    lods: [DetailMeshes; LODS.len()],
    wound: MeshBuffers,
    wound_cones: InstanceBuffer<SolidInstance>,
    /// `None` before the first hand.
    hand: Option<MeshBuffers>,
    hands: InstanceBuffer<SolidInstance>,
}

/// Meshes and instances of one level of detail.
#[derive(Debug)]
struct DetailMeshes {
    cone: MeshBuffers,
    ball: MeshBuffers,
    cones: InstanceBuffer<SolidInstance>,
    balls: InstanceBuffer<SolidInstance>,
    guide_cones: InstanceBuffer<SolidInstance>,
    guide_balls: InstanceBuffer<SolidInstance>,
}

impl Solids {
    /// Number of instance buffers: cones, balls, guide cones and guide balls at each level of
    /// detail, cones that wind, and hands.
    pub const LISTS: usize = 4 * LODS.len() + 2;

    pub fn new(gpu: &Gpu, view: &wgpu::BindGroupLayout) -> Self {
        let vertex = wgpu::vertex_attr_array![0 => Float32, 1 => Float32x3, 2 => Float32x3];
        let instance = wgpu::vertex_attr_array![
            3 => Float32x4, 4 => Float32x4, 5 => Float32x4, 6 => Float32x3, 7 => Float32x4,
            8 => Float32x2, 9 => Float32
        ];
        let buffers = [
            wgpu::VertexBufferLayout {
                array_stride: size_of::<SolidVertex>() as u64,
                step_mode: wgpu::VertexStepMode::Vertex,
                attributes: &vertex,
            },
            wgpu::VertexBufferLayout {
                array_stride: size_of::<SolidInstance>() as u64,
                step_mode: wgpu::VertexStepMode::Instance,
                attributes: &instance,
            },
        ];
        let layouts = [view];
        let visible = PipelineDescriptor {
            buffers: &buffers,
            cull: Some(wgpu::Face::Back),
            ..PipelineDescriptor::new("solid", SHADER, &layouts, PipelineOutput::Opaque)
        };
        let hidden = PipelineDescriptor {
            label: "solid, hidden",
            fragment: "fragment_hidden",
            depth: wgpu::CompareFunction::Less,
            output: PipelineOutput::Blended,
            ..visible
        };
        Self {
            visible: visible.build(gpu),
            hidden: hidden.build(gpu),
            lods: LODS.map(|lod| DetailMeshes::new(gpu, lod.segments)),
            wound: wound_cone(gpu),
            wound_cones: InstanceBuffer::new("cones that wind"),
            hand: None,
            hands: InstanceBuffer::new("hands"),
        }
    }

    /// Sends the changes to the device and returns the number of bytes sent. `size` is the
    /// picture's in pixels.
    pub fn upload(&mut self, gpu: &Gpu, scene: &Scene, size: (u32, u32)) -> u64 {
        let (width, height) = (size.0 as f32, size.1 as f32);
        let projection = scene.camera.projection(width / height);
        let lod_of = |instance: &SolidInstance| {
            let pixels = height / 2.0 / projection.half_height_at(instance.origin);
            let radius = instance.base_radius.max(instance.tip_radius) * pixels;
            // A solid whose origin is beside or behind the eye has no size on screen, but a part of
            // the solid may be near the eye.
            let radius = if radius > 0.0 { radius } else { f32::INFINITY };
            LODS.iter().position(|lod| radius <= lod.max_radius).unwrap_or(LODS.len() - 1)
        };
        let lods = &mut self.lods;
        for instance in scene.solids.iter().map(SolidInstance::of_solid) {
            let winds = instance.winding[0] > 0.0;
            let cones =
                if winds { &mut self.wound_cones } else { &mut lods[lod_of(&instance)].cones };
            cones.push(instance);
        }
        scene.hands.iter().for_each(|hand| self.hands.push(SolidInstance::of_hand(hand)));
        if !scene.hands.is_empty() {
            self.hand.get_or_insert_with(|| hand(gpu));
        }
        for instance in scene.balls.iter().map(|ball| SolidInstance::of_ball(ball, LEAST_BALL)) {
            lods[lod_of(&instance)].balls.push(instance);
        }
        for instance in scene.guide_solids.iter().map(SolidInstance::of_solid) {
            lods[lod_of(&instance)].guide_cones.push(instance);
        }
        for instance in
            scene.guide_balls.iter().map(|ball| SolidInstance::of_ball(ball, LEAST_GUIDE_BALL))
        {
            lods[lod_of(&instance)].guide_balls.push(instance);
        }
        let sent: u64 = lods.iter_mut().map(|lod| lod.upload(gpu)).sum();
        sent + self.wound_cones.upload(gpu) + self.hands.upload(gpu)
    }

    /// Number of triangles drawn; guides are drawn twice.
    pub fn triangles(&self) -> u32 {
        let in_lods: u32 = self.lods.iter().map(DetailMeshes::triangles).sum();
        let of_hand = self.hand.as_ref().map_or(0, MeshBuffers::triangles);
        in_lods + self.wound_cones.count() * self.wound.triangles() + self.hands.count() * of_hand
    }

    pub fn draw(&self, pass: &mut wgpu::RenderPass<'_>) {
        pass.set_pipeline(&self.visible);
        draw(pass, &self.wound, &self.wound_cones);
        if let Some(hand) = &self.hand {
            draw(pass, hand, &self.hands);
        }
        for lod in self.lods.iter().rev() {
            draw(pass, &lod.cone, &lod.cones);
        }
        for lod in self.lods.iter().rev() {
            draw(pass, &lod.ball, &lod.balls);
            lod.draw_guides(pass);
        }
    }

    /// Draws the hidden parts of guides. Must be called after everything opaque is drawn.
    pub fn draw_hidden(&self, pass: &mut wgpu::RenderPass<'_>) {
        pass.set_pipeline(&self.hidden);
        for lod in &self.lods {
            lod.draw_guides(pass);
        }
    }
}

impl DetailMeshes {
    fn new(gpu: &Gpu, segments: u16) -> Self {
        Self {
            cone: cone(gpu, segments),
            ball: ball(gpu, segments),
            cones: InstanceBuffer::new("cones"),
            balls: InstanceBuffer::new("balls"),
            guide_cones: InstanceBuffer::new("guide cones"),
            guide_balls: InstanceBuffer::new("guide balls"),
        }
    }

    fn upload(&mut self, gpu: &Gpu) -> u64 {
        self.cones.upload(gpu)
            + self.balls.upload(gpu)
            + self.guide_cones.upload(gpu)
            + self.guide_balls.upload(gpu)
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

fn draw(
    pass: &mut wgpu::RenderPass<'_>,
    mesh: &MeshBuffers,
    instances: &InstanceBuffer<SolidInstance>,
) {
    if let Some((buffer, count)) = instances.get() {
        mesh.draw(pass, buffer, count);
    }
}

impl SolidInstance {
    fn of_solid(solid: &Solid) -> Self {
        let axes = Mat3::from(solid.transform.matrix3);
        let winding = solid.winding.filter(|winding| winding.is_finite());
        Self {
            x: axes.x_axis,
            length: solid.shape.length,
            y: axes.y_axis,
            base_radius: solid.shape.base_radius,
            z: axes.z_axis,
            tip_radius: solid.shape.tip_radius,
            origin: solid.transform.translation.into(),
            colour: solid.colour.channels(),
            winding: winding.map_or([0.0, 0.0], |winding| [1.0, winding]),
            least_radius: LEAST_CONE,
        }
    }

    fn of_ball(ball: &Ball, least_radius: f32) -> Self {
        Self {
            x: Vec3::X,
            length: 0.0,
            y: Vec3::Y,
            base_radius: ball.radius,
            z: Vec3::Z,
            tip_radius: ball.radius,
            origin: ball.centre,
            colour: ball.colour.channels(),
            winding: [0.0, 0.0],
            least_radius,
        }
    }

    fn of_hand(hand: &Hand) -> Self {
        let axes = Mat3::from(hand.transform.matrix3);
        Self {
            x: axes.x_axis,
            length: 0.0,
            y: axes.y_axis,
            base_radius: hand.size,
            z: axes.z_axis,
            tip_radius: hand.size,
            origin: hand.transform.translation.into(),
            colour: hand.colour.channels(),
            winding: [0.0, 0.0],
            least_radius: 0.0,
        }
    }
}
