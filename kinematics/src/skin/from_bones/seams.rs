//! The seams of a jointed skin, where the body of a joint meets that of the joint above it.

use std::collections::HashMap;

use glam::{DVec3, Vec3};

use super::body::{Body, is_at_tip};
use super::field::{Field, FieldScratch};
use super::grid;
use super::sweep::Sweep;
use crate::skeleton::{JointId, Skeleton, SkeletonPose};
use crate::skin::VertexWeights;

/// A seam between the bodies of two joints.
#[derive(Clone, Copy, Debug)]
pub struct Seam {
    /// Indices of the bodies: of the joint above, and of the joint itself.
    pub bodies: [usize; 2],
    /// The joints of these bodies.
    joints: [JointId; 2],
    bend: Option<Bend>,
}

/// The part of a limb that bends evenly: two bodies of about one radius, one at the tip of the other,
/// or at the side of a body without a bone, as a thigh at a pelvis.
#[derive(Clone, Copy, Debug)]
struct Bend {
    /// Where the weights of both joints are equal.
    centre: DVec3,
    /// Unit vector between the directions of the two bones.
    along: DVec3,
    /// The smaller radius of the two bodies.
    radius: f64,
    side: Option<Side>,
}

/// The side of a body from which a limb goes out. Weights of the limb pass from none at the other side
/// to all at this one, so that the middle, which limbs of both sides pull, stays in shape.
#[derive(Clone, Copy, Debug)]
struct Side {
    /// A point in the middle of the body.
    middle: DVec3,
    /// From the middle to the side.
    out: DVec3,
}

impl Seam {
    /// The seams between bodies that have one joint each.
    pub fn all(bodies: &[&Body], skeleton: &Skeleton) -> Vec<Self> {
        let of_joint = |(index, body): (usize, &&Body)| Some((body.sole_joint()?, index));
        let body_of: HashMap<JointId, usize> =
            bodies.iter().enumerate().filter_map(of_joint).collect();
        let pose = skeleton.bind_pose_in_skeleton();
        let seam = |(joint, body): (&JointId, &usize)| {
            let mut above = skeleton.ancestors(*joint).skip(1);
            let above = above.find(|above| body_of.contains_key(above))?;
            let bodies_of = [body_of[&above], *body];
            let joints = [above, *joint];
            let bend = || {
                let radius = Bend::radius(bodies_of.map(|body| bodies[body]), pose.base(*joint))?;
                match is_at_tip(skeleton, *joint) {
                    true => Bend::at_tip(joints, radius, &pose),
                    false => Bend::at_side(joints, radius, &pose),
                }
            };
            let is_child = skeleton[*joint].parent == Some(above);
            Some(Self { bodies: bodies_of, joints, bend: is_child.then(bend).flatten() })
        };
        let mut seams: Vec<Self> = body_of.iter().filter_map(seam).collect();
        seams.sort_by_key(|seam| seam.joints[1]);
        seams
    }

    /// The other joint that a vertex of one of the two bodies follows, and its weight.
    fn share(&self, body: usize, vertex: DVec3) -> Option<(JointId, f64)> {
        let (bend, [above, below]) = (self.bend.as_ref()?, self.joints);
        let [of_above, of_below] = bend.weights(vertex);
        Some(if body == self.bodies[0] { (below, of_below) } else { (above, of_above) })
    }
}

impl Bend {
    /// Greatest ratio of the radii of two bodies that bend as one limb.
    const MOST_STEP: f64 = 1.4;
    /// Distance along the limb, in radii, in which the weights pass from one joint to the other, to
    /// either side. The less, the sooner the inside of a bend folds; the more, the more its outside
    /// bulges.
    const HALF_LENGTH: f64 = 1.4;
    /// Distances from the centre, in radii, between which the weights of the other joint end.
    const END: [f64; 2] = [1.8, 2.6];
    /// Distance, in radii, from a joint at a side to the centre of the bend, so that the fold is below
    /// the body.
    const BELOW: f64 = 0.3;

    /// The smaller radius of two bodies at a point; `None` if one of them is much thicker there.
    fn radius(bodies: [&Body; 2], at: Vec3) -> Option<f64> {
        let depth = |body| -Field::new(body).distance(at.as_dvec3(), &mut FieldScratch::default());
        let [one, other] = bodies.map(depth);
        let (radius, most) = (one.min(other), one.max(other));
        (radius > 0.0 && most <= Self::MOST_STEP * radius).then_some(radius)
    }

    /// Of two bones, one at the tip of the other; `None` if one has no length.
    fn at_tip([above, below]: [JointId; 2], radius: f64, pose: &SkeletonPose) -> Option<Self> {
        let along = (direction(above, pose)? + direction(below, pose)?).try_normalize()?;
        Some(Self { centre: pose.base(below).as_dvec3(), along, radius, side: None })
    }

    /// Of a bone that starts at a side of a joint without a bone; `None` if the joint has one, or if the
    /// bone starts in its middle.
    fn at_side([above, below]: [JointId; 2], radius: f64, pose: &SkeletonPose) -> Option<Self> {
        let along = direction(below, pose)?;
        let [middle, start] = [above, below].map(|joint| pose.base(joint).as_dvec3());
        let out = (start - middle).reject_from_normalized(along);
        let is_at_side = direction(above, pose).is_none() && out.length() > 0.5 * radius;
        let centre = start + Self::BELOW * radius * along;
        is_at_side.then_some(Self { centre, along, radius, side: Some(Side { middle, out }) })
    }

    /// The weights of the other joint for a vertex of either body: of the joint above, and of the
    /// joint below.
    fn weights(&self, vertex: DVec3) -> [f64; 2] {
        let out = (vertex - self.centre) / self.radius;
        let [near, far] = Self::END;
        let of_side = self.side.map_or(1.0, |side| side.part(vertex));
        let part = of_side * (1.0 - smooth_step((out.length() - near) / (far - near)));
        let below = smooth_step(0.5 + 0.5 * out.dot(self.along) / Self::HALF_LENGTH);
        [part * (1.0 - below), part * below]
    }
}

impl Side {
    fn part(&self, vertex: DVec3) -> f64 {
        let across = (vertex - self.middle).dot(self.out) / self.out.length_squared();
        smooth_step(0.5 + 0.5 * across)
    }
}

/// The direction of the bone of a joint, `None` if it has none.
fn direction(joint: JointId, pose: &SkeletonPose) -> Option<DVec3> {
    (pose.tip(joint).as_dvec3() - pose.base(joint).as_dvec3()).try_normalize()
}

fn smooth_step(x: f64) -> f64 {
    let x = x.clamp(0.0, 1.0);
    x * x * (3.0 - 2.0 * x)
}

/// The weights of the vertices of a body with one joint: that joint's, but near seams of a limb also
/// those of the joint beyond the seam, so that the limb bends there without a crease.
pub fn weights(
    body: usize,
    joint: JointId,
    vertices: &[DVec3],
    seams: &[Seam],
) -> Vec<VertexWeights> {
    let own: Vec<&Seam> = seams.iter().filter(|seam| seam.bodies.contains(&body)).collect();
    let at = |vertex: &DVec3| {
        let shares = own.iter().filter_map(|seam| seam.share(body, *vertex));
        let shares: Vec<(JointId, f64)> = shares.collect();
        let kept = 1.0 - shares.iter().map(|(_, share)| share).sum::<f64>();
        let all = shares.into_iter().chain([(joint, kept)]);
        VertexWeights::heaviest(all.map(|(joint, weight)| (joint, weight as f32))).0
    };
    vertices.iter().map(at).collect()
}

/// Distance from a seam, as a fraction of the radius there, within which normals turn.
const WIDTH: f64 = 0.6;

/// What is added to the normals of bodies, as (body, vertex, normal), so that they turn where two of
/// them meet: at the seam to the mean of both normals, and farther away less and less. Both surfaces
/// are lit alike there, so that the seam is hardly seen.
pub fn turns<'a>(
    seams: &[Seam],
    bodies: &[&Body],
    vertices: impl Fn(usize) -> &'a [DVec3] + Sync,
) -> Vec<(usize, usize, DVec3)> {
    let pairs: Vec<[usize; 2]> = seams
        .iter()
        .flat_map(|Seam { bodies: [one, other], .. }| [[*other, *one], [*one, *other]])
        .collect();
    let of_pair = |[of, other]: &[usize; 2]| {
        let turns = turns_near(vertices(*of), bodies[*other]).into_iter();
        turns.map(|(vertex, turn)| (*of, vertex, turn)).collect::<Vec<_>>()
    };
    grid::map_in_order(&pairs, of_pair).concat()
}

/// The part of another body in the normals of a surface.
fn turns_near(vertices: &[DVec3], other: &Body) -> Vec<(usize, DVec3)> {
    let (field, mut scratch) = (Field::new(other), FieldScratch::default());
    let (low, high) = other.bounds();
    let room = DVec3::splat(WIDTH * other.sweeps().map(Sweep::mean_radius).fold(0.0, f64::max));
    let (low, high) = (low - room, high + room);
    let near = vertices.iter().enumerate();
    let near = near.filter(|(_, at)| at.cmpge(low).all() && at.cmple(high).all());
    let turns = near.filter_map(|(vertex, at)| {
        let seen = field.sighting(*at, &mut scratch);
        let part = 1.0 - seen.distance.abs() / (WIDTH * seen.radius);
        (part > 0.0).then(|| (vertex, part * part * seen.gradient.normalize_or_zero()))
    });
    turns.collect()
}
