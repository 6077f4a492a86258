use glam::{DQuat, DVec3, Vec3};

use super::elbow::{Aim, BendWay, orthonormal};

/// State of a limb from one step of a motion to the next, so that it does not jump where its
/// inputs give no direction.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CarriedLimb {
    /// The way in which the FK pose bends, or bent when it was last bent enough.
    pub(super) way: Option<BendWay>,
    /// The Pointer and the elbow at twist 0, in the space of the upper joint's parent.
    pub(super) aim: Option<Aim>,
    /// Rotations from the FK pose to the solved one of upper joint, lower joint and hand.
    pub(super) turns: [Option<DQuat>; 3],
}

impl CarriedLimb {
    /// The state in single precision: in the space of the upper joint's parent the Pointer and the
    /// elbow's direction at twist 0, then in the upper joint's space the axis about which the FK
    /// pose bends and the direction in which its elbow moves. `None` before the first step.
    pub fn to_vectors(&self) -> Option<[Vec3; 4]> {
        let (aim, way) = self.aim.zip(self.way)?;
        Some([aim.pointer, aim.outward, way.axis, way.outward].map(DVec3::as_vec3))
    }

    /// The state with the vectors of [`CarriedLimb::to_vectors`]; vectors without a direction are
    /// ignored.
    pub fn from_vectors(vectors: [Vec3; 4]) -> Self {
        let [pointer, outward, axis, bending] =
            vectors.map(|vector| vector.as_dvec3().try_normalize());
        let aim = pointer
            .zip(outward)
            .map(|(pointer, outward)| Aim { pointer, outward: orthonormal(outward, pointer) });
        let way = axis.zip(bending).map(|(axis, outward)| BendWay { axis, outward });
        Self { way, aim, turns: [None; 3] }
    }
}
