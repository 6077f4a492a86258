//! Fields of soft limits in a file, and conversions between these fields and [`SoftReach`].

use core::f32::consts::PI;

use serde::{Deserialize, Serialize};

use super::check::number;
use crate::io::json::FieldError;
use crate::io::json::JsonNumber;
use crate::io::json::JsonPath;
use crate::kinematics::soft_reach::{SoftReach, SoftReachField};

#[derive(Serialize, Deserialize)]
pub struct SoftReachFields {
    softness: Option<JsonNumber>,
    max_stretch: Option<JsonNumber>,
    min_elbow_angle: Option<JsonNumber>,
}

impl SoftReachFields {
    pub fn new(soft_reach: SoftReach) -> Self {
        Self {
            softness: Some(JsonNumber(soft_reach.softness())),
            max_stretch: Some(JsonNumber(soft_reach.max_stretch())),
            min_elbow_angle: Some(JsonNumber(soft_reach.min_elbow_angle())),
        }
    }

    pub fn soft_reach(&self, at: &JsonPath) -> Result<SoftReach, FieldError> {
        let default = SoftReach::default();
        let soft_reach = SoftReach::new(
            number(self.softness, default.softness()),
            number(self.max_stretch, default.max_stretch()),
            number(self.min_elbow_angle, default.min_elbow_angle()),
        );
        soft_reach.map_err(|error| {
            let range = match error.field {
                SoftReachField::MinElbowAngle => format!("from 0 to less than {PI}"),
                _ => error.range.to_owned(),
            };
            let reason = format!("must be {range}, got {}", error.value);
            FieldError::new(at.clone().key(&error.field.to_string()), reason)
        })
    }
}
