use super::{Cause, Remedy};
use crate::skeleton::JointId;

/// A cause for which a tip is not at its target, or a hand not turned as its target asks.
#[derive(Clone, Debug, PartialEq)]
pub struct Diagnosis {
    /// The joint whose tip is not at its target.
    pub target: JointId,
    /// Distance from the tip to the target, in world units.
    pub residual: f32,
    /// The cause.
    pub cause: Cause,
    /// The joints concerned; those with the greatest effect first.
    pub joints: Vec<JointId>,
    /// Changes that bring the tip nearer, the best first; empty if none of those tried does.
    pub remedies: Vec<TriedRemedy>,
}

/// A remedy and what it leaves.
#[derive(Clone, Debug, PartialEq)]
pub struct TriedRemedy {
    /// The change.
    pub remedy: Remedy,
    /// Distance from the tip to the target after the change, in world units.
    pub residual: f32,
    /// Angle in radians from the rotation of the hand to that which its target asks for, after the
    /// change; 0 for a target that asks for no rotation.
    pub rotation_residual: f32,
}

impl Diagnosis {
    /// The residual that the best remedy leaves; without a remedy, the present one.
    pub fn residual_with_remedy(&self) -> f32 {
        self.remedies.first().map_or(self.residual, |tried| tried.residual)
    }
}

/// The most likely cause for each target, then the second one for each, and so on.
pub(crate) fn in_turn(mut lists: Vec<Vec<Diagnosis>>) -> Vec<Diagnosis> {
    let mut all = Vec::new();
    lists.iter_mut().for_each(|list| list.reverse());
    while lists.iter().any(|list| !list.is_empty()) {
        all.extend(lists.iter_mut().filter_map(Vec::pop));
    }
    all
}
