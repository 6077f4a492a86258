//! What is wrong with a line.

use std::str::Utf8Error;

use glam::Vec3;
use serde_path_to_error::{Path, Segment};
use thiserror::Error;

use crate::io::error::shortened;
use crate::kinematics::two_bone::LengthError;

/// Why a line has no pose. `place` is empty or ends in a colon and a space.
#[derive(Debug, Error)]
pub enum LineError {
    #[error("the line is longer than 64 KiB; a pose needs far less")]
    TooLong,
    #[error("byte {at} is {byte:#04x}, which is not UTF-8 there; JSON is written in UTF-8")]
    NotUtf8 { at: usize, byte: u8 },
    #[error("{place}not JSON: {reason} (byte {at})")]
    NotJson { place: String, reason: String, at: usize },
    #[error("{place}{reason}")]
    NotARequest { place: String, reason: String },
    #[error("{place}{number} is out of range; it must be between -3.4028235e38 and 3.4028235e38")]
    OutOfRange { place: String, number: String },
    #[error("{}: length is {}; it must be a finite number above 0", .0.bone, .0.value)]
    Length(#[from] LengthError),
    #[error("{field}: is {value}; it must be {range}")]
    SoftReach { field: &'static str, value: f32, range: &'static str },
    #[error("root: {:?} puts the {joint} beyond 3.4028235e38; bring it nearer to 0", .root.to_array())]
    OutOfWorld { joint: &'static str, root: Vec3 },
}

impl LineError {
    /// What to tell whoever wrote the line; of what it quotes at length, only the start and the end.
    pub fn message(&self) -> String {
        shortened(self.to_string())
    }

    pub(super) fn not_utf8(line: &[u8], error: Utf8Error) -> Self {
        let valid = error.valid_up_to();
        Self::NotUtf8 { at: valid + 1, byte: line.get(valid).copied().unwrap_or_default() }
    }

    pub(super) fn not_a_request(line: &str, path: &Path, error: &serde_json::Error) -> Self {
        let reason = without_position(error);
        let place = place(path, &reason);
        // serde_json has no other way to tell this error from the rest.
        if reason == "number out of range" {
            let number = word_around(line, error.column()).to_owned();
            return Self::OutOfRange { place, number };
        }
        if error.is_data() {
            return Self::NotARequest { place, reason };
        }
        Self::not_json(line, place, error)
    }

    pub(super) fn not_json(line: &str, place: String, error: &serde_json::Error) -> Self {
        let (reason, at) = (without_position(error), error.column());
        match word_around(line, at) {
            "" => Self::NotJson { place, reason, at },
            word => Self::NotJson { place, reason: format!("{reason}, found `{word}`"), at },
        }
    }
}

/// The parser counts lines too, and would always say "line 1".
fn without_position(error: &serde_json::Error) -> String {
    let position = format!(" at line {} column {}", error.line(), error.column());
    let text = error.to_string();
    text.strip_suffix(&position).unwrap_or(&text).to_owned()
}

/// The field that an error is about, unless the reason names it already or nobody knows it.
fn place(path: &Path, reason: &str) -> String {
    let known = path.iter().len() > 0 && !path.iter().any(|s| matches!(s, Segment::Unknown));
    if !known || reason.contains(&format!("`{path}`")) {
        return String::new();
    }
    format!("{path}: ")
}

/// What stands where the parser was when it had read `read` bytes, up to the next punctuation.
fn word_around(line: &str, read: usize) -> &str {
    let in_word = |c: char| !(c.is_whitespace() || r#",:[]{}""#.contains(c));
    let (before, after) = line.split_at_checked(read).unwrap_or((line, ""));
    let start = before.trim_end_matches(in_word).len();
    let end = line.len() - after.trim_start_matches(in_word).len();
    &line[start..end]
}
