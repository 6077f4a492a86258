//! The mesh of an exported rig: parts of one material each, and the parts of a skin.

use core::f64::consts::{PI, TAU};
use glam::{Affine3A, DAffine3, DMat3, DVec3, Vec2};

use super::GlbError;
use super::nodes::JointNodes;
use super::rig::{GltfRig, joint_spaces};
use crate::document::{Document, Skin};
use crate::io::formats::gltf::material::linear;
use crate::kinematics::Shared;
use crate::kinematics::skeleton::Skeleton;
use crate::kinematics::skin::{BindSet, Morph, SkinnedMesh, TriangleMesh, VertexWeights};
use crate::rig::{AttachedMesh, PartLook, SkinTexture};

/// The mesh of an exported rig.
pub struct RigMesh {
    /// One part for each material, or for each set of the mesh's inverse bind transforms.
    pub parts: Vec<MeshPart>,
    /// For each set, for each joint the transform from the mesh to the world in the bind pose, in
    /// metres; identity for joints beyond the list. At least one set.
    pub attached: Vec<Vec<DAffine3>>,
    /// Names of the morph targets, each with its weight in the document.
    pub morphs: Vec<(String, f32)>,
}

/// Triangles of one material.
#[derive(Default)]
pub struct MeshPart {
    /// Colour as sRGB channels from 0 to 1.
    pub colour: [f32; 3],
    /// Index in [`RigMesh::attached`].
    pub set: usize,
    pub look: PartLook,
    /// Image that multiplies the colour.
    pub texture: Option<Shared<SkinTexture>>,
    /// Image that multiplies the emission.
    pub emission_texture: Option<Shared<SkinTexture>>,
    /// Texture coordinates; empty without a texture.
    pub coordinates: Vec<[f32; 2]>,
    /// Those of the emission, if they are others.
    pub emission_coordinates: Vec<[f32; 2]>,
    /// Colours of the vertices as linear light with opacity; empty for white ones.
    pub colours: Vec<[f32; 4]>,
    pub positions: Vec<[f32; 3]>,
    pub normals: Vec<[f32; 3]>,
    /// The four joints that each vertex follows.
    pub joints: Vec<[u16; 4]>,
    /// Their weights, with the sum 1.
    pub weights: Vec<[f32; 4]>,
    /// Indices of three vertices for each triangle, counter-clockwise seen from outside.
    pub indices: Vec<u32>,
    /// The changes by each of the morph targets.
    pub morphs: Vec<PartMorph>,
}

/// The changes that a morph target makes to the vertices of a part.
#[derive(Default)]
pub struct PartMorph {
    /// The vertices that it changes, ascending.
    pub vertices: Vec<u32>,
    pub offsets: Vec<[f32; 3]>,
    pub normals: Vec<[f32; 3]>,
}

impl RigMesh {
    /// The skin of the skeleton; `None` without one that has triangles.
    ///
    /// The mesh keeps its own space. Inverse bind matrices bring it to the joints, so that a viewer
    /// gets the vertices that linear blending gives in the program.
    pub fn of_skin(document: &Document) -> Option<Self> {
        let skin = document.rig.skin.as_ref()?;
        let mesh = match skin.mesh_skin() {
            Some(mesh) => mesh.unmorphed().ok(),
            None => skin.mesh().ok(),
        };
        let mesh = mesh.filter(|mesh| !mesh.mesh.mesh().triangles.is_empty())?;
        let weight = |morph| document.rig.morph_weight(morph).unwrap_or_default();
        let morphs = mesh.mesh.morphs().iter().enumerate();
        let metres = f64::from(document.metres_per_unit());
        Some(Self {
            parts: parts(skin, mesh, document.skeleton()),
            attached: attached(&mesh.mesh, document.skeleton(), metres),
            morphs: morphs.map(|(morph, it)| (it.name.clone(), weight(morph))).collect(),
        })
    }
}

/// The parts of a skin, each with its own vertices in the order of the mesh.
fn parts(skin: &Skin, mesh: &AttachedMesh, skeleton: &Skeleton) -> Vec<MeshPart> {
    let is_mirrored = skeleton.transform().matrix3.determinant() < 0.0;
    let sets: Vec<usize> = mesh.mesh.sets_of_vertices().collect();
    let mut rest = &mesh.mesh.mesh().triangles[..];
    let mut parts = Vec::with_capacity(mesh.parts.len());
    for part in &mesh.parts {
        let (triangles, others) = rest.split_at(part.triangles.min(rest.len()));
        rest = others;
        let colour = std::array::from_fn(|channel| skin.colour[channel] * part.colour[channel]);
        let set_of = |corners: &[u32; 3]| sets[corners[0] as usize];
        let textured = [part.texture.is_some(), part.emission_texture.is_some()];
        for of_set in triangles.chunk_by(|one, other| set_of(one) == set_of(other)) {
            let corners = of_set
                .iter()
                .flat_map(|[a, b, c]| if is_mirrored { [*a, *c, *b] } else { [*a, *b, *c] });
            parts.push(MeshPart {
                colour,
                set: set_of(&of_set[0]),
                look: part.look,
                texture: part.texture.clone(),
                emission_texture: part.emission_texture.clone(),
                ..of_corners(&mesh.mesh, &corners.collect::<Vec<_>>(), textured)
            });
        }
    }
    parts
}

/// The triangles with these corners, and the vertices that they have, with images of colour and of
/// emission or without.
fn of_corners(mesh: &SkinnedMesh, corners: &[u32], [colour, emission]: [bool; 2]) -> MeshPart {
    let TriangleMesh { positions, normals, colours, .. } = mesh.mesh();
    let mut places: Vec<Option<u32>> = vec![None; positions.len()];
    corners.iter().for_each(|corner| places[*corner as usize] = Some(0));
    let vertices: Vec<usize> = (0..places.len()).filter(|at| places[*at].is_some()).collect();
    for (place, vertex) in vertices.iter().enumerate() {
        places[*vertex] = Some(place as u32);
    }
    let weights = || vertices.iter().map(|vertex| &mesh.weights()[*vertex]);
    let coordinates = |all: &[Vec2], is_used: bool| -> Vec<[f32; 2]> {
        let used = vertices.iter().filter(|_| is_used);
        used.filter_map(|vertex| all.get(*vertex)).map(Vec2::to_array).collect()
    };
    let colours = vertices.iter().filter_map(|vertex| colours.get(*vertex));
    let in_light = |[red, green, blue, opacity]: &[u8; 4]| {
        let [red, green, blue, opacity] =
            [*red, *green, *blue, *opacity].map(|byte| f32::from(byte) / 255.0);
        [linear(red), linear(green), linear(blue), opacity]
    };
    let colours: Vec<[f32; 4]> = colours.map(in_light).collect();
    let of_part = |morph: &Morph| {
        let mut part = PartMorph::default();
        let changes = morph.offsets.iter().zip(&morph.normals);
        for (vertex, (offset, normal)) in morph.vertices.iter().zip(changes) {
            if let Some(place) = places[*vertex as usize] {
                part.vertices.push(place);
                part.offsets.push(offset.to_array());
                part.normals.push(normal.to_array());
            }
        }
        part
    };
    let is_coloured = colours.iter().any(|colour| *colour != [1.0; 4]);
    MeshPart {
        colours: if is_coloured { colours } else { Vec::new() },
        positions: vertices.iter().map(|vertex| positions[*vertex].to_array()).collect(),
        normals: vertices.iter().map(|vertex| normals[*vertex].to_array()).collect(),
        joints: weights().map(VertexWeights::joints).collect(),
        weights: weights().map(VertexWeights::weights).collect(),
        coordinates: coordinates(&mesh.mesh().texture_coordinates, colour || emission),
        emission_coordinates: coordinates(&mesh.mesh().emission_coordinates, emission),
        indices: corners.iter().filter_map(|corner| places[*corner as usize]).collect(),
        morphs: mesh.morphs().iter().map(of_part).collect(),
        ..MeshPart::default()
    }
}

/// For each set, for each joint the transform from mesh space to the world that its inverse bind
/// transform gives in the bind pose of the skeleton, in metres.
fn attached(mesh: &SkinnedMesh, skeleton: &Skeleton, metres: f64) -> Vec<Vec<DAffine3>> {
    let to_metres = DAffine3::from_scale(DVec3::splat(metres));
    let spaces = joint_spaces(skeleton, |_| DMat3::IDENTITY);
    let of_set = |set: &BindSet| {
        let binds = set.inverse_binds.iter().map(Affine3A::as_daffine3);
        spaces.iter().zip(binds).map(|(space, bind)| to_metres * *space * bind).collect()
    };
    mesh.bind_sets().iter().map(of_set).collect()
}

/// The mesh in the bind pose: a cone for each bone, with balls at its ends. Each colour has its own
/// part.
#[derive(Default)]
pub struct LimbMesh {
    pub parts: [MeshPart; 2],
}

/// Ratio of the radius of a ball to the radius of the bone's end that it covers.
const BALL: f64 = 1.1;

/// Colours of the limbs in the dark theme, as sRGB components.
const COLOURS: [[u8; 3]; 2] = [[0xd8, 0x74, 0x4b], [0x64, 0x92, 0xc6]];

impl From<LimbMesh> for RigMesh {
    fn from(limbs: LimbMesh) -> Self {
        let coloured = limbs.parts.into_iter().zip(COLOURS);
        let parts = coloured.map(|(part, colour)| {
            let colour = colour.map(|component| f32::from(component) / 255.0);
            MeshPart { colour, ..part }
        });
        let parts = parts.collect();
        Self { parts, attached: vec![Vec::new()], morphs: Vec::new() }
    }
}

impl LimbMesh {
    pub fn new(rig: &GltfRig, bones: &JointNodes) -> Result<Self, GlbError> {
        let mut limbs = Self::default();
        let tips = bones.tips();
        for (index, (bone, placed)) in rig.bones.iter().zip(&rig.bind_pose).enumerate() {
            let part = &mut limbs.parts[bone.shade];
            let rotation = placed.frame();
            let length = placed.along.length();
            let tip = tips[index].or(bone.connected).unwrap_or(index);
            let [thick, thin] = bone.radii;
            part.add_ball(placed.base, rotation, thick * BALL, index);
            if length > 0.0 {
                part.add_cone(placed.base, rotation, length, bone.radii, [index, tip]);
                if bone.is_leaf {
                    part.add_ball(placed.base + placed.along, rotation, thin * BALL, tip);
                }
            }
            if !part.is_finite() {
                let joint = bones.nodes[index].name.clone();
                return Err(GlbError::TooFar { joint, time: None });
            }
        }
        Ok(limbs)
    }
}

impl MeshPart {
    /// Adds a tapered cylinder, open at both ends, from `base` along the y axis of `rotation`.
    fn add_cone(
        &mut self,
        base: DVec3,
        rotation: DMat3,
        length: f64,
        radii: [f64; 2],
        joints: [usize; 2],
    ) {
        const SIDES: u32 = 12;
        let first = self.first();
        let slope = (radii[0] - radii[1]) / length;
        for side in 0..SIDES {
            let (sin, cos) = (f64::from(side) / f64::from(SIDES) * TAU).sin_cos();
            let out = DVec3::new(cos, 0.0, sin);
            let normal = rotation * (out + DVec3::Y * slope).normalize();
            for (end, height) in [0.0, length].into_iter().enumerate() {
                let at = base + rotation * (out * radii[end] + DVec3::Y * height);
                self.add_vertex(at, normal, joints[end]);
            }
            let [low, next] = [2 * side, 2 * ((side + 1) % SIDES)].map(|vertex| first + vertex);
            self.indices.extend([low, low + 1, next, next, low + 1, next + 1]);
        }
    }

    /// Adds a ball whose poles are on the y axis of `rotation`.
    fn add_ball(&mut self, centre: DVec3, rotation: DMat3, radius: f64, joint: usize) {
        const SIDES: u32 = 8;
        const RINGS: u32 = 3;
        let first = self.first();
        let mut add = |height: f64, out: f64, angle: f64| {
            let normal = rotation * DVec3::new(out * angle.cos(), height, out * angle.sin());
            self.add_vertex(centre + normal * radius, normal, joint);
        };
        add(1.0, 0.0, 0.0);
        add(-1.0, 0.0, 0.0);
        for ring in 1..=RINGS {
            let (out, height) = (f64::from(ring) / f64::from(RINGS + 1) * PI).sin_cos();
            for side in 0..SIDES {
                add(height, out, f64::from(side) / f64::from(SIDES) * TAU);
            }
        }
        let at = |ring: u32, side: u32| first + 2 + ring * SIDES + side % SIDES;
        for side in 0..SIDES {
            self.indices.extend([first, at(0, side + 1), at(0, side)]);
            self.indices.extend([first + 1, at(RINGS - 1, side), at(RINGS - 1, side + 1)]);
            for ring in 1..RINGS {
                let [above, next] = [at(ring - 1, side), at(ring - 1, side + 1)];
                let [below, last] = [at(ring, side), at(ring, side + 1)];
                self.indices.extend([below, above, last, last, above, next]);
            }
        }
    }

    fn add_vertex(&mut self, at: DVec3, normal: DVec3, joint: usize) {
        self.positions.push(at.as_vec3().to_array());
        self.normals.push(normal.as_vec3().to_array());
        self.joints.push([u16::try_from(joint).unwrap_or_default(), 0, 0, 0]);
        self.weights.push([1.0, 0.0, 0.0, 0.0]);
    }

    /// Index of the vertex that is added next.
    fn first(&self) -> u32 {
        u32::try_from(self.positions.len()).unwrap_or_default()
    }

    /// Returns whether the vertices of the most recently added bone are finite.
    fn is_finite(&self) -> bool {
        const MAX_VERTICES_OF_BONE: usize = 76;
        let last = self.positions.iter().rev().take(MAX_VERTICES_OF_BONE);
        last.flatten().all(|number| number.is_finite())
    }
}
