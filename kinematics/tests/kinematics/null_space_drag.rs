//! Drags in the null space: held targets stay, and the point comes as near as it can.

use glam::{Affine3A, DVec3, Vec3};
use ik_arm_kinematics::chain_ik::{ChainTarget, NullSpaceDrag, Orientation, Root};
use ik_arm_kinematics::skeleton::{JointId, JointLimits, Limit, Skeleton};

use crate::common::Random;
use crate::common::skeletons::{chain, grip, length, shake, transform, tree};

/// The point of the circle of elbows of two bones that is nearest to a place.
fn nearest_on_circle(base: DVec3, elbow: DVec3, hand: DVec3, place: DVec3) -> DVec3 {
    let pointer = (hand - base).normalize();
    let centre = base + pointer * (elbow - base).dot(pointer);
    let out = (place - centre).reject_from_normalized(pointer).normalize();
    centre + out * (elbow - centre).length()
}

#[test]
fn the_middle_of_two_bones_goes_around_the_circle_of_elbows() {
    let mut random = Random(401);
    for case in 0..500 {
        let mut skeleton = chain(&mut random, 2, 1.0);
        shake(&mut random, &mut skeleton);
        let [upper, lower] = [1, 2].map(JointId::new);
        let hand = ChainTarget::at(lower, skeleton.tip(lower));
        let points = [skeleton.base(upper), skeleton.tip(upper), hand.point].map(Vec3::as_dvec3);
        let [base, elbow, tip] = points;
        let place = skeleton.tip(upper) + random.vector(2.0);
        let out = (place.as_dvec3() - base).reject_from((tip - base).normalize()).length();
        if (elbow - base).reject_from((tip - base).normalize()).length() < 0.1 || out < 0.2 {
            continue;
        }
        let dragged = ChainTarget::at(upper, place);
        let mut drag =
            NullSpaceDrag::new(&skeleton, &[hand], dragged, Root::Turns).expect("a drag");
        let report = drag.run();
        drag.write(&mut skeleton);
        let reach = f64::from(length(&skeleton, &[lower]));
        let expected = nearest_on_circle(base, elbow, tip, place.as_dvec3());
        let off = skeleton.tip(upper).as_dvec3().distance(expected);
        assert!(off < 1e-5 * reach, "case {case}: off by {off}, {report:?}");
        let held = skeleton.tip(lower).as_dvec3().distance(tip);
        assert!(held < 1e-5 * reach, "case {case}: the hand is off by {held}");
    }
}

#[test]
fn the_elbow_of_an_arm_can_go_along_the_tangent_of_its_circle_alone() {
    let mut random = Random(402);
    for case in 0..100 {
        let mut skeleton = chain(&mut random, 2, 1.0);
        shake(&mut random, &mut skeleton);
        let [upper, lower] = [1, 2].map(JointId::new);
        let hand = ChainTarget::at(lower, skeleton.tip(lower));
        let elbow = ChainTarget::at(upper, skeleton.tip(upper));
        let drag = NullSpaceDrag::new(&skeleton, &[hand], elbow, Root::Turns).expect("a drag");
        let freedom = drag.freedom();
        let pointer = (hand.point - skeleton.base(upper)).normalize();
        let tangent = pointer.cross(skeleton.tip(upper) - skeleton.base(upper));
        if tangent.length() < 0.1 {
            continue;
        }
        assert_eq!(freedom.values[1..], [0.0; 2], "case {case}");
        assert!(freedom.values[0] > 0.0, "case {case}");
        let along = freedom.axes[0].dot(tangent.normalize()).abs();
        assert!(along > 1.0 - 1e-4, "case {case}: {along}");
        assert!(freedom.centre.distance(skeleton.tip(upper)) < 1e-5);
    }
}

/// A chain of ten joints in a random pose, with limits or without, under any transform; the target
/// of its tip asks for a rotation or for none.
fn ten_joints(random: &mut Random, case: usize) -> (Skeleton, ChainTarget) {
    let mut skeleton = chain(random, 10, 1.0);
    if case % 2 == 1 {
        for joint in skeleton.ids() {
            let limits = JointLimits::new([Some(Limit { min: -1.5, max: 1.5 }); 3]);
            skeleton.change(joint, |joint| joint.limits = limits).expect("limits");
        }
    }
    skeleton.set_transform(transform(random)).expect("a transform");
    shake(random, &mut skeleton);
    let tip = JointId::new(10);
    let target = ChainTarget::at(tip, skeleton.tip(tip));
    let rotation = skeleton.rotation_from_world(skeleton.rotation_in_world(tip)).as_quat();
    let turned = target.with_orientation(Orientation::Rotation(rotation));
    (skeleton, if case.is_multiple_of(3) { turned } else { target })
}

#[test]
fn targets_stay_within_their_tolerance_at_every_pixel_of_a_hundred_drags() {
    let mut random = Random(403);
    for case in 0..100 {
        let (skeleton, held) = ten_joints(&mut random, case);
        let scale = skeleton.transform().matrix3.determinant().abs().cbrt();
        let reach = scale * length(&skeleton, &[held.joint]);
        let joint = JointId::new(1 + random.below(8));
        let from = skeleton.tip(joint);
        let way = random.direction() * reach * random.within(0.1..0.6);
        let mut nearest = Vec::new();
        for pixel in 0..=20 {
            let place = from + way * (pixel as f32 / 20.0);
            let dragged = ChainTarget::at(joint, place);
            let mut drag =
                NullSpaceDrag::new(&skeleton, &[held], dragged, Root::Turns).expect("a drag");
            let report = drag.run();
            let mut posed = skeleton.clone();
            drag.write(&mut posed);
            let missed = posed.tip(held.joint).distance(held.point);
            assert!(missed < 1e-4 * reach, "case {case}, pixel {pixel}: {missed}, {report:?}");
            if let Some(Orientation::Rotation(wanted)) = held.orientation {
                let turned = posed.rotation_from_world(posed.rotation_in_world(held.joint));
                let angle = turned.angle_between(wanted.as_dquat());
                assert!(angle.min(std::f64::consts::TAU - angle) < 1e-3, "case {case}: {angle}");
            }
            assert!(posed.joints().iter().all(|it| it.limits.contains(it.rotation)), "case {case}");
            nearest.push(report.distance / reach);
        }
        assert!(nearest[0] < 1e-5, "case {case}: {}", nearest[0]);
    }
}

#[test]
fn a_point_comes_as_near_as_the_held_targets_allow() {
    // Without limits, what is left of the way has no part along a direction in which it can go.
    let mut random = Random(404);
    let mut worst = 0.0_f32;
    for case in (0..100).map(|case| 2 * case) {
        let (mut skeleton, mut held) = ten_joints(&mut random, case);
        // Distances are compared in skeleton space.
        skeleton.set_transform(Affine3A::IDENTITY).expect("a transform");
        held.point = skeleton.tip(held.joint);
        let joint = JointId::new(1 + random.below(9));
        let reach = length(&skeleton, &[held.joint]);
        let place = skeleton.tip(joint) + random.direction() * reach;
        let dragged = ChainTarget::at(joint, place);
        let mut drag =
            NullSpaceDrag::new(&skeleton, &[held], dragged, Root::Turns).expect("a drag");
        let report = drag.run();
        let freedom = drag.freedom();
        drag.write(&mut skeleton);
        let left = (place - skeleton.tip(joint)).normalize_or_zero();
        let slope = freedom.axes.iter().zip(freedom.values);
        let slope =
            slope.map(|(axis, value)| (axis.dot(left) * value / reach).powi(2)).sum::<f32>();
        if report.distance > 1e-3 * reach {
            worst = worst.max(slope.sqrt());
        }
        assert!(
            slope.sqrt() < 0.02 || report.distance < 1e-3 * reach,
            "case {case}: {slope} {report:?}"
        );
    }
    assert!(worst > 0.0, "some places are out of reach");
}

#[test]
fn without_held_targets_the_point_is_where_it_is_dragged() {
    let mut random = Random(405);
    for case in 0..100 {
        let mut skeleton = chain(&mut random, 6, 1.0);
        shake(&mut random, &mut skeleton);
        let mut posed = skeleton.clone();
        shake(&mut random, &mut posed);
        let joint = JointId::new(2 + random.below(5));
        let grip = random.vector(0.3);
        let place = posed.point_in_world(joint, grip);
        let dragged = ChainTarget::at(joint, place).with_grip(grip);
        let mut drag = NullSpaceDrag::new(&skeleton, &[], dragged, Root::Turns).expect("a drag");
        drag.run();
        drag.write(&mut skeleton);
        let off = skeleton.point_in_world(joint, grip).distance(place);
        assert!(off < 1e-3, "case {case}: {off}");
    }
}

#[test]
fn a_trunk_goes_as_far_as_its_branches_let_it() {
    // The base of each branch may be at most a bone's length from a fixed point.
    let mut random = Random(406);
    for case in 0..100 {
        let (skeleton, _) = tree(&mut random, 1, 1.0);
        let trunk = JointId::new(2);
        let grips = [(); 2].map(|()| random.vector(0.4));
        let held = grips.map(|grip| {
            let at = skeleton.point_in_world(trunk, grip) + random.direction() * 0.9;
            ChainTarget::at(trunk, at).with_grip(grip).with_distances(0.2, 1.0)
        });
        let place = skeleton.tip(trunk) + random.direction() * random.within(0.1..3.0);
        let dragged = ChainTarget::at(trunk, place);
        let mut drag = NullSpaceDrag::new(&skeleton, &held, dragged, Root::Free).expect("a drag");
        let report = drag.run();
        let mut posed = skeleton.clone();
        drag.write(&mut posed);
        for target in held {
            let at = posed.point_in_world(trunk, grip(&target));
            let distance = at.distance(target.point);
            assert!((0.2 - 1e-4..1.0 + 1e-4).contains(&distance), "case {case}: {distance}");
        }
        let before = skeleton.tip(trunk).distance(place);
        assert!(report.distance < before - 1e-3, "case {case}: {report:?}, was {before}");
    }
}

#[test]
fn an_aim_without_a_place_leaves_the_tip_of_its_joint_free_to_be_dragged() {
    let mut random = Random(64);
    let mut far = 0;
    for case in 0..40 {
        let mut skeleton = chain(&mut random, 6, 1.0);
        shake(&mut random, &mut skeleton);
        let tip = JointId::new(6);
        let axis = random.direction();
        let pose = skeleton.full_transform(tip);
        let point = skeleton.base(tip) + 2.0 * pose.transform_vector3(axis).normalize();
        let aim = ChainTarget::turned(tip, Orientation::Aim { axis, point });
        let place = skeleton.tip(tip) + random.direction() * 0.05 * length(&skeleton, &[tip]);
        let grip = skeleton[tip].axis;
        let dragged = ChainTarget::at(tip, place).with_grip(grip);
        let mut drag = NullSpaceDrag::new(&skeleton, &[aim], dragged, Root::Turns).expect("a drag");
        let report = drag.run();
        let mut posed = skeleton.clone();
        drag.write(&mut posed);
        let way = point - posed.base(tip);
        let turned = posed.full_transform(tip).transform_vector3(axis);
        assert!(turned.angle_between(way) < 1e-3, "{case}: {}", turned.angle_between(way));
        far += usize::from(report.distance > 1e-3 * length(&skeleton, &[tip]));
    }
    assert!(far <= 6, "{far} of 40 do not come there");
}
