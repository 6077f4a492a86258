//! The formats of exports, the names of their files and their errors.

use std::ffi::{OsStr, OsString};
use std::path::{Path, PathBuf};

use thiserror::Error;

use crate::io::{
    Cancelled, ContentError, ExportKind, ExportOption, FileFormat, MotionError, WriteContent,
    WriteError, Writer, dotted,
};
use crate::render::{DrawError, GpuError};

/// A format that an export can write.
#[derive(Clone, Copy)]
pub struct ExportFormat {
    /// Names, descriptions and options.
    pub kind: ExportKind,
    pub(super) content: ExportContent,
}

/// The way in which the content of an export is made.
#[derive(Clone, Copy)]
pub(super) enum ExportContent {
    /// By a writer of [`FileFormat::ALL`].
    Written(WriteContent),
    /// One picture.
    Picture,
    /// One picture file per frame.
    PictureSequence,
    /// All frames in one animated picture.
    AnimatedPicture,
}

/// The formats of pictures, beside those of [`FileFormat::ALL`].
const PICTURES: [ExportFormat; 3] = [
    ExportFormat {
        kind: ExportKind {
            name: "PNG",
            label: ".png",
            ending: ".png",
            help: "one picture, at --time",
            tooltip: "One picture of the current frame",
            options: &[ExportOption::Time, ExportOption::Picture],
        },
        content: ExportContent::Picture,
    },
    ExportFormat {
        kind: ExportKind {
            name: "PNG sequence",
            label: ".png with a #",
            ending: "_####.png",
            help: "one picture per frame: walk_####.png gives walk_0000.png, walk_0001.png, ...",
            tooltip: "One picture a frame; #### becomes the frame number",
            options: &[ExportOption::FrameRate, ExportOption::Picture],
        },
        content: ExportContent::PictureSequence,
    },
    ExportFormat {
        kind: ExportKind {
            name: "Animated PNG",
            label: ".apng",
            ending: ".apng",
            help: "all frames in one animated picture",
            tooltip: "One picture file that plays the motion",
            options: &[ExportOption::FrameRate, ExportOption::Picture],
        },
        content: ExportContent::AnimatedPicture,
    },
];

/// A path whose extension is not that of an [`ExportFormat`].
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[error("{path}: extension must be one of {}", extensions())]
pub struct FormatError {
    path: String,
}

impl ExportFormat {
    /// All formats, in the order in which texts list them.
    pub fn all() -> impl Iterator<Item = Self> {
        let written = FileFormat::ALL.iter().filter_map(|format| match format.writer? {
            Writer::Save => None,
            Writer::Export(kind, write) => {
                Some(Self { kind, content: ExportContent::Written(write) })
            }
        });
        written.chain(PICTURES)
    }

    /// All file extensions without the dot.
    pub fn extensions() -> Vec<&'static str> {
        let mut extensions: Vec<_> = Self::all().map(|format| format.kind.extension()).collect();
        extensions.dedup();
        extensions
    }

    /// Returns the format that a file name selects by its extension and, for PNG, by whether the
    /// name contains `#`.
    ///
    /// # Errors
    ///
    /// Fails if the extension is unknown.
    pub fn of(path: &Path) -> Result<Self, FormatError> {
        let extension = path.extension().and_then(OsStr::to_str).unwrap_or_default();
        let is_numbered = NumberedName::new(path).is_some();
        let mut matching = Self::all().filter(|format| {
            extension.eq_ignore_ascii_case(format.kind.extension())
                && (is_numbered || !format.is_sequence())
        });
        let first = matching.next();
        let sequence = matching.find(Self::is_sequence);
        sequence.or(first).ok_or_else(|| FormatError { path: path.display().to_string() })
    }

    /// Returns whether each frame has a file of its own.
    pub fn is_sequence(&self) -> bool {
        matches!(self.content, ExportContent::PictureSequence)
    }

    /// Returns whether an option applies.
    pub fn takes(&self, option: ExportOption) -> bool {
        self.kind.takes(option)
    }
}

impl PartialEq for ExportFormat {
    fn eq(&self, other: &Self) -> bool {
        self.kind == other.kind
    }
}

impl Eq for ExportFormat {}

fn extensions() -> String {
    ExportFormat::extensions().iter().map(dotted).collect::<Vec<_>>().join(", ")
}

/// Returns the existing file that an export to `path` would overwrite, or the first of several
/// existing files of a sequence. `None` if no file would be overwritten.
pub fn existing(path: &Path) -> Option<PathBuf> {
    let is_sequence = ExportFormat::of(path).is_ok_and(|format| format.is_sequence());
    let Some(numbered) = NumberedName::new(path).filter(|_| is_sequence) else {
        return path.exists().then(|| path.to_owned());
    };
    let folder = path.parent().filter(|folder| *folder != Path::new(""));
    let files = std::fs::read_dir(folder.unwrap_or(Path::new("."))).ok()?;
    let found = files.flatten().filter(|file| numbered.contains(&file.file_name()));
    found.map(|file| file.path()).min()
}

/// Placeholder for one digit of a frame's number.
const DIGIT: char = '#';

/// A file name with a placeholder for a number: the last run of `#` in the name.
#[derive(Clone)]
pub(super) struct NumberedName {
    before: String,
    digits: usize,
    after: String,
}

impl NumberedName {
    /// Finds the placeholder; `None` if the name has no `#` or is not Unicode.
    pub fn new(path: &Path) -> Option<Self> {
        let name = path.file_name()?.to_str()?;
        let end = name.rfind(DIGIT)? + DIGIT.len_utf8();
        let (run, after) = name.split_at_checked(end)?;
        let before = run.trim_end_matches(DIGIT);
        Some(Self {
            before: before.to_owned(),
            digits: run.len() - before.len(),
            after: after.to_owned(),
        })
    }

    /// Returns whether `name` is the name of a file of the sequence, with a number in place of the
    /// placeholder.
    pub fn contains(&self, name: &OsStr) -> bool {
        let digits = name.to_str().and_then(|name| {
            name.strip_prefix(self.before.as_str())?.strip_suffix(self.after.as_str())
        });
        digits.is_some_and(|digits| {
            digits.len() >= self.digits && digits.bytes().all(|digit| digit.is_ascii_digit())
        })
    }

    /// The file name with `number` in place of the placeholder. The number is padded with zeros to
    /// the length of the placeholder.
    pub fn with_number(&self, number: usize) -> OsString {
        const MAX_DIGITS: usize = 64;
        let Self { before, after, .. } = self;
        let digits = self.digits.min(MAX_DIGITS);
        format!("{before}{number:0digits$}{after}").into()
    }
}

/// Reasons why no file is exported.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ExportError {
    /// The export was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// The path selects no format.
    #[error(transparent)]
    Format(#[from] FormatError),
    /// The format cannot hold the document.
    #[error(transparent)]
    Content(ContentError),
    /// The time of a single picture is not finite.
    #[error("time must be a finite number of seconds, got {0}")]
    Time(f64),
    /// There is no graphics device for pictures.
    #[error(transparent)]
    Gpu(#[from] GpuError),
    /// A picture could not be drawn.
    #[error(transparent)]
    Draw(#[from] DrawError),
    /// A picture could not be encoded.
    #[error("cannot encode PNG: {0}")]
    Png(#[from] png::EncodingError),
    /// An animated picture has too many frames.
    #[error("an animated PNG must have at most {max} frames, got {0}", max = u32::MAX)]
    Frames(usize),
    /// The file could not be written.
    #[error(transparent)]
    Write(#[from] WriteError),
}

impl ExportError {
    /// Returns whether the error is about the file to write, or about no file, rather than about
    /// the document.
    pub fn is_about_output(&self) -> bool {
        match self {
            Self::Cancelled(_) | Self::Format(_) | Self::Gpu(_) | Self::Write(_) => true,
            Self::Content(_) | Self::Time(_) | Self::Draw(_) | Self::Png(_) | Self::Frames(_) => {
                false
            }
        }
    }
}

/// Turns a nested `Cancelled` into [`ExportError::Cancelled`].
impl From<ContentError> for ExportError {
    fn from(error: ContentError) -> Self {
        match error {
            ContentError::Cancelled(cancelled) => Self::Cancelled(cancelled),
            error => Self::Content(error),
        }
    }
}

impl From<MotionError> for ExportError {
    fn from(error: MotionError) -> Self {
        ContentError::from(error).into()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_extension_selects_the_format() {
        for (path, name) in [
            ("a.glb", "GLB"),
            ("b/a.BVH", "BVH"),
            ("a#.csv", "CSV"),
            ("a#/a.png", "PNG"),
            ("a_##.png", "PNG sequence"),
            ("a.tar.Apng", "Animated PNG"),
        ] {
            let format = ExportFormat::of(Path::new(path)).expect("a format");
            assert_eq!(format.kind.name, name, "{path}");
        }
        for path in ["a", "a.mp4", ".png", "png", ""] {
            let error = ExportFormat::of(Path::new(path)).err().expect("no format").to_string();
            assert!(error.contains(".glb, .bvh, .csv, .obj, .png, .apng"), "{error}");
        }
    }

    #[test]
    fn an_existing_frame_of_a_sequence_is_found() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("walk_##.png");
        assert_eq!(existing(&path), None);
        for name in ["walk_x1.png", "walk_1.png", "swalk_01.png", "walk_01.jpg", "walk_##.png"] {
            std::fs::write(folder.path().join(name), "").expect("written");
        }
        assert_eq!(existing(&path), None, "none of these is a frame");
        for name in ["walk_101.png", "walk_07.png"] {
            std::fs::write(folder.path().join(name), "").expect("written");
        }
        assert_eq!(existing(&path), Some(folder.path().join("walk_07.png")));
        assert!(existing(&folder.path().join("walk_1.png")).is_some());
    }

    #[test]
    fn a_number_replaces_the_last_placeholder() {
        let name = |path: &str, number| {
            NumberedName::new(Path::new(path)).map(|it| it.with_number(number))
        };
        assert_eq!(name("x/walk_####.png", 7), Some("walk_0007.png".into()));
        assert_eq!(name("#a##b.png", 12345), Some("#a12345b.png".into()));
        assert_eq!(name("x#/a.png", 1), None);
    }
}
