use std::path::PathBuf;
use std::sync::{Arc, OnceLock};

use core::fmt;

use glam::Vec3;
use thiserror::Error;

use crate::Shared;
use crate::skeleton::{JointId, JointRemap, Skeleton, SkeletonPose};
use crate::skin::SkinnedMesh;

/// A skin whose mesh was imported: it is read from its file, or saved in the document.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshSkin {
    /// The file that documents refer to; `None` if they contain the mesh.
    file: Option<SkinFile>,
    /// For each joint of the file the joint of the skeleton; `None` if that joint was removed.
    joints: Vec<Option<JointId>>,
    /// Weights of the mesh's morph targets; 0 for those beyond the list.
    morph_weights: Vec<f32>,
    mesh: Result<LoadedMesh, SkinFileError>,
}

/// The file of a mesh.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SkinFile {
    /// Path of the file.
    pub path: PathBuf,
    /// CRC-32 of what was read of the file and of the files that it names.
    pub checksum: u32,
    /// Name of the skeleton in the file.
    pub skeleton: String,
    /// Name of the animation in the file in which the mesh was attached, if the mesh is another one
    /// without it: an animation can scale joints.
    pub animation: Option<String>,
}

/// The reason why a skin has no mesh.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum SkinFileError {
    /// There is no such file.
    #[error("the skin's file {0} is missing: locate it, or remove the skin")]
    Missing(PathBuf),
    /// The file has changed since the document was saved.
    #[error(
        "the skin's file {0} has changed since the document was saved: locate it to use its new version"
    )]
    Changed(PathBuf),
    /// The file cannot be read, or has no such skin.
    #[error("the skin cannot be read: {0}")]
    Invalid(String),
}

#[derive(Clone, Debug)]
struct LoadedMesh {
    in_file: Shared<FileMesh>,
    /// Without morph targets.
    attached: Shared<AttachedMesh>,
    /// In the shape that the weights of the morph targets give it, made when it is needed.
    morphed: Arc<OnceLock<Shared<AttachedMesh>>>,
}

impl MeshSkin {
    /// Attaches a mesh to a skeleton. `joints` has for each joint of the file the joint of the
    /// skeleton; the weights of joints without one go to their nearest ancestor that has one.
    /// Without `file`, documents contain the mesh.
    pub fn new(
        mesh: Shared<FileMesh>,
        file: Option<SkinFile>,
        joints: Vec<Option<JointId>>,
        skeleton: &Skeleton,
    ) -> Self {
        let mesh = LoadedMesh::new(mesh, &joints, skeleton);
        Self { file, joints, morph_weights: Vec::new(), mesh: Ok(mesh) }
    }

    /// A skin whose file cannot be read.
    pub fn without_mesh(
        file: SkinFile,
        joints: Vec<Option<JointId>>,
        error: SkinFileError,
    ) -> Self {
        Self { file: Some(file), joints, morph_weights: Vec::new(), mesh: Err(error) }
    }

    /// The file that documents refer to; `None` if they contain the mesh.
    pub fn file(&self) -> Option<&SkinFile> {
        self.file.as_ref()
    }

    /// For each joint of the file the joint of the skeleton; `None` if that joint was removed.
    pub fn joints(&self) -> &[Option<JointId>] {
        &self.joints
    }

    /// The mesh as the file has it; `None` if the file could not be read.
    pub fn in_file(&self) -> Option<&Shared<FileMesh>> {
        self.mesh.as_ref().ok().map(|mesh| &mesh.in_file)
    }

    /// The mesh on the joints of the skeleton, in the shape that its morph targets give it.
    ///
    /// # Errors
    ///
    /// [`SkinFileError`] if the file could not be read.
    pub fn mesh(&self) -> Result<&Shared<AttachedMesh>, SkinFileError> {
        let LoadedMesh { attached, morphed, .. } = self.mesh.as_ref().map_err(Clone::clone)?;
        let weights = &self.morph_weights;
        if weights.iter().all(|weight| *weight == 0.0) {
            return Ok(attached);
        }
        Ok(morphed.get_or_init(|| attached.morphed(weights).into()))
    }

    /// [`MeshSkin::mesh`] with all weights of morph targets 0.
    ///
    /// # Errors
    ///
    /// [`SkinFileError`] if the file could not be read.
    pub fn unmorphed(&self) -> Result<&Shared<AttachedMesh>, SkinFileError> {
        self.mesh.as_ref().map(|mesh| &mesh.attached).map_err(Clone::clone)
    }

    /// The weights of the morph targets, of which 0 does not change the mesh and 1 gives it the
    /// target's shape; 0 for those beyond the list.
    pub fn morph_weights(&self) -> &[f32] {
        &self.morph_weights
    }

    /// The skin with other weights of its morph targets; those that are not finite become 0.
    #[must_use]
    pub fn with_morph_weights(self, weights: Vec<f32>) -> Self {
        let finite = |weight: f32| if weight.is_finite() { weight } else { 0.0 };
        let morph_weights = weights.into_iter().map(finite).collect();
        let mesh = self.mesh.map(|mesh| LoadedMesh { morphed: Arc::default(), ..mesh });
        Self { morph_weights, mesh, ..self }
    }

    /// The weight of a morph target; `None` if the mesh has no such target.
    pub fn morph_weight(&self, morph: usize) -> Option<f32> {
        self.in_file()?.mesh.morphs().get(morph)?;
        Some(self.morph_weights.get(morph).copied().unwrap_or_default())
    }

    /// Sets the weight of a morph target; ignored for a target that the mesh does not have.
    pub fn set_morph_weight(&mut self, morph: usize, weight: f32) {
        let is_new = |now: f32| now.to_bits() != weight.to_bits() && weight.is_finite();
        if !self.morph_weight(morph).is_some_and(is_new) {
            return;
        }
        let count = self.morph_weights.len().max(morph + 1);
        self.morph_weights.resize(count, 0.0);
        self.morph_weights[morph] = weight;
        if let Ok(mesh) = &mut self.mesh {
            mesh.morphed = Arc::default();
        }
    }

    /// A copy whose mesh is saved in the document, not in a file of its own; `None` without a mesh.
    pub fn packed(&self) -> Option<Self> {
        self.mesh.is_ok().then(|| Self { file: None, ..self.clone() })
    }

    /// A copy, saved in the document, whose mesh `attach` makes from that on the skeleton, without morph
    /// targets; `None` without a mesh.
    ///
    /// # Errors
    ///
    /// Those of `attach`.
    pub fn reattached<E>(
        &self,
        skeleton: &Skeleton,
        attach: impl FnOnce(&SkinnedMesh) -> Result<SkinnedMesh, E>,
    ) -> Result<Option<Self>, E> {
        let Ok(attached) = self.unmorphed() else { return Ok(None) };
        let in_file = FileMesh {
            mesh: attach(&attached.mesh)?,
            parents: skeleton.joints().iter().map(|joint| joint.parent).collect(),
            parts: attached.parts.clone(),
        };
        let joints = skeleton.ids().map(Some).collect();
        let skin = Self::new(in_file.into(), None, joints, skeleton);
        Ok(Some(skin.with_morph_weights(self.morph_weights.clone())))
    }

    /// The joint of the skeleton that all of the mesh follows; `None` if there are several, or no mesh.
    pub fn sole_joint(&self) -> Option<JointId> {
        let mut weights = self.unmorphed().ok()?.mesh.weights().iter();
        let first = weights.next()?;
        let is_sole = first.iter().count() == 1 && weights.all(|it| it == first);
        is_sole.then(|| first.first())
    }

    /// A copy that refers to its file by another path.
    #[must_use]
    pub fn with_path(&self, path: impl FnOnce(&SkinFile) -> PathBuf) -> Self {
        let file = self.file.as_ref().map(|file| SkinFile { path: path(file), ..file.clone() });
        Self { file, ..self.clone() }
    }

    /// The same skin, measured on another pose of its skeleton.
    #[must_use]
    pub fn attached_to(&self, skeleton: &Skeleton) -> Self {
        let mesh = self.mesh.as_ref().map_err(Clone::clone);
        let mesh = mesh.map(|mesh| LoadedMesh::new(mesh.in_file.clone(), &self.joints, skeleton));
        Self { mesh, ..self.clone() }
    }

    /// The skin measured again, if the bones of the skeleton have changed since; otherwise `None`.
    pub(super) fn refreshed(&self, skeleton: &Skeleton) -> Option<Self> {
        let mesh = self.mesh.as_ref().ok()?;
        (!mesh.attached.is_measured_on(skeleton)).then(|| self.attached_to(skeleton))
    }

    /// The skin for a skeleton with other joint indices.
    pub(super) fn remapped(&self, remap: &JointRemap, skeleton: &Skeleton) -> Self {
        let joints: Vec<_> =
            self.joints.iter().map(|joint| joint.and_then(|joint| remap.get(joint))).collect();
        Self { joints, ..self.clone() }.attached_to(skeleton)
    }
}

impl LoadedMesh {
    fn new(in_file: Shared<FileMesh>, joints: &[Option<JointId>], skeleton: &Skeleton) -> Self {
        let FileMesh { mesh, parents, parts } = &*in_file;
        let attached = AttachedMesh::new(mesh.renumbered(joints, parents), parts.clone(), skeleton);
        Self { attached: attached.into(), in_file, morphed: Arc::default() }
    }
}

/// The attached mesh follows from the one in the file, the joints and the skeleton of the rig.
impl PartialEq for LoadedMesh {
    fn eq(&self, other: &Self) -> bool {
        self.in_file == other.in_file
    }
}

/// A skinned mesh on the joints of a skeleton, with its materials and its thickness around each
/// bone.
#[derive(Clone, Debug, PartialEq)]
pub struct AttachedMesh {
    /// The mesh.
    pub mesh: SkinnedMesh,
    /// The parts of the mesh in the order of its triangles, one after the other.
    pub parts: Vec<SkinPart>,
    /// For each joint, how thick the mesh is around its bone: the mean distance from the bone to
    /// the vertices whose greatest weight is this joint's, in skeleton units; 0 for a joint without
    /// such vertices.
    pub radii: Vec<f32>,
    /// For each joint, the box around those vertices in the joint's own space in the bind pose: its
    /// lowest and its highest corner; `None` for a joint without such vertices.
    pub boxes: Vec<Option<[Vec3; 2]>>,
    /// The bones on which the thickness was measured: the axis of each joint.
    axes: Vec<Vec3>,
    /// The mesh that morph targets have changed to this one; `None` for one that none have.
    unmorphed: Option<Shared<Self>>,
}

impl AttachedMesh {
    /// Measures the thickness of a mesh around the bones of its skeleton. Triangles after the last
    /// of `parts` become a white part.
    pub fn new(mesh: SkinnedMesh, mut parts: Vec<SkinPart>, skeleton: &Skeleton) -> Self {
        let listed: usize = parts.iter().map(|part| part.triangles).sum();
        let rest = mesh.mesh().triangles.len().saturating_sub(listed);
        if rest > 0 {
            parts.push(SkinPart::white(rest));
        }
        let mut sums = vec![(0.0_f64, 0_u32); skeleton.joints().len()];
        let mut boxes = vec![None; sums.len()];
        let vertices = mesh.mesh().positions.iter().zip(mesh.weights());
        for ((position, weights), set) in vertices.zip(mesh.sets_of_vertices()) {
            let joint = weights.first();
            let binds = &mesh.bind_sets()[set].inverse_binds;
            if let (Some(bone), Some(bind)) = (skeleton.joint(joint), binds.get(joint.index())) {
                let at = bind.transform_point3(*position);
                let distance = bone.distance(at);
                // Numbers near the limit of f32 overflow.
                if !distance.is_finite() {
                    continue;
                }
                let (sum, count) = &mut sums[joint.index()];
                *sum += f64::from(distance);
                *count += 1;
                let [low, high] = boxes[joint.index()].get_or_insert([at, at]);
                (*low, *high) = (low.min(at), high.max(at));
            }
        }
        let mean = |(sum, count): (f64, u32)| (sum / f64::from(count.max(1))) as f32;
        let axes = skeleton.joints().iter().map(|joint| joint.axis).collect();
        let radii = sums.into_iter().map(mean).collect();
        Self { mesh, parts, radii, boxes, axes, unmorphed: None }
    }

    /// True if the mesh was measured on joints with the bones of this skeleton.
    pub(super) fn is_measured_on(&self, skeleton: &Skeleton) -> bool {
        skeleton.joints().iter().map(|joint| joint.axis).eq(self.axes.iter().copied())
    }

    /// True if two meshes have the same triangles and materials, and differ by their morph targets
    /// alone.
    pub fn has_surface_of(&self, other: &Self) -> bool {
        let both = self.unmorphed.as_ref().zip(other.unmorphed.as_ref());
        both.is_some_and(|(one, other)| one.is_same(other))
    }

    /// The corners of boxes in the world that contain nearly all of the mesh in a pose.
    pub fn corners(&self, pose: &SkeletonPose) -> impl Iterator<Item = Vec3> {
        let corners = move |(joint, bounds): (usize, &Option<[Vec3; 2]>)| {
            let ends = (*bounds)?;
            let to_world = pose.full(JointId::new(joint));
            let end = move |corner: usize, axis: usize| ends[corner >> axis & 1][axis];
            let corner = move |at: usize| Vec3::from_array([end(at, 0), end(at, 1), end(at, 2)]);
            Some((0..8).map(move |at| to_world.transform_point3(corner(at))))
        };
        self.boxes.iter().enumerate().filter_map(corners).flatten()
    }
}

impl Shared<AttachedMesh> {
    /// The mesh in the shape that its morph targets give it with these weights. Its thickness and
    /// boxes stay.
    fn morphed(&self, weights: &[f32]) -> AttachedMesh {
        AttachedMesh {
            mesh: self.mesh.morphed(weights),
            parts: self.parts.clone(),
            radii: self.radii.clone(),
            boxes: self.boxes.clone(),
            axes: self.axes.clone(),
            unmorphed: Some(self.clone()),
        }
    }
}

/// Triangles of a skin with the same material.
#[derive(Clone, Debug, PartialEq)]
pub struct SkinPart {
    /// Number of triangles.
    pub triangles: usize,
    /// Colour as sRGB channels from 0 to 1. It multiplies the texture and the colour of the skin.
    pub colour: [f32; 3],
    /// Image that colours the triangles by the mesh's texture coordinates, repeated beyond 0 to 1.
    pub texture: Option<Shared<SkinTexture>>,
    /// Image that multiplies the light that the part gives off, by the mesh's coordinates of emission,
    /// or by the same ones if it has none.
    pub emission_texture: Option<Shared<SkinTexture>>,
    /// How the triangles are drawn, beside their colour.
    pub look: PartLook,
}

/// How triangles of a skin are drawn, beside their colour; by default opaque and from outside alone.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PartLook {
    /// True if the triangles are seen from both sides.
    pub is_double_sided: bool,
    /// Opacity of the texture, from 0 to 1, below which nothing is drawn; 0 to draw all.
    pub alpha_cutoff: f32,
    /// Opacity from 0 to 1, which multiplies those of the texture and of vertices; `None` for an
    /// opaque part.
    pub opacity: Option<f32>,
    /// Light that the part gives off, as sRGB channels from 0 to 1.
    pub emission: [f32; 3],
}

impl SkinPart {
    /// A white part with so many triangles.
    pub fn white(triangles: usize) -> Self {
        let (texture, emission_texture) = (None, None);
        Self { triangles, colour: [1.0; 3], texture, emission_texture, look: PartLook::default() }
    }

    /// The textures of parts, each once, in the order of the parts that have them first.
    pub fn textures(parts: &[Self]) -> Vec<&Shared<SkinTexture>> {
        let mut textures: Vec<&Shared<SkinTexture>> = Vec::new();
        for texture in parts.iter().flat_map(|it| [&it.texture, &it.emission_texture]).flatten() {
            if !textures.iter().any(|known| known.is_same(texture)) {
                textures.push(texture);
            }
        }
        textures
    }
}

/// An image on a skin, kept as the file that holds it. Most of what a program does with a skin
/// needs no pixels, and a small file can hold many of them, so they are decoded when they are first
/// needed.
#[derive(Clone)]
pub struct SkinTexture {
    /// The content of the PNG or JPEG file that holds the image.
    pub file: Vec<u8>,
    /// Width and height in pixels, both above 0.
    pub size: [u32; 2],
    pixels: OnceLock<Result<Vec<[u8; 4]>, String>>,
}

impl SkinTexture {
    /// An image of `size`, both above 0, in a PNG or JPEG file with the content `file`.
    pub fn new(file: Vec<u8>, size: [u32; 2]) -> Self {
        Self { file, size, pixels: OnceLock::new() }
    }

    /// Pixels as sRGB with opacity, row by row from the top. The first call decodes them from the
    /// file by `decode`; later ones give the same result again.
    ///
    /// # Errors
    ///
    /// The reason that `decode` gives if the content of the file is invalid.
    pub fn pixels(
        &self,
        decode: impl FnOnce(&Self) -> Result<Vec<[u8; 4]>, String>,
    ) -> Result<&[[u8; 4]], &str> {
        let pixels = self.pixels.get_or_init(|| decode(self));
        pixels.as_deref().map_err(String::as_str)
    }
}

/// True if two textures are the same file.
impl PartialEq for SkinTexture {
    fn eq(&self, other: &Self) -> bool {
        self.size == other.size && self.file == other.file
    }
}

impl fmt::Debug for SkinTexture {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { file, size: [width, height], .. } = self;
        write!(f, "SkinTexture({width} × {height} pixels from {} bytes)", file.len())
    }
}

/// A skinned mesh as a file has it, with joints of its own.
#[derive(Clone, Debug, PartialEq)]
pub struct FileMesh {
    /// The mesh, with an inverse bind transform for each joint of the file.
    pub mesh: SkinnedMesh,
    /// Parents of the file's joints, which precede their children.
    pub parents: Vec<Option<JointId>>,
    /// The parts of the mesh in the order of its triangles.
    pub parts: Vec<SkinPart>,
}
