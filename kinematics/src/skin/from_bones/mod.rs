//! Skins made from the bones of a skeleton.
//!
//! Each bone is a round cone with the radii of its joint. The signed distances of the parts of a
//! joint and of its parent blend smoothly, two bones the more the sharper the bend between them;
//! all others by the minimum. The surface of that field is meshed by dual marching cubes, a form of
//! surface nets whose meshes are closed manifolds, one for each tree, or for each joint of a jointed
//! shape; its vertices are then moved onto the surface.

mod body;
mod field;
mod grid;
mod pose;
mod round_cone;
mod seams;
mod surface_nets;
mod sweep;
mod weights;

pub use body::{Blob, SkinShape, SkinShapeError};
pub(super) use grid::map_ranges;
pub use sweep::BlobSphere;
pub(super) use weights::{REACH, falloff, smooth};

use glam::{DVec3, Vec3};

use super::{SkinnedMesh, TriangleMesh, VertexWeights};
use crate::skeleton::Skeleton;
use body::Body;
use field::Field;
use grid::Grid;
use pose::PosedBones;
use seams::Seam;
use surface_nets::SurfaceNet;
use sweep::Sweep;
use weights::Weights;

impl SkinnedMesh {
    /// A skin around the bones of a skeleton in its bind pose, or in the pose of the shape, in
    /// skeleton space. Each tree of joints with radii above 0 gets one closed surface, or each joint
    /// if the shape is jointed. Parts thinner than a cell of the grid, which only a skeleton of very
    /// different sizes has, become as thick as a cell.
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
        let cells = cell_sizes(&bodies, shape)?;
        for (body, cell) in bodies.iter_mut().zip(&cells) {
            body.thicken(f64::from(SkinShape::LEAST_DETAIL) * cell);
        }
        let bodies: Vec<(Body, f64)> = bodies.into_iter().zip(cells).collect();
        let mut surfaces =
            grid::map_in_order(&bodies, |(body, cell)| Surface::new(body, *cell, skeleton));
        if shape.is_jointed {
            join_seams(&mut surfaces, &bodies, skeleton);
        }
        let mut mesh = TriangleMesh::default();
        let mut weights = Vec::new();
        for surface in surfaces {
            surface.add_to(&mut mesh, &mut weights);
        }
        let pose = skeleton.bind_pose_in_skeleton();
        let inverse_binds = skeleton.ids().map(|joint| pose.full(joint).inverse());
        Ok(Self::new(mesh, weights, inverse_binds.collect())?)
    }
}

/// Size of the cells of each body's grid, but not so small that all surfaces together have more than
/// about 200,000 cells. Trees have cells of one size: the smallest radius divided by the detail. In a
/// jointed shape that is the size for the thinnest body, and a body that is n times as thick has
/// cells √n times as large, since a chord of length c misses an arc of radius r by c² / 8 r: the same
/// for all bodies. Where small details would make cells many, such as an ear on a head, they are
/// coarser.
fn cell_sizes(bodies: &[Body], shape: &SkinShape) -> Result<Vec<f64>, SkinShapeError> {
    const MOST_CELLS: f64 = 2e5;
    const MOST_CELLS_ALONG: f64 = 1e5;
    const MOST_CELLS_OF_JOINT: f64 = 1800.0;
    let area = |body: &Body| body.sweeps().map(Sweep::area).sum::<f64>();
    let least = |body: &Body| body.sweeps().map(Sweep::least_radius).fold(f64::INFINITY, f64::min);
    let mean = |body: &Body| {
        let sum: f64 = body.sweeps().map(|sweep| sweep.area() * sweep.mean_radius()).sum();
        sum / area(body)
    };
    let smallest =
        |radius: &dyn Fn(&Body) -> f64| bodies.iter().map(radius).fold(f64::MAX, f64::min);
    let (least_of_all, thinnest) = (smallest(&least), smallest(&mean));
    let detail = f64::from(shape.detail);
    let cell = |body: &Body| match shape.is_jointed {
        false => least_of_all / detail,
        true => {
            let coarse = (area(body) / MOST_CELLS_OF_JOINT).sqrt();
            let even = (thinnest * mean(body)).sqrt() / detail;
            coarse.max(even).min(least(body) / f64::from(SkinShape::LEAST_DETAIL))
        }
    };
    let mut cells: Vec<f64> = bodies.iter().map(cell).collect();
    let count = bodies.iter().zip(&cells).map(|(body, cell)| area(body) / (cell * cell));
    let coarser = (count.sum::<f64>() / MOST_CELLS).sqrt().max(1.0);
    cells.iter_mut().for_each(|cell| *cell *= coarser);
    let size = bodies.iter().map(Body::bounds).map(|(low, high)| (high - low).max_element());
    let along = size.zip(&cells).map(|(size, cell)| size / cell);
    let ratio =
        along.fold(0.0, |most, ratio| if ratio.is_nan() { f64::INFINITY } else { ratio.max(most) });
    if ratio >= MOST_CELLS_ALONG {
        return Err(SkinShapeError::TooThin { most: MOST_CELLS_ALONG, got: ratio });
    }
    Ok(cells)
}

/// Turns the normals near the seams of a jointed skin, and makes limbs bend evenly there.
fn join_seams(surfaces: &mut [Surface], bodies: &[(Body, f64)], skeleton: &Skeleton) {
    let bodies: Vec<&Body> = bodies.iter().map(|(body, _)| body).collect();
    let seams = Seam::all(&bodies, skeleton);
    for (body, vertex, turn) in seams::turns(&seams, &bodies, |body| &surfaces[body].vertices) {
        surfaces[body].normals[vertex] += turn;
    }
    for (index, (surface, body)) in surfaces.iter_mut().zip(&bodies).enumerate() {
        if let Some(joint) = body.sole_joint() {
            surface.weights = seams::weights(index, joint, &surface.vertices, &seams);
        }
    }
}

/// The mesh of a body, with the weights of its vertices.
struct Surface {
    vertices: Vec<DVec3>,
    normals: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
    weights: Vec<VertexWeights>,
}

impl Surface {
    fn new(body: &Body, cell: f64, skeleton: &Skeleton) -> Self {
        const ROUNDS: usize = 2;
        let (low, high) = body.bounds();
        let grid = Grid::new(&Field::new(body), cell, low - 2.0 * cell, high + 2.0 * cell);
        let mut net = SurfaceNet::new(&grid);
        let normals = surface_nets::relax(&mut net, &grid, ROUNDS);
        let triangles: Vec<[u32; 3]> =
            net.quads.iter().flat_map(|quad| halves(&net.vertices, *quad)).collect();
        let weights = match body.sole_joint() {
            Some(joint) => vec![VertexWeights::rigid(joint); net.vertices.len()],
            None => weights_by_distance(body, &net, &grid, &triangles, skeleton),
        };
        Self { vertices: net.vertices, normals, triangles, weights }
    }

    fn add_to(self, mesh: &mut TriangleMesh, weights: &mut Vec<VertexWeights>) {
        let first = mesh.positions.len() as u32;
        mesh.positions.extend(self.vertices.iter().map(|at| at.as_vec3()));
        let normals = self.normals.iter().map(|normal| normal.as_vec3().normalize_or(Vec3::Y));
        mesh.normals.extend(normals);
        let triangles = self.triangles.iter();
        mesh.triangles.extend(triangles.map(|corners| corners.map(|corner| corner + first)));
        weights.extend(self.weights);
    }
}

fn weights_by_distance(
    body: &Body,
    net: &SurfaceNet,
    grid: &Grid,
    triangles: &[[u32; 3]],
    skeleton: &Skeleton,
) -> Vec<VertexWeights> {
    let field = |vertex: usize| &grid.blocks[net.blocks[vertex] as usize];
    let by_distance = Weights::new(body, skeleton);
    let at = |vertex: usize| by_distance.at(net.vertices[vertex], field(vertex).parts());
    let mut weights = grid::map_ranges(net.vertices.len(), |range| range.map(at).collect());
    weights::smooth(&mut weights, &edges(triangles));
    weights
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
