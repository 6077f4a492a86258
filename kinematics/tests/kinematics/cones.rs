//! Cone limits: projection, against a search over the ellipse in f64, and solvers that never leave
//! them.

use std::f32::consts::{self, PI};
use std::f64::consts::TAU;

use glam::{DMat3, DQuat, DVec2, DVec3, EulerRot, Vec2, Vec3};
use ik_arm_kinematics::chain_ik::{
    ChainSolver, ChainTarget, Method, NullSpaceDrag, Root, SolverOptions, solve,
};
use ik_arm_kinematics::skeleton::{
    Cone, Extreme, Joint, JointId, JointLimits, Limit, LimitEnd, RotationAxis, Skeleton,
    SkeletonError, nearest_angles,
};

use crate::common::Random;
use crate::common::skeletons::{ITERATIVE, chain, length};

fn cone(random: &mut Random) -> Cone {
    let (from, size) = (random.within(-2.5..1.0), random.within(0.1..3.0));
    Cone {
        x: random.within(0.1..2.9),
        z: random.within(0.1..2.9),
        twist: Limit { min: from, max: from + size },
        middle: middle(random),
    }
}

/// The middle of a cone: half of them are at the bone at rest.
fn middle(random: &mut Random) -> Vec2 {
    match random.coin() {
        true => Vec2::ZERO,
        false => Vec2::from([(); 2].map(|()| random.within(-1.8..1.8))),
    }
}

/// A joint with a cone around a random bone, in a random frame, as a skeleton has it.
fn joint(random: &mut Random, cone: Cone) -> Joint {
    let bone = random.direction() * random.within(0.2..2.0);
    let joint = Joint {
        frame: random.rotation(),
        limits: JointLimits::cone(cone),
        ..Joint::new("joint", None, bone)
    };
    Skeleton::from_joints(vec![joint]).expect("a joint")[JointId::new(0)].clone()
}

/// Swing, as a rotation vector about x and z, and twist of a joint, from the definition.
fn swing_and_twist(joint: &Joint, angles: Vec3) -> (DVec2, f64) {
    let frame = joint.frame.as_dmat3();
    let y = (frame.transpose() * joint.axis.as_dvec3()).normalize();
    let x = DVec3::X - y * y.x;
    let x = if x.length() > 1e-3 { x } else { DVec3::Z - y * y.z }.normalize();
    let basis = DMat3::from_cols(x, y, x.cross(y));
    let DVec3 { x, y, z } = angles.as_dvec3();
    let turned = DMat3::from_quat(DQuat::from_euler(EulerRot::ZYX, z, y, x));
    let middle = joint.limits.as_cone().expect("a cone").middle.as_dvec2();
    let to_middle = DMat3::from_quat(DQuat::from_scaled_axis(DVec3::new(middle.x, 0.0, middle.y)));
    let turned = to_middle.transpose() * basis.transpose() * turned * basis;
    // From the middle, the swing takes y to where the whole rotation takes it, by the shortest way.
    let to = turned.y_axis;
    let axis = DVec3::Y.cross(to);
    let angle = axis.length().atan2(to.y);
    let swing = axis.normalize_or_zero() * angle;
    let twist = DMat3::from_quat(DQuat::from_scaled_axis(swing)).transpose() * turned;
    (DVec2::new(swing.x, swing.z), (-twist.x_axis.z).atan2(twist.x_axis.x))
}

/// How far a rotation is beyond a cone: the swing as a multiple of the ellipse, the twist in radians.
fn beyond(joint: &Joint, angles: Vec3) -> (f64, f64) {
    let cone = joint.limits.as_cone().expect("a cone");
    let (swing, twist) = swing_and_twist(joint, angles);
    let radii = DVec2::new(cone.x.into(), cone.z.into());
    let [min, max] = [cone.twist.min, cone.twist.max].map(f64::from);
    let twist = twist + ((0.5 * (min + max) - twist) / TAU).round() * TAU;
    ((swing / radii).length() - 1.0, (twist - max).max(min - twist))
}

#[test]
fn projection_is_within_idempotent_and_leaves_what_is_within() {
    let mut random = Random(801);
    let mut within = 0;
    for case in 0..100_000 {
        let cone = cone(&mut random);
        let joint = joint(&mut random, cone);
        let angles = random.vector(1.5 * PI);
        let projected = joint.limits.project(angles);
        let at = format!("{case}: {cone:?} {angles}");
        assert!(joint.limits.contains(projected), "{at}: {projected}");
        let (swing, twist) = beyond(&joint, projected);
        let excess = (swing * f64::from(cone.x.min(cone.z))).max(twist);
        assert!(excess < 1e-5, "{at}: {excess} beyond");
        let again = joint.limits.project(projected);
        assert_eq!(again, projected, "{at}");
        if joint.limits.contains(angles) {
            within += 1;
            assert_eq!(projected, angles, "{at}");
        }
        let (swing, twist) = beyond(&joint, angles);
        if swing.max(twist) < -1e-4 || swing.max(twist) > 1e-4 {
            assert_eq!(joint.limits.contains(angles), swing.max(twist) < 0.0, "{at}");
        }
    }
    assert!(within > 1000, "{within} of the rotations are within");
}

#[test]
fn the_swing_goes_to_the_nearest_point_of_the_ellipse_and_the_twist_to_its_nearer_end() {
    let mut random = Random(802);
    for case in 0..1000 {
        let cone = cone(&mut random);
        let joint = joint(&mut random, cone);
        let angles = random.vector(PI);
        let (swing, twist) = swing_and_twist(&joint, angles);
        let (found, found_twist) = swing_and_twist(&joint, joint.limits.project(angles));
        let radii = DVec2::new(cone.x.into(), cone.z.into());
        if swing.length() > 3.1 {
            continue;
        }
        let at = format!("{case}: {cone:?}, swing {swing}, twist {twist}");
        if (swing / radii).length() > 1.0 {
            let on_ellipse = |turn: f64| radii * DVec2::from_angle(turn);
            let all = (0..20_000).map(|step| on_ellipse(TAU * f64::from(step) / 20_000.0));
            let least = all.map(|it| it.distance(swing)).fold(f64::INFINITY, f64::min);
            assert!(found.distance(swing) < least + 1e-5, "{at}: {found}");
        } else {
            assert!(found.distance(swing) < 1e-5, "{at}: the swing stays, not {found}");
        }
        let off = |angle: f64, other: f64| {
            let turn = (angle - other) / TAU;
            TAU * (turn - turn.round()).abs()
        };
        let [min, max] = [cone.twist.min, cone.twist.max].map(f64::from);
        let ends = off(twist, min).min(off(twist, max));
        let moved = off(twist, found_twist);
        assert!(moved < 1e-4 || (moved - ends).abs() < 1e-4, "{at}: twist {found_twist}");
    }
}

#[test]
fn projection_is_continuous_away_from_half_turns() {
    const STEP: f32 = 1e-3;
    let mut random = Random(803);
    let rotation = |angles: Vec3| {
        let DVec3 { x, y, z } = angles.as_dvec3();
        DQuat::from_euler(EulerRot::ZYX, z, y, x)
    };
    for case in 0..20_000 {
        let cone = cone(&mut random);
        let joint = joint(&mut random, cone);
        let angles = random.vector(PI);
        let near = angles + STEP * random.direction();
        let middle = 0.5 * f64::from(cone.twist.min + cone.twist.max);
        let is_far = [angles, near].into_iter().all(|angles| {
            let (swing, twist) = swing_and_twist(&joint, angles);
            let turn = (twist - middle) / TAU;
            let from_middle = TAU * (turn - turn.round()).abs();
            swing.length() < std::f64::consts::PI - 0.02
                && from_middle < std::f64::consts::PI - 0.02
        });
        if is_far {
            let [one, two] = [angles, near].map(|angles| rotation(joint.limits.project(angles)));
            let apart = one.angle_between(two);
            // Near half a turn of swing a small turn changes the twist much.
            assert!(apart < 0.25, "{case}: {cone:?} {angles}: {apart} apart");
        }
    }
}

#[test]
fn the_border_that_is_drawn_is_that_of_what_the_cone_contains() {
    let mut random = Random(808);
    let (mut inside, mut outside) = (0, 0);
    for case in 0..10_000 {
        let cone = cone(&mut random);
        let joint = joint(&mut random, cone);
        let (azimuth, swing) = (random.within(-PI..PI), random.within(0.0..PI));
        let most = joint.most_swing(azimuth).expect("a border");
        let angles = joint.swung(azimuth, swing).expect("angles");
        if (swing - most).abs() < 1e-4 {
            continue;
        }
        let is_in = joint.limits.contains(angles);
        *if is_in { &mut inside } else { &mut outside } += 1;
        assert_eq!(is_in, swing < most, "{case}: {cone:?}, {swing} of {most} towards {azimuth}");
        let (found, _) = swing_and_twist(&joint, angles);
        assert!((found.length() - f64::from(swing)).abs() < 1e-4, "{case}: swings by {swing}");
    }
    assert!(inside > 2000 && outside > 2000, "{inside} inside, {outside} outside");
}

/// A chain all of whose joints have cones, in a random pose within them.
/// A joint in a skeleton, with a cone or with some ranges of angles, and a rotation within them.
fn limited(random: &mut Random, has_cone: bool) -> Joint {
    let cone = cone(random);
    let mut joint = joint(random, cone);
    if !has_cone {
        joint.limits = JointLimits::NONE;
        for axis in RotationAxis::ALL {
            let (min, size) = (random.within(-2.0..1.0), random.within(0.1..2.0));
            let range = Some(Limit { min, max: min + size });
            joint.limits.set_range(axis, range.filter(|_| random.chance(0.7)));
            joint.rotation[axis.index()] = min + 0.3 * size;
        }
    } else {
        joint.rotation = joint.limits.project(random.vector(1.0));
    }
    Skeleton::from_joints(vec![joint]).expect("a joint")[JointId::new(0)].clone()
}

#[test]
fn ends_of_limits_are_where_turns_about_their_axes_leave_the_limits() {
    const STEP: f64 = 1e-2;
    let mut random = Random(811);
    let mut ends = 0;
    for case in 0..400 {
        let joint = limited(&mut random, case % 2 == 0);
        for end in joint.limit_ends() {
            let at = joint.angles_at_end(end).expect("an end");
            assert!(joint.limits.contains(at), "{case}: {end:?}");
            let axis = joint.axis_of_end(end).expect("an axis").as_dvec3().normalize();
            let turned = |by: f64| {
                let frame = joint.frame.as_dmat3();
                let turn = frame.transpose() * DMat3::from_axis_angle(axis, by) * frame;
                let DVec3 { x, y, z } = at.as_dvec3();
                let turned = turn * DMat3::from_quat(DQuat::from_euler(EulerRot::ZYX, z, y, x));
                nearest_angles(turned.as_mat3().into(), at)
            };
            let is_greatest = matches!(
                end,
                LimitEnd::Range(_, Extreme::Greatest)
                    | LimitEnd::Swing(_, Extreme::Greatest)
                    | LimitEnd::Twist(Extreme::Greatest)
            );
            let out = if is_greatest { STEP } else { -STEP };
            assert!(!joint.limits.contains(turned(out)), "{case}: {end:?} ends too late");
            assert!(joint.limits.contains(turned(-out)), "{case}: {end:?} ends too early");
            ends += 1;
        }
    }
    assert!(ends > 1000, "{ends}");
}

#[test]
fn an_end_of_limits_goes_where_it_is_moved_but_not_beyond_what_is_sound() {
    let mut random = Random(812);
    for case in 0..400 {
        let joint = limited(&mut random, case % 2 == 0);
        for end in joint.limit_ends() {
            let angle = random.within(-7.0..7.0);
            let mut moved = joint.clone();
            moved.limits = joint.limits.with_end(end, angle);
            let before: Vec<f32> =
                joint.limit_ends().filter_map(|it| joint.angle_of_end(it)).collect();
            let after: Vec<f32> =
                joint.limit_ends().filter_map(|it| moved.angle_of_end(it)).collect();
            let own = joint.limit_ends().position(|it| it == end).expect("the end");
            let opposite = own ^ 1;
            for (index, (before, after)) in before.iter().zip(&after).enumerate() {
                let is_moved =
                    index == own || index == opposite && matches!(end, LimitEnd::Swing(..));
                assert!(is_moved || before == after, "{case}: {end:?} moves another end");
            }
            let expected = match end {
                LimitEnd::Swing(_, Extreme::Greatest) => angle.clamp(0.017_453, Cone::WIDEST),
                LimitEnd::Swing(_, Extreme::Least) => angle.clamp(-Cone::WIDEST, -0.017_453),
                LimitEnd::Range(_, Extreme::Least) => angle.min(before[opposite]),
                LimitEnd::Range(_, Extreme::Greatest) => angle.max(before[opposite]),
                LimitEnd::Twist(Extreme::Least) => {
                    angle.clamp(before[opposite] - consts::TAU, before[opposite])
                }
                LimitEnd::Twist(Extreme::Greatest) => {
                    angle.clamp(before[opposite], before[opposite] + consts::TAU)
                }
            };
            assert_eq!(after[own], expected, "{case}: {end:?} to {angle}");
            Skeleton::from_joints(vec![moved]).expect("sound limits");
        }
    }
}

/// A chain with cones whose middles are at the bones at rest.
fn centred(random: &mut Random, joints: usize) -> Skeleton {
    let mut skeleton = chain(random, joints, 1.0);
    for joint in skeleton.ids() {
        let twist = Limit { min: -random.within(0.1..1.5), max: random.within(0.1..1.5) };
        let (x, z) = (random.within(0.2..1.4), random.within(0.2..1.4));
        let limits = JointLimits::cone(Cone { x, z, twist, middle: Vec2::ZERO });
        skeleton.change(joint, |joint| joint.limits = limits).expect("a cone");
    }
    skeleton
}

/// A chain with cones, some of whose middles are away from the bones at rest.
fn coned(random: &mut Random, joints: usize) -> Skeleton {
    let mut skeleton = centred(random, joints);
    for joint in skeleton.ids() {
        let cone = skeleton[joint].limits.as_cone().expect("a cone");
        let limits = JointLimits::cone(Cone { middle: middle(random), ..cone });
        skeleton.change(joint, |joint| joint.limits = limits).expect("a cone");
    }
    skeleton
}

fn pose_within(random: &mut Random, skeleton: &mut Skeleton) {
    for joint in skeleton.ids().filter(|joint| !skeleton[*joint].locked).collect::<Vec<_>>() {
        skeleton.set_rotation(joint, random.vector(2.0)).expect("angles");
    }
}

/// Greatest excess of a pose beyond its cones, in radians.
fn excess(skeleton: &Skeleton) -> f64 {
    let of_joint = |joint: JointId| {
        let joint = &skeleton[joint];
        let Some(cone) = joint.limits.as_cone().filter(|_| joint.axis != Vec3::ZERO) else {
            return 0.0;
        };
        let (swing, twist) = beyond(joint, joint.rotation);
        (swing * f64::from(cone.x.min(cone.z))).max(twist)
    };
    skeleton.ids().map(of_joint).fold(0.0, f64::max)
}

#[test]
fn every_method_reaches_targets_within_cones_and_never_leaves_them() {
    const CASES: usize = 60;
    for method in ITERATIVE {
        let mut random = Random(804);
        let mut reached = 0;
        for case in 0..CASES {
            let mut skeleton = coned(&mut random, 6);
            let tip = skeleton.ids().last().expect("a tip");
            let mut posed = skeleton.clone();
            pose_within(&mut random, &mut posed);
            pose_within(&mut random, &mut skeleton);
            let target = [ChainTarget::at(tip, posed.tip(tip))];
            let options = SolverOptions::new(method);
            let mut solver = ChainSolver::new(&skeleton, &target, &options).expect("a solver");
            let mut now = skeleton.clone();
            for _ in 0..40 {
                solver.step();
                solver.write(&mut now);
                let excess = excess(&now);
                assert!(excess < 1e-5, "{method} {case}: {excess} beyond");
            }
            let report = solver.run();
            solver.write(&mut now);
            assert!(excess(&now) < 1e-5, "{method} {case}");
            reached += usize::from(report.converged());
        }
        assert!(reached >= CASES - 1, "{method}: {reached} of {CASES}");
    }
}

/// How many of 60 chains with cones each method brings as near to a target as a search by many
/// random starts.
fn near_brute_force(methods: &[Method], has_middles: bool) -> Vec<usize> {
    let mut random = Random(805);
    let mut near = vec![0; methods.len()];
    for _ in 0..60 {
        let skeleton = if has_middles { coned(&mut random, 2) } else { centred(&mut random, 2) };
        let tip = skeleton.ids().last().expect("a tip");
        let place = skeleton.base(JointId::new(1)) + random.vector(2.5);
        let mut best = f32::INFINITY;
        for _ in 0..30 {
            let mut start = skeleton.clone();
            pose_within(&mut random, &mut start);
            let target = [ChainTarget::at(tip, place)];
            let options = SolverOptions::new(Method::DampedLeastSquares);
            solve(&mut start, &target, &options).expect("solved");
            best = best.min(start.tip(tip).distance(place));
        }
        for _ in 0..3000 {
            let mut pose = skeleton.clone();
            pose_within(&mut random, &mut pose);
            best = best.min(pose.tip(tip).distance(place));
        }
        let size = length(&skeleton, &[tip]);
        for (method, near) in methods.iter().zip(&mut near) {
            let mut solved = skeleton.clone();
            let target = [ChainTarget::at(tip, place)];
            solve(&mut solved, &target, &SolverOptions::new(*method)).expect("solved");
            *near += usize::from(solved.tip(tip).distance(place) <= best + 2e-3 * size);
        }
    }
    near
}

#[test]
fn the_nearest_point_of_a_chain_with_cones_is_that_of_brute_force() {
    let methods = [Method::DampedLeastSquares, Method::Transpose, Method::Ccd, Method::Fabrik];
    let near = near_brute_force(&methods, false);
    assert!(near[0] == 60 && near.iter().all(|near| *near >= 59), "{near:?}");
    let near = near_brute_force(&methods, true);
    assert!(near.iter().all(|near| *near >= 58), "{near:?} with middles away from the bones");
}

#[test]
fn a_motion_within_cones_is_tracked_without_pops() {
    for method in [Method::DampedLeastSquares, Method::Transpose, Method::Fabrik] {
        let mut random = Random(806);
        for case in 0..6 {
            let mut fk = coned(&mut random, 8);
            pose_within(&mut random, &mut fk);
            let tip = fk.ids().last().expect("a tip");
            let (from, way) = (fk.tip(tip), random.vector(1.0));
            let target = |frame: u16| {
                let part = (f32::from(frame) / 30.0).sin();
                [ChainTarget::at(tip, from + way * part)]
            };
            let options = SolverOptions::new(method);
            let mut solver = ChainSolver::new(&fk, &target(0), &options).expect("a solver");
            solver.run();
            let mut posed = fk.clone();
            for frame in 1..100 {
                let step = solver.track(&target(frame), &fk).expect("a step");
                solver.write(&mut posed);
                let at = format!("{method} {case} {frame}");
                assert!(step.joint_motion < 12.0 * step.target_motion + 1e-3, "{at}: {step:?}");
                assert!(excess(&posed) < 1e-5, "{at}: {}", excess(&posed));
            }
        }
    }
}

#[test]
fn a_drag_in_the_null_space_stays_within_cones() {
    let mut random = Random(807);
    for case in 0..40 {
        let mut skeleton = coned(&mut random, 8);
        pose_within(&mut random, &mut skeleton);
        let tip = skeleton.ids().last().expect("a tip");
        let held = [ChainTarget::at(tip, skeleton.tip(tip))];
        let joint = JointId::new(4);
        let dragged = ChainTarget::at(joint, skeleton.tip(joint) + random.direction());
        let mut drag = NullSpaceDrag::new(&skeleton, &held, dragged, Root::Turns).expect("a drag");
        let report = drag.run();
        drag.write(&mut skeleton);
        assert!(report.held_error < 1e-4, "{case}: {report:?}");
        assert!(excess(&skeleton) < 1e-5, "{case}: {}", excess(&skeleton));
    }
}

#[test]
fn cones_out_of_range_are_refused_and_bones_that_turn_take_them_along() {
    let twist = Limit { min: -0.5, max: 0.5 };
    let whole = Cone { x: 1.0, z: 1.0, twist, middle: Vec2::ZERO };
    let invalid = [
        Cone { x: 0.0, ..whole },
        Cone { z: 3.0, ..whole },
        Cone { z: f32::NAN, ..whole },
        Cone { twist: Limit { min: 1.0, max: 0.0 }, ..whole },
        Cone { twist: Limit { min: -4.0, max: 4.0 }, ..whole },
        Cone { middle: Vec2::new(3.0, 1.0), ..whole },
        Cone { middle: Vec2::new(f32::NAN, 0.0), ..whole },
    ];
    for cone in invalid {
        let joint = Joint { limits: JointLimits::cone(cone), ..Joint::new("a", None, Vec3::Y) };
        let refused = Skeleton::from_joints(vec![joint]).expect_err("an invalid cone");
        assert!(matches!(refused, SkeletonError::Cone { .. }), "{refused}");
    }
    let limits = JointLimits::cone(Cone { x: 0.2, z: 1.2, twist, middle: Vec2::ZERO });
    let joint = Joint { limits, ..Joint::new("a", None, Vec3::Y) };
    let mut skeleton = Skeleton::from_joints(vec![joint]).expect("a joint");
    let root = JointId::new(0);
    assert!(!skeleton[root].limits.contains(Vec3::X) && skeleton[root].limits.contains(Vec3::Z));
    skeleton.set_axis(root, Vec3::X).expect("an axis");
    // Along x, the twist is about x, and swings are about y and z.
    assert!(!skeleton[root].limits.contains(Vec3::X * 0.7));
    assert!(skeleton[root].limits.contains(Vec3::X * 0.4));
}
