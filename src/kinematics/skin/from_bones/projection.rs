//! Vertices moved onto the surface of a field.

use glam::DVec3;

use super::field::{Field, FieldScratch};
use super::round_cone::Sighting;
use super::surface_nets::SurfaceNet;

/// Greatest distance from the surface, in local radii.
const TOLERANCE: f64 = 2e-4;

/// Spreads the vertices evenly over the surface: each moves to the mean of its neighbours, along the
/// surface, and back onto it.
pub fn relax(net: &mut SurfaceNet, blocks: &[Field<'_>], rounds: usize) {
    let mut scratch = FieldScratch::default();
    let directed =
        net.quads.iter().flat_map(|[a, b, c, d]| [[*a, *b], [*b, *c], [*c, *d], [*d, *a]]);
    let edges: Vec<[u32; 2]> = directed.collect();
    project(net, blocks, &mut scratch);
    for _ in 0..rounds {
        // Each edge belongs to two quads, once in each direction.
        let mut sums = vec![(DVec3::ZERO, 0.0); net.vertices.len()];
        for [from, to] in &edges {
            let (sum, count) = &mut sums[*from as usize];
            *sum += net.vertices[*to as usize];
            *count += 1.0;
        }
        for (vertex, (sum, count)) in sums.into_iter().enumerate() {
            let here = net.vertices[vertex];
            let field = &blocks[net.blocks[vertex] as usize];
            let normal = field.sighting(here, &mut scratch).gradient.normalize_or(DVec3::X);
            net.vertices[vertex] = here + 0.5 * (sum / count - here).reject_from(normal);
        }
        project(net, blocks, &mut scratch);
    }
}

fn project(net: &mut SurfaceNet, blocks: &[Field<'_>], scratch: &mut FieldScratch) {
    for (vertex, block) in net.vertices.iter_mut().zip(&net.blocks) {
        *vertex = onto_surface(&blocks[*block as usize], *vertex, scratch);
    }
}

/// The point of the surface that Newton steps along the gradient lead to. Where they go back and forth
/// across a crease, the surface is between the last points on either side.
fn onto_surface(field: &Field<'_>, start: DVec3, scratch: &mut FieldScratch) -> DVec3 {
    let mut point = start;
    let mut sides: [Option<DVec3>; 2] = [None, None];
    for _ in 0..8 {
        let Sighting { distance, gradient, radius } = field.sighting(point, scratch);
        if distance.abs() <= TOLERANCE * radius {
            return point;
        }
        sides[usize::from(distance < 0.0)] = Some(point);
        let length = gradient.length_squared().max(0.25);
        point -= gradient * (distance / length);
    }
    match sides {
        [Some(outside), Some(inside)] => between(field, outside, inside, scratch),
        _ => point,
    }
}

fn between(
    field: &Field<'_>,
    mut outside: DVec3,
    mut inside: DVec3,
    scratch: &mut FieldScratch,
) -> DVec3 {
    let mut point = outside.midpoint(inside);
    for _ in 0..60 {
        let Sighting { distance, radius, .. } = field.sighting(point, scratch);
        if distance.abs() <= TOLERANCE * radius {
            break;
        }
        *(if distance < 0.0 { &mut inside } else { &mut outside }) = point;
        point = outside.midpoint(inside);
    }
    point
}
