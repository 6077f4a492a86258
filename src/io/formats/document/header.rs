//! The first two fields: the name of the format and its version.

use serde::Deserialize;

use crate::io::json::FieldError;
use crate::io::json::JsonPath;
use crate::io::json::Whole;

pub const FORMAT: &str = "ik-arm";
/// The version of saved files. Files of version 1 up to this version can be read.
pub const VERSION: u32 = 2;

#[derive(Deserialize)]
pub struct Header {
    format: String,
    version: Whole,
}

impl Header {
    /// Returns the version of the file. Fails if this program cannot read the format or the
    /// version.
    pub fn version(&self) -> Result<u32, FieldError> {
        if self.format != FORMAT {
            let reason = format!("must be {FORMAT:?}, got {:?}", self.format);
            return Err(FieldError::new(JsonPath::root().key("format"), reason));
        }
        let version = self.version.0;
        if (1..=VERSION).contains(&version) {
            return Ok(version);
        }
        let reason = if version > VERSION {
            format!("must be from 1 to {VERSION}, got {version}, which needs a newer ik-arm")
        } else {
            format!("must be from 1 to {VERSION}, got {version}")
        };
        Err(FieldError::new(JsonPath::root().key("version"), reason))
    }
}
