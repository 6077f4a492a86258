use std::ffi::{OsStr, OsString};
use std::path::Path;

/// Placeholder for one digit of a frame's number.
const DIGIT: char = '#';

/// A file name with a placeholder for a number: the last run of `#` in the name.
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

#[cfg(test)]
mod tests {
    use super::*;

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
