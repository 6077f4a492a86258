//! Cells of a grid that the surface of a field passes through.

use std::collections::HashMap;

use glam::{DVec3, IVec3};

use super::field::{Field, FieldScratch};

/// Cells by their integer coordinates.
pub type Cells = HashMap<IVec3, Cell>;

/// Distances at the corners of a cell; corner c has the coordinates of its bits: 1 for x, 2 for y, 4 for z.
#[derive(Clone, Copy, Debug)]
pub struct Cell {
    pub corners: [f64; 8],
    /// Index of the block that it belongs to, in [`Grid::blocks`].
    pub block: u32,
}

/// The cells of a grid that the surface passes through, found by an octree of cubes whose centre is nearer
/// to the surface than their corners are.
pub struct Grid<'a> {
    origin: DVec3,
    cell: f64,
    pub cells: Cells,
    /// The field near each block of cells.
    pub blocks: Vec<Field<'a>>,
}

/// Cells along the edge of a block.
const BLOCK: i32 = 4;

impl<'a> Grid<'a> {
    /// The grid of cells of the size `cell` over the box from `low` to `high`.
    pub fn new(field: &Field<'a>, cell: f64, low: DVec3, high: DVec3) -> Self {
        let mut blocks = 1;
        while f64::from(blocks * BLOCK) * cell < (high - low).max_element() {
            blocks *= 2;
        }
        // Not on the bones, where symmetric bodies would have distances of exactly 0.
        let shift = DVec3::new(0.317, 0.229, 0.411) * cell;
        let origin = low.midpoint(high) - 0.5 * f64::from(blocks * BLOCK) * cell + shift;
        let mut grid = Self { origin, cell, cells: Cells::new(), blocks: Vec::new() };
        grid.visit(field, IVec3::ZERO, blocks * BLOCK);
        grid
    }

    /// Position of a corner of cells.
    pub fn corner(&self, corner: IVec3) -> DVec3 {
        self.origin + corner.as_dvec3() * self.cell
    }

    fn visit(&mut self, field: &Field<'a>, low: IVec3, cells: i32) {
        let half = 0.5 * f64::from(cells) * self.cell;
        let centre = self.corner(low) + half;
        let radius = half * 3.0_f64.sqrt();
        let near = field.near(centre, radius + 2.0 * self.cell);
        if near.distance(centre, &mut FieldScratch::default()).abs() > 1.001 * radius {
            return;
        }
        if cells == BLOCK {
            self.sample(near, low);
            return;
        }
        let step = cells / 2;
        for child in 0..8 {
            self.visit(&near, low + corner_offset(child) * step, step);
        }
    }

    fn sample(&mut self, field: Field<'a>, low: IVec3) {
        const CORNERS: usize = BLOCK as usize + 1;
        let mut scratch = FieldScratch::default();
        let mut distances = [[[0.0; CORNERS]; CORNERS]; CORNERS];
        for (z, plane) in (0..).zip(&mut distances) {
            for (y, row) in (0..).zip(plane) {
                for (x, distance) in (0..).zip(row) {
                    let corner = self.corner(low + IVec3::new(x, y, z));
                    *distance = field.distance(corner, &mut scratch);
                }
            }
        }
        let block = self.blocks.len() as u32;
        for index in 0..BLOCK.pow(3) {
            let at = IVec3::new(index % BLOCK, index / BLOCK % BLOCK, index / BLOCK.pow(2));
            let corners = [0, 1, 2, 3, 4, 5, 6, 7].map(|corner| {
                let IVec3 { x, y, z } = at + corner_offset(corner);
                distances[z as usize][y as usize][x as usize]
            });
            let inside = corners.iter().filter(|distance| **distance < 0.0).count();
            if (1..8).contains(&inside) {
                self.cells.insert(low + at, Cell { corners, block });
            }
        }
        self.blocks.push(field);
    }
}

/// Coordinates of a corner of a cell of the size 1.
pub fn corner_offset(corner: u8) -> IVec3 {
    IVec3::new(i32::from(corner & 1), i32::from(corner >> 1 & 1), i32::from(corner >> 2 & 1))
}
