use core::fmt;

use glam::Vec3;
use thiserror::Error;

use crate::skeleton::{JointId, Skeleton, SkeletonPose};

/// An arm or a leg of a figure.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct HumanoidLimb {
    /// The shoulder or hip.
    pub upper: JointId,
    /// The elbow or knee: an ancestor of the end and a descendant of the upper joint.
    pub lower: JointId,
    /// The hand or foot.
    pub end: JointId,
}

/// The joints of a human-like figure.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Humanoid {
    /// The head; `None` for a figure without one.
    pub head: Option<JointId>,
    /// The left and the right arm.
    pub arms: [HumanoidLimb; 2],
    /// The left and the right leg.
    pub legs: [HumanoidLimb; 2],
}

/// Directions of a figure in a pose, unit vectors in skeleton space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HumanoidDirections {
    /// From the hips to the shoulders.
    pub up: Vec3,
    /// To the front: perpendicular to up and to the axis from right to left. Reversed if the toes point
    /// the other way, as in figures whose left is called right.
    pub forward: Vec3,
}

/// A part of a human-like figure.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BodyPart {
    /// The left arm from shoulder to hand.
    LeftArm,
    /// The right arm from shoulder to hand.
    RightArm,
    /// The left leg from hip to foot.
    LeftLeg,
    /// The right leg from hip to foot.
    RightLeg,
    /// The head.
    Head,
}

impl BodyPart {
    /// True for a leg.
    pub fn is_leg(self) -> bool {
        matches!(self, Self::LeftLeg | Self::RightLeg)
    }
}

/// "left arm", "right leg" …
impl fmt::Display for BodyPart {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::LeftArm => "left arm",
            Self::RightArm => "right arm",
            Self::LeftLeg => "left leg",
            Self::RightLeg => "right leg",
            Self::Head => "head",
        })
    }
}

/// The reason why a skeleton is not recognised as human-like.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum NotHumanoid {
    /// Some limbs have no joints with known names.
    #[error("found {}, but no {}", listed(found, "and"), listed(missing, "or"))]
    Missing {
        /// The parts that were found.
        found: Vec<BodyPart>,
        /// The parts that were not found.
        missing: Vec<BodyPart>,
    },
    /// Two joints may be the same part.
    #[error("found more than one {part}: {} and {}", between[0], between[1])]
    Several {
        /// The part.
        part: BodyPart,
        /// The names of two joints at the end of such a part.
        between: [String; 2],
    },
    /// Limbs of the two sides share joints.
    #[error("the {0} shares a joint with another limb")]
    Shared(BodyPart),
    /// Left and right differ in length.
    #[error("left and right bones of the {limbs} differ in length: {} and {}", lengths[0], lengths[1])]
    Uneven {
        /// "arms" or "legs".
        limbs: &'static str,
        /// Lengths of the two bones that differ, in units of the skeleton.
        lengths: [f32; 2],
    },
    /// A limb has a bone without length, or one that is much shorter than the other.
    #[error("found the {0}, but its two bones are not of similar length")]
    Bones(BodyPart),
    /// The legs do not go down from the trunk.
    #[error("found arms and legs, but the legs do not go down from the trunk as a person's do")]
    NotUpright,
    /// Neither names nor a shape with two arms, two legs and a head.
    #[error("found no joints with known names, and no two arms, two legs and a head")]
    Unknown,
    /// Names do not tell the limbs, and no toes tell where the front is.
    #[error("found arms, legs and a head, but no toes that tell where the front is")]
    NoFront,
}

fn listed(parts: &[BodyPart], word: &str) -> String {
    match parts {
        [] => "nothing".to_owned(),
        [only] => only.to_string(),
        [first @ .., last] => {
            let first: Vec<String> = first.iter().map(BodyPart::to_string).collect();
            format!("{} {word} {last}", first.join(", "))
        }
    }
}

impl Humanoid {
    /// The arms, then the legs, each left before right, with their parts.
    pub fn limbs(&self) -> [(BodyPart, HumanoidLimb); 4] {
        let ([left_arm, right_arm], [left_leg, right_leg]) = (self.arms, self.legs);
        [
            (BodyPart::LeftArm, left_arm),
            (BodyPart::RightArm, right_arm),
            (BodyPart::LeftLeg, left_leg),
            (BodyPart::RightLeg, right_leg),
        ]
    }

    /// The directions of the figure in its bind pose or, where its legs do not go down from the
    /// trunk there, in the pose that the skeleton has, with that pose in skeleton space; `None` if
    /// they do so in neither.
    pub fn directions(&self, skeleton: &Skeleton) -> Option<(HumanoidDirections, SkeletonPose)> {
        let poses = [skeleton.bind_pose_in_skeleton(), skeleton.pose_in_skeleton()];
        let found = |pose| Some((self.directions_in(skeleton, &pose)?, pose));
        poses.into_iter().find_map(found)
    }

    pub(super) fn directions_in(
        &self,
        skeleton: &Skeleton,
        pose: &SkeletonPose,
    ) -> Option<HumanoidDirections> {
        /// Cosine of the greatest angle between a leg and straight down: 60°.
        const LEAST_DOWN: f32 = 0.5;
        /// Sine of the greatest tilt of the axis from right to left: 30°.
        const MOST_TILT: f32 = 0.5;
        /// Cosine of the angle from which toes point backwards: 120°.
        const BACKWARDS: f32 = -0.5;
        /// Least length of the trunk, relative to that of a leg.
        const LEAST_TRUNK: f32 = 0.2;
        let base = |joint| pose.base(joint);
        let middle =
            |[left, right]: [HumanoidLimb; 2]| 0.5 * (base(left.upper) + base(right.upper));
        let trunk = middle(self.arms) - middle(self.legs);
        let up = trunk.try_normalize()?;
        let goes_down = |leg: &HumanoidLimb| {
            let leg = base(leg.end) - base(leg.upper);
            trunk.length() > LEAST_TRUNK * leg.length()
                && leg.normalize_or_zero().dot(up) < -LEAST_DOWN
        };
        let across = |[left, right]: [HumanoidLimb; 2]| base(left.upper) - base(right.upper);
        let left = (across(self.arms) + across(self.legs)).try_normalize()?;
        if !self.legs.iter().all(goes_down) || left.dot(up).abs() > MOST_TILT {
            return None;
        }
        let front = left.cross(up).try_normalize()?;
        let toes = self.toes(skeleton, pose, up);
        let is_backwards = toes.is_some_and(|toes| toes.dot(front) < BACKWARDS);
        Some(HumanoidDirections { up, forward: if is_backwards { -front } else { front } })
    }

    /// The unit direction of the toes, level with the ground; `None` for feet without toes.
    pub(super) fn toes(&self, skeleton: &Skeleton, pose: &SkeletonPose, up: Vec3) -> Option<Vec3> {
        let toes = self.legs.map(|leg| {
            let below = skeleton.children(leg.end).map(|toe| pose.base(toe));
            let ends = below.chain([pose.tip(leg.end)]).map(|end| end - pose.base(leg.end));
            let level = ends.map(|end| end.reject_from_normalized(up));
            level.max_by(|one, other| one.length().total_cmp(&other.length())).unwrap_or_default()
        });
        let lengths = self.legs.map(|leg| pose.base(leg.lower).distance(pose.base(leg.end)));
        /// Least length of a foot, relative to the shin.
        const FOOT: f32 = 0.1;
        let is_foot = toes.iter().zip(lengths).all(|(toe, shin)| toe.length() > FOOT * shin);
        toes.into_iter().sum::<Vec3>().try_normalize().filter(|_| is_foot)
    }

    /// The figure if it has the proportions and the posture of a person.
    pub(super) fn checked(self, skeleton: &Skeleton) -> Result<Self, NotHumanoid> {
        let limbs = self.limbs();
        for (index, (part, limb)) in limbs.iter().enumerate() {
            let others = limbs.iter().enumerate().filter(|(other, _)| *other != index);
            let mut joints = others.flat_map(|(_, (_, it))| [it.upper, it.lower, it.end]);
            if joints.any(|joint| [limb.upper, limb.lower, limb.end].contains(&joint)) {
                return Err(NotHumanoid::Shared(*part));
            }
        }
        let pose = skeleton.bind_pose_in_skeleton();
        let lengths = |limb: &HumanoidLimb| {
            let upper = pose.base(limb.upper).distance(pose.base(limb.lower));
            [upper, pose.base(limb.lower).distance(pose.base(limb.end))]
        };
        /// Greatest ratio of the bones of a limb.
        const BONES: f32 = 2.5;
        for (part, limb) in &limbs {
            let [upper, lower] = lengths(limb);
            if !(upper > 0.0 && lower > 0.0 && upper < BONES * lower && lower < BONES * upper) {
                return Err(NotHumanoid::Bones(*part));
            }
        }
        /// Greatest difference between the sides, relative to the longer one.
        const MIRRORED: f32 = 0.15;
        for (limbs, [left, right]) in [("arms", self.arms), ("legs", self.legs)] {
            let sides = lengths(&left).into_iter().zip(lengths(&right));
            for (left, right) in sides {
                if (left - right).abs() > MIRRORED * left.max(right) {
                    return Err(NotHumanoid::Uneven { limbs, lengths: [left, right] });
                }
            }
        }
        self.directions(skeleton).map(|_| self).ok_or(NotHumanoid::NotUpright)
    }
}
