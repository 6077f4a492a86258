//! Scenes and pictures of the hard cases.

use glam::Vec3;
use ik_arm::document::{Document, Theme, Track};
use ik_arm::io::{Example, ExampleGroup};
use ik_arm::rig::TaperedCylinder;
use ik_arm::scene::Scene;
use ik_arm::session::Overlays;
use pollster::block_on;

use crate::gallery::{opened, times};

#[test]
fn every_number_of_every_picture_is_finite_and_the_limbs_are_in_it() {
    for example in Example::of(ExampleGroup::HardCases) {
        let document = opened(example.name);
        for time in times(&document) {
            let posed = document.at(time);
            let overlays = Overlays::new(&Track::new(&document), &posed);
            let scene = Scene::new(&posed, &overlays, Theme::Dark);
            let at = format!("{} at {time}", example.name);
            assert!(numbers(&scene).all(f32::is_finite), "{at}");
            let projection = scene.camera.projection(1.6);
            // The limb that is a thousand times longer leaves the picture towards its root.
            let from = usize::from(example.name == "thousand-to-one");
            for ball in &scene.balls[from..3] {
                let seen = projection.project(ball.centre).expect("before the eye");
                assert!(seen.abs().max_element() < 0.97, "{at}: {} is at {seen}", ball.centre);
                let size = ball.radius / projection.half_height_at(ball.centre);
                assert!(size > 0.004, "{at}: {size} of half the picture");
            }
        }
    }
}

#[test]
fn grid_cells_scale_with_the_rig() {
    assert_eq!(Document::default().grid_cell(), 100.0);
    for example in Example::of(ExampleGroup::HardCases) {
        let document = opened(example.name);
        let planes = Scene::new(&document.at(0.0), &Overlays::default(), Theme::Dark).planes;
        let cells = planes.radius / planes.cell;
        assert!((3.0..35.0).contains(&cells), "{}: {cells}", example.name);
    }
}

/// All numbers of a scene except texts and colours.
fn numbers(scene: &Scene) -> impl Iterator<Item = f32> {
    let solids = scene.solids.iter().chain(&scene.guide_solids).flat_map(|solid| {
        let TaperedCylinder { length, base_radius, tip_radius } = solid.shape;
        let shape = [length, base_radius, tip_radius];
        solid.transform.to_cols_array().into_iter().chain(shape)
    });
    let round = |centre: Vec3, radius: f32| centre.extend(radius).to_array();
    let balls = scene.balls.iter().chain(&scene.guide_balls);
    let balls = balls.flat_map(move |ball| round(ball.centre, ball.radius));
    let shells = scene.shells.iter().flat_map(move |shell| round(shell.centre, shell.radius));
    let lines = scene.lines.iter().flat_map(|line| [line.from, line.to]);
    let lines = lines.flat_map(|at| at.to_array());
    let labels = scene.labels.iter().flat_map(move |label| round(label.at, label.clearance));
    let shadows = scene.shadows.iter().flat_map(move |shadow| {
        let ends = [(shadow.base, shadow.base_radius), (shadow.tip, shadow.tip_radius)];
        ends.into_iter().flat_map(move |(at, radius)| round(at, radius))
    });
    let planes =
        round(scene.planes.centre, scene.planes.radius).into_iter().chain([scene.planes.cell]);
    let view = scene.camera.projection(1.6).clip_from_world.to_cols_array();
    let placed = solids.chain(balls).chain(shells).chain(lines).chain(labels).chain(shadows);
    placed.chain(planes).chain(view)
}

/// In every hard case the rig covers a part of the picture, but not all of it.
#[cfg(feature = "app")]
#[test]
fn every_hard_case_is_drawn() {
    let gpu = block_on(ik_arm::render::Gpu::headless()).expect("a graphics adapter");
    let mut picture = ik_arm::render::PictureRenderer::new(&gpu, 240, 150, 1.0);
    for example in Example::of(ExampleGroup::HardCases) {
        let document = opened(example.name);
        let mut scene = Scene::new(&document.at(0.0), &Overlays::default(), Theme::Dark);
        let with = block_on(picture.draw(&scene)).expect("drawn");
        scene.solids.clear();
        scene.balls.clear();
        let without = block_on(picture.draw(&scene)).expect("drawn");
        let differing = with.pixels().zip(without.pixels()).filter(|(a, b)| a != b).count();
        let part = differing as f64 / (240.0 * 150.0);
        assert!((0.01..0.5).contains(&part), "{}: {part}", example.name);
    }
}
