use glam::{DQuat, DVec3, Vec3};

use super::elbow::{LimbAim, orthonormal};

/// State of a limb from one step of a motion to the next, so that it does not jump where its
/// inputs give no direction.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CarriedLimb {
    /// The way in which the FK pose bends, or bent when it was last bent enough.
    pub(super) way: Option<BendWay>,
    /// The Pointer and the elbow at twist 0, in the space of the upper joint's parent.
    pub(super) aim: Option<LimbAim>,
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
            .map(|(pointer, outward)| LimbAim { pointer, outward: orthonormal(outward, pointer) });
        let way = axis.zip(bending).map(|(axis, outward)| BendWay { axis, outward });
        Self { way, aim, turns: [None; 3] }
    }
}

/// Which way a limb bends, in the upper joint's space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct BendWay {
    /// Unit axis about which a positive rotation bends the limb farther.
    pub axis: DVec3,
    /// Unit direction to which the elbow moves.
    pub outward: DVec3,
}

impl BendWay {
    /// The other way of a hinge.
    pub fn reversed(self) -> Self {
        Self { axis: -self.axis, outward: -self.outward }
    }

    /// This way turned towards another one by a fraction of the least rotations.
    pub fn towards(self, other: Self, fraction: f64) -> Self {
        let turned = |from, to| turned_towards(from, to, fraction);
        Self { axis: turned(self.axis, other.axis), outward: turned(self.outward, other.outward) }
    }
}

/// A unit vector turned towards another one by a fraction of the least rotation.
fn turned_towards(from: DVec3, to: DVec3, fraction: f64) -> DVec3 {
    if fraction >= 1.0 {
        return to;
    }
    let rotation = DQuat::from_rotation_arc(from, to);
    DQuat::IDENTITY.slerp(rotation, fraction) * from
}
