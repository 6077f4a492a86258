//! Whole body follows: limb targets that their limbs do not reach pull the rest of the body along.
//!
//! A limb target acts on the base of its limb, such as a shoulder or a hip: the base may be anywhere
//! from which the limb reaches the target, and is brought to the nearest such place from elsewhere.
//! The bases of all limbs are solved together with the whole-body targets; the limbs are solved
//! after them. So the body moves as far as limbs cannot, and planted feet stay.
//!
//! A limb that is long enough but that its limits keep from its target pulls the body, too: by the
//! place of its tip, as if the limb were stiff. Then body and limbs are solved again.

use glam::Vec3;

use super::carried::BodyTarget;
use super::skeleton_rig::SkeletonRig;
use super::target::{Target, TargetSpace};
use crate::chain_ik::{ChainTarget, Root};
use crate::limb_ik::{Limb, LimbRange};
use crate::skeleton::{JointId, Skeleton};

/// A limb that its limits keep from its target.
pub(super) struct BlockedLimb {
    /// The joint of its target.
    target: JointId,
    /// Where its tip is, in the space of the joint that it is on.
    tip: Vec3,
    /// Distance from there to the target, in the world.
    pub miss: f32,
}

/// The part of a limb's reach to which its base is brought: a little less than all of it, since the
/// joints of a limb that becomes straight race.
const REACH: f64 = 0.966;

impl SkeletonRig {
    /// True if a target pulls the body along by its limb, where the limb does not reach it:
    /// [`SkeletonRig::body_follows`], and joints above the limb can turn. A target in the space of
    /// a joint pulls none, since it moves with the body; nor does one whose limb is on another limb.
    pub fn pulls_body(&self, target: &Target) -> bool {
        self.pulling_limb(target).is_some()
    }

    /// True if there is a limb target whose limb is on a body, which can follow it.
    pub fn has_body_to_follow(&self) -> bool {
        let mut limbs = self.targets.iter().filter_map(|target| target.limb_in(&self.skeleton));
        limbs.any(|limb| self.body_of(limb).next().is_some())
    }

    /// The limb of a target that pulls the body.
    pub(super) fn pulling_limb(&self, target: &Target) -> Option<Limb> {
        let is_pulling = self.body_follows
            && self.is_solved_for(target)
            && target.present_space() == TargetSpace::World;
        let limb = target.limb_in(&self.skeleton).filter(|_| is_pulling)?;
        (self.body_of(limb).next().is_some() && !self.is_on_limb(limb)).then_some(limb)
    }

    /// True if a limb target pulls a joint along.
    pub fn is_pulled(&self, joint: JointId) -> bool {
        let mut limbs = self.targets.iter().filter_map(|target| self.pulling_limb(target));
        limbs.any(|limb| self.body_of(limb).any(|of_body| of_body == joint))
    }

    /// The joints above a limb that solvers turn, or move.
    pub fn body_of(&self, limb: Limb) -> impl Iterator<Item = JointId> {
        let root = self.solver.root;
        let above = self.skeleton.ancestors(limb.upper).skip(1);
        above.filter(move |joint| {
            let joint = &self.skeleton[*joint];
            match (joint.parent, root) {
                (None, Root::Free) => true,
                (None, Root::Locked) => false,
                _ => !joint.locked,
            }
        })
    }

    /// True if a joint above a limb belongs to the limb of another solved target.
    fn is_on_limb(&self, limb: Limb) -> bool {
        let others = self.targets.iter().filter(|other| self.is_solved_for(other));
        let mut joints =
            others.filter_map(|other| other.limb_in(&self.skeleton)).flat_map(Limb::joints);
        joints.any(|joint| {
            joint != limb.upper && self.skeleton.ancestors(limb.upper).any(|above| above == joint)
        })
    }

    /// The targets that pull the body by limbs, for the FK pose at a time in seconds.
    pub(super) fn base_targets(
        &self,
        fk: &Skeleton,
        time: f64,
        blocked: &[BlockedLimb],
    ) -> Vec<BodyTarget> {
        let pulling = self.targets.iter().filter(|target| self.pulls_body(target));
        let of_target = |target: &Target| {
            let mut tip = self.base_target(target, fk, time)?;
            if let Some(limb) = blocked.iter().find(|limb| limb.target == target.joint) {
                tip = tip.with_grip(limb.tip).with_distances(0.0, 0.0);
            }
            Some(BodyTarget { tip, influence: target.influence })
        };
        pulling.filter_map(of_target).collect()
    }

    /// Of targets whose limbs are stopped by their limits, those that pull the body by limbs that do
    /// not reach them, in a pose.
    pub(super) fn blocked_limbs<'a>(
        &self,
        posed: &Skeleton,
        stopped: impl Iterator<Item = &'a Target>,
        time: f64,
    ) -> Vec<BlockedLimb> {
        let blocked = |target: &Target| {
            let limb = self.pulling_limb(target)?;
            let (tip, place) = (posed.tip(target.joint), target.in_world(posed, time));
            let miss = tip.distance(place);
            if miss <= self.tolerance() || target.influence < 1.0 {
                return None;
            }
            let above = posed.full_transform(posed[limb.upper].parent?);
            let tip = above.inverse().transform_point3(tip);
            Some(BlockedLimb { target: target.joint, tip, miss }).filter(|_| tip.is_finite())
        };
        stopped.filter_map(blocked).collect()
    }

    /// The places of the base of a target's limb from which the limb reaches the target; `None` for
    /// a target that pulls no body.
    pub(super) fn base_target(
        &self,
        target: &Target,
        fk: &Skeleton,
        time: f64,
    ) -> Option<ChainTarget> {
        let (settings, limb) = (target.limb()?, self.pulling_limb(target)?);
        let base = &fk[limb.upper];
        let LimbRange { least, most, present } =
            LimbRange::of(fk, limb, settings.soft_reach, settings.fk_stretch)?;
        // A limb that the FK pose has straighter, such as a leg that stands, may stay so.
        let most = (REACH * most).max(present.min(most));
        let place = ChainTarget::at(base.parent?, target.in_world(fk, time))
            .with_grip(base.offset)
            .with_distances(least.min(most) as f32, most as f32)
            .with_weight(target.weight);
        Some(place)
    }
}
