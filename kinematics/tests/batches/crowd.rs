//! A crowd is solved by the batch solver, with and without the feature `parallel`.

use ik_arm_kinematics::batch::{
    ArmBatch, BatchBones, BatchPositions, BatchTwist, Points, PointsMut,
};
use ik_arm_kinematics::rig::{Crowd, CrowdArrays, Processor};
use ik_arm_kinematics::two_bone::TwoBone;

#[test]
fn a_crowd_is_bit_identical_to_a_batch() {
    const ARMS: u32 = 5_000;
    let bones = TwoBone::new(200.0, 300.0).expect("lengths");
    let crowd = Crowd { arms: ARMS, bones, time: 3.25, processor: Processor::Cpu };
    let mut arrays = CrowdArrays::default();
    arrays.resize(&crowd);
    arrays.set_targets(&crowd);
    arrays.solve(bones).expect("a batch");

    let [x, y, z] = &arrays.cursor;
    let twist = BatchTwist::CosSin { cos: &arrays.cos, sin: &arrays.sin };
    let arms = ArmBatch::new(BatchBones::Same(bones), Points { x, y, z }, twist).expect("a batch");
    let [mut elbow, mut hand] = [(); 2].map(|()| [(); 3].map(|()| vec![0.0; ARMS as usize]));
    let positions =
        BatchPositions { elbow: PointsMut::of(&mut elbow), hand: PointsMut::of(&mut hand) };
    arms.solve(positions, None).expect("room");

    let bits = |of: &[Vec<f32>; 3]| {
        of.each_ref().map(|all| all.iter().map(|x| x.to_bits()).collect::<Vec<_>>())
    };
    assert_eq!(bits(&arrays.elbow), bits(&elbow));
    assert_eq!(bits(&arrays.hand), bits(&hand));
    assert!(hand.iter().flatten().any(|coordinate| *coordinate != 0.0));
}
