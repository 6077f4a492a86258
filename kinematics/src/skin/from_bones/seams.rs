//! Normals near the seams of a jointed skin.

use glam::DVec3;

use super::body::Body;
use super::field::{Field, FieldScratch};
use super::grid;
use super::sweep::Sweep;
use crate::skeleton::{JointId, Skeleton};

/// Distance from a seam, as a fraction of the radius there, within which normals turn.
const WIDTH: f64 = 0.6;

/// What is added to the normals of each body, by the indices of its vertices, so that they turn where
/// the surface of a joint meets that of the joint above it: at the seam to the mean of both normals, and
/// farther away less and less. Both surfaces are lit alike there, so that the seam is hardly seen.
pub fn turns<'a>(
    bodies: &[&'a Body],
    vertices: impl Fn(usize) -> &'a [DVec3] + Sync,
    skeleton: &Skeleton,
) -> Vec<Vec<(usize, DVec3)>> {
    let joints: Vec<Option<JointId>> = bodies.iter().map(|body| body.sole_joint()).collect();
    let body_of = |joint| joints.iter().position(|it| *it == Some(joint));
    let above = |joint: JointId| skeleton.ancestors(joint).skip(1).find_map(body_of);
    let pairs = joints.iter().enumerate();
    let pairs = pairs.filter_map(|(body, joint)| Some((body, above((*joint)?)?)));
    let pairs: Vec<[usize; 2]> =
        pairs.flat_map(|(body, above)| [[body, above], [above, body]]).collect();
    let of_pairs =
        grid::map_in_order(&pairs, |[of, other]| turns_near(vertices(*of), bodies[*other]));
    let mut all = vec![Vec::new(); bodies.len()];
    for ([of, _], turns) in pairs.iter().zip(of_pairs) {
        all[*of].extend(turns);
    }
    all
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
