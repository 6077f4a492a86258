use core::f32::consts::TAU;

use glam::{Quat, Vec3};

use crate::kinematics::Shared;
use crate::kinematics::skeleton::{Joint, JointId, SkeletonPose};
use crate::scene::{Ball, Colour, Label, LabelSide, Line, Scene, Shadow};
use crate::session::Overlays;

/// Maximum radius of a bone: as a fraction of its length, and as a fraction of the skeleton's
/// reach.
const MAX_RADIUS: (f32, f32) = (0.45, 0.028);
/// Minimum of a bone's radius limit by reach, as a fraction of the bone's length, so that the first
/// bones of a new skeleton are as thick as they will be in the complete one.
const MIN_LIMIT: f32 = 0.07;
/// Minimum of a bone's radius limit, as a fraction of the skeleton's reach, so that a chain of many
/// short bones can be seen.
const LEAST_LIMIT: f32 = 0.004;
/// Ratio of a bone's length to its radius below which the balls at its ends would hide it.
const SHORT: f32 = 2.4;
/// Least length of a shadow as a fraction of the reach: short bones in a row share one, since soft
/// shadows add up where they overlap.
const SHADOW: f32 = 0.04;
/// Maximum radius of a joint without a bone, as a fraction of the skeleton's reach.
const POINT_RADIUS: f32 = 0.02;
/// Ratio of the tip's radius to the base's radius of a slender bone.
const TAPER: f32 = 0.6;
/// Ratio of length to base radius above which a bone is slender and tapers. Shorter bones do not
/// taper, so that a chain of many forms one smooth body, and neither do the last ones, so that none
/// ends in a spike.
const SLENDER: f32 = 4.0;
/// Ratio of the radius of a ghost's bone to that of the skeleton's bone.
pub(super) const GHOST: f32 = 0.45;
/// Ratio of the radius of a rod between a bone and a child away from it to the thinner bone's
/// radius.
const LINK: f32 = 0.3;
/// Part of the sky in the grey of bones outside of the limb that a page is about.
const OF_NO_LIMB: f32 = 0.25;
/// Ratio of the radius of an onion skin to that of the figure, so that it hides less of the figure.
const ONION_SKIN: f32 = 0.5;
/// Contrast of the FK pose with the background, from 0 to 1.
const FK_CONTRAST: f32 = 0.35;

/// A posed skeleton with the sizes that its drawing depends on.
#[derive(Clone, Copy)]
pub(super) struct DrawnSkeleton<'a> {
    pub joints: &'a [Shared<Joint>],
    pub pose: &'a SkeletonPose,
    pub depths: &'a [usize],
    pub children: &'a [usize],
    pub hands: &'a [Option<JointId>],
    /// Reach in world units.
    pub reach: f32,
    /// World units per unit of the skeleton.
    pub scale: f32,
    /// True if bones have the colours of their joints' stiffness.
    pub shows_stiffness: bool,
}

impl<'a> DrawnSkeleton<'a> {
    /// The skeleton in another pose.
    pub fn posed<'b>(&self, pose: &'b SkeletonPose) -> DrawnSkeleton<'b>
    where
        'a: 'b,
    {
        DrawnSkeleton { pose, ..*self }
    }

    /// Radius of a bone at its base as drawn, in world units.
    pub fn radius(&self, joint: JointId) -> f32 {
        let length = self.pose.base(joint).distance(self.pose.tip(joint));
        let (of_length, of_reach) = MAX_RADIUS;
        let limit = match length {
            0.0 => POINT_RADIUS * self.reach,
            length => {
                let of_reach = (of_reach * self.reach).max(MIN_LIMIT * length);
                of_reach.min((of_length * length).max(LEAST_LIMIT * self.reach))
            }
        };
        (self.joints[joint.index()].radius * self.scale).clamp(0.25 * limit, limit)
    }

    fn tip_radius(&self, joint: JointId) -> f32 {
        let length = self.pose.base(joint).distance(self.pose.tip(joint));
        let radius = self.radius(joint);
        let tapers = length > SLENDER * radius && !self.is_leaf(joint);
        if tapers { radius * TAPER } else { radius }
    }

    /// Radius of the ball at a bone's base, which covers the end of the bone before it.
    fn ball_radius(&self, joint: JointId) -> f32 {
        let parent = self.joints[joint.index()].parent;
        let is_next = |it: &JointId| self.pose.tip(*it) == self.pose.base(joint);
        let before = parent.filter(is_next).map_or(0.0, |parent| self.tip_radius(parent));
        1.1 * self.radius(joint).max(before)
    }

    /// Greatest stiffness of a joint's angles; 1 if it is locked.
    fn stiffness(&self, joint: JointId) -> f32 {
        let joint = &self.joints[joint.index()];
        if joint.locked { 1.0 } else { joint.stiffness.max_element() }
    }

    /// Adds the stiffness of each stiff joint as a label beside its bone.
    pub fn add_stiffness(&self, scene: &mut Scene) {
        for joint in self.pose.ids().filter(|joint| !self.joints[joint.index()].locked) {
            let stiffness = self.stiffness(joint);
            if stiffness > 0.0 {
                let middle = self.pose.base(joint).midpoint(self.pose.tip(joint));
                let colour = scene.palette.text;
                let label = Label::new(middle, self.radius(joint), LabelSide::Above, colour);
                scene.add_label(label, format_args!("{stiffness:.2}"));
            }
        }
    }

    /// Colour of a bone. The limbs' colours alternate from parent to child, or are those of the limb
    /// that a page is about; locked, hovered and selected joints have colours of their own.
    pub fn colour(&self, scene: &Scene, joint: JointId, overlays: &Overlays) -> Colour {
        let palette = &scene.palette;
        let colour = if self.shows_stiffness {
            palette.weight(self.stiffness(joint))
        } else if self.joints[joint.index()].locked {
            palette.joint
        } else if let Some(limb) = overlays.limb {
            match joint {
                _ if joint == limb.upper => palette.upper,
                _ if joint == limb.lower => palette.lower,
                _ => palette.joint.mixed(palette.sky_top, OF_NO_LIMB),
            }
        } else if self.depths[joint.index()].is_multiple_of(2) {
            palette.upper
        } else {
            palette.lower
        };
        if overlays.selection.contains(&joint) {
            palette.accent
        } else if overlays.hovered == Some(joint) {
            palette.lit(colour)
        } else {
            colour
        }
    }

    pub fn add_bone(&self, scene: &mut Scene, joint: JointId, colour: Colour) {
        let (base, tip, radius) = (self.pose.base(joint), self.pose.tip(joint), self.radius(joint));
        if base != tip {
            scene.add_solid(base, tip, radius, self.tip_radius(joint), colour);
        }
        if base.distance(tip) < SHORT * radius {
            scene.balls.push(Ball { centre: base, radius, colour });
        } else {
            let colour = scene.palette.joint;
            scene.balls.push(Ball { centre: base, radius: self.ball_radius(joint), colour });
        }
        if self.is_leaf(joint) && base != tip {
            let colour = scene.palette.joint;
            scene.balls.push(Ball { centre: tip, radius: self.tip_radius(joint) * 1.1, colour });
        }
    }

    /// Adds lines around a bone, like those of a cage, and a circle around its joint.
    pub fn add_outline(&self, scene: &mut Scene, joint: JointId, colour: Colour) {
        // Ratio of the cage's radius to the bone's, and number of lines along the bone.
        const WIDER: f32 = 1.35;
        const LINES: u8 = 8;
        let (base, tip) = (self.pose.base(joint), self.pose.tip(joint));
        let axis = (tip - base).try_normalize().unwrap_or(Vec3::Y);
        let side = axis.any_orthonormal_vector();
        let radius = WIDER * self.radius(joint);
        scene.add_arc(base, radius * side, axis, TAU, colour);
        if base == tip {
            return scene.add_arc(base, radius * axis, side, TAU, colour);
        }
        let tip_radius = WIDER * self.tip_radius(joint);
        scene.add_arc(tip, tip_radius * side, axis, TAU, colour);
        for nth in 0..LINES {
            let around =
                Quat::from_axis_angle(axis, TAU * f32::from(nth) / f32::from(LINES)) * side;
            let (from, to) = (base + radius * around, tip + tip_radius * around);
            scene.lines.push(Line { from, to, colour, dashed: false });
        }
    }

    /// Adds a thin rod to a joint that starts away from its parent's bone, from the nearer end of
    /// that bone, so that no bone floats.
    pub fn add_link(&self, scene: &mut Scene, joint: JointId, colour: Colour) {
        let Some(parent) = self.joints[joint.index()].parent else { return };
        let (base, tip) = (self.pose.base(parent), self.pose.tip(parent));
        let to = self.pose.base(joint);
        let from = if to.distance(base) <= to.distance(tip) { base } else { tip };
        if distance_from_segment(to, base, tip) > self.radius(parent) {
            let radius = LINK * self.radius(parent).min(self.radius(joint));
            scene.add_solid(from, to, radius, radius, colour);
        }
    }

    /// Adds the bones that `fk`, the FK pose, has elsewhere, for the joints that are to be shown.
    pub fn add_fk_pose(
        &self,
        scene: &mut Scene,
        fk: &SkeletonPose,
        is_shown: impl Fn(JointId) -> bool,
    ) {
        let colour = scene.palette.sky_top.mixed(scene.palette.joint, FK_CONTRAST);
        self.add_thin_pose(scene, fk, colour, is_shown);
    }

    /// Adds the bones that another pose has elsewhere, thin, for the joints that are to be shown.
    pub fn add_thin_pose(
        &self,
        scene: &mut Scene,
        other: &SkeletonPose,
        colour: Colour,
        is_shown: impl Fn(JointId) -> bool,
    ) {
        // Fraction of the reach.
        const APART: f32 = 1e-3;
        for joint in other.ids().filter(|joint| is_shown(*joint)) {
            let (base, tip) = (other.base(joint), other.tip(joint));
            let apart =
                base.distance(self.pose.base(joint)).max(tip.distance(self.pose.tip(joint)));
            if apart > APART * self.reach {
                let radius = self.radius(joint) * GHOST;
                if base != tip {
                    scene.add_solid(base, tip, radius, radius, colour);
                }
                scene.balls.push(Ball { centre: tip, radius, colour });
            }
        }
    }

    /// The shadow of a joint's bone, and of the short bones before it that have none of their own; a
    /// hand has one, from its base to the middle of its fingertips. `radii` are the radii of a bone's
    /// base and tip. `None` for a short bone, for one without a length, and below the ground.
    pub fn shadow(&self, joint: JointId, radii: impl Fn(JointId) -> [f32; 2]) -> Option<Shadow> {
        if !self.ends_shadow(joint) {
            return None;
        }
        let above = |joint: &JointId| self.joints[joint.index()].parent;
        let shared = std::iter::successors(above(&joint), above);
        let first = shared.take_while(|it| !self.ends_shadow(*it)).last().unwrap_or(joint);
        let (base, tip) = (self.pose.base(first), self.tip_of_shadow(joint));
        let ([base_radius, _], [_, tip_radius]) = (radii(first), radii(joint));
        let limb = Shadow { base, base_radius, tip, tip_radius };
        (base != tip).then(|| limb.above_ground()).flatten()
    }

    /// Radii of a bone at its base and tip.
    pub fn radii(&self, joint: JointId) -> [f32; 2] {
        [self.radius(joint), self.tip_radius(joint)]
    }

    fn is_leaf(&self, joint: JointId) -> bool {
        self.children[joint.index()] == 0
    }

    /// The joint's tip; for a hand, the middle of its fingertips.
    fn tip_of_shadow(&self, joint: JointId) -> Vec3 {
        if self.hands[joint.index()].is_none() {
            return self.pose.tip(joint);
        }
        let is_fingertip =
            |it: &JointId| self.hands[it.index()] == Some(joint) && self.is_leaf(*it);
        let tips = self.pose.ids().filter(is_fingertip).map(|it| self.pose.tip(it));
        let (sum, count) =
            tips.fold((Vec3::ZERO, 0.0), |(sum, count), tip| (sum + tip, count + 1.0));
        sum / count
    }

    /// True if a shadow ends at a joint's tip: every so many short bones, at the end of a chain, and
    /// at a hand, but not at its fingers.
    fn ends_shadow(&self, joint: JointId) -> bool {
        const MOST: f32 = 64.0;
        if let Some(hand) = self.hands[joint.index()] {
            return hand == joint;
        }
        let length = self.pose.base(joint).distance(self.pose.tip(joint));
        let bones = (SHADOW * self.reach / length).ceil().clamp(1.0, MOST) as usize;
        self.is_leaf(joint) || (self.depths[joint.index()] + 1).is_multiple_of(bones)
    }

    /// Adds the bones in the pose of another frame.
    pub fn add_onion_skin(&self, scene: &mut Scene, colour: Colour) {
        for joint in self.pose.ids() {
            let (base, tip) = (self.pose.base(joint), self.pose.tip(joint));
            let [from, to] = self.radii(joint).map(|radius| ONION_SKIN * radius);
            if base != tip {
                scene.add_solid(base, tip, from, to, colour);
                scene.balls.push(Ball { centre: tip, radius: to, colour });
            }
            scene.balls.push(Ball { centre: base, radius: from, colour });
            self.add_link(scene, joint, colour);
        }
    }

    /// Adds the names of the selected joints and of the joint under the mouse, beside bodies with a
    /// radius.
    pub fn add_labels(
        &self,
        scene: &mut Scene,
        overlays: &Overlays,
        labelled: &mut Vec<JointId>,
        has_name: impl Fn(JointId) -> bool,
        radius: impl Fn(JointId) -> f32,
    ) {
        labelled.clear();
        labelled.extend(overlays.selection.iter().copied().chain(overlays.hovered));
        labelled.sort_unstable();
        labelled.dedup();
        let is_there = |joint: &JointId| joint.index() < self.joints.len();
        for joint in labelled.iter().copied().filter(is_there).filter(|joint| has_name(*joint)) {
            let middle = self.pose.base(joint).midpoint(self.pose.tip(joint));
            let label = Label::new(middle, radius(joint), LabelSide::Below, scene.palette.text);
            scene.add_label(label, format_args!("{}", self.joints[joint.index()].name));
        }
    }
}

/// Distance of a point from the line segment between two points.
fn distance_from_segment(point: Vec3, from: Vec3, to: Vec3) -> f32 {
    let along = to - from;
    let part = (point - from).dot(along) / along.length_squared();
    let part = if part.is_finite() { part.clamp(0.0, 1.0) } else { 0.0 };
    point.distance(from + along * part)
}
