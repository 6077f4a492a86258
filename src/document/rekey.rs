use core::f32::consts::TAU;

use glam::Vec3;

use super::channel::Channel;
use super::document::Document;
use super::hand_orientation::HandSpace;
use crate::kinematics::spline::Spline;
use crate::kinematics::twist::TwistReferenceKind;

/// Changes of what angles are measured from, at every key.
impl Document {
    /// Changes the kind of the arm's twist reference, and its twist so that the elbow stays where it is,
    /// at every key of the twist too.
    #[must_use]
    pub fn with_twist_reference(&self, kind: TwistReferenceKind) -> Self {
        let mut after = Self { arm: self.arm.with_twist_reference(kind), ..self.clone() };
        let Some(track) = self.keys.track(Channel::Twist) else {
            return after;
        };
        let mut shift = 0.0;
        for knot in track.knots() {
            let mut arm = self.arm_at(knot.time);
            arm.ik_state.transported = None;
            let measured = arm.with_twist_reference(kind).keyed_twist();
            let (old, turned) = (knot.value.x, measured - knot.value.x);
            shift = turned + ((shift - turned) / TAU).round() * TAU;
            after.keys.insert(Channel::Twist, knot.time, Vec3::new(old + shift, 0.0, 0.0));
        }
        after
    }

    /// Measures the hand's angles in another space. The hand keeps its orientation, at every key of its
    /// angles too.
    #[must_use]
    pub fn with_hand_space(&self, space: HandSpace) -> Self {
        let mut after = self.clone();
        after.arm.hand_orientation = self.arm.hand_orientation.in_space(space, &self.arm.pose());
        let mut last = None;
        let track = self.keys.track(Channel::HandOrientation);
        for knot in track.into_iter().flat_map(Spline::knots) {
            let arm = self.arm_at(knot.time);
            let orientation = arm.hand_orientation;
            // Unwrapped from key to key.
            let near = last.unwrap_or(orientation.angles);
            let angles = orientation.in_space_near(space, &arm.pose(), near).angles;
            last = Some(angles);
            after.keys.insert(Channel::HandOrientation, knot.time, angles);
        }
        after
    }
}
