//! Skins made from the bones of a skeleton.
//!
//! Each bone is a round cone with the radii of its joint. The signed distances of the parts of a
//! joint and of its parent blend smoothly, two bones the more the sharper the bend between them;
//! all others by the minimum. The surface of that field is meshed by dual marching cubes, a form of
//! surface nets whose meshes are closed manifolds, one for each tree; its vertices are then moved
//! onto the surface.

mod body;
mod field;
mod grid;
mod pose;
mod round_cone;
mod surface_nets;
mod weights;

pub use body::{Blob, SkinShape, SkinShapeError};
pub(super) use grid::map_ranges;
pub(super) use weights::{REACH, falloff, smooth};

use glam::{DVec3, Vec3};

use super::{SkinnedMesh, TriangleMesh, VertexWeights};
use crate::skeleton::Skeleton;
use body::Body;
use field::Field;
use grid::Grid;
use pose::PosedBones;
use round_cone::RoundCone;
use surface_nets::SurfaceNet;
use weights::Weights;

impl SkinnedMesh {
    /// A skin around the bones of a skeleton in its bind pose, or in the pose of the shape, in
    /// skeleton space. Each tree of
    /// joints with radii above 0 gets one closed surface. Parts thinner than a cell of the grid,
    /// which only a skeleton of very different sizes has, become as thick as a cell.
    ///
    /// # Errors
    ///
    /// [`SkinShapeError`] if no joint has a radius, if the shape is invalid, or if the bones are so
    /// long that the surface has numbers that are not finite.
    pub fn from_bones(skeleton: &Skeleton, shape: &SkinShape) -> Result<Self, SkinShapeError> {
        if !shape.pose.is_empty() {
            shape.check(skeleton)?;
            let posed = PosedBones::new(skeleton, shape);
            let mesh = Self::from_bones(&posed.skeleton, &posed.shape)?;
            return Ok(posed.attached(mesh)?);
        }
        let mut bodies = Body::all(skeleton, shape)?;
        let cell = cell_size(&bodies, shape.detail)?;
        let mut mesh = TriangleMesh::default();
        let mut weights = Vec::new();
        for body in &mut bodies {
            body.thicken(f64::from(SkinShape::LEAST_DETAIL) * cell);
            add(body, cell, skeleton, &mut mesh, &mut weights);
        }
        let pose = skeleton.bind_pose_in_skeleton();
        let inverse_binds = skeleton.ids().map(|joint| pose.full(joint).inverse());
        Ok(Self::new(mesh, weights, inverse_binds.collect())?)
    }
}

/// Size of a cell of the grid: the smallest radius divided by the detail, but not so small that the
/// surface has more than about 200,000 cells.
fn cell_size(bodies: &[Body], detail: f32) -> Result<f64, SkinShapeError> {
    const MOST_CELLS: f64 = 2e5;
    const MOST_CELLS_ALONG: f64 = 1e5;
    let cones = || bodies.iter().flat_map(|body| &body.parts).map(|part| &part.cone);
    let least = cones().map(RoundCone::least_radius).fold(f64::INFINITY, f64::min);
    let area: f64 = cones().map(RoundCone::area).sum();
    let cell = (least / f64::from(detail)).max((area / MOST_CELLS).sqrt());
    let size = bodies.iter().map(bounds).map(|(low, high)| (high - low).max_element());
    let ratio = size.fold(0.0, f64::max) / cell;
    if !ratio.is_finite() || ratio >= MOST_CELLS_ALONG {
        return Err(SkinShapeError::TooThin { most: MOST_CELLS_ALONG, got: ratio });
    }
    Ok(cell)
}

/// Lowest and highest corner of a box around a body.
fn bounds(body: &Body) -> (DVec3, DVec3) {
    let boxes = body.parts.iter().map(|part| {
        let (centre, radius) = part.cone.bounds();
        (centre - radius, centre + radius)
    });
    boxes.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1))).unwrap_or_default()
}

/// Adds the mesh of a body and its weights.
fn add(
    body: &Body,
    cell: f64,
    skeleton: &Skeleton,
    mesh: &mut TriangleMesh,
    weights: &mut Vec<VertexWeights>,
) {
    const ROUNDS: usize = 2;
    let (low, high) = bounds(body);
    let grid = Grid::new(&Field::new(body), cell, low - 2.0 * cell, high + 2.0 * cell);
    let mut net = SurfaceNet::new(&grid);
    let normals = surface_nets::relax(&mut net, &grid, ROUNDS);
    let field = |vertex: usize| &grid.blocks[net.blocks[vertex] as usize];
    let by_distance = Weights::new(body, skeleton);
    let at = |vertex: usize| by_distance.at(net.vertices[vertex], field(vertex).parts());
    let mut own = grid::map_ranges(net.vertices.len(), |range| range.map(at).collect());
    let triangles: Vec<[u32; 3]> =
        net.quads.iter().flat_map(|quad| halves(&net.vertices, *quad)).collect();
    weights::smooth(&mut own, &edges(&triangles));
    let first = mesh.positions.len() as u32;
    mesh.positions.extend(net.vertices.iter().map(|at| at.as_vec3()));
    mesh.normals.extend(normals.iter().map(|normal| normal.as_vec3().normalize_or(Vec3::Y)));
    mesh.triangles.extend(triangles.iter().map(|corners| corners.map(|corner| corner + first)));
    weights.extend(own);
}

/// The two triangles of a quad, cut along its shorter diagonal.
fn halves(vertices: &[DVec3], [a, b, c, d]: [u32; 4]) -> [[u32; 3]; 2] {
    let apart =
        |one: u32, other: u32| vertices[one as usize].distance_squared(vertices[other as usize]);
    if apart(a, c) <= apart(b, d) { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] }
}

/// The edges of closed triangles, each once.
fn edges(triangles: &[[u32; 3]]) -> Vec<[u32; 2]> {
    let directed = triangles.iter().flat_map(|[a, b, c]| [[*a, *b], [*b, *c], [*c, *a]]);
    directed.filter(|[from, to]| from < to).collect()
}
