//! Fields under `extras` that this program adds to glTF files and reads again from its own files.
//! Other programs ignore them. The program that has written a file is named by `asset.generator`.

use glam::{DQuat, Quat, Vec3};
use serde::de::IgnoredAny;
use serde::{Deserialize, Serialize};

use crate::document::{Quantity, Timeline};
use crate::io::formats::document::KeyFields;
use crate::kinematics::spline::{Knot, Spline};

/// Extras of a sampler: the keys whose curve it is, with times of the file, and in the joint's
/// angles or as its offsets in metres.
#[derive(Serialize, Deserialize)]
pub struct SamplerExtras {
    #[serde(rename = "ik_arm_keys")]
    keys: Vec<KeyFields>,
}

/// Extras of a node.
#[derive(Clone, Copy, Default, Serialize, Deserialize)]
pub struct NodeExtras {
    /// Of a joint's node, the frame of the joint's angles relative to the node, as a quaternion.
    #[serde(rename = "ik_arm_frame", skip_serializing_if = "Option::is_none")]
    frame: Option<[f32; 4]>,
    /// True if the node is no joint, but stretches the skin of the joint above.
    #[serde(rename = "ik_arm_stretches_skin", skip_serializing_if = "Option::is_none")]
    stretches_skin: Option<bool>,
}

/// Extras of a mesh: the names of its morph targets, as many programs write them.
#[derive(Serialize, Deserialize)]
pub struct MeshExtras {
    #[serde(rename = "targetNames")]
    pub target_names: Vec<String>,
}

/// Extras of an animation: the frames in a second of its timeline.
#[derive(Clone, Copy, Serialize, Deserialize)]
pub struct AnimationExtras {
    #[serde(rename = "ik_arm_frame_rate")]
    frame_rate: f64,
}

/// Extras in a file, which may be those of another program.
#[derive(Deserialize, Serialize)]
#[serde(untagged)]
pub enum Extras<T> {
    Own(T),
    #[serde(skip_serializing)]
    Other(IgnoredAny),
}

impl<T> Extras<T> {
    pub fn own(&self) -> Option<&T> {
        match self {
            Self::Own(extras) => Some(extras),
            Self::Other(_) => None,
        }
    }
}

impl SamplerExtras {
    pub fn new(keys: &[Knot<Vec3>]) -> Self {
        Self { keys: keys.iter().map(|key| KeyFields::new(key, 3)).collect() }
    }

    /// The keys; `None` if there are none, or one is damaged.
    pub fn spline(&self) -> Option<Spline<Vec3>> {
        let key = |key: &KeyFields| key.key(Quantity::Point).ok();
        let spline = self.keys.iter().map(key).collect::<Option<Spline<Vec3>>>()?;
        (!spline.is_empty()).then_some(spline)
    }
}

impl NodeExtras {
    /// Extras of the node that stretches the skin of the joint above.
    pub const STRETCHES_SKIN: Self = Self { frame: None, stretches_skin: Some(true) };

    pub fn of_joint(frame: DQuat) -> Self {
        Self { frame: Some(frame.as_quat().to_array()), stretches_skin: None }
    }

    pub fn stretches_skin(self) -> bool {
        self.stretches_skin == Some(true)
    }

    /// The frame of a joint; `None` without one, or if the numbers are no rotation.
    pub fn frame(self) -> Option<DQuat> {
        let frame = Quat::from_array(self.frame?).as_dquat();
        let is_rotation = (frame.length() - 1.0).abs() < 1e-3;
        is_rotation.then(|| frame.normalize())
    }
}

impl AnimationExtras {
    pub fn new(timeline: Timeline) -> Self {
        Self { frame_rate: timeline.frame_rate }
    }

    /// Frames in a second; `None` if no timeline can have as many or as few.
    pub fn frame_rate(self) -> Option<f64> {
        let range = Timeline::MIN_FRAME_RATE..=Timeline::MAX_FRAME_RATE;
        Some(self.frame_rate).filter(|rate| range.contains(rate))
    }
}

const NAME: &str = "ik-arm ";

/// The name that this program writes.
pub fn this_program() -> String {
    format!("{NAME}{}", env!("CARGO_PKG_VERSION"))
}

/// Returns whether this is the name that any version of this program writes.
pub fn is_this_program(generator: &str) -> bool {
    generator.starts_with(NAME)
}
