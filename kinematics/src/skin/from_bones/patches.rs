//! The pieces of surface in a cell.
//!
//! Where the corners of a cell are inside and outside, the surface crosses the edges between them. On each
//! face of the cell the crossed edges are joined by segments; the segments of all faces form cycles, and
//! each cycle is the border of one piece of surface, a patch. Naive surface nets have one vertex per cell
//! and tie different patches of it together; with one vertex per patch the mesh is a closed manifold
//! (G. Nielson, *Dual marching cubes*, IEEE Visualization 2004).
//!
//! A face with two opposite corners inside has four crossed edges, which can be joined in two ways. They
//! are joined so that the inside corners are separate, except on faces where one patch on either side
//! would then have both segments, that is, where two patches would share two edges of the mesh: there
//! the outside corners are separate. This splits both patches in two.

use super::grid::Cell;

/// Corners of the faces, counter-clockwise seen from outside: −x, +x, −y, +y, −z, +z.
const FACES: [[u8; 4]; 6] =
    [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];

/// Edges of a cell, by axis and lower corner: three axes with eight corners, of which four are used.
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

/// For each crossed edge of a cell the patch that it belongs to.
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

    /// Whether the face is crossed by two segments that belong to one patch.
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

/// For each crossed edge the next one around its patch. Each segment starts where the border of its face,
/// counter-clockwise seen from outside, goes in, and ends where it goes out.
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
