//! Fields of the followed path in a file, and conversions between these fields and a [`FollowPath`].

use serde::{Deserialize, Serialize};

use super::check::above_0;
use crate::document::{FollowPath, WavyRing};
use crate::io::field_error::FieldError;
use crate::io::json_path::JsonPath;
use crate::io::value::{JsonNumber, Whole};

#[derive(Default, Serialize, Deserialize)]
pub struct FollowPathFields {
    #[serde(skip_serializing_if = "Option::is_none")]
    path: Option<FollowPathName>,
    #[serde(skip_serializing_if = "Option::is_none")]
    radius: Option<JsonNumber>,
    #[serde(skip_serializing_if = "Option::is_none")]
    amplitude: Option<JsonNumber>,
    #[serde(skip_serializing_if = "Option::is_none")]
    waves: Option<Whole>,
    #[serde(skip_serializing_if = "Option::is_none")]
    period: Option<JsonNumber>,
}

#[derive(Clone, Copy, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
enum FollowPathName {
    #[default]
    Ring,
    Head,
}

impl FollowPathFields {
    pub fn new(path: &FollowPath) -> Self {
        match path {
            FollowPath::Ring(ring) => Self {
                path: None,
                radius: Some(JsonNumber(ring.radius)),
                amplitude: Some(JsonNumber(ring.amplitude)),
                waves: Some(Whole(ring.waves)),
                period: Some(JsonNumber(ring.period)),
            },
            FollowPath::Head => Self { path: Some(FollowPathName::Head), ..Self::default() },
        }
    }

    pub fn follow_path(&self, at: &JsonPath) -> Result<FollowPath, FieldError> {
        match self.path.unwrap_or_default() {
            FollowPathName::Ring => Ok(FollowPath::Ring(self.ring(at)?)),
            FollowPathName::Head => Ok(FollowPath::Head),
        }
    }

    fn ring(&self, at: &JsonPath) -> Result<WavyRing, FieldError> {
        let missing = |name| FieldError::new(at.clone(), format!("must have `{name}` for a ring"));
        let number = |name, field: Option<JsonNumber>| Ok(field.ok_or_else(|| missing(name))?.0);
        Ok(WavyRing {
            radius: number("radius", self.radius)?,
            amplitude: number("amplitude", self.amplitude)?,
            waves: self.waves.ok_or_else(|| missing("waves"))?.0,
            period: above_0(at.clone().key("period"), number("period", self.period)?)?,
        })
    }
}
