use crate::skeleton::JointId;

/// The joints that a vertex follows, at most four, with their weights: above 0, the heaviest first,
/// their sum 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VertexWeights {
    joints: [u16; 4],
    weights: [f32; 4],
}

impl VertexWeights {
    /// Full weight for one joint.
    pub fn rigid(joint: JointId) -> Self {
        Self::heaviest([(joint, 1.0)]).0
    }

    /// Weights in the form of [`VertexWeights::joints`] and [`VertexWeights::weights`], unchanged
    /// if they are valid; otherwise as [`VertexWeights::heaviest`].
    pub fn listed(joints: [u16; 4], weights: [f32; 4]) -> Self {
        const ROUNDING: f32 = 1e-5;
        let sum: f32 = weights.iter().sum();
        let is_sorted = weights.is_sorted_by(|one, next| one >= next) && weights[3] >= 0.0;
        if is_sorted && (sum - 1.0).abs() <= ROUNDING {
            return Self { joints, weights };
        }
        let joints = joints.map(|joint| JointId::new(usize::from(joint)));
        Self::heaviest(joints.into_iter().zip(weights)).0
    }

    /// The four heaviest of any number of weights, scaled to the sum 1, and the part of the
    /// original sum that was cut. Weights of the same joint are added; weights that are not finite
    /// or not above 0 count as 0. Without any weight above 0 the vertex follows joint 0.
    pub fn heaviest(weights: impl IntoIterator<Item = (JointId, f32)>) -> (Self, f32) {
        let merged = merged(weights);
        let all: f64 = merged.iter().map(|(_, weight)| weight).sum();
        let kept: f64 = merged.iter().take(4).map(|(_, weight)| weight).sum();
        (Self::of_heaviest(&merged), if all > 0.0 { (1.0 - kept / all) as f32 } else { 0.0 })
    }

    /// The four heaviest of any number of weights, after the fifth, if there is one, is subtracted
    /// from each: so the weights change evenly where another joint becomes one of the four.
    /// Otherwise as [`VertexWeights::heaviest`].
    pub(super) fn heaviest_evenly(weights: impl IntoIterator<Item = (JointId, f32)>) -> Self {
        let mut merged = merged(weights);
        // Not all of it: five equal weights would leave nothing.
        let fifth = merged.get(4).map_or(0.0, |(_, weight)| 0.999 * weight);
        merged.truncate(4);
        merged.iter_mut().for_each(|(_, weight)| *weight -= fifth);
        Self::of_heaviest(&merged)
    }

    /// The first four of sorted weights, scaled to the sum 1; without any, full weight for joint 0.
    fn of_heaviest(sorted: &[(JointId, f64)]) -> Self {
        let sorted = &sorted[..sorted.len().min(4)];
        let sum: f64 = sorted.iter().map(|(_, weight)| weight).sum();
        let mut result = Self { joints: [0; 4], weights: [1.0, 0.0, 0.0, 0.0] };
        for (index, (joint, weight)) in sorted.iter().enumerate() {
            result.joints[index] = u16::try_from(joint.index()).unwrap_or(u16::MAX);
            result.weights[index] = (weight / sum) as f32;
        }
        result
    }

    /// The joints with their weights, the heaviest first.
    pub fn iter(&self) -> impl Iterator<Item = (JointId, f32)> + Clone + '_ {
        let joints = self.joints.iter().map(|joint| JointId::new(usize::from(*joint)));
        joints.zip(self.weights).take_while(|(_, weight)| *weight > 0.0)
    }

    /// The heaviest joint.
    pub fn first(&self) -> JointId {
        JointId::new(usize::from(self.joints[0]))
    }

    /// The weight of a joint; 0 if the vertex does not follow it.
    pub fn of(&self, joint: JointId) -> f32 {
        self.iter().find(|(other, _)| *other == joint).map_or(0.0, |(_, weight)| weight)
    }

    /// Joint indices, with 0 where there are fewer than four, as graphics devices take them.
    pub fn joints(&self) -> [u16; 4] {
        self.joints
    }

    /// Weights in the order of [`VertexWeights::joints`], with 0 where there are fewer than four.
    pub fn weights(&self) -> [f32; 4] {
        self.weights
    }
}

/// The weights that are finite and above 0, those of one joint added, the heaviest first.
fn merged(weights: impl IntoIterator<Item = (JointId, f32)>) -> Vec<(JointId, f64)> {
    let mut merged: Vec<(JointId, f64)> = Vec::new();
    for (joint, weight) in weights {
        let weight = f64::from(weight);
        if !(weight.is_finite() && weight > 0.0) {
            continue;
        }
        match merged.iter_mut().find(|(other, _)| *other == joint) {
            Some((_, sum)) => *sum += weight,
            None => merged.push((joint, weight)),
        }
    }
    merged.sort_by(|one, other| other.1.total_cmp(&one.1).then(one.0.cmp(&other.0)));
    merged
}
