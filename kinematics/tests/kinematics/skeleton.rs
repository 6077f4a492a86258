//! Forward kinematics against an f64 twin, and building.

use std::f32::consts::FRAC_PI_2;

use glam::{Affine3A, DMat3, DMat4, DVec3, Mat3, Vec3};
use ik_arm_kinematics::skeleton::{
    Joint, JointField, JointId, JointLimits, Limit, RotationAxis, Skeleton, SkeletonError,
};

use crate::common::Random;
use crate::common::skeletons::{forest, limit, transform};

/// T(offset) · A R_z R_y R_x Aᵀ of every joint from the root down, the transform in front, in f64;
/// the last R left out for the transform to the base.
fn twin(skeleton: &Skeleton, joint: JointId, is_turned: bool, to_base: bool) -> DMat4 {
    let Joint { parent, offset, rotation, frame, .. } = &skeleton[joint];
    let above = parent.map_or_else(
        || world(skeleton.transform()),
        |parent| twin(skeleton, parent, is_turned, false),
    );
    let at_base = above * DMat4::from_translation(offset.as_dvec3());
    if to_base || !is_turned {
        return at_base;
    }
    let DVec3 { x, y, z } = rotation.as_dvec3();
    let turned = DMat3::from_rotation_z(z) * DMat3::from_rotation_y(y) * DMat3::from_rotation_x(x);
    at_base * DMat4::from_mat3(frame.as_dmat3() * turned * frame.as_dmat3().transpose())
}

fn world(transform: Affine3A) -> DMat4 {
    let translation = DMat4::from_translation(transform.translation.as_dvec3());
    translation * DMat4::from_mat3(transform.matrix3.as_dmat3())
}

/// Within rounding of f32, far from the origin and for scales up to ten.
fn is_near(point: Vec3, expected: DVec3) -> bool {
    point.as_dvec3().distance(expected) <= 1e-5 * (10.0 + expected.length())
}

#[test]
fn forward_kinematics_is_the_product_of_matrices() {
    let mut random = Random(1);
    for _ in 0..300 {
        let mut skeleton = forest(&mut random, 15);
        skeleton.set_transform(transform(&mut random)).expect("transform");
        let (pose, bind) = (skeleton.pose(), skeleton.bind_pose());
        for (index, joint) in skeleton.joints().iter().enumerate() {
            let axis = joint.axis.as_dvec3();
            let full = twin(&skeleton, JointId::new(index), true, false);
            assert!(is_near(
                skeleton.base(JointId::new(index)),
                full.transform_point3(DVec3::ZERO)
            ));
            assert!(is_near(skeleton.tip(JointId::new(index)), full.transform_point3(axis)));
            assert!(is_near(pose.base(JointId::new(index)), full.transform_point3(DVec3::ZERO)));
            assert!(is_near(pose.tip(JointId::new(index)), full.transform_point3(axis)));
            for unit in [Vec3::X, Vec3::Y, Vec3::Z] {
                let point = skeleton.full_transform(JointId::new(index)).transform_point3(unit);
                assert!(is_near(point, full.transform_point3(unit.as_dvec3())));
                let to_base = twin(&skeleton, JointId::new(index), true, true);
                let point = skeleton.transform_to_base(JointId::new(index)).transform_point3(unit);
                assert!(is_near(point, to_base.transform_point3(unit.as_dvec3())));
            }
            let bound = twin(&skeleton, JointId::new(index), false, false);
            assert!(is_near(bind.tip(JointId::new(index)), bound.transform_point3(axis)));
        }
    }
}

#[test]
fn turning_a_joint_moves_its_subtree_and_nothing_else() {
    let mut random = Random(2);
    for _ in 0..300 {
        let mut skeleton = forest(&mut random, 12);
        let turned = JointId::new(random.below(12));
        let before = skeleton.pose();
        skeleton.change(turned, |joint| joint.limits = JointLimits::NONE).expect("joint");
        let angles = skeleton[turned].rotation + Vec3::new(0.3, -0.4, 0.5);
        skeleton.set_rotation(turned, angles).expect("angles");
        let after = skeleton.pose();
        assert_eq!(before.base(turned), after.base(turned), "its own base");
        for joint in skeleton.ids() {
            if skeleton.is_in_subtree(joint, turned) {
                assert_ne!(before.full(joint), after.full(joint));
            } else {
                assert_eq!(before.full(joint), after.full(joint));
                assert_eq!(before.tip(joint), after.tip(joint));
            }
        }
    }
}

#[test]
fn each_joint_of_a_chain_of_three_moves_itself_and_those_after_it() {
    let mut skeleton = Skeleton::default();
    for (index, offset) in [Vec3::new(1.0, 2.0, 0.0), Vec3::Y, Vec3::Y].into_iter().enumerate() {
        let joint =
            Joint::new(&format!("c{index}"), index.checked_sub(1).map(JointId::new), Vec3::Y);
        skeleton.add(Joint { offset, ..joint }).expect("joint");
    }
    let quarter = Vec3::Z * FRAC_PI_2;
    let tips_after = |turned: &[usize]| {
        let mut posed = skeleton.clone();
        turned
            .iter()
            .for_each(|joint| posed.set_rotation(JointId::new(*joint), quarter).expect("angles"));
        [0, 1, 2].map(|joint| posed.tip(JointId::new(joint)))
    };
    let is_at = |tips: [Vec3; 3], expected: [[f32; 2]; 3]| {
        for (tip, [x, y]) in tips.into_iter().zip(expected) {
            assert!(tip.distance(Vec3::new(x, y, 0.0)) < 1e-6, "{tip}, not {x}, {y}");
        }
    };
    is_at(tips_after(&[]), [[1.0, 3.0], [1.0, 4.0], [1.0, 5.0]]);
    is_at(tips_after(&[0]), [[0.0, 2.0], [-1.0, 2.0], [-2.0, 2.0]]);
    is_at(tips_after(&[1]), [[1.0, 3.0], [0.0, 3.0], [-1.0, 3.0]]);
    is_at(tips_after(&[2]), [[1.0, 3.0], [1.0, 4.0], [0.0, 4.0]]);
    is_at(tips_after(&[0, 1]), [[0.0, 2.0], [0.0, 1.0], [0.0, 0.0]]);
}

#[test]
fn x_is_the_first_rotation_in_the_joints_own_frame() {
    let mut skeleton = Skeleton::default();
    // The frame's x is the bone's y, its y the bone's z, its z the bone's x.
    let frame = Mat3::from_cols(Vec3::Y, Vec3::Z, Vec3::X);
    skeleton.add(Joint { frame, ..Joint::new("only", None, Vec3::X) }).expect("joint");
    skeleton.set_rotation(JointId::new(0), Vec3::new(FRAC_PI_2, 0.0, FRAC_PI_2)).expect("angles");
    // About y: x goes to −z; about x: −z goes to y.
    assert!(
        skeleton.tip(JointId::new(0)).distance(Vec3::Y) < 1e-6,
        "{}",
        skeleton.tip(JointId::new(0))
    );
}

/// Parents before children, names that differ, numbers, angles within limits.
fn assert_is_one(skeleton: &Skeleton) {
    let joints = skeleton.iter().map(|(_, joint)| joint.clone()).collect();
    let again = Skeleton::from_joints(joints).expect("a skeleton");
    assert_eq!(again.joints(), skeleton.joints());
    for (id, joint) in skeleton.iter() {
        assert!(joint.parent.is_none_or(|parent| parent < id));
        assert_eq!(joint.limits.project(joint.rotation), joint.rotation);
        assert_eq!(skeleton.find(&joint.name), Some(id));
        let children: Vec<_> = skeleton.children(id).collect();
        assert!(children.iter().all(|child| skeleton[*child].parent == Some(id)));
    }
}

#[test]
fn random_edits_leave_a_valid_skeleton() {
    let mut random = Random(4);
    for _ in 0..40 {
        let mut skeleton = forest(&mut random, 6);
        for _ in 0..60 {
            let before = skeleton.clone();
            if !any_change(&mut random, &mut skeleton) {
                assert_eq!(skeleton, before, "refused, and yet changed");
            }
            assert_is_one(&skeleton);
        }
    }
}

/// Makes a random edit. Returns whether it was accepted.
fn any_change(random: &mut Random, skeleton: &mut Skeleton) -> bool {
    // Often a joint that is not there, or a name that is.
    let joint = JointId::new(random.below(skeleton.joints().len() + 2));
    let parent = random.chance(0.8).then(|| random.below(skeleton.joints().len() + 2).into());
    let name = format!("j{}", random.below(30));
    match random.below(7) {
        0 | 1 => skeleton.add(Joint::new(&name, parent, random.vector(1.0))).is_ok(),
        2 => skeleton.rename(joint, &name).is_ok(),
        3 => skeleton.set_rotation(joint, random.angles()).is_ok(),
        4 => {
            let limits = [(); 3].map(|()| random.chance(0.5).then(|| limit(random)));
            skeleton.change(joint, |joint| joint.limits = limits.into()).is_ok()
        }
        5 if random.chance(0.3) => {
            let count = skeleton.joints().len();
            let falling: Vec<_> =
                skeleton.ids().filter(|other| skeleton.is_in_subtree(*other, joint)).collect();
            let names: Vec<_> = skeleton.joints().iter().map(|joint| joint.name.clone()).collect();
            let Ok(moved) = skeleton.remove(&[joint]) else {
                assert!(joint.index() >= count);
                return false;
            };
            assert_eq!(skeleton.joints().len() + falling.len(), count);
            for (old, name) in (0..).map(JointId::new).zip(&names) {
                assert_eq!(moved.get(old).is_none(), falling.contains(&old));
                assert_eq!(moved.get(old), skeleton.find(name));
            }
            !falling.is_empty()
        }
        _ => reparent(skeleton, joint, parent),
    }
}

/// Reparents, and checks that all joints stay except the subtree of a joint with limits.
fn reparent(skeleton: &mut Skeleton, joint: JointId, parent: Option<JointId>) -> bool {
    let before = skeleton.clone();
    let Ok(moved) = skeleton.reparent(joint, parent) else { return false };
    let now = moved.get(joint).expect("it is still there");
    assert_eq!(skeleton.joints()[now.index()].parent, parent.and_then(|parent| moved.get(parent)));
    for old in before.ids() {
        let new = moved.get(old).expect("all are still there");
        if before.joints()[joint.index()].limits.is_limited() && before.is_in_subtree(old, joint) {
            continue;
        }
        let (here, there) = (before.tip(old), skeleton.tip(new));
        assert!(here.distance(there) <= 1e-4 * (1.0 + here.length()), "{here} went to {there}");
    }
    true
}

#[test]
fn children_on_a_tip_stay_on_it_when_the_bone_changes() {
    let mut skeleton = Skeleton::with_root("root");
    skeleton.add(Joint::new("bone", Some(JointId::new(0)), Vec3::Y)).expect("bone");
    for (name, offset) in [("on", Vec3::Y), ("beside", Vec3::X)] {
        skeleton
            .add(Joint { offset, ..Joint::new(name, Some(JointId::new(1)), Vec3::Y) })
            .expect("child");
    }
    skeleton.set_axis(JointId::new(1), Vec3::Z * 2.0).expect("axis");
    assert_eq!([2, 3].map(|joint| skeleton.joints()[joint].offset), [Vec3::Z * 2.0, Vec3::X]);
}

#[test]
fn invalid_joints_are_refused() {
    let root = || Joint::new("root", None, Vec3::Y);
    let one = Skeleton::from_joints(vec![root()]).expect("one joint");
    let added = |joint: Joint| one.clone().add(joint).expect_err("refused");
    let child = || Joint::new("child", Some(JointId::new(0)), Vec3::Y);

    let [first, second, absent] = [0, 1, 3].map(JointId::new);
    assert_eq!(one.clone().set_rotation(second, Vec3::ZERO), Err(SkeletonError::NoJoint(second)));
    assert_eq!(one.clone().remove(&[first, absent]), Err(SkeletonError::NoJoint(absent)));
    assert_eq!(one.clone().dissolve(&[first, absent]), Err(SkeletonError::NoJoint(absent)));
    assert_eq!(one.clone().rename(second, "x"), Err(SkeletonError::NoJoint(second)));
    assert_eq!(one.clone().reparent(first, Some(absent)), Err(SkeletonError::NoJoint(absent)));
    assert_eq!(
        one.clone().reparent(first, Some(first)),
        Err(SkeletonError::Cycle { joint: first, parent: first })
    );
    assert_eq!(
        added(Joint { parent: Some(second), ..child() }),
        SkeletonError::Parent { joint: second, parent: second }
    );
    assert_eq!(added(Joint { name: " ".into(), ..child() }), SkeletonError::NoName);
    assert_eq!(
        added(Joint::new("root", Some(JointId::new(0)), Vec3::Y)),
        SkeletonError::Name("root".into())
    );
    assert_eq!(
        Skeleton::from_joints(vec![root(), root()]),
        Err(SkeletonError::Name("root".into()))
    );
    let value = Vec3::new(0.0, f32::INFINITY, 0.0);
    for (field, joint) in [
        (JointField::Offset, Joint { offset: value, ..child() }),
        (JointField::Axis, Joint { axis: value, ..child() }),
        (JointField::Rotation, Joint { rotation: value, ..child() }),
    ] {
        assert_eq!(added(joint), SkeletonError::NotFinite { joint: second, field, value });
    }
    assert_eq!(
        added(Joint { radius: -1.0, ..child() }),
        SkeletonError::Radius { joint: second, value: -1.0 }
    );
    for frame in [Mat3::ZERO, -Mat3::IDENTITY, Mat3::from_diagonal(Vec3::splat(1.001))] {
        assert_eq!(added(Joint { frame, ..child() }), SkeletonError::Frame { joint: second });
    }
    let limit = Limit { min: 1.0, max: 0.5 };
    assert_eq!(
        added(Joint { limits: [None, Some(limit), None].into(), ..child() }),
        SkeletonError::Limit { joint: second, axis: RotationAxis::Y, min: 1.0, max: 0.5 }
    );
    let flat = Affine3A::from_translation(value);
    assert_eq!(one.clone().set_transform(flat), Err(SkeletonError::Transform));
    let many = (0..=Skeleton::MOST_JOINTS).map(|index| Joint { name: index.to_string(), ..root() });
    assert_eq!(Skeleton::from_joints(many.collect()), Err(SkeletonError::TooMany));
}

#[cfg(feature = "serde")]
#[test]
fn skeletons_round_trip_through_serde_and_invalid_ones_are_refused() {
    let mut skeleton = Skeleton::with_root("root");
    let limits = [Some(Limit { min: -1.0, max: 0.5 }), None, None];
    let child =
        Joint { limits: limits.into(), ..Joint::new("child", Some(JointId::new(0)), Vec3::Y) };
    skeleton.add(child).expect("a joint");
    let json = serde_json::to_string(&skeleton).expect("finite numbers");
    assert_eq!(serde_json::from_str::<Skeleton>(&json).expect("the same"), skeleton);

    let invalid = json.replace("\"parent\":0", "\"parent\":1");
    let error = serde_json::from_str::<Skeleton>(&invalid).expect_err("its own parent");
    assert!(error.to_string().contains("must precede it"), "{error}");
}
