//! The mesh of a figure: all surfaces that follow joints of its skins.
//!
//! As the file's nodes stand, the node of joint i has the transform N_i in the world, and its
//! inverse bind matrix IBM_i maps the mesh to the node's own space; so the joint places the mesh by
//! A_i = N_i·IBM_i. The skeleton that is read has its joint i at the same place, but not turned:
//! X_i is the translation to N_i's origin. The inverse bind transform of the skeleton's joint is
//! therefore B_i⁻¹ = X_i⁻¹·A_i. Skins that have the same A_i for the joints that they share are one
//! set. A mesh on a node without a skin follows the nearest joint j above
//! it rigidly: with the node's transform N, its vertices become A_j⁻¹·N·v.

use std::collections::{BTreeMap, BTreeSet, HashMap};

use glam::{Affine2, DAffine3, DMat3, DVec3, Vec3};

use super::bind_tables::{BindTable, BindTables};
use super::buffers::{GltfBuffers, is_file};
use super::figures::Figure;
use super::joint_tracks::JointPlacement;
use super::morphs::MorphOwner;
use super::nodes::{NodeTree, SkinJoints, at_node, at_skin};
use super::primitive::{
    ImageCache, MaterialSource, PartMaterial, PrimitiveMesh, PrimitiveMorph, image_views,
};
use super::rows::{buffer_of_view, buffers_of};
use crate::io::formats::gltf::UniqueNames;
use crate::io::formats::gltf::extras::Extras;
use crate::io::formats::gltf::file::{DRACO, GltfFile, GltfMesh, GltfPrimitive, index_rule};
use crate::io::formats::gltf::material::{GltfMaterial, Uri};
use crate::io::json::{FieldError, FieldWarnings, JsonNumber, JsonPath, Whole};
use crate::io::source::Source;
use crate::kinematics::skeleton::JointId;
use crate::kinematics::skin::{BindSet, Morph, SkinnedMesh, TriangleMesh, VertexWeights};
use crate::rig::{FileMesh, PartLook, SkinPart};

/// Maximum number of primitives of all meshes of a skin.
const MOST_PARTS: usize = 10_000;

/// A figure of a file, with the joints that it becomes.
pub struct MeshImport<'a> {
    pub source: &'a Source,
    pub file: &'a GltfFile<'a>,
    pub nodes: &'a NodeTree,
    pub figure: &'a Figure,
    pub joints: &'a SkinJoints,
    pub bind_pose: &'a [JointPlacement],
}

/// A mesh of the file that follows joints of the skin.
struct UsedMesh<'a> {
    node: usize,
    index: usize,
    mesh: &'a GltfMesh,
    follows: Follows,
}

/// What the vertices of a mesh follow.
#[derive(Clone, Copy)]
enum Follows {
    /// A joint.
    Joint(usize),
    /// The joints of a skin by weights of their own; which of the figure's skins.
    Skin(usize),
}

impl UsedMesh<'_> {
    /// The primitives with triangles, each with its path.
    fn surfaces(&self) -> impl Iterator<Item = (JsonPath, &GltfPrimitive)> {
        let at = at_mesh(self.index).key("primitives");
        let primitives = self.mesh.primitives.0.iter().enumerate();
        let surfaces = primitives.filter(|(_, primitive)| primitive.is_surface());
        surfaces.map(move |(index, primitive)| (at.clone().index(index), primitive))
    }
}

fn at_mesh(mesh: usize) -> JsonPath {
    JsonPath::root().key("meshes").index(mesh)
}

impl MeshImport<'_> {
    /// Reads the mesh; `None` if the skin has none. Warns of what is not read.
    pub fn read(&self, warnings: &mut FieldWarnings) -> Result<Option<FigureMesh>, FieldError> {
        let Self { source, file, nodes, joints, .. } = *self;
        if let Some(reason) = file.compression() {
            return Err(FieldError::new(JsonPath::root().key("extensionsRequired"), reason));
        }
        let mut meshes = self.meshes()?;
        if meshes.iter().all(|mesh| mesh.surfaces().next().is_none()) {
            return Ok(None);
        }
        self.check_size(&meshes)?;
        let needed = self.buffers(&meshes)?;
        let buffers = GltfBuffers::read(source, file, &needed)?;
        let mut checksum = source.checksum();
        for buffer in needed {
            let uri = file.buffers.0.get(buffer).and_then(|buffer| buffer.uri.as_ref());
            if uri.is_some_and(|Uri(uri)| is_file(uri)) {
                checksum.update(buffers.get(buffer).unwrap_or_default());
            }
        }
        let worlds = nodes.worlds();
        let BindTables { tables, of_skins } =
            BindTables::new(file, &buffers, self.figure, joints, &worlds)?;
        let attached = &tables[0].attached;
        let table_of = |mesh: &UsedMesh<'_>| match mesh.follows {
            Follows::Joint(_) => 0,
            Follows::Skin(skin) => of_skins[skin],
        };
        meshes.sort_by_key(table_of);
        let mut builder = MeshBuilder::default();
        let mut vertices = vec![0; tables.len()];
        let mut materials = BTreeMap::new();
        let mut images = ImageCache::default();
        let mut names = UniqueNames::default();
        for mesh in &meshes {
            builder.begin(self.file, mesh, &mut names);
            let (rigid, of_skin) = match mesh.follows {
                Follows::Joint(joint) => {
                    (Some((joint, attached[joint].inverse() * worlds[mesh.node])), &[][..])
                }
                Follows::Skin(skin) => (None, &joints.of_skins[skin][..]),
            };
            if rigid.is_some_and(|(_, to_mesh)| !to_mesh.is_finite()) {
                let reason = "its mesh is not read, because its joint has no volume";
                warnings.push(at_node(mesh.node), reason);
                continue;
            }
            for (at, primitive) in mesh.surfaces() {
                let material = self.material(primitive, &at)?;
                let set = material.map_or((0, None), |(_, material)| material.sets());
                let count = of_skin.len();
                let read = PrimitiveMesh::new(file, &buffers, primitive, set, count, &at)?;
                let look = material.map(|(index, material)| {
                    let new = || {
                        images.material(
                            &MaterialSource { source, file, buffers: &buffers },
                            material,
                            &mut checksum,
                            warnings,
                        )
                    };
                    materials.entry(index).or_insert_with(new).clone()
                });
                // The corners of a mesh on a mirrored node are in reverse order.
                let mirrors = rigid.map_or(worlds[mesh.node], |(_, to_mesh)| to_mesh);
                let is_mirrored = mirrors.matrix3.determinant() < 0.0;
                let look = look.unwrap_or(PartMaterial::white(PartLook::default()));
                if look.is_hidden() {
                    continue;
                }
                vertices[table_of(mesh)] += read.positions.len();
                builder.add(read, rigid, is_mirrored, look, of_skin);
            }
        }
        self.warn_of_unread(&meshes, &builder, warnings);
        let MeshBuilder { mesh, weights, parts, morphs, owners, morph_weights, .. } = builder;
        let bind = |(attached, joint): (&DAffine3, &JointPlacement)| {
            (DAffine3::from_translation(-joint.base) * *attached).as_affine3a()
        };
        let set = |(table, vertices): (&BindTable, usize)| BindSet {
            vertices,
            inverse_binds: table.attached.iter().zip(self.bind_pose).map(bind).collect(),
        };
        let sets = tables.iter().zip(vertices).map(set).collect();
        let mesh = SkinnedMesh::with_bind_sets(mesh, weights, sets)
            .and_then(|mesh| mesh.with_morphs(morphs))
            .map_err(|error| FieldError::new(at_skin(self.figure.first()), error.to_string()))?;
        let parents = joints.parents.iter().map(|parent| parent.map(JointId::new)).collect();
        let mesh = FileMesh { mesh, parents, parts };
        Ok(Some(FigureMesh { mesh, checksum: checksum.finalize(), owners, morph_weights }))
    }

    /// Checks the numbers of vertices, corners and primitives before anything of them is read.
    fn check_size(&self, meshes: &[UsedMesh<'_>]) -> Result<(), FieldError> {
        const MOST_CORNERS: usize = 3 * SkinnedMesh::MOST_TRIANGLES;
        let count = |accessor: Option<&Whole>| {
            let accessor = accessor.and_then(|it| self.file.accessors.0.get(it.0 as usize));
            accessor.map_or(0, |accessor| accessor.count.0 as usize)
        };
        /// Maximum number of changes of morph targets, those of 0 included.
        const MOST_CHANGES: usize = 30_000_000;
        let (mut parts, mut vertices, mut corners, mut changes) = (0, 0_usize, 0_usize, 0_usize);
        for (at, primitive) in meshes.iter().flat_map(UsedMesh::surfaces) {
            parts += 1;
            vertices = vertices.saturating_add(count(primitive.attributes.get("POSITION")));
            corners = corners.saturating_add(count(primitive.indices.as_ref()));
            let moved = primitive.targets.iter().flat_map(BTreeMap::values);
            changes = moved.fold(changes, |sum, it| sum.saturating_add(count(Some(it))));
            for (what, most, got) in [
                ("primitives", MOST_PARTS, parts),
                ("vertices", SkinnedMesh::MOST_VERTICES, vertices),
                ("corners of triangles", MOST_CORNERS, corners),
                ("changes of morph targets", MOST_CHANGES, changes),
            ] {
                if got > most {
                    let reason =
                        format!("a skin must have at most {most} {what}, got {got} or more");
                    return Err(FieldError::new(at, reason));
                }
            }
        }
        Ok(())
    }

    /// The meshes of the nodes with the figure's skins, and those of nodes below its joints.
    fn meshes(&self) -> Result<Vec<UsedMesh<'_>>, FieldError> {
        let file = self.file;
        let nearest = self.nearest_joints();
        let skins = self.figure.skins.iter().enumerate();
        let places: HashMap<usize, usize> = skins.map(|(place, skin)| (*skin, place)).collect();
        let mut meshes: Vec<UsedMesh<'_>> = Vec::new();
        let mut with_skin = BTreeSet::new();
        for (node, fields) in file.nodes.0.iter().enumerate() {
            let Some(index) = fields.mesh.map(|mesh| mesh.0 as usize) else { continue };
            let mesh = file.meshes.0.get(index).ok_or_else(|| {
                let reason = index_rule("meshes", file.meshes.0.len(), index);
                FieldError::new(at_node(node).key("mesh"), reason)
            })?;
            let skin = fields.skin.map(|skin| skin.0 as usize);
            let of_figure = skin.and_then(|skin| places.get(&skin).copied());
            let follows = match (skin, of_figure, nearest[node]) {
                // The place of its node makes no difference to a mesh with a skin.
                (_, Some(skin), _) if with_skin.insert((index, skin)) => Follows::Skin(skin),
                (None, _, Some(joint)) => Follows::Joint(joint),
                _ => continue,
            };
            meshes.push(UsedMesh { node, index, mesh, follows });
        }
        Ok(meshes)
    }

    /// For each node its joint, or that of its nearest ancestor with one.
    fn nearest_joints(&self) -> Vec<Option<usize>> {
        let mut nearest = vec![None; self.nodes.parents.len()];
        for (joint, node) in self.joints.nodes.iter().enumerate() {
            nearest[*node] = Some(joint);
        }
        for &node in &self.nodes.order {
            let of_parent = self.nodes.parents[node].and_then(|parent| nearest[parent]);
            nearest[node] = nearest[node].or(of_parent);
        }
        nearest
    }

    /// The buffers of meshes, of their images and of the inverse bind matrices.
    fn buffers(&self, meshes: &[UsedMesh<'_>]) -> Result<BTreeSet<usize>, FieldError> {
        let file = self.file;
        let skins = self.figure.skins.iter().map(|skin| &file.skins.0[*skin]);
        let mut accessors: BTreeSet<usize> =
            skins.filter_map(|skin| Some(skin.inverse_binds?.0 as usize)).collect();
        let mut buffers = BTreeSet::new();
        for (at, primitive) in meshes.iter().flat_map(UsedMesh::surfaces) {
            let material = self.material(primitive, &at)?;
            let set = material.map_or((0, None), |(_, material)| material.sets());
            accessors.extend(primitive.accessors(set));
            if let Some(packed) = primitive.draco() {
                let at = at.key("extensions").key(DRACO).key("bufferView");
                buffers.insert(buffer_of_view(file, packed.view.0 as usize, at)?);
            }
            let views = material.map(|(_, material)| image_views(file, material));
            for view in views.into_iter().flatten() {
                buffers.extend(buffer_of_view(file, view, JsonPath::root().key("images")));
            }
        }
        for accessor in accessors {
            buffers.extend(buffers_of(file, accessor)?);
        }
        Ok(buffers)
    }

    /// The material of a primitive, with its index.
    fn material(
        &self,
        primitive: &GltfPrimitive,
        at: &JsonPath,
    ) -> Result<Option<(usize, &GltfMaterial)>, FieldError> {
        let Some(index) = primitive.material.map(|material| material.0 as usize) else {
            return Ok(None);
        };
        let materials = &self.file.materials.0;
        let found = materials.get(index).ok_or_else(|| {
            let reason = index_rule("materials", materials.len(), index);
            FieldError::new(at.clone().key("material"), reason)
        })?;
        Ok(Some((index, found)))
    }

    /// Warns once of weights beyond four, and once of everything else that is not read.
    fn warn_of_unread(
        &self,
        meshes: &[UsedMesh<'_>],
        built: &MeshBuilder,
        warnings: &mut FieldWarnings,
    ) {
        if built.cut > 0 {
            let (cut, all, most) = (built.cut, built.weights.len(), 100.0 * built.most_cut);
            let reason = format!(
                "{cut} of {all} vertices follow more than four joints; the four heaviest are kept, and \
                 up to {most:.1} % of the weight of a vertex is lost"
            );
            warnings.push(at_skin(self.figure.first()), reason);
        }
        let mut unread: BTreeSet<String> = BTreeSet::new();
        let name = |name: &str| name.to_owned();
        let primitives = meshes.iter().flat_map(|mesh| &mesh.mesh.primitives.0);
        for primitive in primitives {
            unread.extend((!primitive.is_surface()).then(|| name("points and lines")));
            let material =
                primitive.material.and_then(|it| self.file.materials.0.get(it.0 as usize));
            unread.extend(material.into_iter().flat_map(GltfMaterial::unread));
        }
        let others = self.other_meshes(meshes);
        match others {
            0 => {}
            1 => unread.extend([name("1 mesh that follows no joint of the figure")]),
            _ => unread.extend([format!("{others} meshes that follow no joint of the figure")]),
        }
        if !unread.is_empty() {
            let unread: Vec<String> = unread.into_iter().collect();
            let reason = format!("not read: {}", unread.join(", "));
            warnings.push(JsonPath::root().key("meshes"), reason);
        }
    }

    /// Number of meshes on nodes that are none of `meshes`.
    fn other_meshes(&self, meshes: &[UsedMesh<'_>]) -> usize {
        let read: BTreeSet<usize> = meshes.iter().map(|mesh| mesh.index).collect();
        let used = self.file.nodes.0.iter().filter_map(|node| node.mesh);
        let others: BTreeSet<usize> =
            used.map(|mesh| mesh.0 as usize).filter(|mesh| !read.contains(mesh)).collect();
        others.len()
    }
}

/// The mesh of a figure as its file has it.
pub struct FigureMesh {
    pub mesh: FileMesh,
    /// CRC-32 of all files that it is read from.
    pub checksum: u32,
    /// The nodes whose meshes have the morph targets.
    pub owners: Vec<MorphOwner>,
    /// For each morph target its weight in the file.
    pub morph_weights: Vec<f32>,
}

/// A mesh in progress.
#[derive(Default)]
struct MeshBuilder {
    mesh: TriangleMesh,
    weights: Vec<VertexWeights>,
    parts: Vec<SkinPart>,
    morphs: Vec<Morph>,
    /// For each morph target its weight in the file.
    morph_weights: Vec<f32>,
    owners: Vec<MorphOwner>,
    /// Number of vertices that lost weight.
    cut: usize,
    /// The greatest part of its weight that a vertex lost.
    most_cut: f32,
}

impl MeshBuilder {
    /// Adds the morph targets of a mesh, which change nothing yet.
    fn begin(&mut self, file: &GltfFile<'_>, used: &UsedMesh<'_>, names: &mut UniqueNames) {
        let (mesh, node) = (used.mesh, &file.nodes.0[used.node]);
        let count = mesh.primitives.0.iter().map(|it| it.targets.len()).max().unwrap_or_default();
        let extras = mesh.extras.as_ref().and_then(Extras::own);
        let weights = node.weights.as_ref().or(mesh.weights.as_ref());
        for morph in 0..count {
            let name = extras.and_then(|extras| extras.target_names.get(morph));
            let name = name.filter(|name| !name.trim().is_empty());
            let name = names.free(name.map_or(&format!("morph_{morph}"), |name| name));
            let weight = weights.and_then(|weights| weights.get(morph));
            self.morph_weights.push(weight.map_or(0.0, |JsonNumber(weight)| *weight));
            self.morphs.push(Morph { name, ..Morph::default() });
        }
        let first = self.morphs.len() - count;
        self.owners.push(MorphOwner { node: used.node, first, count });
    }

    fn add(
        &mut self,
        primitive: PrimitiveMesh,
        rigid: Option<(usize, DAffine3)>,
        is_mirrored: bool,
        material: PartMaterial,
        of_skin: &[usize],
    ) {
        let PartMaterial { colour, texture, emission_texture, moved, emission_moved, look } =
            material;
        let PrimitiveMesh {
            mut positions,
            mut normals,
            coordinates,
            emission_coordinates,
            colours,
            weights,
            mut triangles,
            mut morphs,
        } = primitive;
        if normals.is_empty() {
            normals = smooth_normals(&positions, &triangles);
            for morph in morphs.iter_mut().filter(|morph| morph.normals.is_none()) {
                *morph = with_smooth_normals(morph, &positions, &normals, &triangles);
            }
        }
        self.add_morphs(&morphs, &normals, rigid);
        if let Some((_, to_mesh)) = rigid {
            let of_normals = to_mesh.matrix3.inverse().transpose();
            for (position, normal) in positions.iter_mut().zip(&mut normals) {
                *position = to_mesh.transform_point3(position.as_dvec3()).as_vec3();
                *normal = (of_normals * normal.as_dvec3()).as_vec3();
            }
        }
        if is_mirrored {
            triangles.iter_mut().for_each(|[_, b, c]| std::mem::swap(b, c));
        }
        let first = self.mesh.positions.len();
        let alpha_cutoff = if texture.is_some() { look.alpha_cutoff } else { 0.0 };
        let look = PartLook { alpha_cutoff, ..look };
        self.parts.push(SkinPart {
            triangles: triangles.len(),
            colour,
            texture,
            emission_texture,
            look,
        });
        let shifted = triangles.into_iter().map(|it| it.map(|corner| corner + first as u32));
        self.mesh.triangles.extend(shifted);
        let count = positions.len();
        self.mesh.normals.extend(normals.into_iter().map(|it| it.normalize_or(Vec3::Y)));
        self.mesh.positions.extend(positions);
        let moved = moved.unwrap_or(Affine2::IDENTITY);
        let coordinates = coordinates.into_iter().map(|it| moved.transform_point2(it));
        self.mesh.texture_coordinates.extend(coordinates);
        self.mesh.texture_coordinates.resize(first + count, glam::Vec2::ZERO);
        if emission_moved.is_some() || !self.mesh.emission_coordinates.is_empty() {
            let TriangleMesh { texture_coordinates, emission_coordinates: all, .. } =
                &mut self.mesh;
            all.extend_from_slice(&texture_coordinates[all.len()..first]);
            match emission_moved {
                Some(moved) => {
                    all.extend(
                        emission_coordinates.into_iter().map(|it| moved.transform_point2(it)),
                    );
                }
                None => all.extend_from_slice(&texture_coordinates[first..]),
            }
            all.resize(first + count, glam::Vec2::ZERO);
        }
        if !(colours.is_empty() && self.mesh.colours.is_empty()) {
            self.mesh.colours.resize(first, [u8::MAX; 4]);
            self.mesh.colours.extend(colours);
            self.mesh.colours.resize(first + count, [u8::MAX; 4]);
        }
        for vertex in 0..count {
            let of_file = weights.get(vertex).map_or(&[][..], Vec::as_slice);
            let listed = of_file.iter().map(|(joint, weight)| (of_skin[*joint], *weight));
            let only = rigid.map(|(joint, _)| (joint, 1.0));
            let all = listed.filter(|_| rigid.is_none()).chain(only);
            let (kept, cut) =
                VertexWeights::heaviest(all.map(|(joint, weight)| (JointId::new(joint), weight)));
            self.weights.push(kept);
            self.cut += usize::from(cut > 0.0);
            self.most_cut = self.most_cut.max(cut);
        }
    }
}

impl MeshBuilder {
    /// Adds the changes of the next primitive's vertices, which has these normals, to the morph
    /// targets of its mesh.
    fn add_morphs(
        &mut self,
        morphs: &[PrimitiveMorph],
        normals: &[Vec3],
        rigid: Option<(usize, DAffine3)>,
    ) {
        let shift = self.mesh.positions.len() as u32;
        let first = self.owners.last().map_or(0, |owner| owner.first);
        let linear = rigid.map_or(DMat3::IDENTITY, |(_, to_mesh)| to_mesh.matrix3);
        let of_normals = linear.inverse().transpose();
        for (morph, changes) in self.morphs[first..].iter_mut().zip(morphs) {
            for (place, vertex) in changes.vertices.iter().enumerate() {
                let normal = normals[*vertex as usize].as_dvec3();
                let change = changes.normals.as_ref().map_or(Vec3::ZERO, |all| all[place]);
                let [before, after] = [normal, normal + change.as_dvec3()]
                    .map(|normal| (of_normals * normal).normalize_or_zero());
                morph.vertices.push(vertex + shift);
                morph.offsets.push((linear * changes.offsets[place].as_dvec3()).as_vec3());
                morph.normals.push((after - before).as_vec3());
            }
        }
    }
}

/// A morph target with the change that it makes to the smooth normals of a primitive.
fn with_smooth_normals(
    morph: &PrimitiveMorph,
    positions: &[Vec3],
    normals: &[Vec3],
    triangles: &[[u32; 3]],
) -> PrimitiveMorph {
    let mut moved = positions.to_vec();
    let mut offsets = vec![Vec3::ZERO; positions.len()];
    for (vertex, offset) in morph.vertices.iter().zip(&morph.offsets) {
        moved[*vertex as usize] += *offset;
        offsets[*vertex as usize] = *offset;
    }
    let after = smooth_normals(&moved, triangles);
    let changes = after.iter().zip(normals).map(|(after, before)| *after - *before).collect();
    PrimitiveMorph::new(Some(offsets), Some(changes))
}

/// Normals of vertices from the triangles around them, by their areas.
fn smooth_normals(positions: &[Vec3], triangles: &[[u32; 3]]) -> Vec<Vec3> {
    let mut sums = vec![DVec3::ZERO; positions.len()];
    for corners in triangles {
        let [a, b, c] = corners.map(|corner| positions[corner as usize].as_dvec3());
        let area = (b - a).cross(c - a);
        corners.iter().for_each(|corner| sums[*corner as usize] += area);
    }
    sums.into_iter().map(|sum| sum.normalize_or_zero().as_vec3()).collect()
}
