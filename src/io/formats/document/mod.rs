//! The program's own format: JSON, described in docs/files.md field by field.
//!
//! serde parses the text to [fields](DocumentFields), where `None` stands for a field that the file
//! leaves out. The fields are converted to a document: missing fields get defaults. Rules of single
//! numbers are checked while these are read, all other rules by the conversions, whose callers
//! [tell the path](AtField) of an error. Saving converts the document to fields, and serde writes
//! the fields as text.

mod follow_path;
mod keys;
mod posture;
mod skeleton;
mod skin;
mod targets;
mod version_2;

use core::f32::consts::FRAC_PI_2;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use crate::document::{Camera, Document, Overlay, SkeletonRig, Skin};
use crate::io::error::{OpenError, SaveError};
use crate::io::json::{
    Above0, AtField, FieldError, FieldWarnings, JsonNumber, JsonObject, JsonPoint, JsonSeconds,
    Whole, to_styled_json, value_or,
};
use crate::io::opened::{OpenOptions, Opened};
use crate::io::source::Source;
use crate::io::write::write;
use crate::rig::{SkinFile, SkinSource};
use follow_path::FollowPathList;
pub use keys::KeyFields;
use keys::{ChannelFields, TimelineFields, keys};
use posture::PostureFields;
use skeleton::SkeletonFields;
use skin::SkinFields;
use targets::{BalanceFields, SolverFields, TargetFields, add_targets};
use version_2::{ArmFields, RigFields, RigName};

/// The key by which a file is recognized.
pub const KEY: &str = "format";

/// Reads a document. The mesh of a skin that is in a file of its own is still to be read.
pub fn read(source: &Source, options: &OpenOptions) -> Result<Opened, OpenError> {
    if let Some(name) = &options.skeleton {
        let (file, name) = (source.name().to_owned(), name.clone());
        return Err(OpenError::NoSkeleton { file, name, names: Vec::new() });
    }
    // If the header is invalid, reading all fields fails, too, and its error names the exact field.
    if let Ok(JsonObject(header)) = source.parse::<JsonObject<Header>>(|_| {}) {
        header.check().map_err(|error| source.error(&error))?;
    }
    let mut warnings = FieldWarnings::default();
    let JsonObject(fields) = source.parse::<JsonObject<DocumentFields>>(|field| {
        warnings.push(field, "unknown field, ignored");
    })?;
    // In version 2, the default camera shows an arm whose file has none.
    let has_camera = fields.camera.is_some() || fields.rig == Some(RigName::Arm);
    let mut document = fields.document(&mut warnings).map_err(|error| source.error(&error))?;
    if !has_camera && !options.without_camera {
        document.camera = document.framing_camera();
    }
    Ok(Opened {
        order: document.skeleton().ids().collect(),
        document,
        warnings: source.warnings(&warnings),
        skeletons: Vec::new(),
        skeleton: None,
        animations: Vec::new(),
        animation: None,
    })
}

/// Converts a document to the text of a file. Reading this text returns the same document, bit for
/// bit.
///
/// # Errors
///
/// Fails if a number of the document is not finite.
pub fn to_json(document: &Document) -> Result<String, serde_json::Error> {
    to_styled_json(&DocumentFields::new(document))
}

/// Writes a document to a file, whole or not at all. The file of its skin's mesh is named by its
/// path from the folder of the document.
///
/// # Errors
///
/// Fails if the folder or the file cannot be written, the document is too large to be opened again,
/// or a number of it is not finite.
pub fn save(document: &Document, path: &Path) -> Result<(), SaveError> {
    let folder = path.parent().unwrap_or(Path::new(""));
    let document = with_relative_skin(document, folder);
    let text = to_json(&document)?;
    if text.len() as u64 > OpenError::MAX_BYTES {
        return Err(SaveError::TooLarge { got: text.len() as u64 >> 20 });
    }
    Ok(write(path, text.as_bytes())?)
}

/// The document with the path of its skin's file relative to `folder`, if both exist and that is
/// possible; otherwise absolute.
fn with_relative_skin(document: &Document, folder: &Path) -> Document {
    let mut document = document.clone();
    if let Some(Skin { source: SkinSource::Mesh(skin), .. }) = &mut document.rig.skin {
        let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
        // Without links and `..`, whose folders would be others from the document's own folder.
        let relative = |file: &SkinFile| -> Option<PathBuf> {
            pathdiff::diff_paths(file.path.canonicalize().ok()?, folder.canonicalize().ok()?)
        };
        *skin = skin.with_path(|file| relative(file).unwrap_or_else(|| file.path.clone()));
    }
    document
}

const FORMAT: &str = "ik-arm";
/// The version of files that are written.
const VERSION: u32 = 3;
/// The earliest version of files that are read.
const EARLIEST: u32 = 2;

/// The first two fields: the name of the format and its version.
#[derive(Deserialize)]
struct Header {
    format: String,
    version: Whole,
}

impl Header {
    /// Fails if this program cannot read the format or the version.
    fn check(&self) -> Result<(), FieldError> {
        if self.format != FORMAT {
            return Err(format!("must be {FORMAT:?}, got {:?}", self.format)).at("format");
        }
        let reason = match self.version.0 {
            EARLIEST..=VERSION => return Ok(()),
            version if version > VERSION => {
                format!("must be at most {VERSION}, got {version}, which needs a newer ik-arm")
            }
            version => {
                format!(
                    "must be {EARLIEST} or {VERSION}, the versions that are read, got {version}"
                )
            }
        };
        Err(reason).at("version")
    }
}

#[derive(Serialize, Deserialize)]
struct DocumentFields {
    format: String,
    version: Whole,
    /// In version 2, the rig that is shown.
    #[serde(skip_serializing)]
    rig: Option<RigName>,
    /// In version 2, the arm.
    #[serde(skip_serializing)]
    arm: Option<JsonObject<ArmFields>>,
    skeleton: Option<JsonObject<SkeletonFields>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    skin: Option<JsonObject<SkinFields>>,
    targets: Option<Vec<JsonObject<TargetFields>>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    balance: Option<JsonObject<BalanceFields>>,
    solver: Option<JsonObject<SolverFields>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    posture: Option<JsonObject<PostureFields>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    track_start: Option<JsonSeconds>,
    follow_path: Option<FollowPathList>,
    #[serde(skip_serializing_if = "Option::is_none")]
    channels: Option<Vec<JsonObject<ChannelFields>>>,
    timeline: Option<JsonObject<TimelineFields>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    metres_per_unit: Option<Above0>,
    #[serde(skip_serializing_if = "Option::is_none")]
    animation_name: Option<String>,
    camera: Option<JsonObject<CameraFields>>,
    /// In version 2, the camera of the rig that is not shown.
    #[serde(skip_serializing)]
    #[expect(dead_code, reason = "later versions have one rig, with one camera")]
    other_camera: Option<serde::de::IgnoredAny>,
    overlays: Option<Vec<Overlay>>,
}

impl DocumentFields {
    fn new(document: &Document) -> Self {
        let SkeletonRig { skeleton, skin, targets, balance, follow_paths, posture, .. } =
            &document.rig;
        let posture = posture.as_ref().map(|posture| PostureFields::new(posture));
        let channels = (!document.keys.is_empty()).then(|| ChannelFields::all(&document.keys));
        Self {
            format: FORMAT.to_owned(),
            version: Whole(VERSION),
            rig: None,
            arm: None,
            skeleton: Some(JsonObject(SkeletonFields::new(skeleton))),
            skin: skin.as_ref().map(SkinFields::new).map(JsonObject),
            targets: Some(targets.iter().map(TargetFields::new).map(JsonObject).collect()),
            balance: balance.as_ref().map(BalanceFields::new).map(JsonObject),
            solver: Some(JsonObject(SolverFields::new(&document.rig))),
            posture: posture.map(JsonObject),
            track_start: document.track_start.map(JsonSeconds::from),
            follow_path: Some(FollowPathList::new(follow_paths)),
            channels,
            timeline: Some(JsonObject(TimelineFields::new(document.timeline))),
            metres_per_unit: document.metres_per_unit.map(Above0::from),
            animation_name: document.animation_name.clone(),
            camera: Some(JsonObject(CameraFields::new(&document.camera))),
            other_camera: None,
            overlays: Some(document.display.overlays().collect()),
        }
    }

    fn document(self, warnings: &mut FieldWarnings) -> Result<Document, FieldError> {
        let is_of_version_2 = self.version == Whole(2);
        let fields = RigFields { shown: self.rig, arm: self.arm };
        let mut rig = SkeletonRig::default();
        if let Some(JsonObject(fields)) = self.skeleton {
            rig.skeleton = fields.skeleton(warnings).at("skeleton")?.into();
        }
        if let Some(JsonObject(fields)) = self.skin {
            rig.skin = Some(fields.skin(&rig.skeleton).at("skin")?);
        }
        add_targets(&mut rig, self.targets.unwrap_or_default()).at("targets")?;
        if let Some(JsonObject(fields)) = self.balance {
            rig.balance = Some(fields.balance().at("balance")?);
        }
        if let Some(JsonObject(fields)) = self.solver {
            fields.set(&mut rig).at("solver")?;
        }
        if let Some(JsonObject(fields)) = self.posture {
            let posture = fields.posture(rig.skeleton.joints().len()).at("posture")?;
            rig.posture = (!posture.is_empty()).then(|| posture.into());
        }
        if let Some(paths) = self.follow_path {
            paths.add_to(&mut rig).at("follow_path")?;
        }
        let camera = self.camera.map(|JsonObject(fields)| fields.camera().at("camera"));
        let timeline = self.timeline.map(|JsonObject(fields)| fields.timeline().at("timeline"));
        let mut document = Document {
            timeline: timeline.transpose()?.unwrap_or_default(),
            track_start: self.track_start.map(f64::from),
            camera: camera.transpose()?.unwrap_or_default(),
            metres_per_unit: self.metres_per_unit.map(f32::from),
            animation_name: self.animation_name,
            ..Document::new(rig)
        };
        let overlays = self.overlays.map(FromIterator::from_iter);
        let channels = self.channels.unwrap_or_default();
        if is_of_version_2 || fields.shown.is_some() {
            return fields.document(document, overlays, channels, is_of_version_2, warnings);
        }
        document.display = overlays.unwrap_or_default();
        document.keys = keys(channels, &document).at("channels")?;
        Ok(document)
    }
}

#[derive(Serialize, Deserialize)]
struct CameraFields {
    target: Option<JsonPoint>,
    yaw: Option<JsonNumber>,
    pitch: Option<JsonNumber>,
    distance: Option<Above0>,
    orthographic: Option<bool>,
}

impl CameraFields {
    fn new(camera: &Camera) -> Self {
        Self {
            target: Some(camera.target.into()),
            yaw: Some(camera.yaw.into()),
            pitch: Some(camera.pitch.into()),
            distance: Some(camera.distance.into()),
            orthographic: Some(camera.orthographic),
        }
    }

    fn camera(self) -> Result<Camera, FieldError> {
        let default = Camera::default();
        let pitch = value_or(self.pitch, default.pitch);
        if pitch.abs() > FRAC_PI_2 {
            let rule = format!("must be from {} to {FRAC_PI_2}", -FRAC_PI_2);
            return Err(format!("{rule}, got {pitch}")).at("pitch");
        }
        Ok(Camera {
            target: value_or(self.target, default.target),
            yaw: value_or(self.yaw, default.yaw),
            pitch,
            distance: value_or(self.distance, default.distance),
            orthographic: self.orthographic.unwrap_or(default.orthographic),
        })
    }
}
