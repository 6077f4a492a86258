//! Range checks of numbers in files, and the fields of soft limits. Errors name the field, the rule
//! and the value.

use core::f32::consts::PI;

use glam::Vec3;
use serde::{Deserialize, Serialize};

use crate::io::json::{FieldError, JsonNumber, JsonPath, Whole};
use crate::kinematics::soft_reach::{SoftReach, SoftReachField};

/// Tolerance for unit vectors in a file: the maximum difference of a length from 1, and the maximum
/// absolute cosine of the angle between two vectors that must be perpendicular.
pub const UNIT_TOLERANCE: f32 = 1e-3;

/// Returns the number in the file, or `default` if the file has none.
pub fn number(file: Option<JsonNumber>, default: f32) -> f32 {
    file.map_or(default, |JsonNumber(number)| number)
}

pub fn above_0(at: JsonPath, value: f32) -> Result<f32, FieldError> {
    checked(value > 0.0, at, value, "above 0")
}

/// Checks that a number is from 0 to 1, and returns it.
pub fn fraction(at: JsonPath, value: f32) -> Result<f32, FieldError> {
    checked((0.0..=1.0).contains(&value), at, value, "from 0 to 1")
}

/// Checks that a number is from `-limit` to `limit`, and returns it.
pub fn within(at: JsonPath, value: f32, limit: f32) -> Result<f32, FieldError> {
    checked(value.abs() <= limit, at, value, &format!("from {} to {limit}", -limit))
}

pub fn from_1_to(at: JsonPath, Whole(count): Whole, max: u32) -> Result<u32, FieldError> {
    if (1..=max).contains(&count) {
        Ok(count)
    } else {
        Err(FieldError::new(at, format!("must be from 1 to {max}, got {count}")))
    }
}

/// Checks that the length of a vector is 1 within [`UNIT_TOLERANCE`], and returns the normalized
/// vector. If the length is 1 within rounding, returns the vector unchanged, bit for bit.
pub fn unit_vector(at: JsonPath, vector: Vec3) -> Result<Vec3, FieldError> {
    const ROUNDING: f32 = 1e-6;
    let length = vector.length();
    if (length - 1.0).abs() > UNIT_TOLERANCE {
        return Err(FieldError::new(at, format!("must have length 1, got {length}")));
    }
    Ok(if (length - 1.0).abs() <= ROUNDING { vector } else { vector.normalize() })
}

/// Checks that a joint index is below `joints`, the number of joints, and returns it.
pub fn joint(at: JsonPath, Whole(joint): Whole, joints: usize) -> Result<usize, FieldError> {
    let index = joint as usize;
    if index < joints {
        return Ok(index);
    }
    let rule = match joints {
        0 => "must be a joint, but the skeleton has none".to_owned(),
        1 => "must be 0, the only joint".to_owned(),
        _ => format!("must be a joint from 0 to {}", joints - 1),
    };
    Err(FieldError::new(at, format!("{rule}, got {joint}")))
}

fn checked(holds: bool, at: JsonPath, value: f32, rule: &str) -> Result<f32, FieldError> {
    if holds { Ok(value) } else { Err(FieldError::new(at, format!("must be {rule}, got {value}"))) }
}

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
