use std::ffi::{OsStr, OsString};
use std::path::{Path, PathBuf};

use super::ExportError;

/// What kind of file an export makes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// glTF in one file.
    Glb,
    Bvh,
    /// Where the joints are, as a table.
    Csv,
    /// One picture.
    Png,
    /// A picture for each frame, each in a file of its own.
    PngSequence,
    /// All frames in one animated picture.
    Apng,
}

/// What in a file's name stands for the digits of a frame's number.
const DIGIT: char = '#';

impl Format {
    /// The endings of files, with what they mean.
    pub const ENDINGS: [(&'static str, Self); 5] = [
        ("glb", Self::Glb),
        ("bvh", Self::Bvh),
        ("csv", Self::Csv),
        ("png", Self::Png),
        ("apng", Self::Apng),
    ];

    /// What a file's name asks for: its ending, and whether it has `#`s.
    ///
    /// # Errors
    ///
    /// Refuses an ending that is not known.
    pub fn of(path: &Path) -> Result<Self, ExportError> {
        let ending = path.extension().and_then(OsStr::to_str).unwrap_or_default();
        let is_asked = |(known, _): &(&str, Self)| ending.eq_ignore_ascii_case(known);
        match Self::ENDINGS.into_iter().find(is_asked) {
            Some((_, Self::Png)) if Numbered::new(path).is_some() => Ok(Self::PngSequence),
            Some((_, format)) => Ok(format),
            None => Err(ExportError::Ending { path: path.display().to_string() }),
        }
    }

    pub fn is_picture(self) -> bool {
        matches!(self, Self::Png | Self::PngSequence | Self::Apng)
    }

    /// All endings, as a message has them.
    pub(super) fn endings() -> String {
        Self::ENDINGS.map(|(ending, _)| format!(".{ending}")).join(", ")
    }
}

/// A file's name with a place for a number: its last run of `#`.
pub struct Numbered {
    before: String,
    digits: usize,
    after: String,
}

impl Numbered {
    /// Nothing where the name has no `#`, or is no Unicode.
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

    /// Whether a file is called like one of the sequence.
    fn is_name(&self, name: &OsStr) -> bool {
        let digits = name.to_str().and_then(|name| {
            name.strip_prefix(self.before.as_str())?.strip_suffix(self.after.as_str())
        });
        digits.is_some_and(|digits| {
            digits.len() >= self.digits && digits.bytes().all(|digit| digit.is_ascii_digit())
        })
    }

    /// The name of a number, with zeros before it.
    pub fn name(&self, number: usize) -> OsString {
        /// More zeros than any number needs.
        const MOST_DIGITS: usize = 64;
        let Self { before, after, .. } = self;
        let digits = self.digits.min(MOST_DIGITS);
        format!("{before}{number:0digits$}{after}").into()
    }
}

/// The file that an export to this path would overwrite, the first of several.
pub fn existing(path: &Path) -> Option<PathBuf> {
    let is_sequence = matches!(Format::of(path), Ok(Format::PngSequence));
    let Some(numbered) = Numbered::new(path).filter(|_| is_sequence) else {
        return path.exists().then(|| path.to_owned());
    };
    let folder = path.parent().filter(|folder| *folder != Path::new(""));
    let files = std::fs::read_dir(folder.unwrap_or(Path::new("."))).ok()?;
    let found = files.flatten().filter(|file| numbered.is_name(&file.file_name()));
    found.map(|file| file.path()).min()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_ending_says_the_format() {
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
            assert!(error.contains(".glb, .bvh, .csv, .png, .apng"), "{error}");
        }
    }

    #[test]
    fn a_number_stands_where_the_last_signs_are() {
        let name = |path: &str, number| Numbered::new(Path::new(path)).map(|it| it.name(number));
        assert_eq!(name("x/walk_####.png", 7), Some("walk_0007.png".into()));
        assert_eq!(name("#a##b.png", 12345), Some("#a12345b.png".into()));
        assert_eq!(name("x#/a.png", 1), None);
    }

    #[test]
    fn a_sequence_finds_the_frames_that_are_there_already() {
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
