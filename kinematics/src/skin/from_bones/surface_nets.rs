//! A closed mesh through the cells of a grid: one vertex per patch of surface in a cell, one quad
//! around each crossed edge. The vertices are then moved onto the surface of the field.

use glam::{DVec3, IVec3};

use super::field::{Field, FieldScratch};
use super::grid::{self, Cell, Grid, MARGIN, corner_offset};
use super::round_cone::Sighting;

/// Vertices, with the block of the grid that each is in, and quads, counter-clockwise seen from
/// outside.
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

/// The quad around the edge from the lowest corner of a cell along an axis; `None` if the surface
/// does not cross it.
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

/// Corners of the faces, counter-clockwise seen from outside: −x, +x, −y, +y, −z, +z.
const FACES: [[u8; 4]; 6] =
    [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];

/// Edges of a cell, by axis and lower corner: three axes with eight corners, of which four are
/// used.
pub const EDGES: usize = 24;

/// Index of the edge between two corners.
pub fn edge(one: u8, other: u8) -> usize {
    let axis = (one ^ other).trailing_zeros() as usize;
    axis * 8 + usize::from(one & other)
}

/// The corners of an edge.
pub fn edge_corners(edge: usize) -> [u8; 2] {
    let lower = (edge % 8) as u8;
    [lower, lower | 1 << (edge / 8)]
}

/// The pieces of surface in a cell: for each crossed edge the patch that it belongs to.
///
/// Where the corners of a cell are inside and outside, the surface crosses the edges between them.
/// On each face of the cell the crossed edges are joined by segments; the segments of all faces
/// form cycles, and each cycle is the border of one patch. Naive surface nets have one vertex per
/// cell and tie different patches of it together; with one vertex per patch the mesh is a closed
/// manifold (G. Nielson, *Dual marching cubes*, IEEE Visualization 2004).
///
/// A face with two opposite corners inside has four crossed edges, which can be joined in two ways.
/// They are joined so that the inside corners are separate, except on faces where one patch on
/// either side would then have both segments, that is, where two patches would share two edges of
/// the mesh: there the outside corners are separate. This splits both patches in two.
#[derive(Clone, Copy, Debug)]
pub struct Patches {
    patch: [u8; EDGES],
    count: u8,
    flipped: u8,
}

const NONE: u8 = u8::MAX;

impl Patches {
    pub fn new(cell: &Cell) -> Self {
        Self::with_flipped(cell, 0)
    }

    /// The patches after the segments on a face are joined in the other way.
    pub fn flip(&mut self, cell: &Cell, face: usize) {
        *self = Self::with_flipped(cell, self.flipped ^ 1 << face);
    }

    /// Number of patches.
    pub fn count(&self) -> usize {
        self.count.into()
    }

    /// The patch that a crossed edge belongs to; `None` for an edge that is not crossed.
    pub fn of_edge(&self, edge: usize) -> Option<usize> {
        Some(self.patch[edge]).filter(|patch| *patch != NONE).map(usize::from)
    }

    /// True if the face is crossed by two segments that belong to one patch.
    pub fn has_twice(&self, face: usize) -> bool {
        let corners = FACES[face];
        let of = |index: usize| self.of_edge(edge(corners[index], corners[(index + 1) % 4]));
        let patches = [of(0), of(1), of(2), of(3)];
        patches[0].is_some() && patches.iter().all(|patch| *patch == patches[0])
    }

    fn with_flipped(cell: &Cell, flipped: u8) -> Self {
        let next = segments(cell, flipped);
        let mut patches = Self { patch: [NONE; EDGES], count: 0, flipped };
        for start in 0..EDGES {
            if next[start] == NONE || patches.patch[start] != NONE {
                continue;
            }
            let mut edge = start;
            while patches.patch[edge] == NONE {
                patches.patch[edge] = patches.count;
                edge = next[edge].into();
            }
            patches.count += 1;
        }
        patches
    }
}

/// For each crossed edge the next one around its patch. Each segment starts where the border of its
/// face, counter-clockwise seen from outside, goes in, and ends where it goes out.
fn segments(cell: &Cell, flipped: u8) -> [u8; EDGES] {
    let is_inside = |corner: u8| cell.corners[usize::from(corner)] < 0.0;
    let mut next = [NONE; EDGES];
    for (face, corners) in FACES.iter().enumerate() {
        let corner = |index: usize| corners[index % 4];
        let border = |index: usize| edge(corner(index), corner(index + 1));
        let goes_in = |index: usize| !is_inside(corner(index)) && is_inside(corner(index + 1));
        let goes_out = |index: usize| is_inside(corner(index)) && !is_inside(corner(index + 1));
        for start in (0..4).filter(|index| goes_in(*index)) {
            let mut way = [start + 1, start + 2, start + 3];
            if flipped >> face & 1 == 1 {
                way.reverse();
            }
            if let Some(end) = way.into_iter().find(|index| goes_out(*index)) {
                next[border(start)] = border(end) as u8;
            }
        }
    }
    next
}

/// Greatest distance from the surface, in local radii.
const TOLERANCE: f64 = 2e-4;

/// Spreads the vertices evenly over the surface: each moves to the mean of its neighbours, along
/// the surface, and back onto it. A vertex stays near the cell that it was made in, where the field
/// of its block is exact. Returns the unit normals of the vertices.
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
    grid::map_ranges(count, |range| {
        let mut scratch = FieldScratch::default();
        range.map(|vertex| compute(vertex, &mut scratch)).collect()
    })
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

/// The point of the surface that Newton steps along the gradient lead to, and the normal there.
/// Where the steps go back and forth across a crease, the surface is between the last points on
/// either side.
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
