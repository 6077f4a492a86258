//! Jobs that are refused, and jobs that are barely accepted.

use glam::{Affine3A, DAffine3, DMat3, DQuat, DVec3, Mat3, Quat, Vec3};
use ik_arm_kinematics::job::{JobError, JobField, TwoBoneJob};
use ik_arm_kinematics::two_bone::Reach;

use crate::common::Random;
use crate::two_bone_job::skeleton::*;

#[test]
fn a_joint_whose_own_scale_mirrors_one_axis_is_turned_before_it() {
    let mut random = Random(3);
    for _ in 0..500 {
        let mut skeleton = Skeleton::random(&mut random);
        for local in [&mut skeleton.start, &mut skeleton.middle] {
            let signs = random.vector(1.0).as_dvec3().map(f64::signum);
            local.scale = signs * local.scale.x.abs();
        }
        let direction = random.direction().as_dvec3();
        let target = skeleton.point_in_reach(direction, 0.5);
        let job = TwoBoneJob { pole: Some(random.vector(1.0)), ..skeleton.job(target) };
        let scales = [skeleton.start.scale, skeleton.middle.scale].map(DVec3::as_vec3);
        is_at(&skeleton, &run(job).before_scales(scales[0], scales[1]), target);
    }
}

#[test]
fn invalid_jobs_are_refused_by_name() {
    let job = Skeleton::square().job(DVec3::X);
    let scaled = |x: f32, y: f32, z: f32| Affine3A::from_scale(Vec3::new(x, y, z));
    let sheared = |by: f64| {
        let axes = DMat3::from_cols(DVec3::X, DVec3::new(by, 1.0, 0.0).normalize(), DVec3::Z);
        Affine3A::from_mat3(axes.as_mat3())
    };
    let said = |job: TwoBoneJob| job.run().expect_err("refused").to_string();

    assert!(TwoBoneJob { middle: scaled(1.0, 1.0, 1.0009), ..job }.run().is_ok());
    assert!(TwoBoneJob { middle: sheared(0.0009), ..job }.run().is_ok());
    for middle in [scaled(1.0, 1.0, 1.01), scaled(0.0, 1.0, 1.0), scaled(2.0, -1.0, 2.0)] {
        let error = TwoBoneJob { middle, ..job }.run();
        assert!(
            matches!(error, Err(JobError::UnevenAxes { field: JobField::Middle, .. })),
            "{error:?}"
        );
    }
    assert_eq!(
        said(TwoBoneJob { middle: scaled(1.0, 2.0, 1.0), ..job }),
        "middle must have axes of equal length in start joint space, to one in a thousand, got 1, 2 \
         and 1"
    );
    assert_eq!(
        said(TwoBoneJob { start: scaled(1.0, 2.0, 1.0), ..job }),
        "middle must have axes of equal length in start joint space, to one in a thousand, got 1, \
         0.5 and 1"
    );
    assert_eq!(
        said(TwoBoneJob { middle: sheared(-1.0), ..job }),
        "middle must have perpendicular axes in start joint space (cosine from -0.001 to 0.001), got a \
         cosine of -0.70710677"
    );

    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        let vector = Vec3::new(0.0, bad, 0.0);
        let joint = Affine3A::from_translation(vector);
        let fields = [
            (JobField::Start, TwoBoneJob { start: joint, ..job }),
            (JobField::Middle, TwoBoneJob { middle: Affine3A::from_scale(vector), ..job }),
            (JobField::End, TwoBoneJob { end: joint, ..job }),
            (JobField::Target, TwoBoneJob { target: vector, ..job }),
            (JobField::Pole, TwoBoneJob { pole: Some(vector), ..job }),
            (JobField::Hinge, TwoBoneJob { hinge: Some(vector), ..job }),
        ];
        for (field, job) in fields {
            assert_eq!(job.run(), Err(JobError::NotFinite { field }));
        }
        assert_eq!(
            said(TwoBoneJob { twist: bad, ..job }),
            format!("twist must be finite, got {bad}")
        );
    }
    assert_eq!(
        said(TwoBoneJob { softness: 1.0, ..job }),
        "softness must be from 0 to less than 1, got 1"
    );
    for weight in [-0.1, 1.1] {
        let expected = format!("weight must be from 0 to 1, got {weight}");
        assert_eq!(said(TwoBoneJob { weight, ..job }), expected);
    }
}

#[test]
fn a_start_joint_without_an_inverse_is_refused_unless_it_has_scale_0() {
    let job = Skeleton::square().job(DVec3::X);
    let flat = Affine3A::from_scale(Vec3::new(1.0, 0.0, 1.0));
    let turn = Affine3A::from_quat(Quat::from_euler(glam::EulerRot::XYZ, 0.5, 0.9, -0.4));
    let line = Affine3A::from_mat3(Mat3::from_cols(Vec3::X, Vec3::X * 2.0, Vec3::NEG_X));
    let plane = Affine3A::from_mat3(Mat3::from_cols(Vec3::X, Vec3::Y, Vec3::new(0.5, -3.0, 0.0)));
    for start in [flat, flat * turn, turn * flat, turn * flat * turn, line, plane] {
        // The middle joint under it, as a skeleton would have it.
        let middle = start * job.middle;
        let error = TwoBoneJob { start, middle, ..job }.run().expect_err("refused");
        assert_eq!(error, JobError::NotInvertible { field: JobField::Start });
        assert_eq!(
            error.to_string(),
            "start must have an inverse, or scale 0; its axes are in one plane"
        );
    }
    // Nothing turns under scale 0, for any middle joint.
    let start = Affine3A::from_scale(Vec3::ZERO);
    for middle in [Affine3A::from_scale(Vec3::ZERO), flat, job.middle] {
        let correction = run(TwoBoneJob { start, middle, ..job });
        assert_eq!(
            (correction.start_correction, correction.middle_correction),
            (Quat::IDENTITY, Quat::IDENTITY)
        );
        assert!(correction.hand_error.is_finite());
    }
    // A thin matrix is not singular.
    let parent = DAffine3::from_scale(DVec3::new(1.0, 1e-4, 1.0));
    let skeleton = Skeleton { parent, ..Skeleton::square() };
    let target = parent.transform_point3(DVec3::new(0.2, 0.7, 0.9));
    let correction = run(skeleton.job(target));
    assert_eq!(correction.reach, Reach::Reached);
    assert!(skeleton.off_ss(&correction, target) <= EXACT);
}

#[test]
fn the_end_joints_axes_do_not_matter() {
    let job =
        TwoBoneJob { pole: Some(Vec3::Y), ..Skeleton::square().job(DVec3::new(0.3, 0.8, 1.1)) };
    let expected = run(job);
    let nan = Mat3::from_cols(Vec3::NAN, Vec3::INFINITY, Vec3::ZERO);
    for axes in [Mat3::ZERO, Mat3::from_diagonal(Vec3::new(1.0, 2.0, 1.0)), nan] {
        let end = Affine3A::from_mat3_translation(axes, job.end.translation.into());
        assert_eq!(run(TwoBoneJob { end, ..job }), expected);
    }
}

#[test]
fn a_slightly_uneven_scale_is_exact_in_a_parent_and_not_reported_reached_in_a_joint() {
    let target = DVec3::new(0.2, 0.9, 0.8);
    let uneven = DVec3::new(1.0, 1.0009, 1.0);
    let parent = DAffine3::from_scale(uneven);
    let turned = |at: DVec3| Local {
        rotation: DQuat::from_euler(glam::EulerRot::XYZ, 0.5, 0.9, -0.4),
        ..Local::at(at)
    };
    let own =
        Skeleton { start: turned(DVec3::ZERO), middle: turned(DVec3::Y), ..Skeleton::square() };
    let skeleton = Skeleton { parent, ..own };
    is_at(&skeleton, &run(skeleton.job(target)), target);

    let skeleton = Skeleton { middle: Local { scale: uneven, ..own.middle }, ..own };
    let correction = run(skeleton.job(target));
    assert_ne!(correction.reach, Reach::Reached);
    assert!(correction.hand_error > 1e-6 && correction.hand_error < 1e-3);
}

#[test]
fn a_uniform_scale_in_pieces_is_not_too_uneven() {
    // Rounding of products of rotations and scales is far below one in a thousand.
    let step = Affine3A::from_scale_rotation_translation(
        Vec3::splat(1.01),
        Quat::from_axis_angle(Vec3::new(1.0, 2.0, 3.0).normalize(), 1.0),
        Vec3::X * 0.01,
    );
    let start = (0..100).fold(Affine3A::IDENTITY, |parent, _| parent * step);
    let middle = start * Affine3A::from_translation(Vec3::Y);
    let end = middle * Affine3A::from_translation(Vec3::X);
    let target = start.transform_point3(Vec3::new(0.2, 0.7, 0.9));
    let correction = run(TwoBoneJob::new(start, middle, end, target));
    assert_eq!(correction.reach, Reach::Reached);
}
