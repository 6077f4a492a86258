use std::ffi::OsStr;
use std::path::{Path, PathBuf};

use thiserror::Error;

use super::numbered_name::NumberedName;

/// File format of an export.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Binary glTF.
    Glb,
    /// Biovision hierarchy: joints and their motion.
    Bvh,
    /// Joint positions as a table.
    Csv,
    /// The mesh of the skin at one time.
    Obj,
    /// One picture.
    Png,
    /// One picture file per frame.
    PngSequence,
    /// All frames in one animated picture.
    Apng,
}

/// A path whose extension is not that of a [`Format`].
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[error("{path}: extension must be one of {}", extensions())]
pub struct FormatError {
    path: String,
}

impl Format {
    /// File extensions with their formats.
    pub const EXTENSIONS: [(&'static str, Self); 6] = [
        ("glb", Self::Glb),
        ("bvh", Self::Bvh),
        ("csv", Self::Csv),
        ("obj", Self::Obj),
        ("png", Self::Png),
        ("apng", Self::Apng),
    ];

    /// Returns the format that a file name selects by its extension and, for PNG, by whether the
    /// name contains `#`.
    ///
    /// # Errors
    ///
    /// Fails if the extension is unknown.
    pub fn of(path: &Path) -> Result<Self, FormatError> {
        let extension = path.extension().and_then(OsStr::to_str).unwrap_or_default();
        let matches = |(known, _): &(&str, Self)| extension.eq_ignore_ascii_case(known);
        match Self::EXTENSIONS.into_iter().find(matches) {
            Some((_, Self::Png)) if NumberedName::new(path).is_some() => Ok(Self::PngSequence),
            Some((_, format)) => Ok(format),
            None => Err(FormatError { path: path.display().to_string() }),
        }
    }

    /// Whether the format holds one time instead of a motion.
    pub fn is_still(self) -> bool {
        matches!(self, Self::Png | Self::Obj)
    }

    /// Whether a file of the format holds the frames of a motion rather than a single moment.
    pub fn has_frames(self) -> bool {
        !matches!(self, Self::Png | Self::Obj)
    }

    /// Whether the format consists of pictures.
    pub fn is_picture(self) -> bool {
        matches!(self, Self::Png | Self::PngSequence | Self::Apng)
    }
}

fn extensions() -> String {
    Format::EXTENSIONS.map(|(extension, _)| format!(".{extension}")).join(", ")
}

/// Returns the existing file that an export to `path` would overwrite, or the first of several
/// existing files of a sequence. `None` if no file would be overwritten.
pub fn existing(path: &Path) -> Option<PathBuf> {
    let is_sequence = matches!(Format::of(path), Ok(Format::PngSequence));
    let Some(numbered) = NumberedName::new(path).filter(|_| is_sequence) else {
        return path.exists().then(|| path.to_owned());
    };
    let folder = path.parent().filter(|folder| *folder != Path::new(""));
    let files = std::fs::read_dir(folder.unwrap_or(Path::new("."))).ok()?;
    let found = files.flatten().filter(|file| numbered.contains(&file.file_name()));
    found.map(|file| file.path()).min()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_extension_selects_the_format() {
        for (path, format) in [
            ("a.glb", Format::Glb),
            ("b/a.BVH", Format::Bvh),
            ("a#.csv", Format::Csv),
            ("a#/a.png", Format::Png),
            ("a_##.png", Format::PngSequence),
            ("a.tar.Apng", Format::Apng),
        ] {
            assert_eq!(Format::of(Path::new(path)).ok(), Some(format), "{path}");
        }
        for path in ["a", "a.mp4", ".png", "png", ""] {
            let error = Format::of(Path::new(path)).expect_err("no format").to_string();
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
}
