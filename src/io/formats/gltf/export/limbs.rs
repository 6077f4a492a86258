use core::f64::consts::{PI, TAU};

use glam::{DMat3, DVec3};

use super::error::GlbError;
use super::mesh::{MeshPart, RigMesh};
use super::nodes::JointNodes;
use super::rig::GltfRig;

/// The mesh in the bind pose: a cone for each bone, with balls at its ends. Each colour has its own
/// part.
#[derive(Default)]
pub struct LimbMesh {
    pub parts: [MeshPart; 2],
}

/// Ratio of the radius of a ball to the radius of the bone's end that it covers.
const BALL: f64 = 1.1;

/// Colours of the limbs in the dark theme, as sRGB components.
const COLOURS: [[u8; 3]; 2] = [[0xd8, 0x74, 0x4b], [0x64, 0x92, 0xc6]];

impl From<LimbMesh> for RigMesh {
    fn from(limbs: LimbMesh) -> Self {
        let coloured = limbs.parts.into_iter().zip(COLOURS);
        let parts = coloured.map(|(part, colour)| {
            let colour = colour.map(|component| f32::from(component) / 255.0);
            MeshPart { colour, ..part }
        });
        let parts = parts.collect();
        Self { parts, attached: Vec::new() }
    }
}

impl LimbMesh {
    pub fn new(rig: &GltfRig, bones: &JointNodes) -> Result<Self, GlbError> {
        let mut limbs = Self::default();
        let tips = bones.tips();
        for (index, (bone, placed)) in rig.bones.iter().zip(&rig.bind_pose).enumerate() {
            let part = &mut limbs.parts[bone.shade];
            let rotation = placed.frame();
            let length = placed.along.length();
            let tip = tips[index].or(bone.connected).unwrap_or(index);
            let [thick, thin] = bone.radii;
            part.add_ball(placed.base, rotation, thick * BALL, index);
            if length > 0.0 {
                part.add_cone(placed.base, rotation, length, bone.radii, [index, tip]);
                if bone.is_leaf {
                    part.add_ball(placed.base + placed.along, rotation, thin * BALL, tip);
                }
            }
            if !part.is_finite() {
                let joint = bones.nodes[index].name.clone();
                return Err(GlbError::TooFar { joint, time: None });
            }
        }
        Ok(limbs)
    }
}

impl MeshPart {
    /// Adds a tapered cylinder, open at both ends, from `base` along the y axis of `rotation`.
    fn add_cone(
        &mut self,
        base: DVec3,
        rotation: DMat3,
        length: f64,
        radii: [f64; 2],
        joints: [usize; 2],
    ) {
        const SIDES: u32 = 12;
        let first = self.first();
        let slope = (radii[0] - radii[1]) / length;
        for side in 0..SIDES {
            let (sin, cos) = (f64::from(side) / f64::from(SIDES) * TAU).sin_cos();
            let out = DVec3::new(cos, 0.0, sin);
            let normal = rotation * (out + DVec3::Y * slope).normalize();
            for (end, height) in [0.0, length].into_iter().enumerate() {
                let at = base + rotation * (out * radii[end] + DVec3::Y * height);
                self.add_vertex(at, normal, joints[end]);
            }
            let [low, next] = [2 * side, 2 * ((side + 1) % SIDES)].map(|vertex| first + vertex);
            self.indices.extend([low, low + 1, next, next, low + 1, next + 1]);
        }
    }

    /// Adds a ball whose poles are on the y axis of `rotation`.
    fn add_ball(&mut self, centre: DVec3, rotation: DMat3, radius: f64, joint: usize) {
        const SIDES: u32 = 8;
        const RINGS: u32 = 3;
        let first = self.first();
        let mut add = |height: f64, out: f64, angle: f64| {
            let normal = rotation * DVec3::new(out * angle.cos(), height, out * angle.sin());
            self.add_vertex(centre + normal * radius, normal, joint);
        };
        add(1.0, 0.0, 0.0);
        add(-1.0, 0.0, 0.0);
        for ring in 1..=RINGS {
            let (out, height) = (f64::from(ring) / f64::from(RINGS + 1) * PI).sin_cos();
            for side in 0..SIDES {
                add(height, out, f64::from(side) / f64::from(SIDES) * TAU);
            }
        }
        let at = |ring: u32, side: u32| first + 2 + ring * SIDES + side % SIDES;
        for side in 0..SIDES {
            self.indices.extend([first, at(0, side + 1), at(0, side)]);
            self.indices.extend([first + 1, at(RINGS - 1, side), at(RINGS - 1, side + 1)]);
            for ring in 1..RINGS {
                let [above, next] = [at(ring - 1, side), at(ring - 1, side + 1)];
                let [below, last] = [at(ring, side), at(ring, side + 1)];
                self.indices.extend([below, above, last, last, above, next]);
            }
        }
    }

    fn add_vertex(&mut self, at: DVec3, normal: DVec3, joint: usize) {
        self.positions.push(at.as_vec3().to_array());
        self.normals.push(normal.as_vec3().to_array());
        self.joints.push([u16::try_from(joint).unwrap_or_default(), 0, 0, 0]);
        self.weights.push([1.0, 0.0, 0.0, 0.0]);
    }

    /// Index of the vertex that is added next.
    fn first(&self) -> u32 {
        u32::try_from(self.positions.len()).unwrap_or_default()
    }

    /// Returns whether the vertices of the most recently added bone are finite.
    fn is_finite(&self) -> bool {
        const MAX_VERTICES_OF_BONE: usize = 76;
        let last = self.positions.iter().rev().take(MAX_VERTICES_OF_BONE);
        last.flatten().all(|number| number.is_finite())
    }
}
