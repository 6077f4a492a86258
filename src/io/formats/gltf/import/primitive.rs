use std::collections::{BTreeMap, BTreeSet};

use glam::{Affine2, Vec2, Vec3};

use super::buffers::{GltfBuffers, is_file, read_uri};
use super::draco::DracoMesh;
use super::rows::{AccessorRows, at_accessor, find_accessor, view_bytes, width};
use crate::io::error::OpenError;
use crate::io::formats::gltf::file::{GltfFile, GltfPrimitive, index_rule};
use crate::io::formats::gltf::material::{GltfImage, GltfMaterial, GltfTextureUse, Uri, srgb};
use crate::io::json::{FieldError, FieldWarnings, JsonObject, JsonPath, Whole};
use crate::io::source::Source;
use crate::io::texture::TextureReader;
use crate::kinematics::Shared;
use crate::rig::{PartLook, SkinTexture};

/// The part of a material that a skin uses.
#[derive(Clone)]
pub struct PartMaterial {
    /// Colour as sRGB channels from 0 to 1.
    pub colour: [f32; 3],
    pub texture: Option<Shared<SkinTexture>>,
    pub emission_texture: Option<Shared<SkinTexture>>,
    /// What moves the texture coordinates.
    pub moved: Option<Affine2>,
    /// What moves those of the emission; `None` if they are the same.
    pub emission_moved: Option<Affine2>,
    pub look: PartLook,
}

impl PartMaterial {
    /// White with a look.
    pub fn white(look: PartLook) -> Self {
        let (texture, emission_texture) = (None, None);
        let (moved, emission_moved) = (None, None);
        Self { colour: [1.0; 3], texture, emission_texture, moved, emission_moved, look }
    }

    /// Returns whether the alpha of the material hides all of it.
    pub fn is_hidden(&self) -> bool {
        self.look.alpha_cutoff > 1.0
    }
}

/// Where the images of materials are.
pub struct MaterialSource<'a> {
    pub source: &'a Source,
    pub file: &'a GltfFile<'a>,
    pub buffers: &'a GltfBuffers<'a>,
}

/// The images of a skin that were read, by their index; `None` for one that cannot be used.
#[derive(Default)]
pub struct ImageCache {
    images: BTreeMap<usize, Option<Shared<SkinTexture>>>,
    reader: TextureReader,
}

impl ImageCache {
    /// Reads base colour and emission of a material. A texture that cannot be read is left out, with
    /// a warning.
    pub fn material(
        &mut self,
        from: &MaterialSource<'_>,
        material: &GltfMaterial,
        checksum: &mut crc32fast::Hasher,
        warnings: &mut FieldWarnings,
    ) -> PartMaterial {
        let moved = material.coordinates_of().and_then(GltfTextureUse::moved);
        let apart = material.apart_emission();
        let emission_moved = apart.map(|used| used.moved().unwrap_or(Affine2::IDENTITY));
        let mut look = material.look();
        let colour = material.roughness.as_ref().map_or([1.0; 3], |JsonObject(it)| it.colour());
        let mut read = |used: &GltfTextureUse| {
            let texture = self.texture(from, used, checksum);
            texture
                .map_err(|error| warnings.push(error.field, format!("not read: {}", error.reason)))
                .ok()
                .flatten()
        };
        let texture = material.texture_use().and_then(&mut read);
        let emission_texture = material.emission_use().and_then(&mut read);
        // Without its texture, the whole surface would shine.
        if material.emissive_texture.is_some() && emission_texture.is_none() {
            look.emission = [0.0; 3];
        }
        PartMaterial { colour, texture, emission_texture, moved, emission_moved, look }
    }

    /// The image of a texture; `None` if it has failed before.
    fn texture(
        &mut self,
        from: &MaterialSource<'_>,
        used: &GltfTextureUse,
        checksum: &mut crc32fast::Hasher,
    ) -> Result<Option<Shared<SkinTexture>>, FieldError> {
        let (index, image) = image(from.file, used)?;
        if let Some(known) = self.images.get(&index) {
            return Ok(known.clone());
        }
        self.images.insert(index, None);
        let bytes = image_bytes(from, (index, image))?;
        if image.uri.as_ref().is_some_and(|Uri(uri)| is_file(uri)) {
            checksum.update(&bytes);
        }
        let error = |reason| FieldError::new(at_image(index), reason);
        let texture = Some(Shared::from(self.reader.read(bytes).map_err(error)?));
        self.images.insert(index, texture.clone());
        Ok(texture)
    }
}

fn at_image(index: usize) -> JsonPath {
    JsonPath::root().key("images").index(index)
}

/// Buffer views of the images of a material's base colour and emission, if they are in some.
pub fn image_views(file: &GltfFile<'_>, material: &GltfMaterial) -> impl Iterator<Item = usize> {
    let used = [material.texture_use(), material.emission_use()].into_iter().flatten();
    used.filter_map(|used| Some(image(file, used).ok()?.1.view?.0 as usize))
}

/// The image of a texture, with its index.
fn image<'a>(
    file: &'a GltfFile<'a>,
    used: &GltfTextureUse,
) -> Result<(usize, &'a GltfImage<'a>), FieldError> {
    let index = used.index.0 as usize;
    let at = JsonPath::root().key("textures").index(index);
    let Some(texture) = file.textures.0.get(index) else {
        return Err(FieldError::new(at, index_rule("textures", file.textures.0.len(), index)));
    };
    let Some(source) = texture.source else {
        return Err(FieldError::new(at, "must have an image in PNG or JPEG as its source"));
    };
    let image = source.0 as usize;
    let found = file.images.0.get(image).ok_or_else(|| {
        FieldError::new(at.key("source"), index_rule("images", file.images.0.len(), image))
    })?;
    Ok((image, found))
}

fn image_bytes(
    from: &MaterialSource<'_>,
    (index, image): (usize, &GltfImage<'_>),
) -> Result<Vec<u8>, FieldError> {
    let MaterialSource { source, file, buffers } = *from;
    let at = at_image(index);
    match (&image.uri, image.view) {
        (Some(Uri(uri)), _) => read_uri(source, uri, OpenError::MAX_BYTES as usize)
            .map_err(|reason| FieldError::new(at.key("uri"), reason)),
        (None, Some(view)) => Ok(view_bytes(file, buffers, view.0 as usize, &at)?.to_vec()),
        (None, None) => Err(FieldError::new(at, "must have a uri or a buffer view")),
    }
}

/// The vertices and triangles of a primitive, as the file has them.
pub struct PrimitiveMesh {
    pub positions: Vec<Vec3>,
    /// Normals of any length; empty if the file has none.
    pub normals: Vec<Vec3>,
    /// Texture coordinates; empty if the file has none.
    pub coordinates: Vec<Vec2>,
    /// Those of the emission, if they are apart; empty if the file has none.
    pub emission_coordinates: Vec<Vec2>,
    /// Colours as sRGB with opacity; empty if the file has none.
    pub colours: Vec<[u8; 4]>,
    /// For each vertex the joints, numbered as in the skin's list, with their weights; empty for a
    /// primitive without weights.
    pub weights: Vec<Vec<(usize, f32)>>,
    pub triangles: Vec<[u32; 3]>,
    pub morphs: Vec<PrimitiveMorph>,
}

/// The changes that a morph target makes to the vertices of a primitive.
pub struct PrimitiveMorph {
    /// The vertices that it changes, ascending.
    pub vertices: Vec<u32>,
    pub offsets: Vec<Vec3>,
    /// Changes of normals; `None` if the file has none.
    pub normals: Option<Vec<Vec3>>,
}

/// The attribute of the colours of vertices.
const COLOURS: &str = "COLOR_0";

/// The attributes of morph targets that are read.
const MORPHED: [&str; 2] = ["POSITION", "NORMAL"];

/// Maximum number of sets of four joints for each vertex.
const MOST_SETS: usize = 16;

/// Rule by which corners make triangles.
#[derive(Clone, Copy)]
enum Mode {
    Triangles,
    Strip,
    Fan,
}

impl Mode {
    /// The mode of a primitive; `None` for points and lines.
    fn of(primitive: &GltfPrimitive) -> Option<Self> {
        match primitive.mode.map_or(4, |mode| mode.0) {
            4 => Some(Self::Triangles),
            5 => Some(Self::Strip),
            6 => Some(Self::Fan),
            _ => None,
        }
    }

    fn triangles(self, corners: &[u32]) -> Vec<[u32; 3]> {
        let turned = |(index, corners): (usize, &[u32])| match index % 2 {
            0 => [corners[0], corners[1], corners[2]],
            _ => [corners[0], corners[2], corners[1]],
        };
        let all: Vec<[u32; 3]> = match (self, corners) {
            (Self::Triangles, _) => corners.as_chunks().0.to_vec(),
            (Self::Strip, _) => corners.windows(3).enumerate().map(turned).collect(),
            (Self::Fan, [first, others @ ..]) => {
                others.windows(2).map(|pair| [*first, pair[0], pair[1]]).collect()
            }
            (Self::Fan, []) => Vec::new(),
        };
        let has_area = |[a, b, c]: &[u32; 3]| a != b && b != c && c != a;
        all.into_iter().filter(has_area).collect()
    }
}

impl GltfPrimitive {
    /// Returns whether the primitive has triangles, rather than points or lines.
    pub fn is_surface(&self) -> bool {
        Mode::of(self).is_some() && self.attributes.contains_key("POSITION")
    }

    /// Accessor of an attribute.
    fn attribute(&self, name: &str) -> Option<usize> {
        self.attributes.get(name).map(|accessor| accessor.0 as usize)
    }

    /// Accessors of the sets of joints, each with that of their weights.
    fn weights(&self) -> impl Iterator<Item = (usize, usize)> {
        (0..MOST_SETS).map_while(|set| {
            let joints = self.attribute(&format!("JOINTS_{set}"))?;
            Some((joints, self.attribute(&format!("WEIGHTS_{set}"))?))
        })
    }

    /// The accessors that [`PrimitiveMesh::new`] reads with these sets of texture coordinates.
    pub fn accessors(&self, (set, of_emission): (u32, Option<u32>)) -> BTreeSet<usize> {
        let sets = [Some(set), of_emission].into_iter().flatten();
        let sets = sets.filter_map(|set| self.attribute(&format!("TEXCOORD_{set}")));
        let names = ["POSITION", "NORMAL", COLOURS];
        let attributes = names.into_iter().filter_map(|name| self.attribute(name)).chain(sets);
        let weights = self.weights().flat_map(|(joints, weights)| [joints, weights]);
        let indices = self.indices.iter().map(|indices| indices.0 as usize);
        let of_morph = |morph: &BTreeMap<String, Whole>| {
            MORPHED.map(|name| morph.get(name).map(|accessor| accessor.0 as usize))
        };
        let morphs = self.targets.iter().flat_map(of_morph).flatten();
        attributes.chain(weights).chain(indices).chain(morphs).collect()
    }
}

impl PrimitiveMesh {
    /// Reads a primitive, with these sets of texture coordinates. `at` is its path, and `joints` the
    /// number of joints of the skin.
    pub fn new(
        file: &GltfFile<'_>,
        buffers: &GltfBuffers<'_>,
        primitive: &GltfPrimitive,
        (set, of_emission): (u32, Option<u32>),
        joints: usize,
        at: &JsonPath,
    ) -> Result<Self, FieldError> {
        let draco = DracoMesh::new(file, buffers, primitive, at)?;
        let rows = |name: &str, accessor, shape| {
            let found = find_accessor(file, accessor)?;
            let decoded = draco.as_ref().and_then(|mesh| mesh.rows(name, found, width(shape)));
            decoded.map_or_else(|| AccessorRows::new(file, buffers, accessor, shape), Ok)
        };
        let points = |name: &str| match primitive.attribute(name) {
            Some(accessor) => Ok::<_, FieldError>(vectors(&rows(name, accessor, "VEC3")?)),
            None => Ok(Vec::new()),
        };
        let positions = points("POSITION")?;
        let count = positions.len();
        let has_as_many = |name: &str, got: usize| {
            if got == 0 || got == count {
                return Ok(());
            }
            let reason = format!("must have {count} rows like POSITION, got {got}");
            Err(FieldError::new(at.clone().key("attributes").key(name), reason))
        };
        let normals = points("NORMAL")?;
        has_as_many("NORMAL", normals.len())?;
        let coordinates = |set: u32| {
            let name = format!("TEXCOORD_{set}");
            let Some(accessor) = primitive.attribute(&name) else { return Ok(Vec::new()) };
            let coordinates = coordinates(&rows(&name, accessor, "VEC2")?);
            has_as_many(&name, coordinates.len())?;
            Ok::<_, FieldError>(coordinates)
        };
        let emission_coordinates = of_emission.map(coordinates).transpose()?.unwrap_or_default();
        let coordinates = coordinates(set)?;
        let colours = match primitive.attribute(COLOURS) {
            Some(accessor) => {
                let shape = &*find_accessor(file, accessor)?.shape;
                let shape = if shape == "VEC3" { "VEC3" } else { "VEC4" };
                colours(&rows(COLOURS, accessor, shape)?, shape == "VEC4")
            }
            None => Vec::new(),
        };
        has_as_many(COLOURS, colours.len())?;
        let mut weights = Vec::new();
        for (set, (of_joints, of_weights)) in primitive.weights().enumerate() {
            let numbers = rows(&format!("JOINTS_{set}"), of_joints, "VEC4")?;
            let shares = rows(&format!("WEIGHTS_{set}"), of_weights, "VEC4")?;
            has_as_many("JOINTS_n", numbers.len())?;
            has_as_many("WEIGHTS_n", shares.len())?;
            weights.resize_with(count, Vec::new);
            add_weights(&mut weights, [&numbers, &shares], joints, &at_accessor(of_joints))?;
        }
        let mut morphs = Vec::with_capacity(primitive.targets.len());
        for (index, target) in primitive.targets.iter().enumerate() {
            let changes = |name: &str| {
                let Some(accessor) = target.get(name) else { return Ok(None) };
                let rows = AccessorRows::new(file, buffers, accessor.0 as usize, "VEC3")?;
                if rows.len() != count {
                    let reason =
                        format!("must have {count} rows like POSITION, got {}", rows.len());
                    let at = at.clone().key("targets").index(index).key(name);
                    return Err(FieldError::new(at, reason));
                }
                Ok(Some(vectors(&rows)))
            };
            morphs.push(PrimitiveMorph::new(changes("POSITION")?, changes("NORMAL")?));
        }
        Ok(Self {
            morphs,
            triangles: match draco {
                Some(mesh) => Mode::Triangles.triangles(&mesh.corners()),
                None => triangles(file, buffers, primitive, count)?,
            },
            positions,
            normals,
            coordinates,
            emission_coordinates,
            colours,
            weights,
        })
    }
}

impl PrimitiveMorph {
    /// Keeps those vertices that are changed.
    pub fn new(offsets: Option<Vec<Vec3>>, normals: Option<Vec<Vec3>>) -> Self {
        let at = |all: &Option<Vec<Vec3>>, vertex: u32| {
            all.as_ref().map_or(Vec3::ZERO, |all| all[vertex as usize])
        };
        let count = offsets.as_ref().or(normals.as_ref()).map_or(0, Vec::len);
        let is_changed =
            |vertex: &u32| [&offsets, &normals].iter().any(|all| at(all, *vertex) != Vec3::ZERO);
        let vertices: Vec<u32> = (0..count as u32).filter(is_changed).collect();
        let kept =
            |all: &Option<Vec<Vec3>>| vertices.iter().map(|vertex| at(all, *vertex)).collect();
        Self {
            offsets: kept(&offsets),
            normals: normals.is_some().then(|| kept(&normals)),
            vertices,
        }
    }
}

fn vectors(rows: &AccessorRows<'_>) -> Vec<Vec3> {
    let vector = |row| Vec3::from_array(rows.row::<3>(row).map(|number| number as f32));
    (0..rows.len()).map(vector).collect()
}

fn coordinates(rows: &AccessorRows<'_>) -> Vec<Vec2> {
    let vector = |row| {
        let vector = Vec2::from_array(rows.row::<2>(row).map(|number| number as f32));
        if vector.is_finite() { vector } else { Vec2::ZERO }
    };
    (0..rows.len()).map(vector).collect()
}

/// Colours of vertices, of which the file has linear light, with or without opacity.
fn colours(rows: &AccessorRows<'_>, has_opacity: bool) -> Vec<[u8; 4]> {
    let byte = |part: f32| (part.clamp(0.0, 1.0) * 255.0).round() as u8;
    let colour = |row| {
        let [red, green, blue, opacity] = rows.row::<4>(row).map(|number| number as f32);
        let [red, green, blue] = [red, green, blue].map(|linear| byte(srgb(linear)));
        [red, green, blue, if has_opacity { byte(opacity) } else { u8::MAX }]
    };
    (0..rows.len()).map(colour).collect()
}

/// Adds a set of joints with their weights to the weights of the vertices.
fn add_weights(
    weights: &mut [Vec<(usize, f32)>],
    [joints, shares]: [&AccessorRows<'_>; 2],
    count: usize,
    at: &JsonPath,
) -> Result<(), FieldError> {
    for (vertex, weights) in weights.iter_mut().enumerate() {
        let (joints, shares) = (joints.row::<4>(vertex), shares.row::<4>(vertex));
        for (joint, share) in joints.into_iter().zip(shares).filter(|(_, share)| *share > 0.0) {
            let joint = joint as usize;
            if joint >= count {
                return Err(FieldError::new(at.clone(), index_rule("joints", count, joint)));
            }
            weights.push((joint, share as f32));
        }
    }
    Ok(())
}

fn triangles(
    file: &GltfFile<'_>,
    buffers: &GltfBuffers<'_>,
    primitive: &GltfPrimitive,
    count: usize,
) -> Result<Vec<[u32; 3]>, FieldError> {
    let Some(mode) = Mode::of(primitive) else { return Ok(Vec::new()) };
    let corners: Vec<u32> = match primitive.indices {
        None => (0..count as u32).collect(),
        Some(accessor) => {
            let accessor = accessor.0 as usize;
            let rows = AccessorRows::new(file, buffers, accessor, "SCALAR")?;
            let corners: Vec<u32> =
                (0..rows.len()).map(|row| rows.row::<1>(row)[0] as u32).collect();
            if let Some(corner) = corners.iter().find(|corner| **corner as usize >= count) {
                let reason = index_rule("vertices", count, *corner as usize);
                return Err(FieldError::new(at_accessor(accessor), reason));
            }
            corners
        }
    };
    Ok(mode.triangles(&corners))
}
