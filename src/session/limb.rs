use crate::document::{Document, LengthFormat, Posed};
use crate::kinematics::skeleton::JointId;
use crate::rig::{LimbFrames, SkeletonRig};

/// The limb that pages and guides are about: that of the selected joint, else the first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShownLimb {
    /// The joint of the limb's target.
    pub target: JointId,
    /// The limb in its frames.
    pub frames: LimbFrames,
    /// Words for its joints.
    pub words: LimbWords,
}

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

    /// Words for a limb with these names of its joints.
    pub fn of<'a>(names: impl IntoIterator<Item = &'a str>) -> Self {
        const OF_LEGS: [&str; 9] =
            ["leg", "thigh", "hip", "knee", "shin", "calf", "foot", "ankle", "toe"];
        let is_of_leg = |name: &str| {
            let name = name.to_lowercase();
            OF_LEGS.into_iter().any(|part| name.contains(part))
        };
        if names.into_iter().any(is_of_leg) { Self::LEG } else { Self::ARM }
    }
}

impl ShownLimb {
    /// The limb of a posed document that is shown while `selected` is the active joint; `None`
    /// without a limb.
    pub fn new(posed: &Posed, selected: Option<JointId>) -> Option<Self> {
        let document = posed.document();
        let target = Self::target(document, selected)?;
        let frames = posed.limb_frames(target)?;
        Some(Self { target, frames, words: words_of(&document.rig, target) })
    }

    /// [`ShownLimb::new`] without its words, which take memory.
    pub fn frames(posed: &Posed, selected: Option<JointId>) -> Option<LimbFrames> {
        posed.limb_frames(Self::target(posed.document(), selected)?)
    }

    /// The joint of the target of the shown limb.
    fn target(document: &Document, selected: Option<JointId>) -> Option<JointId> {
        let rig = &document.rig;
        let of_selected = selected.and_then(|joint| rig.limb_target_of(joint));
        let first = || rig.targets.iter().position(|it| it.limb().is_some());
        let index = of_selected.or_else(first)?;
        Some(rig.targets[index].joint)
    }

    /// The format of the limb's lengths.
    pub fn lengths(&self) -> LengthFormat {
        LengthFormat::of_limb(self.frames.bones())
    }
}

fn words_of(rig: &SkeletonRig, target: JointId) -> LimbWords {
    let joints = rig.limb_joints(target);
    LimbWords::of(joints.filter_map(|it| Some(rig.skeleton.joint(it)?.name.as_str())))
}

#[cfg(test)]
mod tests {
    use super::*;

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
