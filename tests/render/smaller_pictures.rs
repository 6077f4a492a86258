//! Scenes drawn at a smaller size and enlarged, as the window does while something moves, and at a
//! larger one, as it does at rest.

use ik_arm::document::{Camera, Display, Document, Overlay, Theme};
use ik_arm::kinematics::two_bone::TwoBone;
use ik_arm::render::{Canvas, Gpu, Renderer};
use ik_arm::rig::{Crowd, Processor};
use ik_arm::scene::Scene;
use ik_arm::session::Overlays;
use image::RgbaImage;
use image::imageops::thumbnail;
use pollster::block_on;

use crate::common::pictures::difference;

const SIZE: (u32, u32) = (724, 712);
const SCALES: [f32; 5] = [2.0, 0.85, 0.7, 0.6, 0.5];

struct Bench {
    gpu: Gpu,
    renderer: Renderer,
    canvas: Canvas,
}

impl Bench {
    fn new() -> Self {
        let gpu = block_on(Gpu::headless()).expect("a graphics adapter");
        let renderer = Renderer::new(&gpu);
        let canvas = Canvas::new(&gpu, SIZE.0, SIZE.1);
        Self { gpu, renderer, canvas }
    }

    fn draw(&mut self, scene: &Scene, scale: f32) -> RgbaImage {
        self.canvas.set_resolution_scale(&self.gpu, scale);
        self.renderer.draw(&self.gpu, scene, &self.canvas, 1.0);
        block_on(self.canvas.read(&self.gpu)).expect("a picture")
    }
}

fn scene(theme: Theme, overlays: impl IntoIterator<Item = Overlay>) -> Scene {
    let document = Document {
        display: Display::from_iter(overlays.into_iter().chain([Overlay::Cylinders])),
        ..Document::default()
    };
    Scene::new(&document.at(0.0), &Overlays::default(), theme)
}

const GUIDES: [Overlay; 12] = [
    Overlay::Cursor,
    Overlay::Pointer,
    Overlay::InnerLimit,
    Overlay::OuterLimit,
    Overlay::ElbowCircle,
    Overlay::Hand,
    Overlay::GridXy,
    Overlay::GridXz,
    Overlay::GridYz,
    Overlay::Ground,
    Overlay::Axes,
    Overlay::Shadow,
];

/// Means of red, green and blue in a square of a picture, from 0 to 255.
fn mean(image: &RgbaImage, [left, top]: [u32; 2], side: u32) -> [f64; 3] {
    let pixels = (0..side * side).map(|at| image.get_pixel(left + at % side, top + at / side));
    let sum = pixels.fold([0.0; 3], |sum: [f64; 3], pixel| {
        core::array::from_fn(|channel| sum[channel] + f64::from(pixel[channel]))
    });
    sum.map(|channel| channel / f64::from(side * side))
}

#[test]
fn a_picture_in_full_after_others_is_the_same_bit_for_bit() {
    let scene = scene(Theme::Dark, GUIDES.into_iter().chain([Overlay::Labels]));
    let expected = Bench::new().draw(&scene, 1.0);
    let mut bench = Bench::new();
    for scale in SCALES {
        assert!(bench.draw(&scene, scale) != expected, "it differs at {scale}");
        assert!(bench.draw(&scene, 1.0) == expected, "after {scale}");
    }
}

#[test]
fn colours_do_not_jump_when_the_picture_sharpens() {
    const SIDE: u32 = 60;
    for theme in [Theme::Dark, Theme::Light] {
        let mut bench = Bench::new();
        let scene = scene(theme, GUIDES);
        let full = bench.draw(&scene, 1.0);
        for scale in SCALES {
            let smaller = bench.draw(&scene, scale);
            let all = SIDE * (SIZE.0.min(SIZE.1) / SIDE);
            let [before, after] = [&smaller, &full].map(|image| mean(image, [0, 0], all));
            for (before, after) in before.into_iter().zip(after) {
                let off = (before - after).abs();
                assert!(off < 0.7, "the whole at {scale} in {theme:?} is off by {off}");
            }
            for at in (0..(all / SIDE).pow(2)).map(|at| [at % 11 * SIDE, at / 11 * SIDE]) {
                let [before, after] = [&smaller, &full].map(|image| mean(image, at, SIDE));
                for (before, after) in before.into_iter().zip(after) {
                    let off = (before - after).abs();
                    assert!(off < 6.0, "{at:?} at {scale} in {theme:?} is off by {off}");
                }
            }
        }
    }
}

#[test]
fn edges_of_a_finer_picture_have_more_tones() {
    let mut bench = Bench::new();
    let scene = scene(Theme::Light, []);
    let mut tones = |scale| {
        let picture = bench.draw(&scene, scale);
        let blues: std::collections::BTreeSet<_> = picture.pixels().map(|pixel| pixel[2]).collect();
        blues.len()
    };
    let (full, finer) = (tones(1.0), tones(Canvas::FINEST));
    assert!(finer > full, "{finer} tones of blue, {full} in full");
}

#[test]
fn far_arms_of_a_crowd_are_as_dense_as_in_full() {
    let mut bench = Bench::new();
    let bones = TwoBone::new(200.0, 300.0).expect("lengths");
    for arms in [2_000, 20_000, 100_000] {
        let crowd = Crowd { arms, bones, time: 3.25, processor: Processor::Cpu };
        let (centre, radius) = crowd.bounds();
        let camera = Camera::default().framing(centre, radius, 1.0);
        let document = Document { camera, ..Document::default() };
        let overlays = Overlays { crowd: Some(crowd), ..Overlays::default() };
        let mut scene = Scene::new(&document.at(0.0), &overlays, Theme::Dark);
        let with = [1.0, 0.5].map(|scale| bench.draw(&scene, scale));
        scene.crowd = None;
        let without = [1.0, 0.5].map(|scale| bench.draw(&scene, scale));
        // Only the brightness of small areas counts.
        let areas = |image: &RgbaImage| thumbnail(image, SIZE.0 / 12, SIZE.1 / 12);
        let added = [0, 1].map(|at| difference(&areas(&with[at]), &areas(&without[at])));
        let ratio = added[1] / added[0];
        assert!((ratio - 1.0).abs() < 0.06, "{arms} arms: {added:?}, {ratio}");
    }
}

#[test]
fn labels_are_as_sharp_as_in_full() {
    let mut bench = Bench::new();
    let [plain, labelled] = [scene(Theme::Dark, []), scene(Theme::Dark, [Overlay::Labels])];
    // Brightness that the labels add.
    let mut letters = |scale| {
        let (without, with) = (bench.draw(&plain, scale), bench.draw(&labelled, scale));
        let pixels = without.pixels().zip(with.pixels());
        pixels.map(|(without, with)| i32::from(with[1]) - i32::from(without[1])).collect::<Vec<_>>()
    };
    let (full, half) = (letters(1.0), letters(0.5));
    let bright = full.iter().filter(|added| **added > 60).count();
    assert!(bright > 100, "there are letters: {bright}");
    let off = full.iter().zip(&half).filter(|(full, half)| (**full - **half).abs() > 40).count();
    assert!(off * 20 < bright, "{off} pixels of {bright} differ");
}

#[test]
fn a_resolution_scale_is_limited() {
    let mut bench = Bench::new();
    for (wanted, scale) in [(2.0, 2.0), (3.0, 2.0), (0.0, 0.125), (-1.0, 0.125), (0.6, 0.6)] {
        bench.canvas.set_resolution_scale(&bench.gpu, wanted);
        assert_eq!(bench.canvas.resolution_scale(), scale);
        assert_eq!(bench.canvas.size(), SIZE);
    }
}
