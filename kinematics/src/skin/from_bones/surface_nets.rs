//! A closed mesh through the cells of a grid: one vertex per patch of surface in a cell, one quad around
//! each crossed edge.

use glam::{DVec3, IVec3};

use super::grid::{Cell, Grid, corner_offset};
use super::patches::{EDGES, Patches, edge, edge_corners};

/// Vertices, with the block of the grid that each is in, and quads, counter-clockwise seen from outside.
#[derive(Default)]
pub struct SurfaceNet {
    pub vertices: Vec<DVec3>,
    pub blocks: Vec<u32>,
    pub quads: Vec<[u32; 4]>,
}

impl SurfaceNet {
    pub fn new(grid: &Grid) -> Self {
        let patches = patches(grid);
        let mut net = Self::default();
        let mut first_vertices = Vec::with_capacity(grid.cells.len());
        for (cell, patches) in grid.cells.iter().zip(&patches) {
            first_vertices.push(net.vertices.len() as u32);
            net.vertices.extend(centres(grid, cell, patches));
            net.blocks.resize(net.vertices.len(), cell.block);
        }
        for cell in 0..grid.cells.len() {
            let quad = |axis| quad(grid, &patches, &first_vertices, cell, axis);
            net.quads.extend((0..3).filter_map(quad));
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
        let mut solid = Self::default();
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
fn patches(grid: &Grid) -> Vec<Patches> {
    let mut all: Vec<Patches> = grid.cells.iter().map(Patches::new).collect();
    for (index, cell) in grid.cells.iter().enumerate() {
        for axis in 0..3 {
            let (low, high) = (2 * axis, 2 * axis + 1);
            if !all[index].has_twice(high) {
                continue;
            }
            let beyond = grid.index_of(cell.at + IVec3::AXES[axis]);
            if let Some(beyond) = beyond.filter(|beyond| all[*beyond].has_twice(low)) {
                all[index].flip(cell, high);
                all[beyond].flip(&grid.cells[beyond], low);
            }
        }
    }
    all
}

/// The mean of the points where the surface crosses the edges of each patch.
fn centres(grid: &Grid, cell: &Cell, patches: &Patches) -> impl Iterator<Item = DVec3> {
    let mut sums = vec![(DVec3::ZERO, 0.0); patches.count()];
    for crossed in 0..EDGES {
        if let Some(patch) = patches.of_edge(crossed) {
            let [low, high] = edge_corners(crossed);
            let (a, b) = (cell.corners[usize::from(low)], cell.corners[usize::from(high)]);
            let [low, high] =
                [low, high].map(|corner| grid.corner(cell.at + corner_offset(corner)));
            sums[patch].0 += low.lerp(high, a / (a - b));
            sums[patch].1 += 1.0;
        }
    }
    sums.into_iter().map(|(sum, count)| sum / count)
}

/// The quad around the edge from the lowest corner of a cell along an axis; `None` if the surface does
/// not cross it.
fn quad(
    grid: &Grid,
    patches: &[Patches],
    first_vertices: &[u32],
    cell: usize,
    axis: usize,
) -> Option<[u32; 4]> {
    patches[cell].of_edge(edge(0, 1 << axis))?;
    let at = grid.cells[cell].at;
    let (second, third) = ((axis + 1) % 3, (axis + 2) % 3);
    // The four cells around the edge, counter-clockwise seen from its end.
    let around = [(0, 0), (1, 0), (1, 1), (0, 1)];
    let mut corners = [0; 4];
    for (corner, (back, down)) in corners.iter_mut().zip(around) {
        let neighbour = at - IVec3::AXES[second] * back - IVec3::AXES[third] * down;
        let neighbour = grid.index_of(neighbour)?;
        let low = (back as u8) << second | (down as u8) << third;
        let patch = patches[neighbour].of_edge(edge(low, low | 1 << axis))?;
        *corner = first_vertices[neighbour] + patch as u32;
    }
    if grid.cells[cell].corners[0] >= 0.0 {
        corners.reverse();
    }
    Some(corners)
}
