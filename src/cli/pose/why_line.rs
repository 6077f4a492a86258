use serde::Serialize;

use crate::document::SkeletonRig;
use crate::kinematics::diagnosis::Diagnosis;
use crate::kinematics::skeleton::JointId;

/// A cause for which a target is not reached, in the output of the command.
#[derive(Serialize)]
pub struct WhyLine<'a> {
    cause: &'static str,
    target: &'a str,
    joints: Vec<&'a str>,
    sentence: String,
    remedy: Option<String>,
    residual_with_remedy: Option<f32>,
    rotation_error_with_remedy_deg: Option<f32>,
}

impl<'a> WhyLine<'a> {
    /// The output for a diagnosis of a rig, with its best remedy.
    pub fn new(found: &Diagnosis, rig: &'a SkeletonRig) -> Self {
        let name = |joint: JointId| rig.skeleton[joint].name.as_str();
        let best = found.remedies.first();
        Self {
            cause: found.cause.name(),
            target: name(found.target),
            joints: found.joints.iter().map(|joint| name(*joint)).collect(),
            sentence: rig.sentence(found),
            remedy: best.map(|tried| rig.remedy_sentence(&tried.remedy)),
            residual_with_remedy: best.map(|tried| tried.residual),
            rotation_error_with_remedy_deg: best.map(|tried| tried.rotation_residual.to_degrees()),
        }
    }
}
