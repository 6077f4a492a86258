use super::path::JsonPath;

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
