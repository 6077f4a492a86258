//! Allocations per picture once everything has been drawn. The test has its own binary because its
//! allocator counts.

use crate::common::arm::{Arm, Cursor};
use allocation_counter::measure;
use glam::Vec3;
use ik_arm::document::{Display, Document, Overlay, SkeletonRig, Theme};
use ik_arm::kinematics::skeleton::{JointId, Skeleton};
use ik_arm::render::{Canvas, Gpu, Renderer};
use ik_arm::scene::{Ball, Line, Scene, SphereShell};
use ik_arm::session::Overlays;
use pollster::block_on;

const SIZE: (u32, u32) = (480, 300);

/// An arm with all its guides, and `more` balls and lines around it.
fn scene(hand: Vec3, more: usize) -> Scene {
    let arm = Arm { cursor: Cursor::unpinned(hand), ..Arm::default() };
    let display: Display = Overlay::all().collect();
    let document = Document { display, ..arm.document() };
    let mut scene = Scene::new(&document.at(0.0), &Overlays::default(), Theme::Dark);
    let colour = scene.palette.joint;
    for index in 0..more {
        let at = hand + Vec3::splat(index as f32 / more as f32);
        scene.balls.push(Ball { centre: at, radius: 3.0, colour });
        scene.lines.push(Line { from: at, to: Vec3::ZERO, colour, dashed: false });
    }
    scene
}

struct Bench {
    gpu: Gpu,
    canvas: Canvas,
    renderer: Renderer,
}

impl Bench {
    fn new() -> Self {
        let gpu = block_on(Gpu::headless()).expect("a graphics adapter");
        let canvas = Canvas::new(&gpu, SIZE.0, SIZE.1);
        let renderer = Renderer::new(&gpu);
        Self { gpu, canvas, renderer }
    }

    /// Number of allocations to upload a scene and to encode its draw commands.
    fn frame(&mut self, scene: &Scene) -> (u64, u64) {
        let Self { gpu, canvas, renderer } = self;
        let uploading = measure(|| renderer.upload(gpu, scene, canvas, 1.0));
        let mut commands = None;
        let encoding = measure(|| commands = Some(renderer.encode(gpu, canvas, None)));
        gpu.queue.submit(commands);
        gpu.device.poll(wgpu::PollType::wait_indefinitely()).expect("drawn");
        (uploading.count_total, encoding.count_total)
    }
}

fn least(costs: impl Iterator<Item = (u64, u64)>) -> (u64, u64) {
    costs.fold((u64::MAX, u64::MAX), |least, cost| (least.0.min(cost.0), least.1.min(cost.1)))
}

fn median(counts: &[u64]) -> u64 {
    let mut sorted = counts.to_vec();
    sorted.sort_unstable();
    sorted[sorted.len() / 2]
}

const HANDS: [Vec3; 3] =
    [Vec3::new(250.0, 120.0, 60.0), Vec3::new(180.0, 260.0, -90.0), Vec3::new(40.0, 330.0, 70.0)];

#[test]
fn an_unchanged_scene_allocates_and_uploads_nothing() {
    let mut bench = Bench::new();
    let scene = scene(HANDS[0], 1000);
    bench.frame(&scene);
    assert!(bench.renderer.counts().uploaded > 1000 * 80);
    for _ in 0..5 {
        let (uploading, _) = bench.frame(&scene);
        assert_eq!((uploading, bench.renderer.counts().uploaded), (0, 0));
    }
}

/// A skeleton of one joint with its name.
fn named(name: &str) -> Scene {
    let mut document = Document::new(SkeletonRig::default());
    *document.skeleton_mut() = Skeleton::with_root(name);
    let overlays = Overlays { selection: vec![JointId::new(0)], ..Overlays::default() };
    Scene::new(&document.at(0.0), &overlays, Theme::Dark)
}

#[test]
fn a_letter_is_rasterized_and_uploaded_once() {
    let mut bench = Bench::new();
    // The last is in no font of the program.
    let names = ["Hand", "Hüfte", "左手"];
    let scenes = names.map(named);
    for scene in &scenes {
        bench.frame(scene);
    }
    let mut sent = Vec::new();
    for _ in 0..3 {
        sent = scenes
            .each_ref()
            .map(|scene| {
                bench.frame(scene);
                bench.renderer.counts().uploaded
            })
            .into();
        let (uploading, _) = bench.frame(&scenes[2]);
        assert_eq!((uploading, bench.renderer.counts().uploaded), (0, 0));
    }
    let letters = 9 * 48 * 7;
    assert!(sent.iter().all(|sent| *sent < letters), "places of letters alone: {sent:?}");
    let [new, _, known] = ["Hände", "Hand", "Hände"].map(|name| {
        bench.frame(&named(name));
        bench.renderer.counts().uploaded
    });
    assert!(new > known, "a new letter");
}

#[test]
fn only_changes_are_uploaded() {
    let mut bench = Bench::new();
    let mut scene = scene(HANDS[0], 1000);
    bench.frame(&scene);
    let last = scene.balls.last_mut().expect("a ball");
    last.centre += Vec3::Y;
    bench.frame(&scene);
    let a_ball = bench.renderer.counts().uploaded;
    assert!(a_ball > 0 && a_ball < 200, "{a_ball} bytes for a ball");
    // So little that nothing comes near enough for a finer mesh.
    scene.camera.yaw += 1e-4;
    scene.labels.clear();
    bench.frame(&scene);
    let a_view = bench.renderer.counts().uploaded;
    assert!(a_view > 0 && a_view < 1000, "{a_view} bytes for a view");
}

#[test]
fn allocations_of_a_changed_picture_do_not_depend_on_the_scene_size() {
    let mut bench = Bench::new();
    let mut costs = Vec::new();
    for more in [20, 200, 2_000] {
        let scenes = HANDS.map(|hand| scene(hand, more));
        let rounds: Vec<_> =
            (0..6).map(|_| scenes.each_ref().map(|scene| bench.frame(scene))).collect();
        // Once in a while a list of wgpu's own grows.
        costs.push([0, 1, 2].map(|scene| least(rounds[2..].iter().map(|round| round[scene]))));
        assert!(bench.renderer.counts().uploaded > more as u64 * 80, "all of it has changed");
    }
    assert!(costs.iter().all(|cost| *cost == costs[0]), "{costs:?}");
}

#[test]
fn allocations_of_shells_do_not_depend_on_their_number() {
    let mut bench = Bench::new();
    let mut costs = Vec::new();
    for count in [4_u8, 40] {
        let scenes = HANDS.map(|hand| {
            let mut scene = scene(hand, 20);
            let colour = scene.palette.guide;
            scene.shells.extend((0..count).map(|step| {
                let part = f32::from(step);
                SphereShell { centre: hand * part / 10.0, radius: 20.0 + part, colour }
            }));
            scene
        });
        let rounds: Vec<_> =
            (0..4).map(|_| scenes.each_ref().map(|scene| bench.frame(scene))).collect();
        costs.push([0, 1, 2].map(|scene| least(rounds[2..].iter().map(|round| round[scene]))));
        bench.frame(&scenes[2]);
        assert_eq!(bench.frame(&scenes[2]).0, 0, "nothing has changed");
    }
    assert_eq!(costs[0], costs[1]);
}

#[test]
fn allocations_per_picture_do_not_grow() {
    let mut bench = Bench::new();
    let scenes = HANDS.map(|hand| scene(hand, 100));
    let frames: Vec<_> =
        (0..60).map(|frame| bench.frame(&scenes[frame % scenes.len()]).1).collect();
    let (middle, last) = (median(&frames[20..40]), median(&frames[40..]));
    assert_eq!(middle, last, "{frames:?}");
}
