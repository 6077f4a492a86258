//! The bodies of a robot as a mesh.

use core::f64::consts::{PI, TAU};

use std::collections::HashMap;

use glam::{DAffine3, DVec3};

use super::file::{Shape, Visual};
use crate::kinematics::skeleton::JointId;
use crate::kinematics::skin::{SkinError, SkinnedMesh, TriangleMesh, VertexWeights};
use crate::rig::{FileMesh, PartLook, SkinPart};

/// Number of sides of cylinders and spheres.
const SIDES: u32 = 32;

/// Rings of a sphere from pole to pole.
const RINGS: u32 = 16;

/// The mesh of bodies on joints, which have `frames` in the skeleton's space and these parents;
/// `None` without bodies. Bodies of the same colour are one part.
pub fn mesh(
    bodies: &[(JointId, &Visual)],
    frames: &[DAffine3],
    parents: Vec<Option<JointId>>,
) -> Result<Option<FileMesh>, SkinError> {
    let mut builder = Builder::default();
    let mut parts = Vec::new();
    for bodies in of_one_colour(bodies) {
        let before = builder.mesh.triangles.len();
        for (joint, body) in &bodies {
            builder.place = frames[joint.index()] * body.origin;
            builder.joint = *joint;
            builder.add(body.shape);
            if builder.mesh.positions.len() > SkinnedMesh::MOST_VERTICES {
                break;
            }
        }
        let [red, green, blue, opacity] = bodies[0].1.colour;
        let look = PartLook { opacity: (opacity < 1.0).then_some(opacity), ..PartLook::default() };
        let white = SkinPart::white(builder.mesh.triangles.len() - before);
        parts.push(SkinPart { colour: [red, green, blue], look, ..white });
    }
    if builder.mesh.triangles.is_empty() {
        return Ok(None);
    }
    let binds = frames.iter().map(|frame| DAffine3::from_translation(-frame.translation));
    let binds = binds.map(|bind| bind.as_affine3a()).collect();
    let mesh = SkinnedMesh::new(builder.mesh, builder.weights, binds)?;
    Ok(Some(FileMesh { mesh, parents, parts }))
}

/// The bodies by colour, in the order in which the colours appear.
fn of_one_colour<'a>(bodies: &[(JointId, &'a Visual)]) -> Vec<Vec<(JointId, &'a Visual)>> {
    let mut index_of: HashMap<[u32; 4], usize> = HashMap::new();
    let mut coloured: Vec<Vec<(JointId, &Visual)>> = Vec::new();
    for body in bodies {
        let colour = body.1.colour.map(f32::to_bits);
        let index = *index_of.entry(colour).or_insert(coloured.len());
        if index == coloured.len() {
            coloured.push(Vec::new());
        }
        coloured[index].push(*body);
    }
    coloured
}

/// The point opposite to a link's origin in the box around its bodies, in the link's space; `None`
/// without bodies.
pub fn far_end(visuals: &[Visual]) -> Option<DVec3> {
    let corners = visuals.iter().flat_map(|visual| {
        let half = match visual.shape {
            Shape::Box(size) => 0.5 * size,
            Shape::Cylinder { radius, length } => DVec3::new(radius, radius, 0.5 * length),
            Shape::Sphere { radius } => DVec3::splat(radius),
        };
        let sign = |corner: u32, bit: u32| if corner >> bit & 1 == 0 { -1.0 } else { 1.0 };
        (0..8_u32).map(move |corner| {
            let signs = DVec3::new(sign(corner, 0), sign(corner, 1), sign(corner, 2));
            visual.origin.transform_point3(signs * half)
        })
    });
    let (low, high) = corners.map(|it| (it, it)).reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))?;
    Some(low + high)
}

#[derive(Default)]
struct Builder {
    mesh: TriangleMesh,
    weights: Vec<VertexWeights>,
    /// From the body's space to the skeleton's.
    place: DAffine3,
    joint: JointId,
}

impl Builder {
    fn add(&mut self, shape: Shape) {
        match shape {
            Shape::Box(size) => self.add_box(size),
            Shape::Cylinder { radius, length } => self.add_cylinder(radius, length),
            Shape::Sphere { radius } => self.add_sphere(radius),
        }
    }

    fn add_box(&mut self, size: DVec3) {
        let half = 0.5 * size;
        for axis in 0..3 {
            for sign in [-1.0, 1.0] {
                let normal = sign * DVec3::AXES[axis];
                let (u, v) = (DVec3::AXES[(axis + 1) % 3], DVec3::AXES[(axis + 2) % 3]);
                let corners = [u * -sign - v, u * sign - v, u * sign + v, u * -sign + v];
                let first = self.count();
                for corner in corners {
                    self.vertex((corner + normal) * half, normal);
                }
                self.fan(first, 4);
            }
        }
    }

    fn add_cylinder(&mut self, radius: f64, length: f64) {
        let half = 0.5 * length * DVec3::Z;
        let first = self.count();
        for side in 0..=SIDES {
            let out = direction(side);
            self.vertex(radius * out - half, out);
            self.vertex(radius * out + half, out);
        }
        for side in 0..SIDES {
            let [a, b] = [first + 2 * side, first + 2 * side + 2];
            self.mesh.triangles.extend([[a, b, b + 1], [a, b + 1, a + 1]]);
        }
        for sign in [-1.0, 1.0] {
            let first = self.count();
            for side in 0..SIDES {
                let side = if sign > 0.0 { side } else { SIDES - side };
                self.vertex(radius * direction(side) + sign * half, sign * DVec3::Z);
            }
            self.fan(first, SIDES);
        }
    }

    fn add_sphere(&mut self, radius: f64) {
        let first = self.count();
        for ring in 0..=RINGS {
            let (sin, cos) = (PI * f64::from(ring) / f64::from(RINGS)).sin_cos();
            for side in 0..=SIDES {
                let out = sin * direction(side) - cos * DVec3::Z;
                self.vertex(radius * out, out);
            }
        }
        for ring in 0..RINGS {
            for side in 0..SIDES {
                let a = first + ring * (SIDES + 1) + side;
                let above = a + SIDES + 1;
                if ring > 0 {
                    self.mesh.triangles.push([a, a + 1, above + 1]);
                }
                if ring + 1 < RINGS {
                    self.mesh.triangles.push([a, above + 1, above]);
                }
            }
        }
    }

    fn count(&self) -> u32 {
        self.mesh.positions.len() as u32
    }

    fn vertex(&mut self, point: DVec3, normal: DVec3) {
        let turn = self.place.matrix3;
        self.mesh.positions.push(self.place.transform_point3(point).as_vec3());
        self.mesh.normals.push((turn * normal).normalize_or(DVec3::Z).as_vec3());
        self.weights.push(VertexWeights::rigid(self.joint));
    }

    /// Adds the triangles of a convex polygon of the last vertices.
    fn fan(&mut self, first: u32, corners: u32) {
        self.mesh
            .triangles
            .extend((1..corners - 1).map(|next| [first, first + next, first + next + 1]));
    }
}

/// The unit vector at a side of the circle around z.
fn direction(side: u32) -> DVec3 {
    let (sin, cos) = (TAU * f64::from(side % SIDES) / f64::from(SIDES)).sin_cos();
    DVec3::new(cos, sin, 0.0)
}
