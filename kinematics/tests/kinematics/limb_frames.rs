//! The hierarchy agrees with the solver, in the world.

use glam::{Affine3A, DMat3, DVec3, Mat4, Vec3};
use ik_arm_kinematics::fk::Fk;
use ik_arm_kinematics::ik::{Ik, IkSolution};
use ik_arm_kinematics::pop::PosedLimb;
use ik_arm_kinematics::rig::{LimbFrames, LimbPart, TaperedCylinder};
use ik_arm_kinematics::soft_reach::SoftReach;
use ik_arm_kinematics::twist::{TransportedFrame, TwistReference, TwistReferenceKind};
use ik_arm_kinematics::two_bone::TwoBonePose;
use proptest::prelude::*;
use proptest::test_runner::TestCaseResult;

use crate::common::strategies::{
    Case, EXACT, U, anywhere, bones, config, directions, limb_rotation, limits, power_of_ten,
    within, yaw_and_pitch,
};

/// The hierarchy of Palmieri's report, written out in f64.
const PARENTS: [(LimbPart, Option<LimbPart>); 11] = [
    (LimbPart::Root, None),
    (LimbPart::Limb, Some(LimbPart::Root)),
    (LimbPart::Socket, Some(LimbPart::Limb)),
    (LimbPart::UpperLimb, Some(LimbPart::Socket)),
    (LimbPart::LowerLimb, Some(LimbPart::Socket)),
    (LimbPart::Elbow, Some(LimbPart::Socket)),
    (LimbPart::Hand, Some(LimbPart::Socket)),
    (LimbPart::Pointer, Some(LimbPart::Limb)),
    (LimbPart::Cursor, Some(LimbPart::Root)),
    (LimbPart::InnerLimit, Some(LimbPart::Root)),
    (LimbPart::OuterLimit, Some(LimbPart::Root)),
];

/// A posed arm with its root anywhere in world space.
#[derive(Debug)]
struct ArmCase {
    case: Case,
    root: Vec3,
    pose: TwoBonePose,
    rig: LimbFrames,
}

impl ArmCase {
    /// A point of Root space in the world.
    fn in_world(&self, at: Vec3) -> DVec3 {
        self.root.as_dvec3() + at.as_dvec3()
    }

    /// Allowed error of a point of the arm.
    fn bound(&self) -> f64 {
        let TwoBonePose { elbow, hand, .. } = self.pose;
        let points = [self.root.as_dvec3(), self.in_world(elbow), self.in_world(hand)];
        world_bound(limits(self.case.arm).1, &points)
    }

    /// The point so far along a part's +x, in the world.
    fn point(&self, part: LimbPart, x: f32) -> DVec3 {
        at(self.rig.world(part), x)
    }
}

/// The point so far along a transform's +x.
fn at(transform: Affine3A, x: f32) -> DVec3 {
    transform.as_daffine3().transform_point3(DVec3::X * f64::from(x))
}

/// The accuracy in Root space, and two units in the last place of the largest coordinate.
fn world_bound(length: f64, points: &[DVec3]) -> f64 {
    let largest = points.iter().map(|point| point.abs().max_element()).fold(0.0, f64::max) as f32;
    EXACT * length + 2.0 * f64::from(largest.next_up() - largest)
}

/// Every coordinate up to ±1e6, at every scale.
fn places() -> impl Strategy<Value = Vec3> {
    (directions(), power_of_ten(-2.0..6.0)).prop_map(|(to, distance)| (to * distance).as_vec3())
}

/// The frames of an arm with hard limits, posed by IK alone.
fn frames(case: &Case, root: Vec3, pose: TwoBonePose) -> LimbFrames {
    let soft_reach = SoftReach::default();
    let limits = soft_reach.limits(case.arm);
    let reference = TwistReference::Up;
    LimbFrames {
        root: Affine3A::from_translation(root),
        posed: PosedLimb {
            pose,
            cursor: case.cursor,
            ik: Ik { bones: case.arm, reference, soft_reach },
            kind: TwistReferenceKind::Up,
            twist: case.twist,
            pinned_root: None,
            influence: 1.0,
            fk: Fk::default(),
        },
        solution: IkSolution { pose, transported: TransportedFrame::new(pose.pointer), slope: 1.0 },
        limits,
        range: limits,
        limited_by: None,
        turned_aside: 0.0,
        references: [Some(reference); TwistReferenceKind::ALL.len()],
    }
}

fn arms() -> impl Strategy<Value = ArmCase> {
    (anywhere(), places()).prop_map(|(case, root)| {
        let pose = case.solve();
        let rig = frames(&case, root, pose);
        ArmCase { case, root, pose, rig }
    })
}

/// Right-handed and orthonormal after `turns` products of rotations, each with axes as accurate as
/// hands.
fn is_rotation(transform: Affine3A, turns: u32) -> TestCaseResult {
    let (axes, error) = (transform.as_daffine3().matrix3, EXACT * f64::from(turns));
    let skew = axes.transpose() * axes - DMat3::IDENTITY;
    within("orthonormality", largest_entry(skew), 2.0 * error)?;
    within("handedness", (axes.determinant() - 1.0).abs(), 3.0 * error)
}

fn largest_entry(matrix: DMat3) -> f64 {
    matrix.to_cols_array().into_iter().map(f64::abs).fold(0.0, f64::max)
}

#[test]
fn parts_are_in_the_order_of_the_enum_and_parents_come_before_children() {
    assert_eq!(LimbPart::ALL, PARENTS.map(|(part, _)| part));
    for (index, (part, parent)) in PARENTS.into_iter().enumerate() {
        assert_eq!(part as usize, index);
        assert_eq!(part.parent(), parent);
        assert!(parent.is_none_or(|parent| (parent as usize) < index), "{part:?}");
    }
}

proptest! {
    #![proptest_config(config(10_000, 0x2014_1a4e))]

    #[test]
    fn elbow_and_hand_are_where_the_solver_says(arm in arms()) {
        for (part, solved) in [(LimbPart::Elbow, arm.pose.elbow), (LimbPart::Hand, arm.pose.hand)] {
            let origin = arm.rig.origin(part).as_dvec3();
            within("joint", origin.distance(arm.in_world(solved)), arm.bound())?;
        }
    }

    #[test]
    fn the_limbs_run_from_shoulder_to_elbow_to_hand(arm in arms()) {
        let (upper, lower) = (arm.rig.upper(), arm.rig.lower());
        for (what, end, joint) in [
            ("shoulder end", arm.point(LimbPart::UpperLimb, 0.0), Vec3::ZERO),
            ("upper elbow end", arm.point(LimbPart::UpperLimb, upper.length), arm.pose.elbow),
            ("lower elbow end", arm.point(LimbPart::LowerLimb, 0.0), arm.pose.elbow),
            ("hand end", arm.point(LimbPart::LowerLimb, lower.length), arm.pose.hand),
        ] {
            within(what, end.distance(arm.in_world(joint)), arm.bound())?;
        }
        let (bones, bound) = (bones(arm.case.arm), EXACT * limits(arm.case.arm).1);
        within("upper length", (f64::from(upper.length) - bones.0).abs(), bound)?;
        within("lower length", (f64::from(lower.length) - bones.1).abs(), bound)?;
        for part in [LimbPart::UpperLimb, LimbPart::LowerLimb] {
            prop_assert_eq!(arm.rig.local(part).matrix3.z_axis, glam::Vec3A::Z, "not a hinge");
        }
    }

    #[test]
    fn the_pointer_is_as_long_as_the_arm_and_passes_through_hand_and_cursor(arm in arms()) {
        let ArmCase { case, root, pose, rig } = &arm;
        let length = limits(case.arm).1;
        within("length", (f64::from(rig.pointer().length) - length).abs(), U * length)?;

        let start = arm.point(LimbPart::Pointer, 0.0);
        prop_assert_eq!(start, root.as_dvec3());
        let along = (arm.point(LimbPart::Pointer, rig.pointer().length) - start).normalize();
        let cursor = arm.in_world(case.cursor);
        let reach = length.max(case.cursor.as_dvec3().length());
        let cursor_bound = world_bound(reach, &[root.as_dvec3(), cursor]);
        for (point, bound) in [
            (arm.in_world(pose.hand), arm.bound()),
            (rig.origin(LimbPart::Cursor).as_dvec3(), cursor_bound),
        ] {
            let ahead = (point - start).dot(along);
            prop_assert!(ahead >= -bound, "the pointer points away");
            within("distance from the line", point.distance(start + along * ahead), bound)?;
        }
        within("cursor", rig.origin(LimbPart::Cursor).as_dvec3().distance(cursor), cursor_bound)?;
    }

    #[test]
    fn the_limit_spheres_are_centred_on_the_shoulder(arm in arms()) {
        for (part, radius, limit) in [
            (LimbPart::InnerLimit, arm.rig.limits.inner, limits(arm.case.arm).0),
            (LimbPart::OuterLimit, arm.rig.limits.outer, limits(arm.case.arm).1),
        ] {
            prop_assert_eq!(arm.rig.world(part), Affine3A::from_translation(arm.root));
            prop_assert_eq!(radius, limit as f32);
        }
    }

    #[test]
    fn limb_and_socket_rotate_by_the_angles_of_the_report(arm in arms()) {
        let turns = [
            (LimbPart::Limb, limb_rotation(yaw_and_pitch(arm.case.cursor))),
            (LimbPart::Socket, DMat3::from_rotation_x(arm.case.twist.into())),
        ];
        for (part, turn) in turns {
            let local = arm.rig.local(part);
            prop_assert_eq!(local.translation, glam::Vec3A::ZERO);
            within("turn", largest_entry(local.as_daffine3().matrix3 - turn), EXACT)?;
        }
    }

    #[test]
    fn world_transforms_are_rotations_and_products_up_the_parents(arm in arms()) {
        for (part, _) in PARENTS {
            let mut product = Mat4::from(arm.rig.local(part)).as_dmat4();
            let (mut child, mut turns) = (part, 0);
            while let Some(parent) = PARENTS[child as usize].1 {
                product = Mat4::from(arm.rig.local(parent)).as_dmat4() * product;
                (child, turns) = (parent, turns + 1);
            }
            let world = arm.rig.world(part);
            is_rotation(world, turns)?;
            // Two products of rotations; each rounds the terms of Σ aᵢₖbₖⱼ, Σ|aᵢₖbₖⱼ| ≤ 1, thrice.
            let turned = world.as_daffine3().matrix3 - DMat3::from_mat4(product);
            within("rotation", largest_entry(turned), 2.0 * 3.0 * U)?;
            let position = product.w_axis.truncate();
            let reach = limits(arm.case.arm).1;
            let bound = world_bound(reach, &[arm.root.as_dvec3(), position]);
            within("position", arm.rig.origin(part).as_dvec3().distance(position), bound)?;
        }
    }

    #[test]
    fn a_cone_between_two_points_lands_on_both(
        base in prop_oneof![places(), Just(Vec3::ZERO)],
        direction in directions(),
        length in prop_oneof![power_of_ten(-2.0..4.0), power_of_ten(-40.0..38.0)],
    ) {
        let tip = (base.as_dvec3() + direction * length).as_vec3();
        let (flat_base, flat_tip) = (base.with_z(0.0), tip.with_z(0.0));
        for (base, tip, (placement, cone)) in [
            (base, tip, TaperedCylinder::between(base, tip, 3.0, 2.0)),
            (flat_base, flat_tip, TaperedCylinder::in_xy_plane(flat_base, flat_tip, 3.0, 2.0)),
        ] {
            is_rotation(placement, 1)?;
            prop_assert_eq!(at(placement, 0.0), base.as_dvec3());
            prop_assert_eq!((cone.base_radius, cone.tip_radius), (3.0, 2.0));
            let (base, tip) = (base.as_dvec3(), tip.as_dvec3());
            let bound = world_bound(base.distance(tip), &[base, tip]);
            within("tip", at(placement, cone.length).distance(tip), bound)?;
        }
    }
}

#[test]
fn a_cone_without_a_length_points_along_x() {
    let here = Vec3::new(1.0, 2.0, 3.0);
    let (placement, cone) = TaperedCylinder::between(here, here, 3.0, 2.0);
    assert_eq!(cone.length, 0.0);
    assert_eq!(at(placement, 1.0), (here + Vec3::X).as_dvec3());
    is_rotation(placement, 1).unwrap();
}
