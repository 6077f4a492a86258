//! A closed mesh through the cells of a grid: one vertex per patch of surface in a cell, one quad around
//! each crossed edge.

use std::collections::HashMap;

use glam::{DVec3, IVec3};

use super::grid::{Cell, Grid, corner_offset};
use super::patches::{EDGES, Patches, edge, edge_corners};

/// Vertices, with the block of the grid that each is in, and quads, counter-clockwise seen from outside.
pub struct SurfaceNet {
    pub vertices: Vec<DVec3>,
    pub blocks: Vec<u32>,
    pub quads: Vec<[u32; 4]>,
}

/// Patches of a cell with the index of its first vertex.
struct Patched {
    patches: Patches,
    first_vertex: u32,
}

impl SurfaceNet {
    pub fn new(grid: &Grid<'_>) -> Self {
        // In one order on every run: the order of a hash map differs.
        let mut order: Vec<IVec3> = grid.cells.keys().copied().collect();
        order.sort_unstable_by_key(glam::IVec3::to_array);
        let mut patched = patches(grid, &order);
        let mut net = Self { vertices: Vec::new(), blocks: Vec::new(), quads: Vec::new() };
        for at in &order {
            let (cell, patched) = (&grid.cells[at], patched.get_mut(at));
            if let Some(Patched { patches, first_vertex }) = patched {
                *first_vertex = net.vertices.len() as u32;
                net.vertices.extend(centres(grid, *at, cell, patches));
                net.blocks.resize(net.vertices.len(), cell.block);
            }
        }
        for at in &order {
            net.quads.extend((0..3).filter_map(|axis| quad(grid, &patched, *at, axis)));
        }
        net.without_cavities()
    }

    /// The mesh without surfaces that enclose a hole inside the body, which nobody can see.
    fn without_cavities(self) -> Self {
        let piece = pieces(self.vertices.len(), &self.quads);
        let mut volumes = vec![0.0; self.vertices.len()];
        for quad in &self.quads {
            let [a, b, c, d] = quad.map(|corner| self.vertices[corner as usize]);
            volumes[piece[quad[0] as usize]] += (a - c).cross(b - d).dot(a + b + c + d);
        }
        let mut index = vec![u32::MAX; self.vertices.len()];
        let mut solid = Self { vertices: Vec::new(), blocks: Vec::new(), quads: Vec::new() };
        for (vertex, at) in self.vertices.iter().enumerate() {
            if volumes[piece[vertex]] > 0.0 {
                index[vertex] = solid.vertices.len() as u32;
                solid.vertices.push(*at);
                solid.blocks.push(self.blocks[vertex]);
            }
        }
        let kept = self.quads.iter().map(|quad| quad.map(|corner| index[corner as usize]));
        solid.quads = kept.filter(|quad| quad[0] != u32::MAX).collect();
        solid
    }
}

/// For each vertex the first vertex of its connected piece of surface.
fn pieces(vertices: usize, quads: &[[u32; 4]]) -> Vec<usize> {
    let mut first: Vec<usize> = (0..vertices).collect();
    fn find(first: &mut [usize], mut vertex: usize) -> usize {
        while first[vertex] != vertex {
            first[vertex] = first[first[vertex]];
            vertex = first[vertex];
        }
        vertex
    }
    for quad in quads {
        let one = find(&mut first, quad[0] as usize);
        for corner in &quad[1..] {
            let other = find(&mut first, *corner as usize);
            first[other] = one;
        }
    }
    (0..vertices).map(|vertex| find(&mut first, vertex)).collect()
}

/// The patches of all cells, with no face that has two segments of the same patches on both sides.
fn patches(grid: &Grid<'_>, order: &[IVec3]) -> HashMap<IVec3, Patched> {
    let patched = |(at, cell): (&IVec3, &Cell)| {
        (*at, Patched { patches: Patches::new(cell), first_vertex: 0 })
    };
    let mut all: HashMap<IVec3, Patched> = grid.cells.iter().map(patched).collect();
    for at in order {
        for axis in 0..3 {
            let beyond = *at + IVec3::AXES[axis];
            let (low, high) = (2 * axis, 2 * axis + 1);
            let has_twice = |at: &IVec3, face: usize| {
                all.get(at).is_some_and(|patched| patched.patches.has_twice(face))
            };
            if has_twice(at, high) && has_twice(&beyond, low) {
                for (at, face) in [(at, high), (&beyond, low)] {
                    if let Some(patched) = all.get_mut(at) {
                        patched.patches.flip(&grid.cells[at], face);
                    }
                }
            }
        }
    }
    all
}

/// The mean of the points where the surface crosses the edges of each patch.
fn centres(
    grid: &Grid<'_>,
    at: IVec3,
    cell: &Cell,
    patches: &Patches,
) -> impl Iterator<Item = DVec3> {
    let mut sums = vec![(DVec3::ZERO, 0.0); patches.count()];
    for crossed in 0..EDGES {
        if let Some(patch) = patches.of_edge(crossed) {
            let [low, high] = edge_corners(crossed);
            let (a, b) = (cell.corners[usize::from(low)], cell.corners[usize::from(high)]);
            let [low, high] = [low, high].map(|corner| grid.corner(at + corner_offset(corner)));
            sums[patch].0 += low.lerp(high, a / (a - b));
            sums[patch].1 += 1.0;
        }
    }
    sums.into_iter().map(|(sum, count)| sum / count)
}

/// The quad around the edge from the lowest corner of a cell along an axis; `None` if the surface does
/// not cross it.
fn quad(
    grid: &Grid<'_>,
    patched: &HashMap<IVec3, Patched>,
    at: IVec3,
    axis: usize,
) -> Option<[u32; 4]> {
    let (second, third) = ((axis + 1) % 3, (axis + 2) % 3);
    // The four cells around the edge, counter-clockwise seen from its end.
    let around = [(0, 0), (1, 0), (1, 1), (0, 1)];
    let mut corners = [0; 4];
    for (corner, (back, down)) in corners.iter_mut().zip(around) {
        let neighbour = at - IVec3::AXES[second] * back - IVec3::AXES[third] * down;
        let low = (back as u8) << second | (down as u8) << third;
        let Patched { patches, first_vertex } = patched.get(&neighbour)?;
        *corner = first_vertex + patches.of_edge(edge(low, low | 1 << axis))? as u32;
    }
    if grid.cells.get(&at)?.corners[0] >= 0.0 {
        corners.reverse();
    }
    Some(corners)
}
