//! Crowds of arms with their own targets, solved on the CPU and the GPU.

use glam::{DVec3, Vec3};
use ik_arm::document::{AxisView, Camera, Document, Theme};
use ik_arm::kinematics::two_bone::TwoBone;
use ik_arm::render::{CrowdSolver, Gpu, PictureRenderer};
use ik_arm::rig::{Crowd, CrowdArrays, Processor};
use ik_arm::scene::Scene;
use ik_arm::session::{Overlays, PlaybackAction, Session, ViewAction};
use image::RgbaImage;
use pollster::block_on;

use crate::common::Random;
use crate::common::pictures::difference;

fn crowd(arms: u32) -> Crowd {
    let bones = TwoBone::new(200.0, 300.0).expect("lengths");
    Crowd { arms, bones, time: 3.25, processor: Processor::Cpu }
}

fn arrays(crowd: &Crowd) -> CrowdArrays {
    let mut arrays = CrowdArrays::default();
    arrays.resize(crowd);
    arrays.set_targets(crowd);
    arrays
}

fn at(of: &[Vec<f32>; 3], arm: usize) -> Vec3 {
    Vec3::from_array([0, 1, 2].map(|axis| of[axis][arm]))
}

/// φ in degrees, from points.
fn elbow_angle(elbow: DVec3, hand: DVec3) -> f64 {
    (-elbow).angle_between(hand - elbow).to_degrees()
}

/// Solves `arrays` on the GPU and by the batch solver, and compares: hands and lengths to 1e-5 of
/// the arm, elbows too where they are well bent.
fn agree(gpu: &Gpu, bones: TwoBone, arrays: &mut CrowdArrays) {
    let mut solver = CrowdSolver::new(gpu).expect("compute shaders");
    solver.reserve(gpu, arrays.len() as u32);
    solver.solve(gpu, bones, arrays).expect("a device");
    let [elbows, hands] = block_on(solver.read(gpu)).expect("poses");
    arrays.solve(bones).expect("a batch");
    let length = f64::from(bones.outer_limit());
    for arm in 0..arrays.len() {
        let [elbow, hand] = [at(&elbows, arm), at(&hands, arm)].map(Vec3::as_dvec3);
        let [elbow_here, hand_here] =
            [at(&arrays.elbow, arm), at(&arrays.hand, arm)].map(Vec3::as_dvec3);
        let within = |what: &str, error: f64, bound: f64| {
            let cursor = at(&arrays.cursor, arm);
            assert!(error.abs() <= bound * length, "{what} of {arm} at {cursor}: {error:e}");
        };
        within("the hand", hand.distance(hand_here), 1e-5);
        within("the upper limb", elbow.length() - f64::from(bones.upper()), 1e-5);
        within("the lower limb", elbow.distance(hand) - f64::from(bones.lower()), 1e-5);
        let is_bent = (1.0..=179.0).contains(&elbow_angle(elbow_here, hand_here));
        within("the elbow", elbow.distance(elbow_here), if is_bent { 1e-5 } else { 1e-3 });
    }
}

#[test]
fn device_and_batch_agree_on_a_hundred_thousand_random_arms() {
    let gpu = block_on(Gpu::headless()).expect("a device");
    let mut random = Random(11);
    for (upper, lower, arms) in [(200.0, 300.0, 100_000), (1.0, 1.0, 10_000), (0.3, 9.0, 10_000)] {
        let bones = TwoBone::new(upper, lower).expect("lengths");
        let mut arrays = arrays(&Crowd { bones, ..crowd(arms) });
        for arm in 0..arrays.len() {
            let cursor = random.direction() * bones.outer_limit() * random.within(0.0..1.3);
            for (axis, part) in cursor.to_array().into_iter().enumerate() {
                arrays.cursor[axis][arm] = part;
            }
            let twist = random.within(-4.0..4.0);
            (arrays.sin[arm], arrays.cos[arm]) = twist.sin_cos();
        }
        agree(&gpu, bones, &mut arrays);
    }
}

#[test]
fn device_and_batch_agree_where_a_cursor_has_no_direction_and_on_the_limits() {
    let gpu = block_on(Gpu::headless()).expect("a device");
    for (upper, lower) in [(200.0, 300.0), (250.0, 250.0), (300.0, 200.0)] {
        let bones = TwoBone::new(upper, lower).expect("lengths");
        let axes = [Vec3::X, Vec3::Y, Vec3::Z, -Vec3::X, -Vec3::Y, -Vec3::Z];
        let fars = [0.0, 1e-20, 1.0, 100.0, 250.0, 499.0, 500.0, 501.0, 1e6];
        let cursors =
            axes.into_iter().flat_map(|axis| fars.map(|far| axis * far)).collect::<Vec<_>>();
        let mut arrays = arrays(&Crowd { bones, ..crowd(cursors.len() as u32) });
        for (arm, cursor) in cursors.into_iter().enumerate() {
            for (axis, part) in cursor.to_array().into_iter().enumerate() {
                arrays.cursor[axis][arm] = part;
            }
        }
        agree(&gpu, bones, &mut arrays);
    }
}

#[test]
fn twists_are_angles_and_targets_stay_near_their_arm_and_loop() {
    let mut crowd = crowd(20_000);
    let mut first = None;
    for step in 0..=8 {
        crowd.time = Crowd::PERIOD * step as f32 / 8.0;
        let arrays = arrays(&crowd);
        let mut reached = 0;
        for arm in 0..arrays.len() {
            let (cos, sin) = (f64::from(arrays.cos[arm]), f64::from(arrays.sin[arm]));
            assert!((cos * cos + sin * sin - 1.0).abs() < 1e-6, "{cos}, {sin}");
            let far = at(&arrays.cursor, arm).length() / crowd.bones.outer_limit();
            assert!((0.1..1.6).contains(&far), "a target is {far} arms away");
            reached += usize::from(far <= 1.0);
        }
        assert!((5_000..19_500).contains(&reached), "{reached} are in reach: all or none is dull");
        match &first {
            None => first = Some(arrays.cursor),
            Some(first) if step == 8 => assert_eq!(*first, arrays.cursor),
            Some(first) => assert_ne!(*first, arrays.cursor),
        }
    }
}

#[test]
fn adding_arms_does_not_move_the_existing_ones() {
    let few = arrays(&crowd(100));
    let mut arrays = few;
    let shoulders = arrays.shoulder.clone();
    arrays.resize(&crowd(5_000));
    for (before, after) in shoulders.iter().zip(&arrays.shoulder) {
        assert_eq!(before[..], after[..100]);
    }
    let bounds = crowd(5_000).bounds().1;
    for (x, z) in arrays.shoulder[0].iter().zip(&arrays.shoulder[1]) {
        assert!(x.hypot(*z) + 500.0 <= bounds * 1.001);
    }
}

#[test]
fn a_crowd_made_smaller_is_drawn_like_a_new_one() {
    let gpu = block_on(Gpu::headless()).expect("a device");
    let (mut used, mut new) = (picture(&gpu), picture(&gpu));
    for arms in [30, 3_000] {
        draw(&mut used, &crowd(arms), near());
    }
    let small = crowd(200);
    assert!(draw(&mut used, &small, near()) == draw(&mut new, &small, near()));
}

#[test]
fn a_crowd_looks_the_same_solved_on_the_cpu_or_the_gpu() {
    let gpu = block_on(Gpu::headless()).expect("a device");
    let mut picture = picture(&gpu);
    let here = draw(&mut picture, &crowd(500), near());
    let there = Crowd { processor: Processor::Gpu, ..crowd(500) };
    let there = draw(&mut picture, &there, near());
    let differing = here
        .pixels()
        .zip(there.pixels())
        .filter(|(a, b)| a.0.iter().zip(b.0).any(|(a, b)| a.abs_diff(b) > 24));
    let count = differing.count();
    assert!(count < 40, "{count} pixels differ");
    let empty = draw(&mut picture, &Crowd { arms: 1, ..crowd(1) }, behind());
    assert!(here != empty);
}

#[test]
fn arms_near_and_far_have_the_colours_of_their_limbs() {
    let gpu = block_on(Gpu::headless()).expect("a device");
    for radius in [600.0, 5_000.0, 30_000.0] {
        let camera = Camera::default().framing(Vec3::ZERO, radius, 1.0);
        let image = draw(&mut picture(&gpu), &crowd(1_000), camera);
        let warm = image.pixels().filter(|p| p.0[0] > p.0[2].saturating_add(40)).count();
        let cold = image.pixels().filter(|p| p.0[2] > p.0[0].saturating_add(40)).count();
        assert!(warm > 100 && cold > 100, "{warm} warm and {cold} cold pixels at {radius}");
    }
}

/// From above, with limbs of this radius in pixels.
fn above(radius: f32) -> Camera {
    let camera = Camera::default().along(AxisView::Top);
    let pixel = 2.0 * camera.projection(1.6).up.length() / 200.0;
    let base_radius = 0.05 * crowd(1).bones.outer_limit();
    Camera { distance: camera.distance * base_radius / (radius * pixel), ..camera }
}

#[test]
fn a_crowd_covers_as_much_of_the_picture_with_points_as_with_lines() {
    let gpu = block_on(Gpu::headless()).expect("a device");
    let mut picture = picture(&gpu);
    let mut covered = |radius: f32| {
        let crowd = draw(&mut picture, &crowd(20_000), above(radius));
        difference(&crowd, &draw_without(&mut picture, above(radius)))
    };
    let (lines, points) = (covered(0.1001), covered(0.0999));
    assert!((points / lines - 1.0).abs() < 0.05, "{lines} with lines, {points} with points");
}

#[test]
fn arms_behind_the_camera_are_not_drawn() {
    let gpu = block_on(Gpu::headless()).expect("a device");
    let with = draw(&mut picture(&gpu), &crowd(1), behind());
    assert!(with == draw_without(&mut picture(&gpu), behind()));
}

#[test]
fn a_session_shows_and_moves_a_crowd_without_changing_the_document() {
    let mut session = Session::default();
    let before = session.document().clone();
    assert_eq!(session.crowd(), None);
    session.apply(ViewAction::ShowCrowd(true));
    session.apply(ViewAction::SetCrowdSize(0));
    assert_eq!(session.crowd().map(|crowd| crowd.arms), Some(1));
    session.apply(ViewAction::SetCrowdSize(u32::MAX));
    assert_eq!(session.crowd().map(|crowd| crowd.arms), Some(Crowd::MOST));
    session.apply(ViewAction::SetCrowdSize(40));
    for time in [10.0, 12.0] {
        session.apply(PlaybackAction::Advance(time));
    }
    assert_eq!(session.crowd().map(|crowd| crowd.time), Some(2.0));
    session.apply(ViewAction::AnimateCrowd(false));
    session.apply(PlaybackAction::Advance(15.0));
    assert_eq!(session.crowd().map(|crowd| crowd.time), Some(2.0));
    assert!(!session.is_moving());
    session.apply(ViewAction::AnimateCrowd(true));
    session.apply(PlaybackAction::Advance(100.0));
    assert_eq!(session.crowd().map(|crowd| crowd.time), Some(2.0), "a pause is no time");
    session.apply(ViewAction::ShowCrowd(false));
    session.apply(PlaybackAction::Advance(120.0));
    assert_eq!(session.crowd(), None);
    let after = Document { camera: before.camera, ..session.document().clone() };
    assert_eq!(after, before);
    assert_eq!(session.history().undo_label(), None);
}

fn picture(gpu: &Gpu) -> PictureRenderer<'_> {
    block_on(PictureRenderer::of_size(gpu, 320, 200)).expect("a canvas")
}

fn near() -> Camera {
    Camera::default().framing(Vec3::ZERO, 3_000.0, 1.0)
}

/// With the only arm behind it.
fn behind() -> Camera {
    let camera = Camera::default();
    let (back, _, _) = camera.basis();
    Camera { target: camera.target - back * 30_000.0, ..camera }
}

fn draw(picture: &mut PictureRenderer<'_>, crowd: &Crowd, camera: Camera) -> RgbaImage {
    block_on(picture.draw(&scene(crowd, camera))).expect("a picture")
}

/// Draws what is around a crowd.
fn draw_without(picture: &mut PictureRenderer<'_>, camera: Camera) -> RgbaImage {
    let mut scene = scene(&crowd(1), camera);
    scene.crowd = None;
    block_on(picture.draw(&scene)).expect("a picture")
}

fn scene(crowd: &Crowd, camera: Camera) -> Scene {
    let document = Document { camera, ..Document::default() };
    let overlays = Overlays { crowd: Some(*crowd), ..Overlays::default() };
    Scene::new(&document.at(0.0), &overlays, Theme::Dark)
}

#[test]
fn a_crowd_whose_squared_lengths_overflow_is_not_drawn() {
    for length in [1e-30, 1e19, 1e38] {
        let bones = TwoBone::new(length, length).expect("lengths");
        let overlays =
            Overlays { crowd: Some(Crowd { bones, ..crowd(10) }), ..Overlays::default() };
        assert_eq!(
            Scene::new(&Document::default().at(0.0), &overlays, Theme::Dark).crowd,
            None,
            "{length}"
        );
    }
}
