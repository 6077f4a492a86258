//! Recognition of human-like figures by the shape of their bind pose: two mirrored pairs of limbs, of
//! which one goes down from the trunk, and a head above the other.

use glam::Vec3;

use super::body::{Humanoid, HumanoidDirections, HumanoidLimb, NotHumanoid};
use crate::skeleton::{JointId, Skeleton, SkeletonPose};

/// Greatest difference between the sides, relative to the length of a limb.
const MIRRORED: f32 = 0.05;
/// Least length of a limb, relative to the longest.
const LEAST_LIMB: f32 = 0.3;

/// Recognises a figure by the shape of its bind pose.
pub fn humanoid(skeleton: &Skeleton) -> Result<Humanoid, NotHumanoid> {
    let shape = Shape::new(skeleton, skeleton.bind_pose_in_skeleton());
    let [one, other] = shape.pairs()[..] else { return Err(NotHumanoid::Unknown) };
    // Both pairs in the same order of the sides, whichever that is.
    let across = |[a, b]: Pair| shape.pose.base(a.upper) - shape.pose.base(b.upper);
    let other = if across(one).dot(across(other)) < 0.0 { [other[1], other[0]] } else { other };
    let mut found = [(one, other), (other, one)].into_iter().filter_map(|(arms, legs)| {
        let body = Humanoid { head: None, arms, legs };
        let directions = body.directions_in(skeleton, &shape.pose)?;
        let head = shape.head(&body, directions)?;
        Some((Humanoid { head: Some(head), ..body }, directions))
    });
    let (body, directions) = found.next().ok_or(NotHumanoid::Unknown)?;
    if found.next().is_some() {
        return Err(NotHumanoid::Unknown);
    }
    // Which side is left is not known yet, so that only the toes tell the front.
    let front = body.toes(skeleton, &shape.pose, directions.up).ok_or(NotHumanoid::NoFront)?;
    let left = directions.up.cross(front);
    let sorted = |[one, other]: [HumanoidLimb; 2]| {
        let across = shape.pose.base(one.upper) - shape.pose.base(other.upper);
        if across.dot(left) >= 0.0 { [one, other] } else { [other, one] }
    };
    Ok(Humanoid { head: body.head, arms: sorted(body.arms), legs: sorted(body.legs) })
}

/// Finds the head by the shape of a pose in skeleton space, for figures whose names include none.
pub fn head(
    skeleton: &Skeleton,
    pose: SkeletonPose,
    body: &Humanoid,
    directions: HumanoidDirections,
) -> Option<JointId> {
    Shape::new(skeleton, pose).head(body, directions)
}

/// Two mirrored limbs.
type Pair = [HumanoidLimb; 2];

struct Shape<'a> {
    skeleton: &'a Skeleton,
    pose: SkeletonPose,
    children: Vec<Vec<JointId>>,
    /// Longest way from each joint to an end below it.
    reach: Vec<f32>,
}

impl<'a> Shape<'a> {
    fn new(skeleton: &'a Skeleton, pose: SkeletonPose) -> Self {
        let count = skeleton.joints().len();
        let (mut children, mut reach) = (vec![Vec::new(); count], vec![0.0_f32; count]);
        for (id, joint) in skeleton.iter().rev() {
            reach[id.index()] = reach[id.index()].max(joint.axis.length());
            let Some(parent) = joint.parent else { continue };
            children[parent.index()].push(id);
            let through = joint.offset.length() + reach[id.index()];
            reach[parent.index()] = reach[parent.index()].max(through);
        }
        children.iter_mut().for_each(|children| children.reverse());
        Self { skeleton, pose, children, reach }
    }

    /// The longest chain from a joint down to a leaf.
    fn chain(&self, joint: JointId) -> Vec<JointId> {
        let way =
            |child: &JointId| self.skeleton[*child].offset.length() + self.reach[child.index()];
        let next = |joint: &JointId| {
            let children = self.children[joint.index()].iter().copied();
            children.reduce(|best, child| if way(&child) > way(&best) { child } else { best })
        };
        core::iter::successors(Some(joint), next).collect()
    }

    /// The pairs of mirrored limbs, but for those that are parts of others, such as fingers.
    fn pairs(&self) -> Vec<Pair> {
        let longest = self.reach.iter().copied().fold(0.0, f32::max);
        let mut pairs: Vec<Pair> = Vec::new();
        for (start, children) in self.skeleton.ids().zip(&self.children) {
            let is_part = |pair: &Pair| {
                let mut uppers = pair.iter().map(|limb| limb.upper);
                uppers.any(|upper| self.skeleton.is_in_subtree(start, upper))
            };
            if self.reach[start.index()] < LEAST_LIMB * longest || pairs.iter().any(is_part) {
                continue;
            }
            for (index, one) in children.iter().enumerate() {
                let mut others = children[index + 1..].iter();
                pairs.extend(others.find_map(|other| self.pair(start, [*one, *other], longest)));
            }
        }
        pairs
    }

    /// The pair of limbs that start with two children of a joint; `None` if they are not mirrored.
    fn pair(&self, start: JointId, children: [JointId; 2], longest: f32) -> Option<Pair> {
        let chains = children.map(|child| self.chain(child));
        let from = self.pose.base(start);
        let distances = |chain: &[JointId]| -> Vec<f32> {
            chain.iter().map(|joint| self.pose.base(*joint).distance(from)).collect()
        };
        let [left, right] = [distances(&chains[0]), distances(&chains[1])];
        let length = left.iter().chain(&right).copied().fold(0.0, f32::max);
        let is_long = length >= LEAST_LIMB * longest;
        let is_mirrored = left.len() == right.len()
            && left.iter().zip(&right).all(|(a, b)| (a - b).abs() <= MIRRORED * length);
        let are_apart = chains[0]
            .iter()
            .zip(&chains[1])
            .any(|(a, b)| self.pose.base(*a).distance(self.pose.base(*b)) > MIRRORED * length);
        if !(is_long && is_mirrored && are_apart) {
            return None;
        }
        let [Some(left), Some(right)] = chains.map(|chain| self.limb(&chain)) else { return None };
        Some([left, right])
    }

    /// The limb of a chain: its two bones in a row of which the shorter one is longest.
    fn limb(&self, chain: &[JointId]) -> Option<HumanoidLimb> {
        let length =
            |joints: &[JointId]| self.pose.base(joints[0]).distance(self.pose.base(joints[1]));
        let shorter = |joints: &[JointId]| length(&joints[..2]).min(length(&joints[1..]));
        let limbs = chain.windows(3);
        let longest =
            limbs.reduce(|best, next| if shorter(next) > shorter(best) { next } else { best })?;
        Some(HumanoidLimb { upper: longest[0], lower: longest[1], end: longest[2] })
    }

    /// The last joint of the neck above the shoulders, before it branches to the face.
    fn head(
        &self,
        body: &Humanoid,
        HumanoidDirections { up, .. }: HumanoidDirections,
    ) -> Option<JointId> {
        /// Cosine of the greatest angle between the neck and up.
        const UPWARDS: f32 = 0.5;
        let [left, right] = body.arms.map(|arm| arm.upper);
        let shoulders = self
            .skeleton
            .ancestors(left)
            .find(|above| self.skeleton.is_in_subtree(right, *above))?;
        let is_up = |from: Vec3, to: Vec3| (to - from).normalize_or_zero().dot(up) > UPWARDS;
        let is_arm = |joint: JointId| {
            [left, right].into_iter().any(|arm| self.skeleton.is_in_subtree(arm, joint))
        };
        let goes_up = |joint: &JointId| {
            let from = self.skeleton[*joint].parent.map(|parent| self.pose.base(parent));
            from.is_some_and(|from| is_up(from, self.pose.base(*joint))) && !is_arm(*joint)
        };
        let next = |joint: JointId| self.children[joint.index()].iter().copied().find(goes_up);
        let neck = next(shoulders)?;
        let is_alone = |joint: JointId| self.children[joint.index()].len() == 1;
        let above = |joint: &JointId| next(*joint).filter(|_| is_alone(*joint));
        core::iter::successors(Some(neck), above).last()
    }
}
