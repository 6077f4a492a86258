use glam::{Mat4, Vec3};
use serde::Serialize;

use super::answered_pose::AnsweredPose;
use crate::document::SkeletonRig;
use crate::kinematics::chain_ik::Report;
use crate::kinematics::diagnosis::Diagnosis;
use crate::kinematics::skeleton::{JointId, is_within_numbers};
use crate::rig::TargetKind;
use crate::words;

/// Output of the command: one line of JSON.
#[derive(Serialize)]
pub struct PoseLine<'a> {
    joints: Vec<JointLine<'a>>,
    targets: Vec<TargetLine>,
    report: Option<ReportLine>,
    why: Vec<WhyLine<'a>>,
}

#[derive(Serialize)]
struct JointLine<'a> {
    index: JointId,
    name: &'a str,
    parent: Option<JointId>,
    rotation_deg: Vec3,
    base: Vec3,
    tip: Vec3,
    transform: [f32; 16],
}

#[derive(Serialize)]
struct TargetLine {
    joint: JointId,
    kind: &'static str,
    influence: f32,
    target: Vec3,
    tip: Vec3,
    error: f32,
    rotation_error_deg: Option<f32>,
}

#[derive(Serialize)]
struct ReportLine {
    solver: &'static str,
    iterations: u32,
    error: f32,
    converged: bool,
}

impl<'a> PoseLine<'a> {
    /// Returns the output for a pose of a rig at `time`, in seconds. `order` has the rig's joints
    /// in the file's order.
    ///
    /// # Errors
    ///
    /// Fails with the name of a joint whose position overflows.
    pub fn new(
        rig: &'a SkeletonRig,
        posed: &'a AnsweredPose,
        order: &[JointId],
        time: f64,
    ) -> Result<Self, &'a str> {
        let skeleton = &posed.skeleton;
        let mut index_of = vec![JointId::default(); order.len()];
        for (index, joint) in order.iter().enumerate() {
            index_of[joint.index()] = JointId::new(index);
        }
        let pose = skeleton.pose();
        let joints = order.iter().enumerate().map(|(index, &joint)| {
            let bone = &skeleton[joint];
            let (full, tip) = (pose.full(joint), pose.tip(joint));
            if !(is_within_numbers(full.translation.into()) && is_within_numbers(tip)) {
                return Err(bone.name.as_str());
            }
            Ok(JointLine {
                index: JointId::new(index),
                name: &bone.name,
                parent: bone.parent.map(|parent| index_of[parent.index()]),
                rotation_deg: degrees(bone.rotation),
                base: pose.base(joint),
                tip,
                transform: Mat4::from(full).to_cols_array(),
            })
        });
        let joints = joints.collect::<Result<_, _>>()?;
        let enabled = rig.targets.iter().filter(|target| target.enabled);
        let targets = enabled.map(|target| {
            let (point, tip) = (target.in_world(skeleton, time), pose.tip(target.joint));
            let error = point.as_dvec3().distance(tip.as_dvec3());
            TargetLine {
                joint: index_of[target.joint.index()],
                kind: match target.kind {
                    TargetKind::Limb(_) => "limb",
                    TargetKind::WholeBody => "whole_body",
                },
                influence: target.influence,
                target: point,
                tip,
                error: (error as f32).min(f32::MAX),
                rotation_error_deg: rig.rotation_error(target, skeleton).map(f32::to_degrees),
            }
        });
        let targets = targets.collect();
        let report = posed.report.as_ref().map(ReportLine::new);
        let why = posed.why.iter().map(|found| WhyLine::new(found, rig)).collect();
        Ok(Self { joints, targets, report, why })
    }
}

impl ReportLine {
    fn new(report: &Report) -> Self {
        Self {
            solver: report.method.name(),
            iterations: report.iterations,
            error: report.error,
            converged: report.converged(),
        }
    }
}

/// A cause for which a target is not reached, in the output of the command.
#[derive(Serialize)]
struct WhyLine<'a> {
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
    fn new(found: &Diagnosis, rig: &'a SkeletonRig) -> Self {
        let name = |joint: JointId| rig.skeleton[joint].name.as_str();
        let best = found.remedies.first();
        Self {
            cause: found.cause.name(),
            target: name(found.target),
            joints: found.joints.iter().map(|joint| name(*joint)).collect(),
            sentence: words::cause(rig, found),
            remedy: best.map(|tried| words::remedy(rig, &tried.remedy)),
            residual_with_remedy: best.map(|tried| tried.residual),
            rotation_error_with_remedy_deg: best.map(|tried| tried.rotation_residual.to_degrees()),
        }
    }
}

/// Converts radians to degrees. Computes in f64, so that 90 degrees in the file are printed as 90.
/// Overflow is clamped to ±f32::MAX.
fn degrees(radians: Vec3) -> Vec3 {
    let degrees = radians.as_dvec3() * 1_f64.to_degrees();
    degrees.clamp(Vec3::MIN.as_dvec3(), Vec3::MAX.as_dvec3()).as_vec3()
}
