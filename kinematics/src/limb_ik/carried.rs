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
    /// Angles of the hand that a target turns, as solved: the next ones are the nearest to these,
    /// whole turns included.
    pub(super) hand: Option<Vec3>,
    /// Angle by which the limits of the upper joint have turned the elbow aside.
    pub(super) aside: f64,
    /// Rotations from the FK pose to the solved one of upper joint, lower joint and hand.
    pub(super) turns: [Option<DQuat>; 3],
}

/// [`CarriedLimb`] as a document keeps it: the state with which a motion begins. Vectors have any
/// length but 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LimbPosture {
    /// From the limb's base to its target, in the space of the upper joint's parent.
    pub pointer: Vec3,
    /// Towards the elbow at twist 0, in the space of the upper joint's parent.
    pub elbow: Vec3,
    /// Axis about which the limb bends, in the upper joint's space.
    pub bend_axis: Vec3,
    /// Direction in which the elbow moves when the limb bends, in the upper joint's space.
    pub bend: Vec3,
    /// Euler angles in radians of the hand, whole turns included; `None` for a hand that no target
    /// turns.
    pub hand: Option<Vec3>,
}

impl LimbPosture {
    /// True if all numbers are finite.
    pub fn is_finite(&self) -> bool {
        let vectors = [self.pointer, self.elbow, self.bend_axis, self.bend];
        vectors.into_iter().chain(self.hand).all(Vec3::is_finite)
    }
}

impl CarriedLimb {
    /// The state in single precision; `None` before the first step.
    pub fn to_posture(&self) -> Option<LimbPosture> {
        let (aim, way) = self.aim.zip(self.way)?;
        let [pointer, elbow, bend_axis, bend] =
            [aim.pointer, aim.outward, way.axis, way.outward].map(DVec3::as_vec3);
        Some(LimbPosture { pointer, elbow, bend_axis, bend, hand: self.hand })
    }

    /// The state of a posture; vectors without a direction are ignored.
    pub fn from_posture(posture: &LimbPosture) -> Self {
        let LimbPosture { pointer, elbow, bend_axis, bend, hand } = *posture;
        let [pointer, outward, axis, bending] =
            [pointer, elbow, bend_axis, bend].map(|vector| vector.as_dvec3().try_normalize());
        let aim = pointer
            .zip(outward)
            .map(|(pointer, outward)| LimbAim { pointer, outward: orthonormal(outward, pointer) });
        let way = axis.zip(bending).map(|(axis, outward)| BendWay { axis, outward });
        Self { way, aim, hand, aside: 0.0, turns: [None; 3] }
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
