use std::str::Utf8Error;

use glam::Vec3;
use serde_path_to_error::{Path, Segment};
use thiserror::Error;

use crate::io::error::{shortened, without_position};
use crate::kinematics::two_bone::LengthError;

/// The reason why a line has no pose. Messages start with the field, if it is known.
#[derive(Debug, Error)]
pub enum LineError {
    /// The line is longer than [`LineError::MAX_LENGTH`].
    #[error("the line must be at most {} KiB long", LineError::MAX_LENGTH >> 10)]
    TooLong,
    /// The line is not UTF-8.
    #[error("the line must be UTF-8, got {byte:#04x} as byte {at}")]
    NotUtf8 {
        /// Position of the first invalid byte in the line, from 1.
        at: usize,
        /// The invalid byte.
        byte: u8,
    },
    /// The line is not JSON.
    #[error("{prefix}not JSON: {reason} (byte {at})")]
    NotJson {
        /// Path of the field with a colon and a space, or empty.
        prefix: String,
        /// The parser's message.
        reason: String,
        /// Number of bytes read when the parser found the error.
        at: usize,
    },
    /// The line is JSON but not a request: a field is missing, unknown or invalid.
    #[error("{prefix}{reason}")]
    NotARequest {
        /// Path of the field with a colon and a space, or empty.
        prefix: String,
        /// The rule that is broken.
        reason: String,
    },
    /// A number overflows.
    #[error("{prefix}must be between -3.4028235e38 and 3.4028235e38, got {number}")]
    OutOfRange {
        /// Path of the field with a colon and a space, or empty.
        prefix: String,
        /// The number as written in the line.
        number: String,
    },
    /// A bone length is not finite or not above 0.
    #[error("{}: must be finite and above 0, got {}", .0.bone, .0.value)]
    Length(#[from] LengthError),
    /// A soft limit is outside its range.
    #[error("{field}: must be {range}, got {value}")]
    SoftReach {
        /// Name of the field.
        field: &'static str,
        /// The refused value, in the field's unit.
        value: f32,
        /// Description of the valid range.
        range: &'static str,
    },
    /// The elbow or the hand overflows in world space.
    #[error("root: must keep the {joint} within ±3.4028235e38, got {:?}", .root.to_array())]
    OutOfWorld {
        /// `elbow` or `hand`.
        joint: &'static str,
        /// Position of the Root in world space.
        root: Vec3,
    },
}

/// Field names of earlier versions, each with the name in this version.
const RENAMED: [(&str, &str); 3] = [
    ("elbow_spin_deg", "twist_deg"),
    ("swivel", "reference"),
    ("min_elbow_deg", "min_elbow_angle_deg"),
];

impl LineError {
    /// Maximum length of a line in bytes, without its line ending.
    pub const MAX_LENGTH: usize = 64 * 1024;

    /// The error's text. Of a long text, only the start and the end are returned.
    pub fn message(&self) -> String {
        shortened(self.to_string())
    }

    pub(super) fn not_utf8(line: &[u8], error: Utf8Error) -> Self {
        let valid = error.valid_up_to();
        Self::NotUtf8 { at: valid + 1, byte: line.get(valid).copied().unwrap_or_default() }
    }

    pub(super) fn not_a_request(line: &str, path: &Path, error: &serde_json::Error) -> Self {
        let reason = renamed(without_position(error));
        let prefix = prefix(path, &reason);
        // serde_json identifies this error by its text alone.
        if reason == "number out of range" {
            let number = word_around(line, error.column()).to_owned();
            return Self::OutOfRange { prefix, number };
        }
        if error.is_data() {
            return Self::NotARequest { prefix, reason };
        }
        Self::not_json(line, prefix, error)
    }

    pub(super) fn not_json(line: &str, prefix: String, error: &serde_json::Error) -> Self {
        let (reason, at) = (without_position(error), error.column());
        match word_around(line, at) {
            "" => Self::NotJson { prefix, reason, at },
            word => Self::NotJson { prefix, reason: format!("{reason}, found `{word}`"), at },
        }
    }
}

/// Returns `reason`, unless it is about an unknown field that was renamed. Then the result has the
/// field's new name instead of the list of all fields.
fn renamed(reason: String) -> String {
    let is_unknown =
        |(old, _): &&(&str, &str)| reason.starts_with(&format!("unknown field `{old}`"));
    match RENAMED.iter().find(is_unknown) {
        Some((old, new)) => format!("unknown field `{old}`; it is called `{new}`"),
        None => reason,
    }
}

/// The path of the invalid field with a colon and a space. Empty if the path is unknown or `reason`
/// already contains it.
fn prefix(path: &Path, reason: &str) -> String {
    let is_known = path.iter().len() > 0 && !path.iter().any(|s| matches!(s, Segment::Unknown));
    if !is_known || reason.contains(&format!("`{path}`")) {
        return String::new();
    }
    format!("{path}: ")
}

/// The word around byte `read` of the line, up to the nearest space or punctuation on both sides.
fn word_around(line: &str, read: usize) -> &str {
    let in_word = |c: char| !(c.is_whitespace() || r#",:[]{}""#.contains(c));
    let (before, after) = line.split_at_checked(read).unwrap_or((line, ""));
    let start = before.trim_end_matches(in_word).len();
    let end = line.len() - after.trim_start_matches(in_word).len();
    &line[start..end]
}
