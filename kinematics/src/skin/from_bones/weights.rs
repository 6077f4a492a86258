//! Weights by distance.

use glam::DVec3;

use super::body::Body;
use super::round_cone::Sighting;
use crate::skeleton::{JointId, Skeleton};
use crate::skin::VertexWeights;

/// Weights of points at the surface of a body.
pub struct Weights<'a> {
    body: &'a Body,
    /// For each joint the joints within two steps in the tree, with the parts that each moves.
    near: Vec<Vec<(JointId, Vec<usize>)>>,
}

impl<'a> Weights<'a> {
    pub fn new(body: &'a Body, skeleton: &Skeleton) -> Self {
        let mut parts = vec![Vec::new(); skeleton.joints().len()];
        for (index, part) in body.parts.iter().enumerate() {
            parts[part.joint.index()].push(index);
        }
        let near = |joint: JointId| {
            let near = within_two_steps(skeleton, joint).into_iter();
            let near = near.map(|near| (near, parts[near.index()].clone()));
            near.filter(|(_, parts)| !parts.is_empty()).collect()
        };
        Self { body, near: skeleton.ids().map(near).collect() }
    }

    /// The weights at a point. The nearest joint has the greatest one. Those of the joints around
    /// it fall to 0 where they are farther away by [`REACH`] times the smaller radius of the two.
    /// `candidates` are parts, among them the nearest one.
    pub fn at(&self, point: DVec3, candidates: &[usize]) -> VertexWeights {
        let (joint, own) = self.nearest(point, candidates);
        let weight = |(joint, parts): &(JointId, Vec<usize>)| {
            let seen = nearest_of(self.body, point, parts);
            let radius = seen.radius.min(own.radius);
            let far = (seen.distance - own.distance).max(0.0) / radius;
            (*joint, falloff(far) as f32)
        };
        VertexWeights::heaviest_evenly(self.near[joint.index()].iter().map(weight))
    }

    fn nearest(&self, point: DVec3, candidates: &[usize]) -> (JointId, Sighting) {
        let seen = candidates
            .iter()
            .map(|part| (self.body.parts[*part].joint, nearest_of(self.body, point, &[*part])));
        let nearer = |one: (JointId, Sighting), other: (JointId, Sighting)| {
            if other.1.distance < one.1.distance { other } else { one }
        };
        seen.fold((JointId::new(0), Sighting::NONE), nearer)
    }
}

/// The nearest of some parts. Behind its base a part counts as farther away, so that where many
/// bones start at one point the surface behind them follows the bone that they start from.
fn nearest_of(body: &Body, point: DVec3, parts: &[usize]) -> Sighting {
    let seen = parts.iter().map(|part| {
        let sweep = &body.parts[*part].sweep;
        let seen = sweep.sighting(point);
        let behind = (sweep.start().0 - point).dot(sweep.direction()).max(0.0);
        Sighting { distance: seen.distance + 0.5 * behind, ..seen }
    });
    seen.fold(Sighting::NONE, Sighting::nearer)
}

/// Weight beside the nearest joint's weight of 1. Of two joints, the farther one then has the share
/// (1 − x)/2, which changes evenly from one joint to the other, with x = `far`/[`REACH`].
pub fn falloff(far: f64) -> f64 {
    let near = (1.0 - far / REACH).max(0.0);
    near / (2.0 - near)
}

/// Distance in local radii, beyond the nearest joint's, at which weights become 0. In the middle
/// third of a straight bone longer than six radii it is √5 − 1 = 1.236 to the next bone.
pub const REACH: f64 = 1.2;

fn within_two_steps(skeleton: &Skeleton, joint: JointId) -> Vec<JointId> {
    let mut near = vec![joint];
    for _ in 0..2 {
        for index in 0..near.len() {
            let at = near[index];
            let next: Vec<JointId> =
                skeleton[at].parent.into_iter().chain(skeleton.children(at)).collect();
            for next in next {
                if !near.contains(&next) {
                    near.push(next);
                }
            }
        }
    }
    near
}

/// Greatest change of any joint's weight along an edge that [`smooth`] leaves.
const GREATEST_JUMP: f32 = 0.3;

/// Smooths weights along the edges that they jump along, such as creases between bones that are far
/// apart in the tree: the two ends of such an edge come closer and follow the same four joints, one
/// edge after the other, until no edge has a jump. All other weights stay.
pub fn smooth(weights: &mut [VertexWeights], edges: &[[u32; 2]]) {
    const MOST_ROUNDS: usize = 500;
    /// Part of its own weights that an end keeps; the rest is the mean of both.
    const KEPT: f32 = 0.3;
    for _ in 0..MOST_ROUNDS {
        let mut is_smooth = true;
        for [one, other] in edges.iter().map(|edge| edge.map(|end| end as usize)) {
            let ends = [weights[one], weights[other]];
            if jump(&ends[0], &ends[1]) <= GREATEST_JUMP {
                continue;
            }
            is_smooth = false;
            let mean = VertexWeights::heaviest(ends.iter().flat_map(VertexWeights::iter)).0;
            let [one_nearer, other_nearer] = ends.map(|own| {
                let mixed = mean
                    .iter()
                    .map(|(joint, mean)| (joint, KEPT * own.of(joint) + (1.0 - KEPT) * mean));
                VertexWeights::heaviest(mixed).0
            });
            (weights[one], weights[other]) = (one_nearer, other_nearer);
        }
        if is_smooth {
            return;
        }
    }
}

/// Greatest change of the weight of any joint.
fn jump(one: &VertexWeights, other: &VertexWeights) -> f32 {
    let joints = one.iter().chain(other.iter()).map(|(joint, _)| joint);
    joints.map(|joint| (one.of(joint) - other.of(joint)).abs()).fold(0.0, f32::max)
}
