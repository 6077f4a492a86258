//! Vertices moved onto the surface of a field.

use core::ops::Range;

use glam::DVec3;

use super::field::{Field, FieldScratch};
use super::grid::{Grid, MARGIN};
use super::parallel;
use super::round_cone::Sighting;
use super::surface_nets::SurfaceNet;

/// Greatest distance from the surface, in local radii.
const TOLERANCE: f64 = 2e-4;

/// Spreads the vertices evenly over the surface: each moves to the mean of its neighbours, along the
/// surface, and back onto it. A vertex stays near the cell that it was made in, where the field of its block
/// is exact. Returns the unit normals of the vertices.
pub fn relax(net: &mut SurfaceNet, grid: &Grid, rounds: usize) -> Vec<DVec3> {
    let directed =
        net.quads.iter().flat_map(|[a, b, c, d]| [[*a, *b], [*b, *c], [*c, *d], [*d, *a]]);
    let edges: Vec<[u32; 2]> = directed.collect();
    let blocks = &net.blocks;
    let field = |vertex: usize| &grid.blocks[blocks[vertex] as usize];
    let starts = &net.vertices;
    let mut points = for_each_vertex(starts.len(), |vertex, scratch| {
        nearest(field(vertex), starts[vertex], scratch)
    });
    for _ in 0..rounds {
        // Each edge belongs to two quads, once in each direction.
        let mut sums = vec![(DVec3::ZERO, 0.0); points.len()];
        for [from, to] in &edges {
            let (sum, count) = &mut sums[*from as usize];
            *sum += points[*to as usize].0;
            *count += 1.0;
        }
        points = for_each_vertex(sums.len(), |vertex, scratch| {
            let ((sum, count), (here, normal)) = (sums[vertex], points[vertex]);
            let moved = here + 0.5 * (sum / count - here).reject_from(normal);
            let (moved, normal_there) = nearest(field(vertex), moved, scratch);
            let is_near = moved.distance(starts[vertex]) <= MARGIN * grid.cell();
            if is_near { (moved, normal_there) } else { (here, normal) }
        });
    }
    let points = for_each_vertex(points.len(), |vertex, scratch| {
        onto_surface(field(vertex), points[vertex].0, scratch)
    });
    let (vertices, normals) = points.into_iter().unzip();
    net.vertices = vertices;
    normals
}

/// Computes something for each vertex, on all cores.
fn for_each_vertex<T: Send + Clone>(
    count: usize,
    compute: impl Fn(usize, &mut FieldScratch) -> T + Sync + Send,
) -> Vec<T> {
    let of_range = |range: &Range<usize>| {
        let mut scratch = FieldScratch::default();
        range.clone().map(|vertex| compute(vertex, &mut scratch)).collect::<Vec<T>>()
    };
    parallel::map(&parallel::ranges(count), of_range).concat()
}

/// One Newton step towards the surface, and the normal at its start.
fn nearest(field: &Field, point: DVec3, scratch: &mut FieldScratch) -> (DVec3, DVec3) {
    let seen = field.sighting(point, scratch);
    (point - newton_step(&seen), seen.gradient.normalize_or(DVec3::X))
}

/// The step of Newton's method towards the surface, backwards.
fn newton_step(seen: &Sighting) -> DVec3 {
    seen.gradient * (seen.distance / seen.gradient.length_squared().max(0.25))
}

/// The point of the surface that Newton steps along the gradient lead to, and the normal there. Where the
/// steps go back and forth across a crease, the surface is between the last points on either side.
fn onto_surface(field: &Field, start: DVec3, scratch: &mut FieldScratch) -> (DVec3, DVec3) {
    let mut point = start;
    let mut sides: [Option<DVec3>; 2] = [None, None];
    for _ in 0..8 {
        let seen = field.sighting(point, scratch);
        if seen.distance.abs() <= TOLERANCE * seen.radius {
            return (point, seen.gradient.normalize_or(DVec3::Y));
        }
        sides[usize::from(seen.distance < 0.0)] = Some(point);
        point -= newton_step(&seen);
    }
    match sides {
        [Some(outside), Some(inside)] => between(field, outside, inside, scratch),
        _ => (point, DVec3::Y),
    }
}

/// A point of the surface between a point outside and one inside, and the normal there.
fn between(
    field: &Field,
    mut outside: DVec3,
    mut inside: DVec3,
    scratch: &mut FieldScratch,
) -> (DVec3, DVec3) {
    let mut point = outside.midpoint(inside);
    let mut normal = DVec3::Y;
    for _ in 0..60 {
        let Sighting { distance, gradient, radius } = field.sighting(point, scratch);
        normal = gradient.normalize_or(normal);
        if distance.abs() <= TOLERANCE * radius {
            break;
        }
        *(if distance < 0.0 { &mut inside } else { &mut outside }) = point;
        point = outside.midpoint(inside);
    }
    (point, normal)
}
