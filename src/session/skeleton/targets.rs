use glam::Vec3;

use crate::document::{Channel, Document, PathKind, SkeletonRig, Target};
use crate::io::enumerated;
use crate::kinematics::diagnosis::{Diagnosis, Remedy};
use crate::kinematics::skeleton::{Joint, JointId};
use crate::kinematics::twist::TwistReferenceKind;
use crate::rig::{Carried, LimbSettings, TargetSpace};
use crate::session::outcome::{Consequence, Outcome};
use crate::session::parts::PoseMode;
use crate::session::session::Session;
use crate::words::{self, significant};

/// A change of a target.
#[derive(Clone, Debug, PartialEq)]
pub enum TargetEdit {
    /// Adds a target at the tip of a joint.
    AddTarget(JointId),
    /// Adds targets for hands, feet and head of a human-like figure, where they are.
    AddHumanoidTargets,
    /// Removes the target of a joint, with its keys.
    RemoveTarget(JointId),
    /// Replaces the target of the joint [`Target::joint`].
    SetTarget(Target),
    /// Moves a joint's target to another space; it stays where it is in the world.
    SetTargetSpace {
        /// Joint of the target.
        joint: JointId,
        /// The space.
        space: TargetSpace,
    },
    /// Moves the pole of a joint's target to another space; it stays where it is in the world.
    SetPoleSpace {
        /// Joint of the target.
        joint: JointId,
        /// The space.
        space: TargetSpace,
    },
    /// Changes what the twist of a joint's limb is measured from; the elbow stays where it is.
    SetReference {
        /// Joint of the target.
        joint: JointId,
        /// The reference.
        reference: TwistReferenceKind,
    },
    /// Pins the target of a joint to the world, or unpins it; it does not move.
    Pin {
        /// Joint of the target.
        joint: JointId,
        /// True to pin it.
        is_pinned: bool,
    },
    /// Lets the target of a joint turn the hand of its limb, or the hand follow the bone above it;
    /// the hand does not turn.
    KeepHand {
        /// Joint of the target.
        joint: JointId,
        /// True if the target turns the hand.
        is_kept: bool,
    },
    /// Switches the limb of a joint's target to FK or to IK; the pose does not change, unless the
    /// soft limits exclude it.
    SwitchPoseMode {
        /// Joint of the target.
        joint: JointId,
        /// FK or IK.
        mode: PoseMode,
    },
    /// Moves the target of a joint to where the FK pose has the tip, with the hand's orientation
    /// and the elbow's side.
    MatchTargetToFk(JointId),
    /// Writes the shown pose to the FK angles of the joints that the target of a joint moves.
    MatchFkToPose(JointId),
    /// Applies a remedy for a target that is not reached.
    ApplyRemedy {
        /// Joint of the target.
        target: JointId,
        /// The remedy.
        remedy: Remedy,
    },
}

impl TargetEdit {
    /// Label of the edit's undo step.
    pub fn label(&self) -> &'static str {
        match self {
            Self::AddTarget(_) => "Add target",
            Self::AddHumanoidTargets => "Add targets",
            Self::RemoveTarget(_) => "Remove target",
            // A finer one is given by `changed_label`.
            Self::SetTarget(_) => "Change target",
            Self::MatchTargetToFk(_) => "Move target to FK",
            Self::MatchFkToPose(_) => "Write pose to FK",
            Self::SetTargetSpace { .. } => "Change target space",
            Self::SetPoleSpace { .. } => "Change pole space",
            Self::SetReference { .. } => "Change twist reference",
            Self::Pin { is_pinned: true, .. } => "Pin target",
            Self::Pin { is_pinned: false, .. } => "Unpin target",
            Self::KeepHand { .. } => "Turn hand",
            Self::SwitchPoseMode { mode: PoseMode::Hand, .. } => "Switch to IK",
            Self::SwitchPoseMode { mode: PoseMode::Angles, .. } => "Switch to FK",
            Self::ApplyRemedy { remedy, .. } => remedy_label(remedy),
        }
    }

    pub(in crate::session) fn apply(self, session: &mut Session) -> Outcome {
        let (shown, time) = (session.shown(), session.playback().time());
        match self {
            Self::AddTarget(joint) => add(session, joint),
            Self::AddHumanoidTargets => add_humanoid(session),
            Self::RemoveTarget(joint) => remove(shown, joint),
            Self::SetTarget(target) => set_target(session, target),
            Self::MatchTargetToFk(joint) => {
                matched(session, joint, SkeletonRig::match_target_to_fk)
            }
            Self::MatchFkToPose(joint) => Outcome::from(Consequence::ResetPosture).and(matched(
                session,
                joint,
                SkeletonRig::match_fk_to_pose,
            )),
            Self::SetTargetSpace { joint, space } => {
                Outcome::change(shown, |document| document.set_target_space(joint, space, time))
            }
            Self::SetPoleSpace { joint, space } => {
                Outcome::change(shown, |document| document.set_pole_space(joint, space, time))
            }
            Self::SetReference { joint, reference } => set_reference(session, joint, reference),
            Self::Pin { joint, is_pinned } => Outcome::change(shown, |document| {
                if let Some(index) = document.rig.target(joint) {
                    let target = document.rig.targets[index];
                    let pinned = target.with_pinned(is_pinned, session.posed().skeleton(), time);
                    document.rig.targets[index] = pinned;
                }
            }),
            Self::KeepHand { joint, is_kept } => {
                Outcome::change(shown, |document| document.set_hand_kept(joint, is_kept, time))
            }
            Self::SwitchPoseMode { joint, mode } => switch_pose_mode(session, joint, mode),
            Self::ApplyRemedy { target, remedy } => apply_remedy(session, target, &remedy),
        }
    }
}

/// Label of the undo step that replaces the target of a joint: what differs from the present one.
pub(in crate::session) fn changed_label(session: &Session, target: &Target) -> &'static str {
    let rig = session.rig();
    let Some(index) = rig.target(target.joint) else { return "Change target" };
    let now = &rig.targets[index];
    let differs =
        |part: fn(&LimbSettings) -> Option<Vec3>| target.limb().map(part) != now.limb().map(part);
    if [target.home, target.pin] != [now.home, now.pin] {
        "Move target"
    } else if target.influence != now.influence {
        "Blend FK and IK"
    } else if differs(|limb| Some(Vec3::X * limb.twist)) {
        "Set Socket twist"
    } else if differs(|limb| limb.pole) {
        "Move pole"
    } else if target.aim != now.aim {
        "Aim target"
    } else if target.orientation != now.orientation {
        if target.limb().is_some() { "Turn hand" } else { "Turn target" }
    } else if target.limb().map(|it| it.soft_reach) != now.limb().map(|it| it.soft_reach) {
        "Change soft reach"
    } else {
        "Change target"
    }
}

/// Changes the twist reference of a limb and of all keys of its twist; the elbow does not move. If
/// the converted keys give the shown twist at the playhead, there is no unkeyed edit.
fn set_reference(session: &Session, joint: JointId, reference: TwistReferenceKind) -> Outcome {
    let channel = Channel::TargetTwist(joint);
    let was_overridden = session.history().is_overridden(channel);
    let forget = (!was_overridden).then_some(Consequence::ForgetLikeKeys(channel));
    let time = session.playback().time();
    Outcome::change(session.shown(), |document| {
        document.set_limb_reference(joint, reference, time);
    })
    .and(forget)
}

/// Switches a limb to FK or IK. The pose does not change, unless the soft limits exclude it.
fn switch_pose_mode(session: &Session, joint: JointId, mode: PoseMode) -> Outcome {
    let Some(index) = session.rig().target(joint) else { return Outcome::default() };
    let time = session.playback().time();
    let before = session.posed().clone().into_known().carried().unwrap_or_default();
    let say = session
        .posed()
        .limb_frames(joint)
        .map(|limb| Consequence::SayIfLimbMoved(joint, Box::new(limb)));
    Outcome::change(session.shown(), |document| match mode {
        PoseMode::Hand => {
            let mut posed = document.rig.clone();
            if posed.targets[index].is_posing() {
                posed.match_fk_to_pose(index, time, &before);
            }
            posed.match_target_to_fk(index, time, &before);
            document.rig.targets[index] = Target { influence: 1.0, ..posed.targets[index] };
            if let (Some(limb), Some(fk_stretch)) =
                (document.rig.targets[index].limb_mut(), fk_stretch(session.rig(), index))
            {
                limb.fk_stretch = fk_stretch;
            }
        }
        PoseMode::Angles => {
            document.rig.match_fk_to_pose(index, time, &before);
            document.rig.targets[index].influence = 0.0;
        }
    })
    .and(say)
}

fn fk_stretch(rig: &SkeletonRig, index: usize) -> Option<f32> {
    Some(rig.targets[index].limb()?.fk_stretch)
}

fn remedy_label(remedy: &Remedy) -> &'static str {
    match remedy {
        Remedy::MoveTarget { .. } => "Move target",
        Remedy::Lengthen { .. } => "Lengthen bones",
        Remedy::SetRoot(_) => "Change root",
        Remedy::FollowBody => "Let body follow",
        Remedy::FreeBalance => "Remove balance",
        Remedy::LengthenChain { .. } => "Lengthen chain",
        Remedy::WidenLimits(_) => "Widen limits",
        Remedy::Unlock(_) => "Unlock joints",
        Remedy::SwitchOff(_) => "Switch off target",
        Remedy::SetWeight { .. } => "Change weight",
        Remedy::FreeTurn(_) => "Free turn",
        Remedy::FreePlace(_) => "Free place",
        Remedy::UseMethod(_) => "Change solver",
        Remedy::StartFrom(_) => "Change start",
        Remedy::AllowIterations(_) => "Allow iterations",
        Remedy::FullInfluence(_) => "Change influence",
        Remedy::Stretch { .. } | Remedy::HardLimits(_) => "Change soft reach",
    }
}

/// Adds a target for a joint that has none.
fn add(session: &Session, joint: JointId) -> Outcome {
    let pose = &session.posed().evaluated_skeleton().solved;
    let Some(target) = session.rig().new_target(joint, pose) else {
        return Outcome::default();
    };
    if !target.home.is_finite() {
        let home = target.home;
        return Outcome::fail(format!("The position of a target must be finite, got {home}"));
    }
    Outcome::change(session.shown(), |document| document.rig.targets.push(target))
}

/// Adds targets for hands, feet and head of a human-like figure, and says which.
fn add_humanoid(session: &Session) -> Outcome {
    let pose = &session.posed().evaluated_skeleton().solved;
    let edited = Outcome::edit_with(session.shown(), |document| {
        let added = document
            .rig
            .add_humanoid_targets(pose)
            .map_err(|why| format!("{why}: add targets by hand, with a joint selected and T"))?;
        let end = |joint: JointId| document.rig.end_of_target(joint).unwrap_or(joint);
        let name = |joint: JointId| document.skeleton()[joint].name.clone();
        let names: Vec<String> = added.into_iter().map(|joint| name(end(joint))).collect();
        Ok::<_, String>(enumerated(&names, "and"))
    });
    match edited {
        Err(refused) => refused,
        Ok((_, names)) if names.is_empty() => {
            Outcome::fail("Hands, feet and head have targets already")
        }
        Ok((written, names)) => written.and(Outcome::say(format!("Added targets: {names}"))),
    }
}

/// Removes the target of a joint, with its keys.
fn remove(shown: &Document, joint: JointId) -> Outcome {
    Outcome::change(shown, |document| {
        document.rig.targets.retain(|target| target.joint != joint);
        Channel::of_target(joint).into_iter().for_each(|it| document.keys.clear(it));
    })
}

/// Matches the FK pose and a target, at the playhead.
fn matched(
    session: &Session,
    joint: JointId,
    matched: fn(&mut SkeletonRig, usize, f64, &Carried),
) -> Outcome {
    let Some(index) = session.rig().target(joint) else {
        return Outcome::default();
    };
    let time = session.playback().time();
    let before = session.posed().clone().into_known().carried().unwrap_or_default();
    Outcome::change(session.shown(), |document| {
        matched(&mut document.rig, index, time, &before);
    })
}

/// Replaces the target of a joint.
pub(in crate::session) fn set_target(session: &Session, target: Target) -> Outcome {
    if let Some(fault) = fault(&target) {
        return Outcome::fail(fault);
    }
    let Some(index) = session.rig().target(target.joint) else {
        return Outcome::default();
    };
    Outcome::change(session.shown(), |document| document.rig.targets[index] = target)
}

/// The rule that a target breaks; `None` for a valid one.
fn fault(target: &Target) -> Option<String> {
    let Target { home, pin, motion, weight, softness, influence, .. } = *target;
    let above_0 = |value: f32| value.is_finite() && value > 0.0;
    if !home.is_finite() {
        Some(format!("The position of a target must be finite, got {home}"))
    } else if !pin.is_finite() {
        Some(format!("The position of a pinned target must be finite, got {pin}"))
    } else if !(above_0(weight) || weight == 0.0 && target.turns_joint()) {
        Some(format!(
            "The weight of a target must be finite and above 0, or 0 for one that turns a joint, got \
             {weight}"
        ))
    } else if !(above_0(motion.period) && motion.radius.is_finite()) {
        Some("The path of a target must have a period above 0 and a finite radius".to_owned())
    } else if !(0.0..=1.0).contains(&influence) {
        Some(format!("The influence of a target must be from 0 to 1, got {influence}"))
    } else if !(0.0..1.0).contains(&softness) {
        Some(format!("The softness of a target must be from 0 to less than 1, got {softness}"))
    } else if target.limb().is_some_and(LimbSettings::lacks_pole) {
        Some("A limb with the reference Pole must have a pole".to_owned())
    } else if !target.has_finite_kind() {
        Some(
            "The twist, pole, orientation, aim and FK stretch of a target must be finite"
                .to_owned(),
        )
    } else {
        None
    }
}

/// Applies a remedy for a target that is not reached, and says what it did.
fn apply_remedy(session: &mut Session, target: JointId, remedy: &Remedy) -> Outcome {
    let time = session.playback().time();
    let edited =
        Outcome::edit_with(session.shown(), |document| document.rig.apply_remedy(remedy, time));
    match edited {
        Ok((written, _)) => drop(session.act(written)),
        Err(refused) => return refused,
    }
    let rig = session.rig();
    let done = words::remedy_done(rig, remedy);
    let result = match rig.target(target).filter(|index| rig.targets[*index].enabled) {
        Some(index) => describe_result(session, rig, index),
        None => String::new(),
    };
    Outcome::say(format!("{done}{result}"))
}

fn describe_result(session: &Session, rig: &SkeletonRig, index: usize) -> String {
    let Some(report) = session.posed().evaluated_skeleton().targets.get(index) else {
        return String::new();
    };
    let name = &rig.skeleton[rig.end_of(&rig.targets[index])].name;
    let missing = significant(report.rotation_error.unwrap_or_default().to_degrees());
    if rig.is_reached(report) {
        format!(": {name} is at its target now")
    } else if report.error > rig.tolerance() {
        format!(": {name} is {} from its target now", significant(report.error))
    } else {
        format!(": {name} is {missing}° short of its target's rotation now")
    }
}

/// Why targets are not reached.
impl Session {
    /// The causes for which the target of the selected joint is not reached, the most likely first;
    /// without such a target, those of the posing target that is farthest from its tip. Empty if
    /// all are reached, and while something is dragged or plays. Also empty if they are not known
    /// since the last change, unless `finds_out`.
    pub fn why(&self, finds_out: bool) -> &[Diagnosis] {
        if !finds_out && !self.evaluated().knows_why() {
            return &[];
        }
        examined_target(self).map_or(&[], |index| self.why_target(index, finds_out))
    }

    /// The causes for which the target with this index in
    /// [`SkeletonRig::targets`](crate::rig::SkeletonRig::targets) is not reached. Empty if they are
    /// not known since the last change, unless `finds_out`.
    pub fn why_target(&self, index: usize, finds_out: bool) -> &[Diagnosis] {
        let (rig, time) = (self.rig(), self.playback().time());
        let targets = rig.targets.len();
        let is_moving = self.history().is_editing() || self.playback().is_playing();
        if is_moving || rig.is_on_path(time) || index >= targets {
            &[]
        } else if finds_out {
            let before = || self.posed().carried().unwrap_or_default();
            let diagnose = || rig.diagnose_targets(&[index], time, &before());
            self.evaluated().why(index, targets, diagnose)
        } else {
            self.evaluated().known_why(index)
        }
    }
}

/// The selected joint's target if it is not reached, or else the posing one farthest from its tip;
/// if all tips are at their targets, the one whose hand misses most of its rotation.
fn examined_target(session: &Session) -> Option<usize> {
    let (rig, reports) = (session.rig(), session.posed().targets());
    let is_missed =
        |index: &usize| reports.get(*index).is_some_and(|report| !rig.is_reached(report));
    let selected = session.selection().active().and_then(|joint| rig.target_of_end(joint));
    let selected = selected.filter(|index| rig.targets[*index].enabled).filter(is_missed);
    let posing =
        rig.targets.iter().zip(reports).enumerate().filter(|(_, (it, _))| rig.is_solved_for(it));
    let missed = posing.filter(|(_, (_, report))| !rig.is_reached(report));
    let most = missed.max_by(|(_, (_, one)), (_, (_, other))| {
        let [one, other] = [one, other].map(|report| {
            let distance = if report.error > rig.tolerance() { report.error } else { 0.0 };
            (distance, report.rotation_error.unwrap_or_default())
        });
        one.0.total_cmp(&other.0).then(one.1.total_cmp(&other.1))
    });
    selected.or(most.map(|(index, _)| index))
}

/// A change of the path that a chain follows.
#[derive(Clone, Debug, PartialEq)]
pub enum PathEdit {
    /// Sets the path that the chain of a root follows; `None` for no path.
    SetFollowPath {
        /// The root.
        root: JointId,
        /// The cause of its motion.
        kind: Option<PathKind>,
    },
    /// Moves a root to a point of skeleton space. With
    /// [`PathKind::Head`](crate::document::PathKind::Head), the chain below it follows.
    SetHead {
        /// The root.
        root: JointId,
        /// Its new place.
        to: Vec3,
    },
}

impl PathEdit {
    /// Label of the edit's undo step.
    pub fn label(&self) -> &'static str {
        match self {
            Self::SetFollowPath { .. } => "Change path",
            Self::SetHead { .. } => "Move head",
        }
    }

    pub(in crate::session) fn apply(self, session: &Session) -> Outcome {
        let rig = session.rig();
        match self {
            Self::SetFollowPath { root, .. } if rig.root_of(root) != Some(root) => {
                Outcome::fail(format!("The joint of a path must be a root, got joint {root}"))
            }
            Self::SetFollowPath { root, kind } if kind.as_ref().is_none_or(PathKind::is_valid) => {
                Outcome::edit_rig(session.shown(), |rig| {
                    rig.follow_paths = rig.with_path(root, kind);
                    Ok(())
                })
            }
            Self::SetFollowPath { .. } => {
                Outcome::fail("The path to follow must have a period above 0 and finite lengths")
            }
            Self::SetHead { root, to } if rig.root_of(root) == Some(root) => {
                move_head(session, root, rig.clone(), &[to])
            }
            Self::SetHead { root, .. } => {
                Outcome::fail(format!("A head must be a root, got joint {root}"))
            }
        }
    }
}

/// Moves the head of a chain of `before` through points of skeleton space, and writes the joints
/// that follow a path to the shown skeleton.
pub(in crate::session) fn move_head(
    session: &Session,
    root: JointId,
    mut before: SkeletonRig,
    points: &[Vec3],
) -> Outcome {
    if let Some(wrong) = points.iter().find(|point| !point.is_finite()) {
        return Outcome::fail(format!("The position of the head must be finite, got {wrong}"));
    }
    let has_keys = before.head_tracks.contains_key(&root);
    before.pull_head(root, points);
    let moved = before.path_joints(root).take(if has_keys { 1 } else { usize::MAX });
    Outcome::edit_rig(session.shown(), |rig| {
        let count = rig.skeleton.joints().len();
        for joint in moved.filter(|joint| joint.index() < count) {
            let Joint { offset, rotation, .. } = before.skeleton[joint];
            rig.skeleton_mut().write_local(joint, |joint| {
                (joint.offset, joint.rotation) = (offset, rotation);
            });
        }
        Ok(())
    })
}
