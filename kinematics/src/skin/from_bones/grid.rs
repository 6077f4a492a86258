//! Cells of a grid that the surface of a field passes through.

use core::ops::Range;
use std::collections::HashMap;

use glam::{DVec3, IVec3};

use super::field::{Field, FieldScratch};

/// Distances at the corners of a cell; corner c has the coordinates of its bits: 1 for x, 2 for y,
/// 4 for z.
#[derive(Clone, Copy, Debug)]
pub struct Cell {
    /// Integer coordinates of the lowest corner.
    pub at: IVec3,
    pub corners: [f64; 8],
    /// Index of the block that it belongs to, in [`Grid::blocks`].
    pub block: u32,
}

/// The cells of a grid that the surface passes through, found by an octree of cubes whose centre is
/// nearer to the surface than their corners are.
pub struct Grid {
    lattice: Lattice,
    /// The cells, in the order of the octree.
    pub cells: Vec<Cell>,
    /// Indices in `cells` by coordinates.
    index: HashMap<IVec3, u32>,
    /// The field near each block of cells.
    pub blocks: Vec<Field>,
}

/// Where the corners of cells are.
#[derive(Clone, Copy)]
struct Lattice {
    origin: DVec3,
    /// Size of a cell.
    cell: f64,
}

/// A cube that the surface may pass through, with the field near it.
struct Cube {
    field: Field,
    low: IVec3,
}

/// The cells of a block.
struct CellBlock {
    field: Field,
    cells: Vec<(IVec3, [f64; 8])>,
}

/// Upper bound of the change of the distance per unit of the way.
const STEEPEST: f64 = 1.1;
/// Cells along the edge of a block.
const BLOCK: i32 = 4;
/// Cubes along the edge of the grid that are searched at the same time.
const BRANCHES: i32 = 8;
/// Distance around a block, in cells, in which the field near the block is exact.
pub const MARGIN: f64 = 1.0;

impl Grid {
    /// The grid of cells of the size `cell` over the box from `low` to `high`.
    pub fn new(field: &Field, cell: f64, low: DVec3, high: DVec3) -> Self {
        let mut blocks = 1;
        while f64::from(blocks * BLOCK) * cell < (high - low).max_element() {
            blocks *= 2;
        }
        // Not on the bones, where symmetric bodies would have distances of exactly 0.
        let shift = DVec3::new(0.317, 0.229, 0.411) * cell;
        let origin = low.midpoint(high) - 0.5 * f64::from(blocks * BLOCK) * cell + shift;
        let lattice = Lattice { origin, cell };
        let all = blocks * BLOCK;
        let large = (all / BRANCHES).max(BLOCK);
        let mut branches = Vec::new();
        lattice.visit(field, IVec3::ZERO, all, large, &mut branches);
        let of_branch = |branch: &Cube| {
            let mut cubes = Vec::new();
            lattice.visit(&branch.field, branch.low, large, BLOCK, &mut cubes);
            cubes.into_iter().map(|cube| lattice.block(cube)).collect::<Vec<CellBlock>>()
        };
        let mut grid =
            Self { lattice, cells: Vec::new(), index: HashMap::new(), blocks: Vec::new() };
        for block in map_in_order(&branches, of_branch).into_iter().flatten() {
            grid.add(block);
        }
        grid
    }

    fn add(&mut self, CellBlock { field, cells }: CellBlock) {
        let block = self.blocks.len() as u32;
        for (at, corners) in cells {
            self.index.insert(at, self.cells.len() as u32);
            self.cells.push(Cell { at, corners, block });
        }
        self.blocks.push(field);
    }

    /// Size of a cell.
    pub fn cell(&self) -> f64 {
        self.lattice.cell
    }

    /// Position of a corner of cells.
    pub fn corner(&self, corner: IVec3) -> DVec3 {
        self.lattice.corner(corner)
    }

    /// Index of the cell at some coordinates; `None` if the surface does not pass through it.
    pub fn index_of(&self, at: IVec3) -> Option<usize> {
        self.index.get(&at).map(|index| *index as usize)
    }
}

impl Lattice {
    fn corner(self, corner: IVec3) -> DVec3 {
        self.origin + corner.as_dvec3() * self.cell
    }

    /// Adds the cubes of `least` cells along the edge that the surface may pass through, of those
    /// in the cube of `cells` cells at `low`.
    fn visit(self, field: &Field, low: IVec3, cells: i32, least: i32, found: &mut Vec<Cube>) {
        let half = 0.5 * f64::from(cells) * self.cell;
        let centre = self.corner(low) + half;
        let radius = half * 3.0_f64.sqrt();
        let near = field.near(centre, radius + MARGIN * self.cell);
        if near.distance(centre, &mut FieldScratch::default()).abs() > STEEPEST * radius {
            return;
        }
        if cells == least {
            found.push(Cube { field: near, low });
            return;
        }
        let step = cells / 2;
        for child in 0..8 {
            self.visit(&near, low + corner_offset(child) * step, step, least, found);
        }
    }

    /// The cells of a block that the surface passes through.
    fn block(self, Cube { field, low }: Cube) -> CellBlock {
        let mut corners = BlockCorners::default();
        let mut cells = Vec::new();
        let mut distance = |at: IVec3| {
            let point = self.corner(low + at);
            corners.distance(at, |scratch| field.distance(point, scratch))
        };
        for octant in 0..8 {
            // The middle of an octant of 2×2×2 cells is √3 cells away from its farthest corners.
            let first = corner_offset(octant) * (BLOCK / 2);
            if distance(first + 1).abs() > STEEPEST * 3.0_f64.sqrt() * self.cell {
                continue;
            }
            for cell in 0..8 {
                let at = first + corner_offset(cell);
                let corners =
                    [0, 1, 2, 3, 4, 5, 6, 7].map(|corner| distance(at + corner_offset(corner)));
                let inside = corners.iter().filter(|distance| **distance < 0.0).count();
                if (1..8).contains(&inside) {
                    cells.push((low + at, corners));
                }
            }
        }
        CellBlock { field, cells }
    }
}

/// Distances at the corners of a block, computed when they are first needed.
#[derive(Default)]
struct BlockCorners {
    distances: [[[Option<f64>; CORNERS]; CORNERS]; CORNERS],
    scratch: FieldScratch,
}

/// Corners of cells along the edge of a block.
const CORNERS: usize = BLOCK as usize + 1;

impl BlockCorners {
    fn distance(&mut self, at: IVec3, compute: impl FnOnce(&mut FieldScratch) -> f64) -> f64 {
        let [x, y, z] = at.to_array().map(|index| index as usize);
        *self.distances[z][y][x].get_or_insert_with(|| compute(&mut self.scratch))
    }
}

/// Coordinates of a corner of a cell of the size 1.
pub fn corner_offset(corner: u8) -> IVec3 {
    IVec3::new(i32::from(corner & 1), i32::from(corner >> 1 & 1), i32::from(corner >> 2 & 1))
}

/// Maps items in their order; on all cores with the feature `parallel`.
pub fn map_in_order<I: Sync, T: Send>(items: &[I], map: impl Fn(&I) -> T + Sync + Send) -> Vec<T> {
    #[cfg(feature = "parallel")]
    {
        use rayon::iter::{IntoParallelRefIterator as _, ParallelIterator as _};
        items.par_iter().map(map).collect()
    }
    #[cfg(not(feature = "parallel"))]
    items.iter().map(map).collect()
}

/// Maps ranges of the indices below `count`, each small beside the work of a core, to lists, and
/// joins these in order; on all cores with the feature `parallel`.
pub fn map_ranges<T: Send + Clone>(
    count: usize,
    map: impl Fn(Range<usize>) -> Vec<T> + Sync + Send,
) -> Vec<T> {
    const LENGTH: usize = 512;
    let starts: Vec<usize> = (0..count).step_by(LENGTH).collect();
    map_in_order(&starts, |start| map(*start..count.min(start + LENGTH))).concat()
}
