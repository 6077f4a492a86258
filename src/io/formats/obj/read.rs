use std::collections::HashMap;

use glam::{Affine3A, Vec3};

use super::material::{self, ObjMaterial};
use super::mesh::{LineError, ObjMesh};
use crate::document::{Document, SkeletonRig};
use crate::io::error::{OpenError, Remark};
use crate::io::opened::{OpenOptions, Opened, attach_skin};
use crate::io::source::Source;
use crate::io::texture::TextureReader;
use crate::kinematics::Shared;
use crate::kinematics::skeleton::{Joint, JointId, Skeleton};
use crate::kinematics::skin::{SkinnedMesh, VertexWeights};
use crate::rig::{FileMesh, PartLook, SkinFile, SkinPart, SkinTexture};

/// Name of the joint that the mesh follows, and of the skeleton.
const ROOT: &str = "root";

/// Returns whether a text is OBJ, judged by the first word that is no comment.
pub fn is_obj(text: &str) -> bool {
    let mut lines = text.lines().map(str::trim_start);
    let first = lines.find(|line| !line.is_empty() && !line.starts_with('#')).unwrap_or_default();
    let word = first.split_whitespace().next().unwrap_or_default();
    let has_more = first.split_whitespace().nth(1).is_some();
    // Some programs begin with a group without a name.
    let is_group = word == "g";
    is_group || has_more && matches!(word, "v" | "vn" | "vt" | "o" | "s" | "mtllib" | "usemtl")
}

/// Reads the mesh of a file, on a joint at the origin.
pub fn read(source: &Source, options: &OpenOptions) -> Result<Opened, OpenError> {
    let skeletons = vec![ROOT.to_owned()];
    if let Some(name) = options.skeleton.as_ref().filter(|name| *name != ROOT) {
        let file = source.name().to_owned();
        return Err(OpenError::NoSkeleton { file, name: name.clone(), names: skeletons });
    }
    let error = |at: usize, reason: &str| {
        let remark = source.remark_about(at, "", reason);
        OpenError::Content { file: source.name().to_owned(), remark }
    };
    let mesh =
        ObjMesh::new(source.text()).map_err(|LineError { at, reason }| error(at, &reason))?;
    let end = source.text().len();
    if mesh.triangles() == 0 {
        return Err(error(end, "must have at least one face (f)"));
    }
    for (what, got, most) in [
        ("vertices", mesh.len(), SkinnedMesh::MOST_VERTICES),
        ("triangles", mesh.triangles(), SkinnedMesh::MOST_TRIANGLES),
    ] {
        if got > most {
            return Err(error(end, &format!("must have at most {most} {what}, got {got}")));
        }
    }
    let mut materials = ObjMaterials::new(source);
    materials.read_libraries(&mesh.libraries);
    let mut parts = Vec::with_capacity(mesh.parts.len());
    for (name, triangles) in &mesh.parts {
        parts.push(materials.part(name, triangles.len()));
    }
    materials.warn_of_unknown(mesh.parts.iter().map(|(name, _)| name));
    let triangles = mesh.mesh();
    let weights = vec![VertexWeights::rigid(JointId::new(0)); triangles.positions.len()];
    let skinned = SkinnedMesh::new(triangles, weights, vec![Affine3A::IDENTITY])
        .map_err(|invalid| error(end, &invalid.to_string()))?;
    let root = Joint { locked: true, ..Joint::new(ROOT, None, Vec3::ZERO) };
    let skeleton = Skeleton::from_joints(vec![root]).map_err(|it| error(end, &it.to_string()))?;
    let mut document = Document::new(SkeletonRig::new(skeleton));
    let file = source.path().map(|path| SkinFile {
        path: path.into(),
        checksum: materials.checksum.finalize(),
        skeleton: ROOT.to_owned(),
        animation: None,
    });
    let in_file = FileMesh { mesh: skinned, parents: vec![None], parts };
    attach_skin(&mut document, in_file, file, vec![Some(JointId::new(0))]);
    document.camera = document.framing_camera();
    Ok(Opened {
        document,
        warnings: materials.warnings,
        order: vec![JointId::new(0)],
        skeletons,
        skeleton: Some(0),
        animations: Vec::new(),
        animation: None,
    })
}

/// The materials of the files that a file names.
struct ObjMaterials<'a> {
    source: &'a Source,
    materials: HashMap<String, ObjMaterial>,
    images: TextureReader,
    /// The images that are read already; `None` for those that cannot be.
    textures: HashMap<String, Option<Shared<SkinTexture>>>,
    checksum: crc32fast::Hasher,
    warnings: Vec<Remark>,
}

impl<'a> ObjMaterials<'a> {
    fn new(source: &'a Source) -> Self {
        Self {
            source,
            materials: HashMap::new(),
            images: TextureReader::default(),
            textures: HashMap::new(),
            checksum: source.checksum(),
            warnings: Vec::new(),
        }
    }

    /// Reads the materials of these files, each with the place of its line. Warns of those that cannot
    /// be read.
    fn read_libraries(&mut self, libraries: &[(String, usize)]) {
        /// Maximum number of bytes of a file with materials.
        const MOST: usize = 16 << 20;
        /// Maximum number of files that are read.
        const MOST_FILES: usize = 100;
        for (name, at) in libraries.iter().take(MOST_FILES) {
            let warning = match self.source.neighbour(name, MOST) {
                Err(reason) => Some(format!("{reason}; its materials are white")),
                Ok(bytes) => {
                    self.checksum.update(&bytes);
                    let wrong =
                        material::read(&String::from_utf8_lossy(&bytes), &mut self.materials);
                    wrong.first().map(|first| match wrong.len() {
                        1 => format!("{name}, {first}"),
                        more => format!("{name}, {first}, and {} more lines like this", more - 1),
                    })
                }
            };
            self.warnings.extend(warning.map(|it| self.source.remark_about(*at, "mtllib", &it)));
        }
    }

    /// Warns of the materials of faces that none of the files that could be read has.
    fn warn_of_unknown<'n>(&mut self, names: impl Iterator<Item = &'n String>) {
        if self.materials.is_empty() {
            return;
        }
        let is_unknown = |name: &&String| !name.is_empty() && !self.materials.contains_key(*name);
        let mut unknown = names.filter(is_unknown);
        let Some(first) = unknown.next() else { return };
        let others = match unknown.count() {
            0 => String::new(),
            others => format!(", nor {others} others of the faces"),
        };
        let reason =
            format!("usemtl: no .mtl file has the material {first:?}{others}; its faces are white");
        self.warnings.push(Remark::new(reason));
    }

    /// The part of a skin with the material of this name; white, if there is none.
    fn part(&mut self, name: &str, triangles: usize) -> SkinPart {
        let material = self.materials.get(name).cloned().unwrap_or_default();
        let texture = material.texture.as_ref().and_then(|file| self.texture(file));
        SkinPart {
            colour: material.colour,
            texture,
            look: PartLook {
                // Faces of such files are often seen from both sides.
                is_double_sided: true,
                opacity: (material.opacity < 1.0).then_some(material.opacity),
                emission: material.emission,
                ..PartLook::default()
            },
            ..SkinPart::white(triangles)
        }
    }

    /// The image in a file. Warns if it cannot be read.
    fn texture(&mut self, file: &str) -> Option<Shared<SkinTexture>> {
        /// Maximum number of bytes of an image.
        const MOST: usize = 256 << 20;
        if let Some(known) = self.textures.get(file) {
            return known.clone();
        }
        let read = self.source.neighbour(file, MOST).and_then(|bytes| {
            self.checksum.update(&bytes);
            self.images.read(bytes).map_err(|reason| format!("{file}: {reason}"))
        });
        let texture = read.map(Shared::from).map_err(|reason| {
            self.warnings.push(Remark::new(format!("{reason}; the texture is left out")));
        });
        self.textures.insert(file.to_owned(), texture.clone().ok());
        texture.ok()
    }
}
