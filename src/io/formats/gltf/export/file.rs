use std::collections::{BTreeMap, HashMap};

use ::gltf::binary::{Glb, Header};
use ::gltf::json::animation::{Channel, Property, Sampler, Target};
use ::gltf::json::buffer::Target::{ArrayBuffer, ElementArrayBuffer};
use ::gltf::json::image::MimeType;
use ::gltf::json::material::{PbrBaseColorFactor, PbrMetallicRoughness, StrengthFactor};
use ::gltf::json::mesh::{Mode, Primitive, Semantic};
use ::gltf::json::scene::UnitQuaternion;
use ::gltf::json::validation::Checked::Valid;
use ::gltf::json::{
    Accessor, Animation, Asset, Buffer, Extras, Image, Index, Material, Mesh, Node, Scene, Skin,
    Texture, buffer, texture,
};
use glam::{DAffine3, DMat4};
use serde_json::value::to_raw_value;

use super::error::GlbError;
use super::joint_track::JointTrack;
use super::mesh::{MeshPart, RigMesh};
use super::motion::JointAnimation;
use super::nodes::JointNodes;
use super::writer::{AccessorKind, GltfWriter, floats};
use crate::io::formats::gltf::conversions::linear;
use crate::io::formats::gltf::extras;
use crate::io::formats::gltf::extras::{AnimationExtras, NodeExtras, SamplerExtras};
use crate::kinematics::Shared;
use crate::rig::SkinTexture;

pub fn write(
    bones: &JointNodes,
    motion: &JointAnimation,
    mesh: &RigMesh,
    name: Option<&str>,
) -> Result<Vec<u8>, GlbError> {
    let mut writer = GltfWriter::default();
    writer.root.asset = Asset { generator: Some(extras::this_program()), ..Asset::default() };
    let [armature, mesh_node] = add_nodes(&mut writer, bones);
    for (node, frame) in &motion.frames {
        writer.root.nodes[*node].extras = Some(to_raw_value(&NodeExtras::new(*frame))?);
    }
    let skin = add_skin(&mut writer, bones, &mesh.attached, armature);
    let mesh = add_mesh(&mut writer, mesh);
    if let Some(node) = writer.root.nodes.get_mut(mesh_node.value()) {
        (node.mesh, node.skin) = (Some(mesh), Some(skin));
    }
    add_animation(&mut writer, motion, name)?;
    writer.root.scenes = vec![Scene {
        name: None,
        nodes: vec![armature, mesh_node],
        extensions: None,
        extras: Extras::default(),
    }];
    writer.root.scene = Some(Index::new(0));
    to_glb(writer)
}

fn to_glb(mut writer: GltfWriter) -> Result<Vec<u8>, GlbError> {
    writer.root.buffers = vec![Buffer {
        byte_length: writer.bytes.len().into(),
        name: None,
        uri: None,
        extensions: None,
        extras: Extras::default(),
    }];
    let json = serde_json::to_vec(&writer.root)?;
    // The length is set when the file is written.
    let header = Header { magic: *b"glTF", version: 2, length: 0 };
    Ok(Glb { header, json: json.into(), bin: Some(writer.bytes.into()) }.to_vec()?)
}

/// Adds the nodes of the joints, with the same indices as in `bones`, then a node above them and
/// the node of the mesh. Returns these two nodes.
fn add_nodes(writer: &mut GltfWriter, bones: &JointNodes) -> [Index<Node>; 2] {
    let mut children = vec![Vec::new(); bones.nodes.len()];
    let mut roots = Vec::new();
    for (index, node) in bones.nodes.iter().enumerate() {
        node.parent.map_or(&mut roots, |parent| &mut children[parent]).push(node_index(index));
    }
    let non_empty = |children: Vec<Index<Node>>| (!children.is_empty()).then_some(children);
    for ((node, bind_pose), children) in bones.nodes.iter().zip(&bones.bind_pose).zip(children) {
        writer.root.push(Node {
            name: Some(node.name.clone()),
            children: non_empty(children),
            translation: Some(bind_pose.translation.as_vec3().to_array()),
            rotation: Some(UnitQuaternion(bind_pose.rotation.as_quat().to_array())),
            ..Node::default()
        });
    }
    let armature = Node {
        name: Some(JointNodes::ARMATURE.to_owned()),
        children: non_empty(roots),
        ..Node::default()
    };
    let mesh_node = Node { name: Some(JointNodes::MESH.to_owned()), ..Node::default() };
    [armature, mesh_node].map(|node| writer.root.push(node))
}

fn node_index(node: usize) -> Index<Node> {
    Index::new(u32::try_from(node).unwrap_or(u32::MAX))
}

fn add_mesh(writer: &mut GltfWriter, mesh: &RigMesh) -> Index<Mesh> {
    let parts = mesh.parts.iter().filter(|part| !part.indices.is_empty());
    let mut textures = Textures::default();
    let primitives = parts.map(|part| primitive(writer, part, &mut textures)).collect();
    writer.root.push(Mesh {
        name: Some(JointNodes::MESH.to_owned()),
        primitives,
        weights: None,
        extensions: None,
        extras: Extras::default(),
    })
}

fn primitive(writer: &mut GltfWriter, part: &MeshPart, textures: &mut Textures) -> Primitive {
    let vertices = part.positions.len();
    let array = Some(ArrayBuffer);
    let joints = part.joints.iter().flatten().flat_map(|joint| joint.to_le_bytes());
    let mut attributes = BTreeMap::from([
        (Valid(Semantic::Positions), writer.bounded(&part.positions, array, AccessorKind::POINT)),
        (
            Valid(Semantic::Normals),
            writer.array(floats(&part.normals), array, vertices, AccessorKind::POINT),
        ),
        (Valid(Semantic::Joints(0)), writer.array(joints, array, vertices, AccessorKind::JOINTS)),
        (
            Valid(Semantic::Weights(0)),
            writer.array(floats(&part.weights), array, vertices, AccessorKind::WEIGHTS),
        ),
    ]);
    if !part.coordinates.is_empty() {
        let coordinates = floats(&part.coordinates);
        let coordinates = writer.array(coordinates, array, vertices, AccessorKind::COORDINATES);
        attributes.insert(Valid(Semantic::TexCoords(0)), coordinates);
    }
    let texture = part.texture.as_ref().map(|texture| textures.index(writer, texture));
    let indices = part.indices.iter().flat_map(|index| index.to_le_bytes());
    let target = Some(ElementArrayBuffer);
    let indices = writer.array(indices, target, part.indices.len(), AccessorKind::INDEX);
    Primitive {
        attributes,
        indices: Some(indices),
        material: Some(writer.root.push(matte(part.colour, texture))),
        mode: Valid(Mode::Triangles),
        targets: None,
        extensions: None,
        extras: Extras::default(),
    }
}

/// The textures of a file that are written already.
#[derive(Default)]
struct Textures(Vec<(Shared<SkinTexture>, Index<Texture>)>);

impl Textures {
    /// Index of a texture, which is written if it is new.
    fn index(&mut self, writer: &mut GltfWriter, texture: &Shared<SkinTexture>) -> Index<Texture> {
        if let Some((_, known)) = self.0.iter().find(|(known, _)| known.is_same(texture)) {
            return *known;
        }
        let start = writer.bytes.len();
        writer.bytes.extend(&texture.file);
        let view = writer.view(start, None);
        let padded = writer.bytes.len().next_multiple_of(4);
        writer.bytes.resize(padded, 0);
        let is_png = texture.file.starts_with(b"\x89PNG");
        let mime = if is_png { "image/png" } else { "image/jpeg" };
        let image = writer.root.push(Image {
            buffer_view: Some(view),
            mime_type: Some(MimeType(mime.to_owned())),
            name: None,
            uri: None,
            extensions: None,
            extras: Extras::default(),
        });
        let index = writer.root.push(Texture {
            name: None,
            sampler: None,
            source: image,
            extensions: None,
            extras: Extras::default(),
        });
        self.0.push((texture.clone(), index));
        index
    }
}

fn matte(colour: [f32; 3], texture: Option<Index<Texture>>) -> Material {
    let [red, green, blue] = colour.map(linear);
    Material {
        pbr_metallic_roughness: PbrMetallicRoughness {
            base_color_factor: PbrBaseColorFactor([red, green, blue, 1.0]),
            base_color_texture: texture.map(|index| texture::Info {
                index,
                tex_coord: 0,
                extensions: None,
                extras: Extras::default(),
            }),
            metallic_factor: StrengthFactor(0.0),
            roughness_factor: StrengthFactor(1.0),
            ..PbrMetallicRoughness::default()
        },
        ..Material::default()
    }
}

fn add_skin(
    writer: &mut GltfWriter,
    bones: &JointNodes,
    attached: &[DAffine3],
    armature: Index<Node>,
) -> Index<Skin> {
    let mut worlds: Vec<DAffine3> = Vec::with_capacity(bones.nodes.len());
    for (node, bind_pose) in bones.nodes.iter().zip(&bones.bind_pose) {
        let local = DAffine3::from_rotation_translation(bind_pose.rotation, bind_pose.translation);
        worlds.push(node.parent.map_or(local, |parent| worlds[parent] * local));
    }
    let attached = attached.iter().copied().chain(core::iter::repeat(DAffine3::IDENTITY));
    let bind = |(world, attached): (&DAffine3, DAffine3)| {
        DMat4::from(world.inverse() * attached).as_mat4().to_cols_array()
    };
    let matrices: Vec<[f32; 16]> = worlds.iter().zip(attached).map(bind).collect();
    let accessor = writer.array(floats(&matrices), None, matrices.len(), AccessorKind::MATRIX);
    writer.root.push(Skin {
        name: Some(JointNodes::ARMATURE.to_owned()),
        inverse_bind_matrices: Some(accessor),
        joints: (0..bones.nodes.len()).map(node_index).collect(),
        skeleton: Some(armature),
        extensions: None,
        extras: Extras::default(),
    })
}

/// Adds the animation, unless it is empty.
fn add_animation(
    writer: &mut GltfWriter,
    motion: &JointAnimation,
    name: Option<&str>,
) -> Result<(), GlbError> {
    if motion.is_empty() {
        return Ok(());
    }
    let lists = TimeLists::new(writer, motion);
    let start = writer.bytes.len();
    let view = Index::new(u32::try_from(writer.root.buffer_views.len()).unwrap_or(u32::MAX));
    let mut animation = Animation {
        channels: Vec::new(),
        samplers: Vec::new(),
        name: name.map(str::to_owned),
        extensions: None,
        extras: Some(to_raw_value(&AnimationExtras::new(motion.timeline))?),
    };
    let mut tracks = AnimationWriter { writer, animation: &mut animation, lists, view, start };
    for track in &motion.rotations {
        tracks.add(track, Property::Rotation, AccessorKind::QUATERNION)?;
    }
    for track in &motion.translations {
        tracks.add(track, Property::Translation, AccessorKind::POINT)?;
    }
    writer.view(start, None);
    writer.root.push(animation);
    Ok(())
}

/// The accessors of the times of keys. Tracks with the same times share one.
struct TimeLists(HashMap<Vec<u32>, Index<Accessor>>);

impl TimeLists {
    fn new(writer: &mut GltfWriter, motion: &JointAnimation) -> Self {
        let mut lists = Self(HashMap::new());
        let rotations = motion.rotations.iter().map(|track| &track.times);
        for times in rotations.chain(motion.translations.iter().map(|track| &track.times)) {
            lists.0.entry(bits(times)).or_insert_with(|| {
                let rows: Vec<[f32; 1]> = times.iter().map(|time| [*time]).collect();
                writer.bounded(&rows, None, AccessorKind::NUMBER)
            });
        }
        lists
    }

    fn of(&self, times: &[f32]) -> Index<Accessor> {
        self.0[&bits(times)]
    }
}

fn bits(times: &[f32]) -> Vec<u32> {
    times.iter().map(|time| time.to_bits()).collect()
}

/// Writes tracks one after the other into the same buffer view. The caller adds the view after the
/// last track.
struct AnimationWriter<'a> {
    writer: &'a mut GltfWriter,
    animation: &'a mut Animation,
    lists: TimeLists,
    view: Index<buffer::View>,
    /// The byte of the buffer at which the view begins.
    start: usize,
}

impl AnimationWriter<'_> {
    fn add<const N: usize>(
        &mut self,
        track: &JointTrack<N>,
        path: Property,
        kind: AccessorKind,
    ) -> Result<(), GlbError> {
        let offset = self.writer.bytes.len() - self.start;
        self.writer.bytes.extend(floats(&track.values));
        let output = self.writer.accessor(self.view, offset, track.values.len(), kind);
        let sampler = Index::push(
            &mut self.animation.samplers,
            Sampler {
                input: self.lists.of(&track.times),
                output,
                interpolation: Valid(track.curve),
                extensions: None,
                extras: if track.keys.is_empty() {
                    None
                } else {
                    Some(to_raw_value(&SamplerExtras::new(&track.keys))?)
                },
            },
        );
        let target = Target {
            node: node_index(track.node),
            path: Valid(path),
            extensions: None,
            extras: Extras::default(),
        };
        self.animation.channels.push(Channel {
            sampler,
            target,
            extensions: None,
            extras: Extras::default(),
        });
        Ok(())
    }
}
