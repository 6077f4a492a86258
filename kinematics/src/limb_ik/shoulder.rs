//! The way around the Pointer by which the elbow is turned aside where the limits of the upper joint
//! do not allow the place that it should have, but another one of its circle.

use core::f64::consts::PI;

use glam::{DMat3, DVec3};

use crate::skeleton::Joint;

/// The upper joint of a limb that reaches for its target.
pub(super) struct Shoulder<'a> {
    pub joint: &'a Joint,
    /// From the base of the upper bone to the limb's tip, in the joint's space.
    pub tip: DVec3,
    /// The joint's rotation with the elbow turned about the Pointer by an angle. All of them bring
    /// the tip to the same place.
    pub turned: &'a dyn Fn(f64) -> DMat3,
}

/// Radians between the places that are tried, and their number to each side.
const STEP: f64 = PI / 36.0;
const STEPS: u8 = 36;

impl Shoulder<'_> {
    /// The least turn of the elbow with which the limits let the tip come to its place: 0 if they
    /// do without. If they never do, the turn that brings the tip nearest. `before`, the turn in
    /// the step before, decides between the two sides.
    pub fn way_aside(&self, before: f64) -> f64 {
        if !self.joint.limits.is_limited() || self.reaches(0.0) {
            return 0.0;
        }
        let sides = if before < 0.0 { [-1.0, 1.0] } else { [1.0, -1.0] };
        match sides.map(|side| self.first_that_reaches(side)) {
            [Some(same), _] if before != 0.0 => same,
            [Some(one), Some(other)] if one.abs() > other.abs() => other,
            [one, other] => one.or(other).unwrap_or_else(|| self.nearest(before)),
        }
    }

    /// Distance from the tip within the limits to its place.
    pub fn miss(&self, aside: f64) -> f64 {
        let wanted = (self.turned)(aside);
        let within = self.joint.rotation_f64(self.joint.angles_within(wanted).angles);
        (within * self.tip).distance(wanted * self.tip)
    }

    /// The distance below which the tip is at its place.
    pub fn rounding(&self) -> f64 {
        1e-5 * self.tip.length()
    }

    fn reaches(&self, aside: f64) -> bool {
        self.miss(aside) <= self.rounding()
    }

    /// The first turn to a side with which the tip comes to its place.
    fn first_that_reaches(&self, side: f64) -> Option<f64> {
        const HALVINGS: u32 = 24;
        let steps = (1..=STEPS).map(|step| side * STEP * f64::from(step));
        let mut reached = steps.into_iter().find(|turn| self.reaches(*turn))?;
        let mut missed = reached - side * STEP;
        for _ in 0..HALVINGS {
            let middle = 0.5 * (reached + missed);
            if self.reaches(middle) {
                reached = middle;
            } else {
                missed = middle;
            }
        }
        Some(reached)
    }

    /// The turn that brings the tip nearest to its place, of about equal ones that which is nearest
    /// to none and to that of the step before. A limb that was turned aside stays there for long, so
    /// that its elbow does not jump.
    fn nearest(&self, before: f64) -> f64 {
        /// Distance, in lengths of the limb, that a turn by half a circle must gain.
        const WORTH: f64 = 0.02;
        /// The same of a turn away from that of the step before.
        const WORTH_OF_CHANGE: f64 = 0.4;
        const HALVINGS: u32 = 12;
        let length = self.tip.length() / PI;
        let of_change = if before == 0.0 { WORTH } else { WORTH_OF_CHANGE };
        let cost = |turn: f64| {
            let turned = WORTH * turn.abs() + of_change * (turn - before).abs();
            self.miss(turn) + length * turned
        };
        let steps = -i16::from(STEPS)..=i16::from(STEPS);
        let turns = steps.map(|step| STEP * f64::from(step));
        let mut best = (0.0, cost(0.0));
        for turn in turns {
            let of_turn = cost(turn);
            if of_turn < best.1 {
                best = (turn, of_turn);
            }
        }
        let mut step = STEP;
        for _ in 0..HALVINGS {
            step *= 0.5;
            for turn in [best.0 - step, best.0 + step] {
                let of_turn = cost(turn);
                if of_turn < best.1 {
                    best = (turn, of_turn);
                }
            }
        }
        best.0
    }
}
