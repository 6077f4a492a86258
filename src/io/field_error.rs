use super::json_path::JsonPath;

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

/// Oddities that do not keep a file from being opened. Only the first are kept, because finding the
/// position of each searches the text.
#[derive(Debug, Default)]
pub struct FieldWarnings {
    pub first: Vec<FieldError>,
    /// Number of further warnings.
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
