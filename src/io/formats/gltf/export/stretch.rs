//! Nodes that stretch the skin of a joint.
//!
//! A node can turn and scale along its axes, but not shear. So a node below the joint's has the
//! frame of the joint and its scale. With shear, the matrix M of the stretch is U·Λ·Vᵀ with rotations
//! U and V and scales Λ; one node turns by U and scales by Λ, and one below it turns by Vᵀ.

use glam::{DMat3, DVec3};

use crate::document::{Channel, Document};
use crate::kinematics::skeleton::{JointId, SkinStretch};

/// How a joint of a document stretches the skin, over all times.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum StretchKind {
    Scale,
    Shear,
}

impl StretchKind {
    /// `None` for a joint that leaves the skin as it is.
    pub fn of(document: &Document, joint: JointId) -> Option<Self> {
        let SkinStretch { scale, shear } = document.skeleton().joint(joint)?.skin;
        let differs = |channel, is_none: bool| !is_none || document.keys.has(channel);
        if differs(Channel::SkinShear(joint), shear == SkinStretch::NONE.shear) {
            return Some(Self::Shear);
        }
        let scales = differs(Channel::SkinScale(joint), scale == SkinStretch::NONE.scale);
        scales.then_some(Self::Scale)
    }
}

/// A stretch as U·Λ·Vᵀ.
#[derive(Clone, Copy)]
pub struct StretchParts {
    /// U.
    pub turn: DMat3,
    /// Λ.
    pub scale: DVec3,
    /// V.
    pub axes: DMat3,
}

impl StretchParts {
    pub const NONE: Self = Self { turn: DMat3::IDENTITY, scale: DVec3::ONE, axes: DMat3::IDENTITY };

    /// The parts of a stretch. V is as near as it can be to `near`, that of the frame before, so that
    /// it turns steadily.
    pub fn new(stretch: SkinStretch, kind: StretchKind, near: DMat3) -> Self {
        if kind == StretchKind::Scale {
            return Self { scale: stretch.scale.as_dvec3(), ..Self::NONE };
        }
        let matrix = stretch.matrix().as_dmat3();
        let axes = eigenvectors(matrix.transpose() * matrix, near);
        let columns = matrix * axes;
        let length = |axis: &usize| columns.col(*axis).length();
        let shortest = (0..3).min_by(|a, b| length(a).total_cmp(&length(b))).unwrap_or_default();
        let (first, second) = ((shortest + 1) % 3, (shortest + 2) % 3);
        let longest = if length(&first) < length(&second) { second } else { first };
        let middle = 3 - longest - shortest;
        // Flat stretches have a rotation, too: columns without length get a direction.
        let mut turn = DMat3::IDENTITY;
        *turn.col_mut(longest) = columns.col(longest).normalize_or(DVec3::X);
        let across = columns.col(middle).reject_from_normalized(turn.col(longest));
        *turn.col_mut(middle) = across.normalize_or(turn.col(longest).any_orthonormal_vector());
        *turn.col_mut(shortest) = turn.col(first).cross(turn.col(second));
        let scale = [0, 1, 2].map(|axis| turn.col(axis).dot(columns.col(axis)));
        Self { turn, scale: scale.into(), axes }
    }
}

/// The unit eigenvectors of a symmetric matrix as a rotation, by Jacobi's method, which turns `near`
/// no farther than it has to.
fn eigenvectors(matrix: DMat3, near: DMat3) -> DMat3 {
    const SWEEPS: usize = 10;
    const ROUNDING: f64 = 1e-15;
    let mut axes = near;
    for _ in 0..SWEEPS {
        for axis in 0..3 {
            let (p, q) = ((axis + 1) % 3, (axis + 2) % 3);
            let seen = axes.transpose() * matrix * axes;
            let (across, [of_p, of_q]) = (seen.col(p)[q], [seen.col(p)[p], seen.col(q)[q]]);
            if across.abs() > ROUNDING * (of_p + of_q) {
                let angle = 0.5 * (2.0 * across / (of_p - of_q)).atan();
                axes *= DMat3::from_axis_angle(DVec3::AXES[axis], angle);
            }
        }
    }
    axes
}

#[cfg(test)]
mod tests {
    use glam::{DQuat, Vec3};

    use super::*;

    fn random(state: &mut u64) -> f32 {
        *state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (*state >> 40) as f32 / (1 << 23) as f32 - 1.0
    }

    #[test]
    fn parts_give_the_stretch_and_turn_steadily() {
        let state = &mut 7;
        let vector = |state: &mut u64| Vec3::from_array([(); 3].map(|()| random(state)));
        for case in 0..200 {
            let is_flat = |every: usize| f32::from(u8::from(case % every != 0));
            let [from, to] = [(); 2].map(|()| SkinStretch {
                scale: (Vec3::ONE + 0.9 * vector(state)) * Vec3::new(1.0, is_flat(20), is_flat(10)),
                shear: 0.8 * vector(state),
            });
            let mut near = StretchParts::NONE;
            for step in 0..=100 {
                let part = step as f32 / 100.0;
                let stretch = SkinStretch {
                    scale: from.scale.lerp(to.scale, part),
                    shear: from.shear.lerp(to.shear, part),
                };
                let parts = StretchParts::new(stretch, StretchKind::Shear, near.axes);
                let product =
                    parts.turn * DMat3::from_diagonal(parts.scale) * parts.axes.transpose();
                let expected = stretch.matrix().as_dmat3();
                assert!(product.abs_diff_eq(expected, 1e-6), "{case}: {product} {expected}");
                for rotation in [parts.turn, parts.axes] {
                    assert!((rotation.determinant() - 1.0).abs() < 1e-9);
                    assert!((rotation.transpose() * rotation).abs_diff_eq(DMat3::IDENTITY, 1e-9));
                }
                let turned = DQuat::from_mat3(&(near.axes.transpose() * parts.axes));
                let limit = if step == 0 { 4.0 } else { 0.9 };
                assert!(turned.to_axis_angle().1 < limit, "{case}: {}", turned.to_axis_angle().1);
                near = parts;
            }
        }
    }
}
