//! The grid of a reach region: its places, and the surface around those that are reached.

use std::collections::HashMap;

use glam::{DVec3, IVec3, Vec3};

use crate::skin::TriangleMesh;

/// Centres of the cells of a grid, in the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Lattice {
    /// Centre of the first cell.
    low: DVec3,
    /// Width of a cell.
    pub width: f64,
    /// Number of cells along each axis.
    pub counts: IVec3,
}

/// What is known of a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Cell {
    pub is_reached: bool,
    /// Least distance to the place that was found.
    pub miss: f32,
    /// Number of tries from neighbours.
    pub tries: u8,
    pub has_fresh_try: bool,
}

impl Cell {
    pub const UNKNOWN: Self =
        Self { is_reached: false, miss: f32::MAX, tries: 0, has_fresh_try: false };
}

impl Lattice {
    /// A grid over a box with this many cells along its longest side.
    pub fn over([low, high]: [DVec3; 2], cells: i32) -> Self {
        let size = (high - low).max(DVec3::splat(f64::MIN_POSITIVE));
        let width = size.max_element() / f64::from(cells);
        let counts = (size / width).ceil().as_ivec3().clamp(IVec3::ONE, IVec3::splat(cells));
        let middle = (low + high) / 2.0;
        let low = middle - (counts - 1).as_dvec3() * (width / 2.0);
        Self { low, width, counts }
    }

    pub fn len(&self) -> usize {
        self.counts.to_array().into_iter().map(|count| count as usize).product()
    }

    pub fn centre(&self, at: IVec3) -> DVec3 {
        self.low + at.as_dvec3() * self.width
    }

    /// The index of a cell; `None` outside the grid.
    pub fn index(&self, at: IVec3) -> Option<usize> {
        let is_in = at.cmpge(IVec3::ZERO).all() && at.cmplt(self.counts).all();
        is_in.then(|| ((at.z * self.counts.y + at.y) * self.counts.x + at.x) as usize)
    }

    pub fn at(&self, index: usize) -> IVec3 {
        let (index, IVec3 { x, y, .. }) = (index as i32, self.counts);
        IVec3::new(index % x, index / x % y, index / (x * y))
    }

    pub fn nearest(&self, point: DVec3) -> IVec3 {
        ((point - self.low) / self.width).round().as_ivec3()
    }
}

/// The surface between the places of a grid that are reached and those that are not, by surface
/// nets: a vertex in each cube of eight places that differ, at the mean of where its edges cross the
/// surface, and a quad around each such edge. An edge is crossed where the tip came nearest to the
/// place that is not reached.
pub(super) fn surface(lattice: &Lattice, cells: &[Cell]) -> TriangleMesh {
    let grid = Grid { lattice, cells };
    let mut vertices = HashMap::new();
    let mut positions = Vec::new();
    let counts = lattice.counts;
    for z in -1..counts.z {
        for y in -1..counts.y {
            for x in -1..counts.x {
                let at = IVec3::new(x, y, z);
                if let Some(vertex) = grid.vertex(at) {
                    vertices.insert(at, positions.len() as u32);
                    positions.push(vertex);
                }
            }
        }
    }
    let mut triangles = Vec::new();
    for at in vertices.keys().copied() {
        triangles.extend((0..3).filter_map(|axis| grid.quad(&vertices, at, axis)).flatten());
    }
    triangles.sort_unstable();
    let normals = normals(&positions, &triangles);
    let positions = positions.into_iter().map(DVec3::as_vec3).collect();
    TriangleMesh { positions, normals, triangles, ..TriangleMesh::default() }
}

struct Grid<'a> {
    lattice: &'a Lattice,
    cells: &'a [Cell],
}

const CORNERS: [IVec3; 8] = [
    IVec3::new(0, 0, 0),
    IVec3::new(1, 0, 0),
    IVec3::new(0, 1, 0),
    IVec3::new(1, 1, 0),
    IVec3::new(0, 0, 1),
    IVec3::new(1, 0, 1),
    IVec3::new(0, 1, 1),
    IVec3::new(1, 1, 1),
];

impl Grid<'_> {
    fn is_reached(&self, at: IVec3) -> bool {
        self.lattice.index(at).is_some_and(|index| self.cells[index].is_reached)
    }

    /// Where the surface crosses the edge between two neighbouring places; `None` if it does not.
    fn crossing(&self, one: IVec3, other: IVec3) -> Option<DVec3> {
        let (inner, outer) = match (self.is_reached(one), self.is_reached(other)) {
            (true, false) => (one, other),
            (false, true) => (other, one),
            _ => return None,
        };
        /// Least distance of the surface from both ends, in widths.
        const MARGIN: f64 = 0.05;
        let miss = self.lattice.index(outer).map_or(f32::MAX, |index| self.cells[index].miss);
        let part = f64::from(miss) / self.lattice.width;
        let part = part.clamp(MARGIN, 1.0 - MARGIN);
        let (from, to) = (self.lattice.centre(outer), self.lattice.centre(inner));
        Some(from.lerp(to, part))
    }

    /// The vertex in the cube of places from `at` on; `None` if all are alike.
    fn vertex(&self, at: IVec3) -> Option<DVec3> {
        let (mut sum, mut count) = (DVec3::ZERO, 0.0);
        for corner in CORNERS {
            for axis in (0..3).filter(|axis| corner[*axis] == 0) {
                let from = at + corner;
                if let Some(crossing) = self.crossing(from, from + IVec3::AXES[axis]) {
                    sum += crossing;
                    count += 1.0;
                }
            }
        }
        (count > 0.0).then(|| sum / count)
    }

    /// The two triangles around the edge from a place along an axis, if the surface crosses it.
    fn quad(
        &self,
        vertices: &HashMap<IVec3, u32>,
        at: IVec3,
        axis: usize,
    ) -> Option<[[u32; 3]; 2]> {
        self.crossing(at, at + IVec3::AXES[axis])?;
        let (second, third) = (IVec3::AXES[(axis + 1) % 3], IVec3::AXES[(axis + 2) % 3]);
        // Counter-clockwise seen from the end of the edge.
        let around = [at, at - second, at - second - third, at - third];
        let [mut a, mut b, mut c, mut d] = [0; 4];
        for (corner, cube) in [&mut a, &mut b, &mut c, &mut d].into_iter().zip(around) {
            *corner = *vertices.get(&cube)?;
        }
        let quad = [[a, b, c], [a, c, d]];
        let flipped = |[a, b, c]: [u32; 3]| [a, c, b];
        Some(if self.is_reached(at) { quad } else { quad.map(flipped) })
    }
}

/// Unit normals of vertices: the means of the triangles' normals by area.
fn normals(positions: &[DVec3], triangles: &[[u32; 3]]) -> Vec<Vec3> {
    let mut sums = vec![DVec3::ZERO; positions.len()];
    for corners in triangles {
        let [a, b, c] = corners.map(|corner| positions[corner as usize]);
        let normal = (b - a).cross(c - a);
        corners.iter().for_each(|corner| sums[*corner as usize] += normal);
    }
    sums.into_iter().map(|sum| sum.normalize_or(DVec3::Y).as_vec3()).collect()
}
