use bytemuck::{Pod, Zeroable};
use glam::{Vec2, Vec3, Vec4};

use super::Gpu;
use super::pipeline::{PipelineDescriptor, PipelineOutput};
use super::skin_deform::{Deformation, DeformedSkin, DeformedVertex, SkinDeformer, SkinVertices};
use super::skin_material::{PartTextures, SkinMaterial, SkinMaterials};
use super::view::Uniforms;
use crate::kinematics::Shared;
use crate::kinematics::skin::TriangleMesh;
use crate::rig::AttachedMesh;
use crate::scene::{Colour, Palette, Scene, SkinInstance, WeightColours};

pub(super) const SHADER: &str =
    concat!(include_str!("../../shaders/view.wgsl"), include_str!("../../shaders/skin.wgsl"),);

#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
struct Look {
    colour: Vec4,
    wire: Vec4,
    offset: Vec3,
    has_weights: f32,
    tint: Vec4,
    ramp: [Vec4; Palette::GAINS],
}

const _: () = assert!(size_of::<Look>() == 9 * 16);

/// What poses do not change of a vertex.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
struct FixedVertex {
    coordinates: Vec2,
    /// sRGB.
    colour: [u8; 4],
    emission_coordinates: Vec2,
}

const _: () = assert!(size_of::<FixedVertex>() == 20);

/// Draws skins. Nothing is created before the first skin is drawn.
#[derive(Debug, Default)]
pub(super) struct Skins {
    pipelines: Option<SkinPipelines>,
    meshes: Vec<SkinMesh>,
    skins: Vec<DrawnSkin>,
    /// See-through parts of opaque skins, the farthest first: indices of the skin and of its material.
    blended: Vec<[usize; 2]>,
}

#[derive(Debug)]
struct SkinPipelines {
    deformer: SkinDeformer,
    materials: SkinMaterials,
    opaque: SurfacePipelines,
    /// Depth of the nearest surface of see-through skins, without and with a texture that can cut out.
    depth: [SidedPipelines; 2],
    see_through: SurfacePipelines,
    /// For see-through parts of opaque skins.
    blended: SurfacePipelines,
    wire: wgpu::RenderPipeline,
}

/// Pipelines for parts of skins by their [`PartTextures`].
#[derive(Debug)]
struct SurfacePipelines([SidedPipelines; 3]);

/// Pipelines for parts that are seen from outside and for those that are seen from both sides, each
/// for skins that are not mirrored and for mirrored ones.
#[derive(Debug)]
struct SidedPipelines([[wgpu::RenderPipeline; 2]; 2]);

/// A mesh on the device.
#[derive(Debug)]
struct SkinMesh {
    mesh: Shared<AttachedMesh>,
    vertices: SkinVertices,
    fixed: wgpu::Buffer,
    triangles: wgpu::Buffer,
    indices: u32,
    materials: Vec<SkinMaterial>,
    /// Edges, made for the first wireframe, with the number of their indices.
    edges: Option<(wgpu::Buffer, u32)>,
    is_used: bool,
}

/// A posed mesh on the device.
#[derive(Debug)]
struct DrawnSkin {
    mesh: Shared<AttachedMesh>,
    deformed: DeformedSkin,
    look: Uniforms<Look>,
    is_mirrored: bool,
    is_opaque: bool,
    has_wireframe: bool,
}

impl Skins {
    /// Sends the changes to the device, moves the vertices if a pose has changed, and returns the
    /// number of bytes sent.
    pub fn upload(&mut self, gpu: &Gpu, view: &wgpu::BindGroupLayout, scene: &Scene) -> u64 {
        if scene.skins.is_empty() {
            self.skins.clear();
            self.meshes.clear();
            return 0;
        }
        let pipelines = self.pipelines.get_or_insert_with(|| SkinPipelines::new(gpu, view));
        self.meshes.iter_mut().for_each(|mesh| mesh.is_used = false);
        self.skins.truncate(scene.skins.len());
        let mut sent = 0;
        for (index, skin) in scene.skins.iter().enumerate() {
            let mesh = match self.meshes.iter().position(|it| it.mesh.is_same(&skin.mesh)) {
                Some(known) => &mut self.meshes[known],
                None => {
                    sent += skin.mesh.mesh.bytes() as u64;
                    let morphs = |it: &SkinMesh| !it.is_used && it.mesh.has_surface_of(&skin.mesh);
                    if let Some(known) = self.meshes.iter().position(morphs) {
                        let mesh = &mut self.meshes[known];
                        mesh.morph(gpu, skin.mesh.clone());
                        mesh
                    } else {
                        let new = SkinMesh::new(gpu, &pipelines.materials, skin.mesh.clone());
                        self.meshes.push(new);
                        let last = self.meshes.len() - 1;
                        &mut self.meshes[last]
                    }
                }
            };
            mesh.is_used = true;
            if skin.wireframe.is_some() {
                mesh.make_edges(gpu);
            }
            if index == self.skins.len() {
                self.skins.push(DrawnSkin::new(gpu, pipelines, mesh));
            } else if !self.skins[index].mesh.is_same(&skin.mesh) {
                self.skins[index] = DrawnSkin::new(gpu, pipelines, mesh);
            }
            sent += self.skins[index].upload(gpu, pipelines, mesh, skin, &scene.palette);
        }
        self.meshes.retain(|mesh| mesh.is_used);
        self.order(scene);
        sent
    }

    /// Orders the see-through parts of opaque skins.
    fn order(&mut self, scene: &Scene) {
        let (back, ..) = scene.camera.basis();
        let mut parts: Vec<(f32, [usize; 2])> = Vec::new();
        for (index, (drawn, skin)) in self.skins.iter().zip(&scene.skins).enumerate() {
            let mesh = self.mesh(drawn).filter(|_| drawn.is_opaque);
            let materials = mesh.into_iter().flat_map(|mesh| mesh.materials.iter().enumerate());
            parts.extend(materials.filter_map(|(material, SkinMaterial { centre, .. })| {
                let centre = centre.as_ref()?.posed(&skin.pose) + skin.offset;
                Some((back.dot(centre), [index, material]))
            }));
        }
        parts.sort_by(|(one, _), (other, _)| one.total_cmp(other));
        self.blended.clear();
        self.blended.extend(parts.into_iter().map(|(_, part)| part));
    }

    pub fn triangles(&self) -> u32 {
        let of = |skin: &DrawnSkin| self.mesh(skin).map_or(0, |mesh| mesh.indices / 3);
        self.skins.iter().map(of).sum()
    }

    /// Draws the opaque skins.
    pub fn draw_opaque(&self, pass: &mut wgpu::RenderPass<'_>) {
        let Some(pipelines) = &self.pipelines else { return };
        for skin in self.skins.iter().filter(|skin| skin.is_opaque) {
            let opaque = |material: &SkinMaterial| material.centre.is_none();
            self.draw(pass, skin, opaque, |material| pipelines.opaque.of(material, skin));
            self.draw_wireframe(pass, pipelines, skin);
        }
    }

    /// Draws the see-through parts of opaque skins, and the nearest surfaces of see-through skins,
    /// over what is drawn already except opaque skins, which stay in front of their onion skins. To be
    /// drawn last: opaque skins then have the nearest depth. `size` is that of the picture in pixels.
    pub fn draw_see_through(&self, pass: &mut wgpu::RenderPass<'_>, size: (u32, u32)) {
        let Some(pipelines) = &self.pipelines else { return };
        for [skin, part] in &self.blended {
            let skin = &self.skins[*skin];
            if let Some(mesh) = self.mesh(skin) {
                skin.bind(pass, mesh);
                let material = &mesh.materials[*part];
                material.draw(pass, pipelines.blended.of(material, skin));
            }
        }
        let all = |_: &SkinMaterial| true;
        let depth = |skin| {
            move |material: &SkinMaterial| {
                let is_textured = material.textures != PartTextures::None;
                pipelines.depth[usize::from(is_textured)].of(material, skin)
            }
        };
        if self.skins.iter().any(|skin| !skin.is_opaque) {
            let [width, height] = [size.0, size.1].map(|side| side as f32);
            // As near as possible, so that what follows is behind them.
            pass.set_viewport(0.0, 0.0, width, height, 1.0, 1.0);
            for skin in self.skins.iter().filter(|skin| skin.is_opaque) {
                self.draw(pass, skin, |material| material.centre.is_none(), depth(skin));
            }
            pass.set_viewport(0.0, 0.0, width, height, 0.0, 1.0);
        }
        for skin in self.skins.iter().filter(|skin| !skin.is_opaque) {
            self.draw(pass, skin, all, depth(skin));
            self.draw(pass, skin, all, |material| pipelines.see_through.of(material, skin));
            self.draw_wireframe(pass, pipelines, skin);
        }
    }

    fn draw<'a>(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        skin: &DrawnSkin,
        is_drawn: impl Fn(&SkinMaterial) -> bool,
        pipeline: impl Fn(&SkinMaterial) -> &'a wgpu::RenderPipeline,
    ) {
        let Some(mesh) = self.mesh(skin) else { return };
        skin.bind(pass, mesh);
        for material in mesh.materials.iter().filter(|material| is_drawn(material)) {
            material.draw(pass, pipeline(material));
        }
    }

    fn draw_wireframe(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        pipelines: &SkinPipelines,
        skin: &DrawnSkin,
    ) {
        let Some(mesh) = self.mesh(skin).filter(|_| skin.has_wireframe) else { return };
        if let (Some((edges, count)), [material, ..]) = (&mesh.edges, &mesh.materials[..]) {
            pass.set_pipeline(&pipelines.wire);
            skin.bind(pass, mesh);
            pass.set_bind_group(2, &material.group, &[]);
            pass.set_index_buffer(edges.slice(..), wgpu::IndexFormat::Uint32);
            pass.draw_indexed(0..*count, 0, 0..1);
        }
    }

    fn mesh(&self, skin: &DrawnSkin) -> Option<&SkinMesh> {
        self.meshes.iter().find(|mesh| mesh.mesh.is_same(&skin.mesh))
    }
}

impl SkinPipelines {
    fn new(gpu: &Gpu, view: &wgpu::BindGroupLayout) -> Self {
        let look = Uniforms::<Look>::new(gpu, "skin look");
        let materials = SkinMaterials::new(gpu);
        let moved = wgpu::vertex_attr_array![0 => Float32x4, 1 => Float32x4];
        let fixed = wgpu::vertex_attr_array![2 => Float32x2, 3 => Unorm8x4, 4 => Float32x2];
        let buffers = [
            wgpu::VertexBufferLayout {
                array_stride: size_of::<DeformedVertex>() as u64,
                step_mode: wgpu::VertexStepMode::Vertex,
                attributes: &moved,
            },
            wgpu::VertexBufferLayout {
                array_stride: size_of::<FixedVertex>() as u64,
                step_mode: wgpu::VertexStepMode::Vertex,
                attributes: &fixed,
            },
        ];
        let layouts = [view, &look.layout, &materials.layout];
        let plain = PipelineDescriptor {
            buffers: &buffers,
            cull: Some(wgpu::Face::Back),
            ..PipelineDescriptor::new("skin", SHADER, &layouts, PipelineOutput::Opaque)
        };
        let depth = PipelineDescriptor {
            label: "skin depth",
            fragment: "fragment_depth",
            output: PipelineOutput::Depth,
            ..plain
        };
        let see_through = PipelineDescriptor {
            label: "skin, see-through",
            depth: wgpu::CompareFunction::Equal,
            output: PipelineOutput::Blended,
            ..plain
        };
        let blended = PipelineDescriptor {
            label: "skin, see-through parts",
            output: PipelineOutput::Blended,
            ..plain
        };
        let wire = PipelineDescriptor {
            label: "skin wireframe",
            fragment: "fragment_wire",
            topology: wgpu::PrimitiveTopology::LineList,
            cull: None,
            depth: wgpu::CompareFunction::GreaterEqual,
            output: PipelineOutput::Blended,
            ..plain
        };
        Self {
            deformer: SkinDeformer::new(gpu),
            opaque: SurfacePipelines::new(gpu, &plain, 0.0),
            depth: [0.0, 1.0]
                .map(|textured| SidedPipelines::new(gpu, &depth, [textured, 0.0, 0.0])),
            see_through: SurfacePipelines::new(gpu, &see_through, 0.0),
            blended: SurfacePipelines::new(gpu, &blended, 1.0),
            wire: wire.build(gpu),
            materials,
        }
    }
}

impl SurfacePipelines {
    fn new(gpu: &Gpu, descriptor: &PipelineDescriptor<'_>, is_blended: f64) -> Self {
        let of = |[is_textured, has_emission]: [f64; 2]| {
            SidedPipelines::new(gpu, descriptor, [is_textured, has_emission, is_blended])
        };
        Self([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]].map(of))
    }

    fn of(&self, material: &SkinMaterial, skin: &DrawnSkin) -> &wgpu::RenderPipeline {
        let kind = match material.textures {
            PartTextures::None => 0,
            PartTextures::Colour => 1,
            PartTextures::Emission => 2,
        };
        self.0[kind].of(material, skin)
    }
}

impl SidedPipelines {
    fn new(
        gpu: &Gpu,
        descriptor: &PipelineDescriptor<'_>,
        [is_textured, has_emission, is_blended]: [f64; 3],
    ) -> Self {
        let hidden = [wgpu::Face::Back, wgpu::Face::Front];
        let constants = [
            ("IS_TEXTURED", is_textured),
            ("HAS_EMISSION_TEXTURE", has_emission),
            ("IS_BLENDED", is_blended),
        ];
        let outside = hidden.map(|face| {
            let constants = &constants;
            PipelineDescriptor { cull: Some(face), constants, ..*descriptor }.build(gpu)
        });
        let both = [1.0, -1.0].map(|outer| {
            let [textured, emission, blended] = constants;
            let constants = &[textured, emission, blended, ("OUTER_SIDE", outer)];
            PipelineDescriptor { cull: None, constants, ..*descriptor }.build(gpu)
        });
        Self([outside, both])
    }

    fn of(&self, material: &SkinMaterial, skin: &DrawnSkin) -> &wgpu::RenderPipeline {
        &self.0[usize::from(material.is_double_sided)][usize::from(skin.is_mirrored)]
    }
}

impl SkinMesh {
    fn new(gpu: &Gpu, materials: &SkinMaterials, mesh: Shared<AttachedMesh>) -> Self {
        let triangle_mesh = mesh.mesh.mesh();
        let TriangleMesh { positions, texture_coordinates, colours, triangles, .. } = triangle_mesh;
        let fixed = |vertex: usize| {
            let coordinates = texture_coordinates.get(vertex).copied().unwrap_or_default();
            let of_emission = triangle_mesh.emission_coordinates.get(vertex).copied();
            FixedVertex {
                coordinates,
                colour: colours.get(vertex).copied().unwrap_or([u8::MAX; 4]),
                emission_coordinates: of_emission.unwrap_or(coordinates),
            }
        };
        let fixed: Vec<FixedVertex> = (0..positions.len()).map(fixed).collect();
        let fixed = gpu.filled_buffer("skin look", &fixed, wgpu::BufferUsages::VERTEX);
        let materials = materials.of_parts(gpu, &mesh);
        let (triangles, indices) = index_buffer(gpu, "skin triangles", triangles.as_flattened());
        let vertices = SkinVertices::new(gpu, &mesh.mesh);
        let (edges, is_used) = (None, true);
        Self { vertices, fixed, triangles, indices, materials, mesh, edges, is_used }
    }

    /// Replaces the mesh by one that has the same triangles and materials.
    fn morph(&mut self, gpu: &Gpu, mesh: Shared<AttachedMesh>) {
        self.vertices = SkinVertices::new(gpu, &mesh.mesh);
        self.mesh = mesh;
    }

    fn make_edges(&mut self, gpu: &Gpu) {
        let mesh = &self.mesh.mesh;
        self.edges.get_or_insert_with(|| {
            let triangles = mesh.mesh().triangles.iter();
            let sides = triangles.flat_map(|[a, b, c]| [[*a, *b], [*b, *c], [*c, *a]]);
            let mut edges: Vec<[u32; 2]> =
                sides.map(|[from, to]| [from.min(to), from.max(to)]).collect();
            edges.sort_unstable();
            edges.dedup();
            index_buffer(gpu, "skin edges", edges.as_flattened())
        });
    }
}

fn index_buffer(gpu: &Gpu, label: &str, indices: &[u32]) -> (wgpu::Buffer, u32) {
    let buffer = gpu.filled_buffer(label, indices, wgpu::BufferUsages::INDEX);
    (buffer, indices.len() as u32)
}

impl DrawnSkin {
    fn new(gpu: &Gpu, pipelines: &SkinPipelines, mesh: &SkinMesh) -> Self {
        Self {
            mesh: mesh.mesh.clone(),
            deformed: pipelines.deformer.skin(gpu, &mesh.vertices),
            look: Uniforms::new(gpu, "skin look"),
            is_mirrored: false,
            is_opaque: true,
            has_wireframe: false,
        }
    }

    /// Sets the look, the vertices and the triangles.
    fn bind(&self, pass: &mut wgpu::RenderPass<'_>, mesh: &SkinMesh) {
        pass.set_bind_group(1, &self.look.group, &[]);
        pass.set_index_buffer(mesh.triangles.slice(..), wgpu::IndexFormat::Uint32);
        pass.set_vertex_buffer(0, self.deformed.vertices.slice(..));
        pass.set_vertex_buffer(1, mesh.fixed.slice(..));
    }

    fn upload(
        &mut self,
        gpu: &Gpu,
        pipelines: &SkinPipelines,
        mesh: &SkinMesh,
        skin: &SkinInstance,
        palette: &Palette,
    ) -> u64 {
        let screen = |colour: Colour| Vec4::from_array(colour.channels());
        self.is_mirrored = skin.pose.to_world().matrix3.determinant() < 0.0;
        self.is_opaque = skin.colour.channels()[3] >= 1.0;
        self.has_wireframe = skin.wireframe.is_some();
        let (has_weights, tint) = match skin.weights_of {
            None => (0.0, Vec4::ZERO),
            Some((_, WeightColours::Ramp)) => (1.0, Vec4::ZERO),
            Some((_, WeightColours::Tint(tint))) => (0.0, screen(tint)),
        };
        let look = Look {
            colour: screen(skin.colour),
            wire: skin.wireframe.map_or(Vec4::ZERO, screen),
            offset: skin.offset,
            has_weights,
            tint,
            ramp: palette.gains.map(screen),
        };
        let deformation = Deformation {
            mesh: &skin.mesh.mesh,
            pose: &skin.pose,
            skinning: skin.skinning,
            weights_of: skin.weights_of.map(|(joint, _)| joint),
        };
        self.look.upload(gpu, look)
            + pipelines.deformer.update(gpu, &mesh.vertices, &mut self.deformed, deformation)
    }
}
