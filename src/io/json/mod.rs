//! Values of JSON files, paths to them, their positions in the text, and errors that name a path.

mod value;

use std::borrow::Cow;
use std::fmt;

use serde::de::{
    DeserializeSeed, Deserializer, Error as _, IgnoredAny, MapAccess, SeqAccess, Visitor,
};

pub use value::{
    Above0, AtLeast0, Fraction, JsonNumber, JsonNumbers, JsonObject, JsonPoint, JsonSeconds,
    KeyRow, Whole, to_styled_json, value_or,
};

/// The path to a value in a JSON text.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct JsonPath(Vec<PathSegment>);

/// A step of a path: into a field of an object, or to an element of an array.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum PathSegment {
    Key(String),
    Index(usize),
}

impl From<&str> for PathSegment {
    fn from(key: &str) -> Self {
        Self::Key(key.to_owned())
    }
}

impl From<usize> for PathSegment {
    fn from(index: usize) -> Self {
        Self::Index(index)
    }
}

impl JsonPath {
    /// The empty path, which leads to the outermost value of the text.
    pub fn root() -> Self {
        Self::default()
    }

    #[must_use]
    pub fn key(mut self, key: &str) -> Self {
        self.0.push(PathSegment::Key(key.to_owned()));
        self
    }

    #[must_use]
    pub fn index(mut self, index: usize) -> Self {
        self.0.push(PathSegment::Index(index));
        self
    }

    /// The names of all fields on the path, from the outside inwards. Array indices are left out.
    pub fn keys(&self) -> impl DoubleEndedIterator<Item = &str> {
        self.0.iter().filter_map(|segment| match segment {
            PathSegment::Key(key) => Some(key.as_str()),
            PathSegment::Index(_) => None,
        })
    }

    /// Returns the byte of `text` at which the value begins. If the value does not exist, returns
    /// the byte at which the innermost existing value around it begins.
    pub fn find(&self, text: &str) -> usize {
        let depths = (1..=self.0.len()).rev();
        let found = depths.map(|depth| &self.0[..depth]).find_map(|path| find(text, path));
        found.unwrap_or_else(|| skip_space(text, 0))
    }
}

/// Writes the path like `skeleton.joints[3].parent`.
impl fmt::Display for JsonPath {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let is_plain = |c: char| c.is_alphanumeric() || "_-".contains(c);
        for (index, segment) in self.0.iter().enumerate() {
            match segment {
                PathSegment::Index(index) => write!(f, "[{index}]")?,
                PathSegment::Key(key) if key.is_empty() || !key.chars().all(is_plain) => {
                    write!(f, "[{key:?}]")?;
                }
                PathSegment::Key(key) if index == 0 => f.write_str(key)?,
                PathSegment::Key(key) => write!(f, ".{key}")?,
            }
        }
        Ok(())
    }
}

impl From<&serde_path_to_error::Path> for JsonPath {
    fn from(path: &serde_path_to_error::Path) -> Self {
        use serde_path_to_error::Segment as Step;
        let segment = |step: &Step| match step {
            Step::Seq { index } => Some(PathSegment::Index(*index)),
            Step::Map { key } => Some(PathSegment::Key(key.clone())),
            Step::Enum { .. } | Step::Unknown => None,
        };
        Self(path.iter().filter_map(segment).collect())
    }
}

impl From<&serde_ignored::Path<'_>> for JsonPath {
    fn from(path: &serde_ignored::Path<'_>) -> Self {
        use serde_ignored::Path;
        match path {
            Path::Root => Self::root(),
            Path::Seq { parent, index } => Self::from(*parent).index(*index),
            Path::Map { parent, key } => Self::from(*parent).key(key),
            Path::Some { parent }
            | Path::NewtypeStruct { parent }
            | Path::NewtypeVariant { parent } => Self::from(*parent),
        }
    }
}

/// Returns the line and the column of a byte of `text`. Both count from 1, and the column counts
/// characters.
pub fn line_and_column(text: &str, byte: usize) -> (usize, usize) {
    let before = text.get(..byte).unwrap_or(text);
    let line_start = before.rfind('\n').map_or(0, |end| end + 1);
    (before.matches('\n').count() + 1, before[line_start..].chars().count() + 1)
}

/// Returns the byte of `text` at a line and a column. Both count from 1, and the column counts
/// bytes. If the column is within a character, returns the first byte of the character.
pub fn byte_at(text: &str, line: usize, column: usize) -> usize {
    let start = start_of_line(text, line);
    let mut byte = (start + column.saturating_sub(1)).min(text.len());
    while !text.is_char_boundary(byte) {
        byte -= 1;
    }
    byte
}

fn start_of_line(text: &str, line: usize) -> usize {
    text.split_inclusive('\n').take(line.saturating_sub(1)).map(str::len).sum()
}

fn find(text: &str, path: &[PathSegment]) -> Option<usize> {
    let mut json = serde_json::Deserializer::from_str(text);
    let mut found = false;
    let error = ValueFinder { path, found: &mut found }.deserialize(&mut json).err()?;
    // The parser stopped at the value, or at the space in front of it.
    found.then(|| skip_space(text, start_of_line(text, error.line()) + error.column()))
}

fn skip_space(text: &str, from: usize) -> usize {
    let rest = text.get(from..).unwrap_or_default();
    text.len() - rest.trim_start().len()
}

/// Parses up to the value at `path`, sets `found` and fails there, so that the error has the
/// position of the value.
struct ValueFinder<'a> {
    path: &'a [PathSegment],
    found: &'a mut bool,
}

impl<'de> DeserializeSeed<'de> for ValueFinder<'_> {
    type Value = ();

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<(), D::Error> {
        if self.path.is_empty() {
            *self.found = true;
            return Err(D::Error::custom("here"));
        }
        deserializer.deserialize_any(self)
    }
}

impl<'de> Visitor<'de> for ValueFinder<'_> {
    type Value = ();

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("an object or an array")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<(), A::Error> {
        let Some((PathSegment::Key(wanted), path)) = self.path.split_first() else {
            return Err(A::Error::custom("no object is wanted"));
        };
        while let Some(key) = map.next_key::<Cow<'_, str>>()? {
            if key == wanted.as_str() {
                return map.next_value_seed(ValueFinder { path, found: self.found });
            }
            map.next_value::<IgnoredAny>()?;
        }
        Ok(())
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut sequence: A) -> Result<(), A::Error> {
        let Some((PathSegment::Index(wanted), path)) = self.path.split_first() else {
            return Err(A::Error::custom("no array is wanted"));
        };
        for _ in 0..*wanted {
            if sequence.next_element::<IgnoredAny>()?.is_none() {
                return Ok(());
            }
        }
        sequence.next_element_seed(ValueFinder { path, found: self.found })?;
        Ok(())
    }
}

/// A field that is invalid, ignored or changed, and the reason.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FieldError {
    pub field: JsonPath,
    pub reason: String,
}

impl FieldError {
    pub fn new(field: JsonPath, reason: impl Into<String>) -> Self {
        Self { field, reason: reason.into() }
    }
}

/// The error of a value whose path is still to be told, by [`AtField::at`].
impl From<String> for FieldError {
    fn from(reason: String) -> Self {
        Self::new(JsonPath::root(), reason)
    }
}

impl From<&str> for FieldError {
    fn from(reason: &str) -> Self {
        Self::new(JsonPath::root(), reason)
    }
}

/// Tells the path of an error from the inside outwards.
pub trait AtField<T> {
    /// Puts a step in front of the path of the error.
    fn at(self, step: impl Into<PathSegment>) -> Result<T, FieldError>;
}

impl<T, E: Into<FieldError>> AtField<T> for Result<T, E> {
    fn at(self, step: impl Into<PathSegment>) -> Result<T, FieldError> {
        self.map_err(|error| {
            let mut error = error.into();
            error.field.0.insert(0, step.into());
            error
        })
    }
}

/// Converts the elements of an array. An error names the index of its element.
pub fn converted<T, U, E: Into<FieldError>>(
    array: impl IntoIterator<Item = T>,
    mut convert: impl FnMut(T) -> Result<U, E>,
) -> Result<Vec<U>, FieldError> {
    let elements = array.into_iter().enumerate();
    elements.map(|(index, element)| convert(element).at(index)).collect()
}

/// Warnings about a file that can be opened all the same. Only the first few are kept, because
/// finding the position of a warning takes a search through the whole text.
#[derive(Debug, Default)]
pub struct FieldWarnings {
    pub first: Vec<FieldError>,
    /// Number of warnings that came after those in `first`.
    pub more: usize,
}

impl FieldWarnings {
    pub fn push(&mut self, field: JsonPath, reason: impl Into<String>) {
        const MAX: usize = 20;
        if self.first.len() < MAX {
            self.first.push(FieldError::new(field, reason));
        } else {
            self.more += 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::io::json::*;

    const TEXT: &str = "{\n  \"é\": 1, \"b\":[ 1,\n\t{\"c\" :\n  \"d\"},[\n[]]],\n \"e\":null}";

    fn position(field: &JsonPath) -> (usize, usize) {
        line_and_column(TEXT, field.find(TEXT))
    }

    #[test]
    fn a_value_is_found_where_it_begins() {
        let root = JsonPath::root;
        let b = || root().key("b");
        for (field, expected) in [
            (root(), (1, 1)),
            (root().key("é"), (2, 8)),
            (b(), (2, 15)),
            (b().index(0), (2, 17)),
            (b().index(1), (3, 2)),
            (b().index(1).key("c"), (4, 3)),
            (b().index(2).index(0), (5, 1)),
            (root().key("e"), (6, 6)),
        ] {
            assert_eq!(position(&field), expected, "{field}");
        }
    }

    #[test]
    fn a_missing_value_is_found_at_the_nearest_value_around_it() {
        assert_eq!(position(&JsonPath::root().key("b").index(1).key("none")), (3, 2));
        assert_eq!(position(&JsonPath::root().key("b").index(9)), (2, 15));
        assert_eq!(position(&JsonPath::root().key("e").key("x").index(1)), (6, 6));
        assert_eq!(position(&JsonPath::root().index(1)), (1, 1));
    }

    #[test]
    fn a_path_reads_as_one_would_write_it() {
        let field = JsonPath::root().key("scene").key("my mesh").key("bones").index(3).key("roll");
        assert_eq!(field.to_string(), r#"scene["my mesh"].bones[3].roll"#);
    }
}
