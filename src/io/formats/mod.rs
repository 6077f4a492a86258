//! The table of file formats.
//!
//! [`FileFormat::ALL`] has a row for each format. Help texts, dialogs, errors and the list of
//! exports are made from it.

pub mod bvh;
pub mod csv;
pub mod document;
pub mod gltf;
pub mod js3d;
pub mod obj;
pub mod urdf;

use std::borrow::Cow;
use std::ffi::OsStr;
use std::fmt;
use std::path::Path;
use std::pin::Pin;

use serde::de::{Deserializer as _, Error as _, IgnoredAny, MapAccess, Visitor};
use thiserror::Error;

use super::error::OpenError;
use super::exported::{
    Cancelled, ExportKind, ExportOption, ExportOptions, Exported, MotionError, Progress,
};
use super::foreign::ForeignFormat;
use super::json::{FieldError, JsonPath, Whole};
use super::opened::{OpenOptions, Opened, Upwards};
use super::source::Source;
use crate::document::Document;
use gltf::GlbError;
use obj::ObjError;

/// A file format.
#[derive(Clone, Copy)]
pub struct FileFormat {
    /// Title in texts that name the extension, too; `None` for well-known extensions.
    pub title: Option<&'static str>,
    /// File extensions without the dot. Files are written with the first one.
    pub extensions: &'static [&'static str],
    /// Content of a file.
    pub holds: &'static str,
    /// Reader of a rig; `None` for formats that are only written.
    pub reader: Option<Reader>,
    /// Writer; `None` for formats that are only read.
    pub writer: Option<Writer>,
}

/// The reading of a rig from files of a format.
#[derive(Clone, Copy)]
pub struct Reader {
    signature: Signature,
    /// True if files have meshes on their skeletons, which the skin of a document can refer to.
    has_skins: bool,
    /// The axis that points up in all files, as the format says; `None` if it does not say.
    says_up: Option<Upwards>,
    /// Maximum size of a file in bytes.
    most_bytes: u64,
    read: fn(&Source, &OpenOptions) -> Result<Opened, OpenError>,
    /// The former version of the format, if a file that cannot be read has it.
    former: fn(&Source) -> Option<ForeignFormat>,
}

/// The beginning of a file, by which its format is detected.
#[derive(Clone, Copy)]
enum Signature {
    /// A JSON object with this key; the text says what such a file is.
    Key(&'static str, &'static str),
    /// A text for which this is true.
    Text(fn(&str) -> bool),
}

/// The writing of files of a format.
#[derive(Clone, Copy)]
pub enum Writer {
    /// [`save`](document::save): the content depends on the folder of the file.
    Save,
    /// An export.
    Export(ExportKind, WriteContent),
}

/// Converts a document to the content of an exported file.
pub type WriteContent = for<'a> fn(&'a Document, &'a ExportOptions, &'a Progress) -> ContentJob<'a>;

/// A running [`WriteContent`].
pub type ContentJob<'a> = Pin<Box<dyn Future<Output = Result<Exported, ContentError>> + 'a>>;

/// The reason why a format cannot hold a document.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ContentError {
    /// The export was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// glTF cannot hold the document.
    #[error(transparent)]
    Glb(GlbError),
    /// The motion cannot be exported.
    #[error(transparent)]
    Motion(MotionError),
    /// The mesh cannot be exported.
    #[error(transparent)]
    Obj(#[from] ObjError),
}

impl FileFormat {
    /// All formats, in the order in which texts list them.
    pub const ALL: &'static [Self] = &[
        Self::DOCUMENT,
        Self {
            title: Some("Scotty3D scene"),
            extensions: &["js3d"],
            holds: "skeletons with skin and motion",
            reader: Some(Reader {
                signature: Signature::Key(js3d::KEY, "a .js3d file of Scotty3D"),
                has_skins: true,
                says_up: None,
                most_bytes: OpenError::MAX_BYTES,
                read: js3d::read,
                former: |_| None,
            }),
            writer: None,
        },
        Self {
            title: None,
            extensions: &["glb", "gltf"],
            holds: "joints, skinned mesh and motion",
            reader: Some(Reader {
                signature: Signature::Key(gltf::KEY, "glTF"),
                has_skins: true,
                says_up: Some(Upwards::Y),
                most_bytes: OpenError::MAX_GLTF_BYTES,
                read: gltf::read,
                former: gltf::former,
            }),
            writer: Some(Writer::Export(
                ExportKind {
                    name: "GLB",
                    label: ".glb",
                    ending: ".glb",
                    help: "skinned, animated model in metres (binary glTF)",
                    tooltip: "glTF: a skinned, animated model for Blender, Unity, Unreal, three.js",
                    options: &[ExportOption::FrameRate, ExportOption::Metres],
                },
                |document, options, progress| {
                    Box::pin(async move {
                        let bytes = gltf::glb(document, options.fps, progress).await?;
                        Ok(Exported { bytes, notes: Vec::new() })
                    })
                },
            )),
        },
        Self {
            title: None,
            extensions: &["bvh"],
            holds: "joints and motion",
            reader: Some(Reader {
                signature: Signature::Text(bvh::is_bvh),
                has_skins: false,
                says_up: None,
                most_bytes: OpenError::MAX_BYTES,
                read: bvh::read,
                former: |_| None,
            }),
            writer: Some(Writer::Export(
                ExportKind {
                    name: "BVH",
                    label: ".bvh",
                    ending: ".bvh",
                    help: "joints and their motion, for animation programs",
                    tooltip: "Joints and their motion, the motion capture format",
                    options: &[ExportOption::FrameRate, ExportOption::Unit, ExportOption::Metres],
                },
                |document, options, progress| {
                    Box::pin(async move {
                        Ok(bvh::to_bvh(document, options.fps, options.unit, progress).await?)
                    })
                },
            )),
        },
        Self {
            title: None,
            extensions: &["urdf"],
            holds: "robots",
            reader: Some(Reader {
                signature: Signature::Text(urdf::is_urdf),
                has_skins: true,
                says_up: Some(Upwards::Z),
                most_bytes: OpenError::MAX_BYTES,
                read: urdf::read,
                former: |_| None,
            }),
            writer: None,
        },
        Self {
            title: None,
            extensions: &["csv"],
            holds: "positions of joints over time",
            reader: None,
            writer: Some(Writer::Export(
                ExportKind {
                    name: "CSV",
                    label: ".csv",
                    ending: ".csv",
                    help: "positions of all joints, one row per frame",
                    tooltip: "A table of joint positions, one row a frame",
                    options: &[ExportOption::FrameRate],
                },
                |document, options, progress| {
                    Box::pin(async move { Ok(csv::to_csv(document, options.fps, progress).await?) })
                },
            )),
        },
        Self {
            title: None,
            extensions: &["obj"],
            holds: "mesh without joints",
            reader: Some(Reader {
                signature: Signature::Text(obj::is_obj),
                has_skins: true,
                says_up: None,
                most_bytes: OpenError::MAX_BYTES,
                read: obj::read,
                former: |_| None,
            }),
            writer: Some(Writer::Export(
                ExportKind {
                    name: "OBJ",
                    label: ".obj",
                    ending: ".obj",
                    help: "posed mesh of the skin at --time: world space, scene units, y up",
                    tooltip: "The posed mesh of the skin in the current frame",
                    options: &[ExportOption::Time, ExportOption::Skinning],
                },
                |document, options, _| {
                    Box::pin(async move {
                        let time = options.time.unwrap_or(document.timeline.start);
                        Ok(obj::to_obj(document, time, options.skinning)?)
                    })
                },
            )),
        },
    ];

    /// The program's own format.
    pub const DOCUMENT: Self = Self {
        title: Some("ik-arm document"),
        extensions: &["json"],
        holds: "a document of ik-arm, with skeleton, skin, keys and timeline",
        reader: Some(Reader {
            signature: Signature::Key(document::KEY, "a document of ik-arm"),
            has_skins: false,
            says_up: Some(Upwards::Y),
            most_bytes: OpenError::MAX_BYTES,
            read: document::read,
            former: |_| None,
        }),
        writer: Some(Writer::Save),
    };

    /// Returns whether files of the format are written to this path, judged by its extension.
    pub fn is_written_to(&self, path: &Path) -> bool {
        let extension = path.extension().and_then(OsStr::to_str).unwrap_or_default();
        self.writer.is_some() && extension.eq_ignore_ascii_case(self.extension())
    }

    /// The extension of written files, without the dot.
    pub fn extension(&self) -> &'static str {
        self.extensions.first().copied().unwrap_or_default()
    }

    /// Returns whether this is the program's own format.
    pub fn is_document(&self) -> bool {
        matches!(self.writer, Some(Writer::Save))
    }

    /// Returns whether an option applies to an export.
    pub fn takes(&self, option: ExportOption) -> bool {
        matches!(self.writer, Some(Writer::Export(kind, _)) if kind.takes(option))
    }

    /// Formats that hold a rig over all times and can be both written and read again.
    pub fn convertible() -> impl Iterator<Item = Self> {
        let all = Self::ALL.iter().copied();
        let both = all.filter(|format| format.reader.is_some() && format.writer.is_some());
        both.filter(|format| !format.takes(ExportOption::Time))
    }

    /// Extensions, without the dot, of the files that can be read.
    pub fn readable() -> Vec<&'static str> {
        let formats = Self::ALL.iter().filter(|format| format.reader.is_some());
        formats.flat_map(|format| format.extensions).copied().collect()
    }

    /// Extensions, without the dot, of the files from which a skin can take its mesh; sorted.
    pub fn with_skins() -> Vec<&'static str> {
        let has_skins = |format: &&Self| format.reader.is_some_and(|reader| reader.has_skins);
        let formats = Self::ALL.iter().filter(has_skins);
        let mut extensions: Vec<_> =
            formats.flat_map(|format| format.extensions).copied().collect();
        extensions.sort_unstable();
        extensions
    }

    /// The files that can be read except for documents, like `Scotty3D scene (.js3d), .bvh or
    /// .glb`.
    pub fn other_inputs() -> String {
        let readable = |format: &&Self| format.reader.is_some();
        let others = || Self::ALL[1..].iter().filter(readable);
        let titled = others().filter(|format| format.title.is_some()).map(Self::titled);
        let plain = others().filter(|format| format.title.is_none());
        let mut plain: Vec<_> = plain.flat_map(|format| format.extensions).map(dotted).collect();
        plain.sort_unstable();
        enumerated(&titled.chain(plain).collect::<Vec<_>>(), "or")
    }

    /// All files that can be read, like `ik-arm document (.json), Scotty3D scene (.js3d) or .bvh`.
    pub fn inputs() -> String {
        format!("{}, {}", Self::DOCUMENT.titled(), Self::other_inputs())
    }

    /// Title and extension, like `ik-arm document (.json)`, or the extension of a format without
    /// title.
    pub fn titled(&self) -> String {
        let extension = dotted(&self.extension());
        self.title.map_or_else(|| extension.clone(), |title| format!("{title} ({extension})"))
    }
}

/// An extension with its dot.
pub fn dotted(extension: &&str) -> String {
    format!(".{extension}")
}

/// Words in a sentence, like `a, b or c`; `last` is the word before the last one.
pub fn enumerated(words: &[String], last: &str) -> String {
    match words {
        [] => String::new(),
        [word] => word.clone(),
        [before @ .., word] => format!("{} {last} {word}", before.join(", ")),
    }
}

impl Reader {
    /// Detects the format by the first word or key that identifies it, and parses no further.
    pub fn detect(source: &Source) -> Result<Self, OpenError> {
        if let Some(foreign) = source.foreign() {
            return Err(foreign_error(source, foreign));
        }
        if source.binary().is_some() {
            return Self::by_key(gltf::KEY).ok_or_else(|| no_key(source));
        }
        let is_text = |reader: &Self| match reader.signature {
            Signature::Text(is_text) => is_text(source.text()),
            Signature::Key(..) => false,
        };
        if let Some(reader) = Self::all().find(is_text) {
            return Ok(reader);
        }
        let mut found = None;
        let mut json = serde_json::Deserializer::from_str(source.text());
        let read = json.deserialize_map(FormatVisitor(&mut found)).and_then(|()| json.end());
        match (found, read) {
            (Some(reader), _) => Ok(reader),
            (None, Err(error)) => Err(source.parse_error(&JsonPath::root(), &error)),
            (None, Ok(())) => Err(no_key(source)),
        }
    }

    fn all() -> impl Iterator<Item = Self> {
        FileFormat::ALL.iter().filter_map(|format| format.reader)
    }

    fn by_key(key: &str) -> Option<Self> {
        Self::all().find(|reader| reader.key().is_some_and(|(own, _)| own == key))
    }

    fn key(&self) -> Option<(&'static str, &'static str)> {
        match self.signature {
            Signature::Key(key, kind) => Some((key, kind)),
            Signature::Text(_) => None,
        }
    }

    /// Returns whether this is the program's own format.
    pub fn is_own(&self) -> bool {
        self.key().is_some_and(|(key, _)| key == document::KEY)
    }

    /// Returns whether files have meshes on their skeletons.
    pub fn has_skins(&self) -> bool {
        self.has_skins
    }

    /// The axis that points up in all files, as the format says; `None` if it does not say.
    pub fn says_up(&self) -> Option<Upwards> {
        self.says_up
    }

    /// Maximum size of a file in bytes.
    pub fn most_bytes(&self) -> u64 {
        self.most_bytes
    }

    /// Reads the file.
    pub fn read(&self, source: &Source, options: &OpenOptions) -> Result<Opened, OpenError> {
        (self.read)(source, options).map_err(|error| match (self.former)(source) {
            Some(former) => foreign_error(source, former),
            None => error,
        })
    }
}

fn foreign_error(source: &Source, foreign: ForeignFormat) -> OpenError {
    let ForeignFormat { what, advice } = foreign;
    let extensions: Vec<_> = FileFormat::readable().iter().map(dotted).collect();
    let readable = enumerated(&extensions, "and");
    OpenError::Foreign { file: source.name().to_owned(), what, readable, advice }
}

/// The error of a JSON file without the key of a format.
fn no_key(source: &Source) -> OpenError {
    let keys = Reader::all().filter_map(|reader| reader.key());
    let keys: Vec<_> = keys.map(|(key, kind)| format!("{key:?} ({kind})")).collect();
    let reason = format!("must have {}", enumerated(&keys, "or"));
    source.error(&FieldError::new(JsonPath::root(), reason))
}

struct FormatVisitor<'a>(&'a mut Option<Reader>);

impl<'de> Visitor<'de> for FormatVisitor<'_> {
    type Value = ();

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("an object: {…}")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<(), A::Error> {
        while let Some(key) = map.next_key::<Cow<'_, str>>()? {
            let Some(reader) = Reader::by_key(&key) else {
                map.next_value::<IgnoredAny>()?;
                continue;
            };
            *self.0 = Some(reader);
            // A number can be the "scene" of a glTF file whose "asset" comes later.
            if key != js3d::KEY || map.next_value::<Whole>().is_err() {
                // Stops the parser; the caller ignores this error.
                return Err(A::Error::custom("the format is detected"));
            }
        }
        Ok(())
    }
}

/// Turns a nested `Cancelled` into [`ContentError::Cancelled`].
impl From<GlbError> for ContentError {
    fn from(error: GlbError) -> Self {
        match error {
            GlbError::Cancelled(cancelled) => Self::Cancelled(cancelled),
            error => Self::Glb(error),
        }
    }
}

/// Turns a nested `Cancelled` into [`ContentError::Cancelled`].
impl From<MotionError> for ContentError {
    fn from(error: MotionError) -> Self {
        match error {
            MotionError::Cancelled(cancelled) => Self::Cancelled(cancelled),
            error => Self::Motion(error),
        }
    }
}
