use glam::{Mat4, Vec3};
use serde::Serialize;

use crate::document::SkeletonRig;
use crate::kinematics::chain_ik::Report;
use crate::kinematics::saturate_vector;
use crate::kinematics::skeleton::{JointId, is_within_numbers};

/// Output of the command: one line of JSON.
#[derive(Serialize)]
pub struct PoseLine<'a> {
    joints: Vec<JointLine<'a>>,
    targets: Vec<TargetLine>,
    report: Option<ReportLine>,
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
    target: Vec3,
    tip: Vec3,
    error: f32,
}

#[derive(Serialize)]
struct ReportLine {
    solver: &'static str,
    iterations: u32,
    error: f32,
    converged: bool,
}

impl<'a> PoseLine<'a> {
    /// Returns the output for a rig with its targets at `time`, in seconds. `order` has the rig's
    /// joints in the file's order.
    ///
    /// # Errors
    ///
    /// Fails with the name of a joint whose position overflows.
    pub fn new(
        rig: &'a SkeletonRig,
        order: &[JointId],
        time: f64,
        report: Option<Report>,
    ) -> Result<Self, &'a str> {
        let mut index_of = vec![JointId::default(); order.len()];
        for (index, joint) in order.iter().enumerate() {
            index_of[joint.index()] = JointId::new(index);
        }
        let pose = rig.skeleton.pose();
        let joints = order.iter().enumerate().map(|(index, &joint)| {
            let bone = &rig.skeleton[joint];
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
        let targets = rig.targets_at(time).into_iter().map(|target| {
            let tip = pose.tip(target.joint);
            let error = target.point.as_dvec3().distance(tip.as_dvec3());
            TargetLine {
                joint: index_of[target.joint.index()],
                target: target.point,
                tip,
                error: (error as f32).min(f32::MAX),
            }
        });
        let targets = targets.collect();
        let report = report.map(|report| ReportLine {
            solver: report.method.name(),
            iterations: report.iterations,
            error: report.error,
            converged: report.converged(),
        });
        Ok(Self { joints, targets, report })
    }
}

/// Converts radians to degrees. Computes in f64, so that 90 degrees in the file are printed as 90.
/// Overflow is clamped to ±f32::MAX.
fn degrees(radians: Vec3) -> Vec3 {
    let degrees = radians.as_dvec3() * 1_f64.to_degrees();
    saturate_vector(degrees)
}
