//! Output of the command: a pose or the list of what a file has.

use glam::{Mat4, Vec3};
use serde::Serialize;

use crate::document::{Channel, Document, Posed, SkeletonRig};
use crate::io::{FileAnimation, Opened};
use crate::kinematics::Shared;
use crate::kinematics::angle::wrapped;
use crate::kinematics::chain_ik::{self, Report, SolveError, SolverOptions, Status};
use crate::kinematics::diagnosis::Diagnosis;
use crate::kinematics::skeleton::{JointId, Skeleton, is_within_numbers};
use crate::kinematics::two_bone::Reach;
use crate::rig::{BalanceReport, LimbFrames, LimbPart, Target, TargetKind, TargetOutcome};
use crate::words;

/// Output of the command: one line of JSON.
#[derive(Serialize)]
pub struct PoseLine<'a> {
    joints: Vec<JointLine<'a>>,
    targets: Vec<TargetLine>,
    #[serde(skip_serializing_if = "Option::is_none")]
    balance: Option<BalanceLine>,
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
    aim_error_deg: Option<f32>,
    limb: Option<LimbLine>,
}

/// Where the centre of mass is, as x and z, and where it should be.
#[derive(Serialize)]
struct BalanceLine {
    over: Option<[f32; 2]>,
    centre: [f32; 2],
    error: f32,
}

impl BalanceLine {
    fn new(report: &BalanceReport) -> Self {
        let over = report.over.map(|over| over.to_array());
        Self { over, centre: report.centre.to_array(), error: report.error() }
    }
}

/// The figures of a limb, in the words of its page in the program.
#[derive(Serialize)]
struct LimbLine {
    root: Vec3,
    pointer: Vec3,
    twist_deg: f32,
    reach: Option<&'static str>,
    upper: f32,
    lower: f32,
    distance: f32,
    along: f32,
    out: f32,
    shoulder_angle_deg: f32,
    elbow_angle_deg: f32,
}

impl LimbLine {
    fn new(limb: &LimbFrames) -> Self {
        let pose = limb.pose();
        let reach = match pose.reach {
            _ if limb.limited_by.is_some() => Some("limited"),
            Some(Reach::Reached) => Some("reached"),
            Some(Reach::TooFar) => Some("too_far"),
            Some(Reach::TooClose) => Some("too_close"),
            None => None,
        };
        let bones = limb.bones().stretched(pose.stretch);
        let pointer = limb.root.transform_vector3(pose.pointer.direction);
        Self {
            root: limb.origin(LimbPart::Root),
            pointer: pointer.normalize_or_zero(),
            twist_deg: wrapped(pose.twist).to_degrees(),
            reach,
            upper: bones.upper(),
            lower: bones.lower(),
            distance: pose.distance,
            along: pose.along,
            out: pose.out,
            shoulder_angle_deg: pose.shoulder_angle().to_degrees(),
            elbow_angle_deg: pose.elbow_angle().to_degrees(),
        }
    }
}

#[derive(Serialize)]
struct ReportLine {
    solver: &'static str,
    iterations: u32,
    error: f32,
    converged: bool,
}

impl<'a> PoseLine<'a> {
    /// Returns the output for a pose of a document. `order` has the rig's joints in the file's
    /// order.
    ///
    /// # Errors
    ///
    /// Fails with the name of a joint whose position overflows.
    pub fn new(
        posed: &'a Posed,
        answer: &'a AnsweredPose,
        order: &[JointId],
    ) -> Result<Self, &'a str> {
        let (rig, time, skeleton) = (&posed.document().rig, posed.time(), &answer.skeleton);
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
        let limb =
            |target: &Target| posed.limb_frames(target.joint).filter(|_| answer.is_evaluated);
        let targets = enabled.map(|target| {
            let (point, tip) = (target.in_world(skeleton, time), pose.tip(target.joint));
            let error = match target.has_free_place() {
                true => 0.0,
                false => point.as_dvec3().distance(tip.as_dvec3()),
            };
            let missing = rig.rotation_error(target, skeleton).map(f32::to_degrees);
            TargetLine {
                joint: index_of[target.joint.index()],
                kind: match target.kind {
                    TargetKind::Limb(_) => "limb",
                    TargetKind::WholeBody => "whole_body",
                    TargetKind::Chain(_) => "chain",
                },
                influence: target.influence,
                target: point,
                tip,
                error: (error as f32).min(f32::MAX),
                rotation_error_deg: missing.filter(|_| target.aim.is_none()),
                aim_error_deg: missing.filter(|_| target.aim.is_some()),
                limb: limb(target).as_ref().map(LimbLine::new),
            }
        });
        let targets = targets.collect();
        let report = answer.report.as_ref().map(ReportLine::new);
        let why = answer.why.iter().map(|found| WhyLine::new(found, rig)).collect();
        let balance = posed.evaluated_skeleton().balance.as_ref().filter(|_| answer.is_evaluated);
        let balance = balance.map(BalanceLine::new);
        Ok(Self { joints, targets, balance, report, why })
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

/// A pose of a rig's skeleton, with the report of the solver of several joints together, if any.
pub struct AnsweredPose {
    pub skeleton: Shared<Skeleton>,
    /// True for the evaluated pose of the document.
    is_evaluated: bool,
    pub report: Option<Report>,
    /// Why targets are not reached.
    pub why: Vec<Diagnosis>,
    /// Why the whole-body targets are not solved, or not to the end.
    pub remark: Option<String>,
}

impl AnsweredPose {
    /// The FK pose.
    pub fn fk(posed: &Posed) -> Self {
        let skeleton = posed.document().rig.fk_at(posed.time());
        Self { skeleton, is_evaluated: false, report: None, why: Vec::new(), remark: None }
    }

    /// The pose by the rig's targets.
    pub fn by_targets(posed: &Posed) -> Self {
        let outcomes = || posed.targets().iter().map(|target| &target.outcome);
        let targets = posed.document().rig.targets.iter().zip(outcomes());
        let bodies = targets.filter(|(target, _)| target.kind == TargetKind::WholeBody);
        let report = bodies.into_iter().find_map(|(_, outcome)| match outcome {
            TargetOutcome::WholeBody(report) => Some(*report),
            _ => None,
        });
        let refused = outcomes().find_map(|outcome| match outcome {
            TargetOutcome::Refused(error) => Some(format!("targets are not solved: {error}")),
            _ => None,
        });
        let bounded = report.filter(|report| report.status == Status::Bounded).map(|report| {
            let Report { iterations, status, method, .. } = report;
            format!("{method} {status}, after {iterations} iterations")
        });
        let remark = refused.or(bounded);
        let before = posed.carried().unwrap_or_default();
        let why = posed.document().rig.diagnose(posed.time(), &before);
        Self { skeleton: posed.skeleton().clone(), is_evaluated: true, report, why, remark }
    }

    /// The FK pose after a solve for all enabled targets.
    ///
    /// # Errors
    ///
    /// [`SolveError`] if the solver refuses a target.
    pub fn solved(posed: &Posed, options: &SolverOptions) -> Result<Self, SolveError> {
        let (rig, time) = (&posed.document().rig, posed.time());
        let mut skeleton = rig.fk_at(time);
        let targets = rig.targets_at(time);
        let why = chain_ik::diagnose(&skeleton, &targets, options)?;
        let report = chain_ik::solve(skeleton.make_mut(), &targets, options)?;
        Ok(Self { skeleton, is_evaluated: false, report: Some(report), why, remark: None })
    }
}

/// The skeletons, animations and targets of a file.
#[derive(Serialize)]
pub struct FileList {
    skeletons: Vec<ListedSkeleton>,
    animations: Vec<ListedAnimation>,
    targets: Vec<String>,
}

#[derive(Serialize)]
struct ListedSkeleton {
    name: String,
    /// Number of joints; `None` if the skeleton cannot be read.
    #[serde(skip_serializing_if = "Option::is_none")]
    joints: Option<usize>,
    /// True if it is the open one.
    open: bool,
}

#[derive(Serialize)]
struct ListedAnimation {
    name: String,
    /// First and last time in seconds.
    start: f64,
    end: f64,
    moving_joints: usize,
    /// True if it changes morph targets.
    #[serde(skip_serializing_if = "core::ops::Not::not")]
    morphs: bool,
    /// True if it is the open one.
    open: bool,
}

impl FileList {
    /// What a file has of which a skeleton was opened. `others` opens the skeleton of a name.
    pub fn new(opened: &Opened, others: impl Fn(&str) -> Option<Opened>) -> Self {
        let document = &opened.document;
        let rig = &document.rig;
        let names = match &opened.skeletons[..] {
            [] => vec!["skeleton".to_owned()],
            names => names.to_vec(),
        };
        let joints = |opened: &Opened| opened.document.skeleton().joints().len();
        let skeleton = |(index, name): (usize, &String)| {
            let open = opened.skeleton.is_none_or(|skeleton| skeleton == index);
            let count = if open { Some(joints(opened)) } else { others(name).as_ref().map(joints) };
            ListedSkeleton { name: name.clone(), joints: count, open }
        };
        let animations = match (&opened.animations[..], document.is_animated()) {
            ([], true) => vec![own_motion(document)],
            (animations, _) => animations.to_vec(),
        };
        let is_open = |index| opened.animation.is_none_or(|animation| animation == index);
        let listed = |(index, animation): (usize, FileAnimation)| {
            let FileAnimation { name, start, end, moving_joints, has_morphs } = animation;
            let open = is_open(index);
            ListedAnimation { name, start, end, moving_joints, morphs: has_morphs, open }
        };
        let target = |target| {
            let joint = rig.skeleton.joint(rig.end_of(target));
            joint.map_or_else(String::new, |joint| joint.name.clone())
        };
        Self {
            skeletons: names.iter().enumerate().map(skeleton).collect(),
            animations: animations.into_iter().enumerate().map(listed).collect(),
            targets: rig.targets.iter().map(target).collect(),
        }
    }
}

/// The motion of a format whose files have one motion.
fn own_motion(document: &Document) -> FileAnimation {
    let keys = &document.keys;
    let moves = |joint| keys.has(Channel::Rotation(joint)) || keys.has(Channel::Offset(joint));
    FileAnimation {
        name: document.animation_name.clone().unwrap_or_else(|| "motion".to_owned()),
        start: document.timeline.start,
        end: document.timeline.end,
        moving_joints: document.skeleton().ids().filter(|joint| moves(*joint)).count(),
        has_morphs: keys.tracks().any(|(channel, _)| matches!(channel, Channel::Morph(_))),
    }
}
