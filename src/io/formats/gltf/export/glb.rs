use core::iter;
use std::collections::{BTreeMap, HashMap};

use glam::{DAffine3, DMat4, DQuat};

use super::GlbError;
use super::mesh::{LimbMesh, MeshPart, PartMorph, RigMesh};
use super::morphs::MorphAnimation;
use super::motion::JointAnimation;
use super::nodes::{ClipTimes, JointNodes, JointTrack, NodeRole};
use super::rig::GltfRig;
use crate::document::{Document, Timeline};
use crate::io::exported::Progress;
use crate::io::formats::gltf::extras::{
    AnimationExtras, Extras, MeshExtras, NodeExtras, SamplerExtras,
};
use crate::io::formats::gltf::file::{
    Component, GltfAccessor, GltfAnimation, GltfAsset, GltfBuffer, GltfBufferView, GltfChannel,
    GltfFile, GltfMesh, GltfNode, GltfPrimitive, GltfSampler, GltfScene, GltfSkin, GltfSparse,
    GltfSparseIndices, GltfSparseValues, GltfTarget, List, whole,
};
use crate::io::formats::gltf::material::{GltfImage, GltfMaterial, GltfTexture};
use crate::io::json::{JsonNumber, JsonNumbers, JsonObject, JsonPoint, Whole};
use crate::kinematics::Shared;
use crate::rig::SkinTexture;

/// Exports the shown rig as a `.glb` file with joints, a skinned mesh and the motion. The mesh is
/// the skin of the skeleton; without one, cones around the bones. The motion has a key at every
/// frame. The frame rate is `frames_per_second`, or with `None` that of the timeline, clamped to
/// the range 0.01 to 1000. With `None`, tracks whose keys glTF can have are written as they are.
/// Lengths are in metres. Only nodes that stretch the skin have scales.
///
/// # Errors
///
/// Fails if the skeleton has no joints, a position overflows, the motion has too many frames, or
/// the export is cancelled.
pub async fn glb(
    document: &Document,
    frames_per_second: Option<f64>,
    progress: &Progress,
) -> Result<Vec<u8>, GlbError> {
    let rate = frames_per_second.unwrap_or(document.timeline.frame_rate);
    let frame_rate = rate.clamp(Timeline::MIN_FRAME_RATE, Timeline::MAX_FRAME_RATE);
    let timeline = Timeline { frame_rate, ..document.timeline };
    let rig = GltfRig::new(document)?;
    let skin = RigMesh::of_skin(document);
    let bones = JointNodes::new(&rig, skin.is_some())?;
    let mut motion = JointAnimation { timeline, ..JointAnimation::default() };
    if frames_per_second.is_none() && timeline.is_valid() {
        motion.keep_tracks(document, &rig, &bones);
    }
    motion.record(&rig, &bones, progress).await?;
    let mesh = match skin {
        Some(skin) => skin,
        None => LimbMesh::new(&rig, &bones)?.into(),
    };
    let mut writer = GltfWriter::default();
    let mut skinned = Vec::new();
    for (set, attached) in mesh.attached.iter().enumerate() {
        let parts: Vec<&MeshPart> = mesh.parts.iter().filter(|part| part.set == set).collect();
        if set == 0 || !parts.is_empty() {
            let skin = writer.add_skin(&bones, attached);
            skinned.push((writer.add_mesh(&parts, &mesh.morphs), skin));
        }
    }
    let frames = motion.frames.iter().copied().chain(bones.stretched_frames());
    let nodes = writer.add_nodes(&bones, frames, &skinned);
    let weights = MorphAnimation::new(document, timeline, mesh.morphs.len())?;
    writer.add_animation(&motion, &weights, &nodes, document.animation_name.as_deref());
    writer.file()
}

/// A file in progress: its JSON, and the bytes of its buffer.
#[derive(Default)]
struct GltfWriter {
    json: GltfFile<'static>,
    bytes: Vec<u8>,
    /// The textures that are written already, with their indices.
    textures: Vec<(Shared<SkinTexture>, Whole)>,
}

/// Use of a buffer view for vertices.
const ARRAY: Option<Whole> = Some(Whole(34962));
/// Use of a buffer view for corners of triangles.
const ELEMENT_ARRAY: Option<Whole> = Some(Whole(34963));

impl GltfWriter {
    /// The `.glb` file: a header of 12 bytes, then two chunks, each with its length and type.
    fn file(mut self) -> Result<Vec<u8>, GlbError> {
        self.json.asset = JsonObject(GltfAsset::of_this_program());
        self.json.buffers.push(GltfBuffer { length: whole(self.bytes.len()), uri: None });
        let mut json = serde_json::to_vec(&self.json)?;
        let mut binary = self.bytes;
        json.resize(json.len().next_multiple_of(4), b' ');
        binary.resize(binary.len().next_multiple_of(4), 0);
        let number = |number: usize| whole(number).0.to_le_bytes();
        Ok([
            b"glTF",
            &number(2)[..],
            &number(12 + 8 + json.len() + 8 + binary.len()),
            &number(json.len()),
            b"JSON",
            &json,
            &number(binary.len()),
            b"BIN\0",
            &binary,
        ]
        .concat())
    }

    /// Adds the nodes of the joints, with the same indices as in `bones`, then a node above them
    /// and a node for each mesh with its skin, which are returned. `frames` has nodes with the
    /// frames of their joints' angles.
    fn add_nodes(
        &mut self,
        bones: &JointNodes,
        frames: impl Iterator<Item = (usize, DQuat)>,
        skinned: &[(Whole, Whole)],
    ) -> Vec<Whole> {
        let armature = bones.nodes.len();
        let mut children = vec![Vec::new(); armature + 1];
        for (index, node) in bones.nodes.iter().enumerate() {
            children[node.parent.unwrap_or(armature)].push(whole(index));
        }
        let names = bones.nodes.iter().map(|node| node.name.as_str());
        for (name, children) in names.chain([JointNodes::ARMATURE]).zip(children) {
            self.json.nodes.push(GltfNode {
                name: Some(name.to_owned()),
                children: (!children.is_empty()).then_some(children),
                ..GltfNode::default()
            });
        }
        for (node, bind_pose) in self.json.nodes.0.iter_mut().zip(&bones.bind_pose) {
            node.translation = Some(JsonPoint(bind_pose.translation.as_vec3()));
            node.rotation = Some(JsonNumbers(bind_pose.rotation.as_quat().to_array()));
        }
        for (node, frame) in frames {
            self.json.nodes.0[node].extras = Some(Extras::Own(NodeExtras::of_joint(frame)));
        }
        for (node, fields) in bones.nodes.iter().zip(&mut self.json.nodes.0) {
            if matches!(node.role, NodeRole::Stretch(_) | NodeRole::StretchAxes) {
                fields.extras = Some(Extras::Own(NodeExtras::STRETCHES_SKIN));
            }
        }
        let mut scene = vec![whole(armature)];
        for (mesh, skin) in skinned {
            scene.push(self.json.nodes.push(GltfNode {
                name: Some(JointNodes::MESH.to_owned()),
                mesh: Some(*mesh),
                skin: Some(*skin),
                ..GltfNode::default()
            }));
        }
        let meshes = scene[1..].to_vec();
        self.json.scenes = [GltfScene { nodes: scene }];
        meshes
    }

    fn add_skin(&mut self, bones: &JointNodes, attached: &[DAffine3]) -> Whole {
        let mut worlds: Vec<DAffine3> = Vec::with_capacity(bones.nodes.len());
        for (node, bind_pose) in bones.nodes.iter().zip(&bones.bind_pose) {
            let (rotation, translation) = (bind_pose.rotation, bind_pose.translation);
            let local = DAffine3::from_rotation_translation(rotation, translation);
            worlds.push(node.parent.map_or(local, |parent| worlds[parent] * local));
        }
        let attached = attached.iter().copied().chain(iter::repeat(DAffine3::IDENTITY));
        let bind = |(world, attached): (&DAffine3, DAffine3)| {
            DMat4::from(world.inverse() * attached).as_mat4().to_cols_array()
        };
        let joints = bones.of_skin();
        let worlds = joints.iter().map(|node| &worlds[*node]);
        let matrices: Vec<[f32; 16]> = worlds.zip(attached).map(bind).collect();
        let inverse_binds = Some(self.add_floats(&matrices, None));
        self.json.skins.push(GltfSkin {
            inverse_binds,
            joints: joints.into_iter().map(whole).collect(),
            name: Some(JointNodes::ARMATURE.to_owned()),
            skeleton: Some(whole(bones.nodes.len())),
        })
    }

    fn add_mesh(&mut self, parts: &[&MeshPart], morphs: &[(String, f32)]) -> Whole {
        let parts = parts.iter().filter(|part| !part.indices.is_empty());
        let primitives = List(parts.map(|part| self.add_primitive(part)).collect());
        let has_morphs = !morphs.is_empty();
        let weights = || morphs.iter().map(|(_, weight)| JsonNumber(*weight)).collect();
        let names = || morphs.iter().map(|(name, _)| name.clone()).collect();
        self.json.meshes.push(GltfMesh {
            extras: has_morphs.then(|| Extras::Own(MeshExtras { target_names: names() })),
            name: JointNodes::MESH.to_owned(),
            primitives,
            weights: has_morphs.then(weights),
        })
    }

    fn add_primitive(&mut self, part: &MeshPart) -> GltfPrimitive {
        let vertices = part.positions.len();
        let joints = part.joints.iter().flatten().flat_map(|joint| joint.to_le_bytes());
        let mut attributes = BTreeMap::from([
            ("POSITION".to_owned(), self.add_bounded(&part.positions, ARRAY)),
            ("NORMAL".to_owned(), self.add_floats(&part.normals, ARRAY)),
            ("JOINTS_0".to_owned(), self.add(joints, ARRAY, vertices, Component::U16, "VEC4")),
            ("WEIGHTS_0".to_owned(), self.add_floats(&part.weights, ARRAY)),
        ]);
        if !part.coordinates.is_empty() {
            let coordinates = self.add_floats(&part.coordinates, ARRAY);
            attributes.insert("TEXCOORD_0".to_owned(), coordinates);
        }
        let emission_set = u32::from(!part.emission_coordinates.is_empty());
        if emission_set == 1 {
            let coordinates = self.add_floats(&part.emission_coordinates, ARRAY);
            attributes.insert("TEXCOORD_1".to_owned(), coordinates);
        }
        if !part.colours.is_empty() {
            attributes.insert("COLOR_0".to_owned(), self.add_floats(&part.colours, ARRAY));
        }
        let textures = [&part.texture, &part.emission_texture]
            .map(|texture| texture.as_ref().map(|texture| self.add_texture(texture)));
        let indices = part.indices.iter().flat_map(|index| index.to_le_bytes());
        let count = part.indices.len();
        let indices = self.add(indices, ELEMENT_ARRAY, count, Component::U32, "SCALAR");
        let material = self.json.materials.push(GltfMaterial::matte(
            part.colour,
            textures,
            emission_set,
            &part.look,
        ));
        GltfPrimitive {
            attributes,
            indices: Some(indices),
            material: Some(material),
            targets: part.morphs.iter().map(|morph| self.add_morph(morph, vertices)).collect(),
            ..GltfPrimitive::default()
        }
    }

    /// The attributes of a morph target of a primitive with so many vertices.
    fn add_morph(&mut self, morph: &PartMorph, vertices: usize) -> BTreeMap<String, Whole> {
        let indices = (!morph.vertices.is_empty()).then(|| {
            let start = self.bytes.len();
            self.bytes.extend(morph.vertices.iter().flat_map(|vertex| vertex.to_le_bytes()));
            self.add_view(start, None)
        });
        let mut add = |name: &str, rows: &[[f32; 3]]| {
            (name.to_owned(), self.add_sparse(rows, indices, vertices))
        };
        BTreeMap::from([add("POSITION", &morph.offsets), add("NORMAL", &morph.normals)])
    }

    /// Adds an accessor of zeros in which `rows` replace those with the indices of a view.
    fn add_sparse(&mut self, rows: &[[f32; 3]], indices: Option<Whole>, count: usize) -> Whole {
        let bound = |of: fn(f32, f32) -> f32| {
            // Beside the rows there are zeros, unless all are replaced.
            let first = rows.first().filter(|_| rows.len() == count).copied().unwrap_or_default();
            let bounds = rows.iter().fold(first, |bounds, row| {
                std::array::from_fn(|number| of(bounds[number], row[number]))
            });
            bounds.map(f64::from).to_vec()
        };
        let (min, max) = (bound(f32::min), bound(f32::max));
        let sparse = indices.map(|indices| {
            let start = self.bytes.len();
            self.bytes.extend(bytes(rows));
            let values = GltfSparseValues { view: self.add_view(start, None), offset: None };
            let component = Whole(Component::U32 as u32);
            let indices = GltfSparseIndices { view: indices, offset: None, component };
            let (indices, values) = (JsonObject(indices), JsonObject(values));
            JsonObject(GltfSparse { count: whole(rows.len()), indices, values })
        });
        self.json.accessors.push(GltfAccessor {
            view: None,
            offset: None,
            count: whole(count),
            component: Whole(Component::F32 as u32),
            shape: shape::<3>().into(),
            min,
            max,
            normalized: None,
            sparse,
        })
    }

    /// Index of a texture, which is written if it is new.
    fn add_texture(&mut self, texture: &Shared<SkinTexture>) -> Whole {
        if let Some((_, known)) = self.textures.iter().find(|(known, _)| known.is_same(texture)) {
            return *known;
        }
        let start = self.bytes.len();
        self.bytes.extend(&texture.file);
        let view = Some(self.add_view(start, None));
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        let is_png = texture.file.starts_with(b"\x89PNG");
        let mime = if is_png { "image/png" } else { "image/jpeg" };
        let source = self.json.images.push(GltfImage { view, mime, uri: None });
        let index = self.json.textures.push(GltfTexture { source: Some(source) });
        self.textures.push((texture.clone(), index));
        index
    }

    /// Adds the animation, unless it is empty.
    fn add_animation(
        &mut self,
        motion: &JointAnimation,
        weights: &MorphAnimation,
        meshes: &[Whole],
        name: Option<&str>,
    ) {
        let has_weights = !weights.times.is_empty();
        let points = [("translation", &motion.translations), ("scale", &motion.scales)];
        let is_still =
            motion.rotations.is_empty() && points.iter().all(|(_, tracks)| tracks.is_empty());
        if is_still && !has_weights {
            return;
        }
        // Tracks with the same times share an accessor.
        let mut accessors: HashMap<Vec<u32>, Whole> = HashMap::new();
        let clip = ClipTimes::new(motion.timeline);
        let mut add_times = |times: &[f64]| {
            let times: Vec<[f32; 1]> = times.iter().map(|time| [clip.of(*time) as f32]).collect();
            let bits = times.as_flattened().iter().map(|time| time.to_bits()).collect();
            *accessors.entry(bits).or_insert_with(|| self.add_bounded(&times, None))
        };
        let of_rotations: Vec<Whole> =
            motion.rotations.iter().map(|track| add_times(&track.times)).collect();
        let of_points = points.map(|(path, tracks)| {
            let times: Vec<Whole> = tracks.iter().map(|track| add_times(&track.times)).collect();
            (path, tracks, times)
        });
        let of_weights = has_weights.then(|| add_times(&weights.times));
        let mut animation = GltfAnimation {
            extras: Some(Extras::Own(AnimationExtras::new(motion.timeline))),
            channels: List::default(),
            name: name.map(str::to_owned),
            samplers: List::default(),
        };
        let start = self.bytes.len();
        for (track, times) in motion.rotations.iter().zip(of_rotations) {
            self.add_track(&mut animation, track, "rotation", times, start);
        }
        for (path, tracks, times) in of_points {
            for (track, times) in tracks.iter().zip(times) {
                self.add_track(&mut animation, track, path, times, start);
            }
        }
        if self.bytes.len() > start {
            self.add_view(start, None);
        }
        if let Some(input) = of_weights {
            let values: Vec<[f32; 1]> = weights.values.iter().map(|weight| [*weight]).collect();
            let output = self.add_floats(&values, None);
            let sampler = animation.samplers.push(GltfSampler {
                extras: None,
                input,
                interpolation: Some(weights.curve.name().to_owned()),
                output,
            });
            for mesh in meshes {
                let target = GltfTarget { node: Some(*mesh), path: "weights".to_owned() };
                animation.channels.push(GltfChannel { sampler, target: JsonObject(target) });
            }
        }
        self.json.animations.push(animation);
    }

    /// Appends the values of a track to those of the tracks before it. The caller adds their view,
    /// which begins at the byte `start` of the buffer, after the last track.
    fn add_track<const N: usize>(
        &mut self,
        animation: &mut GltfAnimation,
        track: &JointTrack<N>,
        path: &str,
        input: Whole,
        start: usize,
    ) {
        let offset = self.bytes.len() - start;
        self.bytes.extend(bytes(&track.values));
        let view = whole(self.json.views.0.len());
        let count = track.values.len();
        let output = self.add_accessor(view, offset, count, Component::F32, shape::<N>());
        let has_keys = !track.keys.is_empty();
        let sampler = animation.samplers.push(GltfSampler {
            extras: has_keys.then(|| Extras::Own(SamplerExtras::new(&track.keys))),
            input,
            interpolation: Some(track.curve.name().to_owned()),
            output,
        });
        let target = GltfTarget { node: Some(whole(track.node)), path: path.to_owned() };
        animation.channels.push(GltfChannel { sampler, target: JsonObject(target) });
    }

    /// Adds a view of the bytes from `start` to the end of the buffer.
    fn add_view(&mut self, start: usize, target: Option<Whole>) -> Whole {
        self.json.views.push(GltfBufferView {
            buffer: Whole(0),
            length: whole(self.bytes.len() - start),
            offset: Some(whole(start)),
            stride: None,
            target,
        })
    }

    /// Adds an accessor of `count` values, the first of which is at byte `offset` of a view.
    fn add_accessor(
        &mut self,
        view: Whole,
        offset: usize,
        count: usize,
        component: Component,
        shape: &'static str,
    ) -> Whole {
        self.json.accessors.push(GltfAccessor {
            view: Some(view),
            offset: Some(whole(offset)),
            count: whole(count),
            component: Whole(component as u32),
            shape: shape.into(),
            min: Vec::new(),
            max: Vec::new(),
            normalized: None,
            sparse: None,
        })
    }

    /// Appends `bytes` to the buffer, and adds a view and an accessor for them. The number of bytes
    /// must be a multiple of 4.
    fn add(
        &mut self,
        bytes: impl Iterator<Item = u8>,
        target: Option<Whole>,
        count: usize,
        component: Component,
        shape: &'static str,
    ) -> Whole {
        let start = self.bytes.len();
        self.bytes.extend(bytes);
        let view = self.add_view(start, target);
        self.add_accessor(view, 0, count, component, shape)
    }

    fn add_floats<const N: usize>(&mut self, rows: &[[f32; N]], target: Option<Whole>) -> Whole {
        self.add(bytes(rows), target, rows.len(), Component::F32, shape::<N>())
    }

    /// Adds rows of floats, with their minimum and maximum in the accessor.
    fn add_bounded<const N: usize>(&mut self, rows: &[[f32; N]], target: Option<Whole>) -> Whole {
        let accessor = self.add_floats(rows, target);
        let bound = |of: fn(f32, f32) -> f32, from: f32| {
            let bounds = rows.iter().fold([from; N], |bounds, row| {
                std::array::from_fn(|number| of(bounds[number], row[number]))
            });
            bounds.map(f64::from).to_vec()
        };
        if let Some(accessor) = self.json.accessors.0.last_mut() {
            accessor.min = bound(f32::min, f32::INFINITY);
            accessor.max = bound(f32::max, f32::NEG_INFINITY);
        }
        accessor
    }
}

/// Little-endian bytes of floats.
fn bytes<const N: usize>(rows: &[[f32; N]]) -> impl Iterator<Item = u8> + '_ {
    rows.iter().flatten().flat_map(|number| number.to_le_bytes())
}

/// Type of an accessor whose rows have `N` numbers.
const fn shape<const N: usize>() -> &'static str {
    match N {
        1 => "SCALAR",
        2 => "VEC2",
        3 => "VEC3",
        4 => "VEC4",
        _ => "MAT4",
    }
}
