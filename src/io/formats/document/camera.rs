//! Fields of a camera in a file, and conversions between these fields and a camera.

use core::f32::consts::FRAC_PI_2;

use serde::{Deserialize, Serialize};

use super::check::{above_0, number, within};
use crate::document::Camera;
use crate::io::json::FieldError;
use crate::io::json::JsonPath;
use crate::io::json::{JsonNumber, JsonPoint};

#[derive(Serialize, Deserialize)]
pub struct CameraFields {
    target: Option<JsonPoint>,
    yaw: Option<JsonNumber>,
    pitch: Option<JsonNumber>,
    distance: Option<JsonNumber>,
    orthographic: Option<bool>,
}

impl CameraFields {
    pub fn new(camera: &Camera) -> Self {
        Self {
            target: Some(JsonPoint(camera.target)),
            yaw: Some(JsonNumber(camera.yaw)),
            pitch: Some(JsonNumber(camera.pitch)),
            distance: Some(JsonNumber(camera.distance)),
            orthographic: Some(camera.orthographic),
        }
    }

    pub fn camera(&self, at: &JsonPath) -> Result<Camera, FieldError> {
        let default = Camera::default();
        let at = |key| at.clone().key(key);
        Ok(Camera {
            target: self.target.map_or(default.target, |JsonPoint(target)| target),
            yaw: number(self.yaw, default.yaw),
            pitch: within(at("pitch"), number(self.pitch, default.pitch), FRAC_PI_2)?,
            distance: above_0(at("distance"), number(self.distance, default.distance))?,
            orthographic: self.orthographic.unwrap_or(default.orthographic),
        })
    }
}
