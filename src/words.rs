//! Diagnoses and their remedies as English sentences, without a full stop, and words for the joints
//! of limbs.

use crate::kinematics::chain_ik::Root;
use crate::kinematics::diagnosis::{
    Boundary, Cause, Diagnosis, Remedy, Start, WidenedLimit, WiderLimit,
};
use crate::kinematics::skeleton::{JointId, RotationAxis};
use crate::rig::{RigPop, RigPopCause, SkeletonRig};

/// Words for the joints of a limb, in lower case.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LimbWords {
    /// The upper joint.
    pub base: &'static str,
    /// The lower joint.
    pub middle: &'static str,
    /// What the target moves.
    pub end: &'static str,
}

impl LimbWords {
    /// Words for an arm.
    pub const ARM: Self = Self { base: "shoulder", middle: "elbow", end: "hand" };
    /// Words for a leg.
    pub const LEG: Self = Self { base: "hip", middle: "knee", end: "foot" };

    /// Words for the limb of a joint's target.
    pub fn of_target(rig: &SkeletonRig, target: JointId) -> Self {
        let joints = rig.limb_joints(target);
        Self::of(joints.filter_map(|it| Some(rig.skeleton.joint(it)?.name.as_str())))
    }

    /// True for one of these words.
    fn has(name: &str) -> bool {
        [Self::ARM, Self::LEG].iter().any(|it| [it.base, it.middle, it.end].contains(&name))
    }

    /// Words for a limb with these names of its joints.
    fn of<'a>(names: impl IntoIterator<Item = &'a str>) -> Self {
        const OF_LEGS: [&str; 9] =
            ["leg", "thigh", "hip", "knee", "shin", "calf", "foot", "ankle", "toe"];
        let is_of_leg = |name: &str| {
            let name = name.to_lowercase();
            OF_LEGS.into_iter().any(|part| name.contains(part))
        };
        if names.into_iter().any(is_of_leg) { Self::LEG } else { Self::ARM }
    }
}

/// The cause of a diagnosis, such as "The limits of the elbow keep the hand away from its target". A
/// limb's target is named after its hand.
pub fn cause(rig: &SkeletonRig, found: &Diagnosis) -> String {
    sentence(with_names(rig, |names| {
        let target = (names.tip)(found.target);
        match found.cause {
            Cause::OutOfReach { base, distance, shortest, longest, boundary } => {
                let base = (names.base)(found.target, base);
                out_of_reach([&target, &base], distance, [shortest, longest], boundary)
            }
            Cause::Limits if found.joints == [found.target] => {
                format!("The limits of {target} itself keep its tip away from the target")
            }
            Cause::Limits => {
                format!(
                    "The limits of {} keep {target} away from its target",
                    listed(&found.joints, names)
                )
            }
            Cause::RotationLimits { missing, axes } => {
                let (degrees, limits) = (significant(missing.to_degrees()), limits_about(axes));
                format!(
                    "{target} is {degrees}° short of its target's rotation: {limits} in the way"
                )
            }
            Cause::Turn { missing, is_had_alone } => {
                let index = rig.target(found.target);
                let is_aim = index.is_some_and(|index| rig.targets[index].aim.is_some());
                let turn = if is_aim { "aim" } else { "rotation" };
                if is_had_alone {
                    format!("{target} reaches its target's place or has its {turn}, but not both")
                } else {
                    let degrees = significant(missing.to_degrees());
                    format!(
                        "{target} can be at its target, but stays {degrees}° short of its {turn}"
                    )
                }
            }
            Cause::Locked => {
                let verb = if found.joints.len() == 1 { "is" } else { "are" };
                format!(
                    "{} {verb} locked, and {target} needs to turn there",
                    listed(&found.joints, names)
                )
            }
            Cause::Conflict { with } => {
                let other = (names.tip)(with);
                format!("{target} and {other} reach their targets one at a time, not together")
            }
            Cause::Stalled => {
                format!(
                    "The solver stopped where no small turn helps, though {target} can get nearer"
                )
            }
            Cause::Lost => format!(
                "{target} can reach its target from another pose, but not from the one to which the motion came"
            ),
            Cause::Singular { .. } => {
                format!("No joint can move {target} in the direction of its target")
            }
            Cause::OutOfIterations { iterations } => {
                let s = if iterations == 1 { "" } else { "s" };
                format!(
                    "{target} was still coming nearer when the solver stopped after {iterations} iteration{s}"
                )
            }
            Cause::Balance => {
                format!("The balance keeps the body from following {target} to its target")
            }
            Cause::ShortChain { length } => {
                let s = if length == 1 { "" } else { "s" };
                format!("The chain of {target} turns {length} joint{s}, and needs more")
            }
            Cause::Influence { influence: 0.0 } => {
                format!("The target of {target} has no influence: the joint angles alone pose it")
            }
            Cause::Influence { influence } => {
                let percent = significant(100.0 * influence);
                format!("{target} is only {percent} % of the way from its FK pose to its target")
            }
        }
    }))
}

/// Begins a sentence with a capital, unless it begins with the name of a joint.
fn sentence(text: String) -> String {
    match text.strip_prefix("the ") {
        Some(rest) => format!("The {rest}"),
        None => text,
    }
}

/// A remedy as an imperative, such as "Unlock the elbow".
pub fn remedy(rig: &SkeletonRig, remedy: &Remedy) -> String {
    with_names(rig, |names| {
        let (verb, rest) = verb_and_rest(remedy, names);
        format!("{} {rest}", verb.imperative())
    })
}

/// A remedy that was applied, such as "Unlocked the elbow".
pub fn remedy_done(rig: &SkeletonRig, remedy: &Remedy) -> String {
    with_names(rig, |names| {
        let (verb, rest) = verb_and_rest(remedy, names);
        format!("{} {rest}", verb.past())
    })
}

fn with_names(rig: &SkeletonRig, say: impl FnOnce(Names<'_>) -> String) -> String {
    let joint = |joint: JointId| match rig.skeleton.joint(joint).map(|it| it.name.as_str()) {
        // The hand of the arm is called "hand".
        Some(name) if LimbWords::has(name) => format!("the {name}"),
        name => name.unwrap_or_default().to_owned(),
    };
    let tip = |of: JointId| joint(rig.end_of_target(of).unwrap_or(of));
    let base = |of: JointId, first: JointId| match rig.target(of) {
        Some(index) if rig.targets[index].limb().is_some() => {
            format!("the {}", LimbWords::of_target(rig, of).base)
        }
        _ => joint(first),
    };
    say(Names { joint: &joint, tip: &tip, base: &base })
}

/// Names for sentences.
#[derive(Clone, Copy)]
struct Names<'a> {
    /// The name of a joint.
    joint: &'a dyn Fn(JointId) -> String,
    /// The name of what the target of a joint moves: the hand of an arm's lower bone, or the joint.
    tip: &'a dyn Fn(JointId) -> String,
    /// What the chain of a joint's target begins with: "the shoulder" or "the hip" of a limb, else
    /// the name of the first joint.
    base: &'a dyn Fn(JointId, JointId) -> String,
}

/// The cause of a pop, such as "the knee of left_foot moves 4 times as far as its target: a joint of the
/// chain meets its limit".
pub fn pop(rig: &SkeletonRig, pop: &RigPop) -> String {
    with_names(rig, |names| {
        let tip = (names.tip)(pop.target);
        let words = LimbWords::of_target(rig, pop.target);
        let limb = rig.target(pop.target).and_then(|it| rig.targets[it].limb_in(&rig.skeleton));
        let joint = match limb {
            Some(limb) if pop.joint == limb.upper => format!("the {} of {tip}", words.middle),
            Some(limb) if pop.joint == limb.lower => tip.clone(),
            _ => (names.joint)(pop.joint),
        };
        let why = match pop.cause {
            RigPopCause::TargetJump => format!("the target of {tip} jumps"),
            RigPopCause::FkJump => "the joint angles jump".to_owned(),
            RigPopCause::Switched => format!("the target of {tip} begins or ends to pose it"),
            RigPopCause::Lost => format!("{tip} loses its target"),
            RigPopCause::Found => format!("{tip} catches up with its target"),
            RigPopCause::ByItself => {
                "each frame is solved by itself, and neighbouring frames find other poses"
                    .to_owned()
            }
            RigPopCause::LimitMet => "a joint of the chain meets its limit".to_owned(),
            RigPopCause::LimitLeft => "a joint of the chain leaves its limit".to_owned(),
            RigPopCause::Straight => format!("the bones to {tip} are nearly straight"),
            RigPopCause::Folded => format!("{tip} is near the base of its chain"),
            RigPopCause::Singular => {
                format!("the {}'s reference is near a direction in which it flips", words.middle)
            }
            RigPopCause::StraightFk => format!(
                "the joint angles pose the limb straight and give the {} no side",
                words.middle
            ),
            RigPopCause::TurnsOver => {
                format!("bones are in line with the way of {tip}, and the solver turns them over")
            }
            RigPopCause::Returns => "it swings back towards its joint angles".to_owned(),
            RigPopCause::AtLimit => {
                "other joints of the chain are at their limits, and it makes up for them".to_owned()
            }
            RigPopCause::Seam => "the motion begins again in another pose".to_owned(),
            RigPopCause::Unknown => "no cause was found".to_owned(),
        };
        format!("{joint} moves {} times as far as its target: {why}", significant(pop.ratio))
    })
}

/// A lost target, such as "The hand misses its target by 0.2, but reaches it from another pose".
pub fn lost(rig: &SkeletonRig, target: JointId, miss: f32) -> String {
    with_names(rig, |names| {
        let (tip, miss) = ((names.tip)(target), significant(miss));
        sentence(format!("{tip} misses its target by {miss}, but reaches it from another pose"))
    })
}

fn verb_and_rest(remedy: &Remedy, names: Names<'_>) -> (Verb, String) {
    let tip = |joint: &JointId| (names.tip)(*joint);
    match remedy {
        Remedy::MoveTarget { joint, .. } => {
            (Verb::Move, format!("the target of {} within reach", tip(joint)))
        }
        Remedy::Lengthen { factor, .. } => {
            (Verb::Lengthen, format!("the bones by {}", percent(*factor - 1.0)))
        }
        Remedy::FollowBody => (Verb::Let, "the whole body follow".to_owned()),
        Remedy::FreeBalance => (Verb::SwitchOff, "the balance".to_owned()),
        Remedy::LengthenChain { joint, length } => {
            (Verb::Let, format!("the chain of {} turn {length} joints", tip(joint)))
        }
        Remedy::SetRoot(Root::Free) => (Verb::Let, "the root move".to_owned()),
        Remedy::SetRoot(Root::Turns) => (Verb::Let, "the root turn".to_owned()),
        Remedy::SetRoot(Root::Locked) => (Verb::Lock, "the root".to_owned()),
        Remedy::WidenLimits(widened) => (Verb::Widen, widen(widened, names)),
        Remedy::Unlock(joints) => (Verb::Unlock, listed(joints, names)),
        Remedy::SwitchOff(joint) => (Verb::SwitchOff, format!("the target of {}", tip(joint))),
        Remedy::SetWeight { joint, weight } => {
            let weight = significant(*weight);
            (Verb::Set, format!("the weight of the target of {} to {weight}", tip(joint)))
        }
        Remedy::FreeTurn(joint) => {
            (Verb::Free, format!("the turn of the target of {}", tip(joint)))
        }
        Remedy::FreePlace(joint) => {
            (Verb::Free, format!("the place of the target of {}", tip(joint)))
        }
        Remedy::UseMethod(method) => (Verb::Set, format!("the solver to {}", method.title())),
        Remedy::StartFrom(Start { is_bend: true, .. }) => {
            (Verb::Bend, "the chain a little".to_owned())
        }
        Remedy::StartFrom(_) => (Verb::Move, "the joints to the middle of their limits".to_owned()),
        Remedy::AllowIterations(iterations) => (Verb::Allow, format!("{iterations} iterations")),
        Remedy::FullInfluence(joint) => {
            (Verb::Set, format!("the influence of the target of {} to 1", tip(joint)))
        }
        Remedy::Stretch { max_stretch, .. } => {
            (Verb::Let, format!("the limb stretch by up to {}", percent(*max_stretch - 1.0)))
        }
        Remedy::HardLimits(_) => (Verb::SwitchOff, "the soft limits".to_owned()),
    }
}

/// The verb of a remedy.
enum Verb {
    Allow,
    Bend,
    Free,
    Lengthen,
    Let,
    Lock,
    Move,
    Set,
    SwitchOff,
    Unlock,
    Widen,
}

impl Verb {
    fn imperative(&self) -> &'static str {
        match self {
            Self::Allow => "Allow",
            Self::Bend => "Bend",
            Self::Free => "Free",
            Self::Lengthen => "Lengthen",
            Self::Let => "Let",
            Self::Lock => "Lock",
            Self::Move => "Move",
            Self::Set => "Set",
            Self::SwitchOff => "Switch off",
            Self::Unlock => "Unlock",
            Self::Widen => "Widen",
        }
    }

    fn past(&self) -> &'static str {
        match self {
            Self::Allow => "Allowed",
            Self::Bend => "Bent",
            Self::Free => "Freed",
            Self::Lengthen => "Lengthened",
            Self::Lock => "Locked",
            Self::Move => "Moved",
            Self::Let | Self::Set => self.imperative(),
            Self::SwitchOff => "Switched off",
            Self::Unlock => "Unlocked",
            Self::Widen => "Widened",
        }
    }
}

fn widen(widened: &[WidenedLimit], names: Names<'_>) -> String {
    let degrees = |it: &WidenedLimit| it.by.to_degrees().round();
    match widened {
        [one] => {
            let name = (names.joint)(one.joint);
            match one.to {
                WiderLimit::Range { axis, .. } => {
                    format!("the limit of {name} about {axis} by {}°", degrees(one))
                }
                WiderLimit::Cone(_) => format!("the cone of {name} by {}°", degrees(one)),
            }
        }
        several => {
            let most = several.iter().map(degrees).fold(0.0, f32::max);
            format!("{} limits by up to {most}°", several.len())
        }
    }
}

/// Joints as a list in words, at most three of them by name.
fn listed(joints: &[JointId], names: Names<'_>) -> String {
    let names: Vec<_> = joints.iter().map(|joint| (names.joint)(*joint)).collect();
    match &names[..] {
        [] => "the chain".to_owned(),
        [one] => one.clone(),
        [one, two] => format!("{one} and {two}"),
        [one, two, three] => format!("{one}, {two} and {three}"),
        [one, two, rest @ ..] => format!("{one}, {two} and {} more joints", rest.len()),
    }
}

/// Limits of a joint with their verb, such as "its limits about x and z are".
fn limits_about(axes: [bool; 3]) -> String {
    let named: Vec<String> = RotationAxis::ALL
        .into_iter()
        .zip(axes)
        .filter(|(_, is_in_the_way)| *is_in_the_way)
        .map(|(axis, _)| axis.to_string())
        .collect();
    match &named[..] {
        [] => "its limits are".to_owned(),
        [one] => format!("its limit about {one} is"),
        [first @ .., last] => format!("its limits about {} and {last} are", first.join(", ")),
    }
}

fn out_of_reach(
    [target, base]: [&str; 2],
    distance: f32,
    [shortest, longest]: [f32; 2],
    boundary: Boundary,
) -> String {
    let (at, least, most) = (significant(distance), significant(shortest), significant(longest));
    let is_far = distance > 0.5 * (shortest + longest);
    match boundary {
        Boundary::Bones if is_far => format!(
            "{target} cannot reach that far: the target is {at} from {base}, the bones are {most} long"
        ),
        Boundary::Bones => format!(
            "{target} cannot come that near: the target is {at} from {base}, the bones fold to {least}"
        ),
        Boundary::SoftLimit => {
            let end = if is_far { "straight" } else { "folded" };
            format!("The soft limits slow {target} down before the limb is {end}")
        }
        Boundary::ElbowAngle => format!(
            "The smallest elbow angle keeps {target} away from its target, {at} from {base}"
        ),
    }
}

/// A fraction in percent, rounded up.
fn percent(fraction: f32) -> String {
    format!("{} %", (100.0 * fraction).ceil())
}

/// A number with three significant digits, without trailing zeros, such as `0.0123` or `150`, and
/// in scientific notation if it is very large.
pub fn significant(value: f32) -> String {
    const LARGE: f32 = 1e9;
    match value.abs() {
        size if size.is_nan() || size >= f32::MAX => return "more than numbers hold".to_owned(),
        LARGE.. => return format!("{value:.2e}"),
        _ => {}
    }
    let magnitude = value.abs().log10().floor();
    let decimals =
        if magnitude.is_finite() { (2.0 - magnitude).clamp(0.0, 8.0) as usize } else { 0 };
    let text = format!("{value:.decimals$}");
    if text.contains('.') {
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        text
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;
    use crate::kinematics::skeleton::{Joint, Skeleton};
    use crate::rig::{Carried, LimbSettings, Target, TargetKind};

    #[test]
    fn sentences_name_hands_joints_and_lengths() {
        let mut skeleton = Skeleton::with_root("root");
        let mut parent = JointId::new(0);
        for (name, length, offset) in [("upper", 1.0, 0.0), ("lower", 0.7, 1.0), ("hand", 0.2, 0.7)]
        {
            let joint = Joint::new(name, Some(parent), Vec3::X * length);
            parent = skeleton.add(Joint { offset: Vec3::X * offset, ..joint }).expect("a joint");
        }
        let mut rig = SkeletonRig::new(skeleton);
        let mut target = Target::new(JointId::new(2), Vec3::Y * 3.4, 1.0);
        target.influence = 1.0;
        target.kind = TargetKind::Limb(LimbSettings::default());
        rig.targets.push(target);
        let found = &rig.diagnose(0.0, &Carried::default())[0];
        assert_eq!(
            cause(&rig, found),
            "The hand cannot reach that far: the target is 3.4 from the shoulder, the bones are 1.7 long"
        );
        let remedies: Vec<_> =
            found.remedies.iter().map(|tried| remedy(&rig, &tried.remedy)).collect();
        assert_eq!(
            remedies,
            ["Move the target of the hand within reach", "Let the limb stretch by up to 101 %"]
        );
        assert_eq!(remedy_done(&rig, &Remedy::Unlock(found.joints.clone()))[..9], *"Unlocked ");
    }

    #[test]
    fn limits_in_the_way_are_named_by_their_axes() {
        let about = |axes: [usize; 3]| limits_about(axes.map(|is_limited| is_limited == 1));
        assert_eq!(about([0, 0, 0]), "its limits are");
        assert_eq!(about([0, 1, 0]), "its limit about y is");
        assert_eq!(about([1, 0, 1]), "its limits about x and z are");
        assert_eq!(about([1, 1, 1]), "its limits about x, y and z are");
    }

    #[test]
    fn legs_are_told_from_arms_by_the_names_of_their_joints() {
        for leg in [["left_thigh", "left_shin"], ["LeftUpLeg", "LeftLeg"], ["a", "R.Foot"]] {
            assert_eq!(LimbWords::of(leg), LimbWords::LEG, "{leg:?}");
        }
        for arm in [["left_upper_arm", "left_forearm"], ["bone 1", "bone 2"]] {
            assert_eq!(LimbWords::of(arm), LimbWords::ARM, "{arm:?}");
        }
    }
}
