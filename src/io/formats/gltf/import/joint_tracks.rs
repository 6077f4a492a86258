use glam::{Mat3, Vec3};

use crate::kinematics::spline::{Knot, Spline};

/// The keys of a joint; a spline without knots if the value is constant.
#[derive(Clone, Debug, Default)]
pub struct JointTracks {
    /// Angles about x, y and z in radians.
    pub rotation: Spline<Vec3>,
    pub offset: Spline<Vec3>,
    /// The frame of the angles relative to the node; `None` for the node's axes.
    pub frame: Option<Mat3>,
}

/// Changes below this count as rounding errors: in radians for an angle, relative to its length for
/// an offset.
const LEAST: f32 = 1e-6;

impl JointTracks {
    /// Whether the joint turns.
    pub fn turns(&self) -> bool {
        changes(&self.rotation, |_| 2.0 * LEAST)
    }

    /// Whether the joint's offset changes. `size` is the length of the skeleton's longest offset.
    pub fn moves(&self, size: f32) -> bool {
        changes(&self.offset, |first| LEAST * first.length().max(1e-3 * size))
    }
}

/// Whether a value changes by more than `least` of its first key, or a slope leads away from it.
fn changes(track: &Spline<Vec3>, least: impl Fn(Vec3) -> f32) -> bool {
    let Some(first) = track.knots().first().map(|knot| knot.value) else { return false };
    let least = least(first);
    let leads_away = |knot: &Knot<Vec3>| {
        let slopes = knot.slopes.iter().flat_map(|it| [it.arriving, it.leaving]);
        track.knots().len() > 1 && slopes.into_iter().any(|slope| slope.length() > least)
    };
    track.knots().iter().any(|knot| knot.value.distance(first) > least || leads_away(knot))
}
