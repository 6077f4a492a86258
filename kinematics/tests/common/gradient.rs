//! Steps along a gradient, against finite differences of a cost in f64.

use glam::{DAffine3, DVec3};
use ik_arm_kinematics::chain_ik::{ChainSolver, ChainTarget, Method, SolverOptions};
use ik_arm_kinematics::skeleton::{JointId, Skeleton};

/// The angles of all joints, in radians.
pub fn angles_f64(skeleton: &Skeleton) -> Vec<DVec3> {
    skeleton.joints().iter().map(|joint| joint.rotation.as_dvec3()).collect()
}

/// From the world to skeleton space.
pub fn to_skeleton_f64(skeleton: &Skeleton) -> DAffine3 {
    let transform = skeleton.transform();
    let (matrix, translation) = (transform.matrix3.as_dmat3(), transform.translation.as_dvec3());
    DAffine3::from_mat3_translation(matrix, translation).inverse()
}

/// Asserts that the first step of the Jacobian transpose turns the joints along the negative
/// gradient of a cost, a function of the angles of all joints.
pub fn assert_first_step_descends(
    case: usize,
    skeleton: &Skeleton,
    targets: &[ChainTarget],
    joints: &[JointId],
    cost: impl Fn(&[DVec3]) -> f64,
) {
    const STEP: f64 = 1e-6;
    let before = angles_f64(skeleton);
    let mut expected = Vec::new();
    for joint in joints {
        for axis in 0..3 {
            let at = |by: f64| {
                let mut moved = before.clone();
                moved[joint.index()][axis] += by;
                cost(&moved)
            };
            expected.push(-(at(STEP) - at(-STEP)) / (2.0 * STEP));
        }
    }
    let options = SolverOptions::new(Method::Transpose);
    let mut solver = ChainSolver::new(skeleton, targets, &options).expect("a solver");
    solver.step();
    let mut posed = skeleton.clone();
    solver.write(&mut posed);
    let turned = |joint: &JointId| posed[*joint].rotation - skeleton[*joint].rotation;
    let found: Vec<f64> =
        joints.iter().flat_map(|joint| turned(joint).to_array()).map(f64::from).collect();
    let dot = |one: &[f64], other: &[f64]| -> f64 {
        one.iter().zip(other).map(|(one, other)| one * other).sum()
    };
    let lengths = (dot(&found, &found) * dot(&expected, &expected)).sqrt();
    if lengths > 0.0 {
        let along = dot(&found, &expected) / lengths;
        assert!(along > 1.0 - 1e-4, "{case}: {along}, {found:?} but {expected:?}");
    }
}
