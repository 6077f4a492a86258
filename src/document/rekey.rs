use glam::Vec3;

use super::channel::Channel;
use super::document::Document;
use super::hand_orientation::HandSpace;
use super::track::Track;
use crate::kinematics::angle;
use crate::kinematics::spline::Spline;
use crate::kinematics::twist::TwistReferenceKind;

/// Conversions of an angle to another reference, for its present value and all its keys.
impl Document {
    /// Changes the kind of the arm's twist reference, and adjusts the present twist and all its
    /// keys so that the elbow does not move in the present pose or at any key.
    #[must_use]
    pub fn with_twist_reference(&self, kind: TwistReferenceKind) -> Self {
        let mut after = Self { arm: self.arm.with_twist_reference(kind), ..self.clone() };
        let Some(keys) = self.keys.track(Channel::Twist) else {
            return after;
        };
        let track = Track::new(self);
        let mut shift = 0.0;
        for knot in keys.knots() {
            let mut arm = *track.at(knot.time).arm();
            arm.ik_state.transported = None;
            let measured = arm.with_twist_reference(kind).keyed_twist();
            let (old, turned) = (knot.value.x, measured - knot.value.x);
            shift = angle::nearest(turned, shift);
            after.keys.insert(Channel::Twist, knot.time, Vec3::new(old + shift, 0.0, 0.0));
        }
        after
    }

    /// Converts the hand's present angles and all their keys to another space. The hand keeps its
    /// orientation in the present pose and at every key.
    #[must_use]
    pub fn with_hand_space(&self, space: HandSpace) -> Self {
        let mut after = self.clone();
        after.arm.hand_orientation = self.arm.hand_orientation.in_space(space, &self.arm.pose());
        let track = Track::new(self);
        let mut last = None;
        let keys = self.keys.track(Channel::HandOrientation);
        for knot in keys.into_iter().flat_map(Spline::knots) {
            let posed = track.at(knot.time);
            let orientation = posed.arm().hand_orientation;
            // Each key has the equivalent angles nearest to those of the previous key.
            let near = last.unwrap_or(orientation.angles);
            let angles = orientation.in_space_near(space, posed.arm_pose(), near).angles;
            last = Some(angles);
            after.keys.insert(Channel::HandOrientation, knot.time, angles);
        }
        after
    }
}
