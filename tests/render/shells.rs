//! Pictures of transparent spheres, drawn from back to front.

use glam::{Mat3, Vec2, Vec3};
use ik_arm::document::{Camera, Document, Theme};
use ik_arm::kinematics::twist::TwistReference;
use ik_arm::render::PictureRenderer;
use ik_arm::scene::{Ball, Colour, Globe, Scene, SphereShell};
use ik_arm::session::Overlays;
use image::RgbaImage;
use pollster::block_on;

use crate::pictures::{GPU, SIZE, check, compare, draw};

const RED: Colour = Colour([230, 60, 50, 255]);
const GREEN: Colour = Colour([70, 200, 80, 255]);
const BLUE: Colour = Colour([60, 110, 240, 255]);
const WHITE: Colour = Colour([255; 4]);

fn shell(centre: Vec3, radius: f32, colour: Colour) -> SphereShell {
    SphereShell { centre, radius, colour }
}

/// Three nested, one beside them, one behind, and two that intersect.
fn shells() -> Vec<SphereShell> {
    vec![
        shell(Vec3::ZERO, 150.0, RED),
        shell(Vec3::new(20.0, 10.0, 0.0), 90.0, GREEN),
        shell(Vec3::new(30.0, 0.0, 20.0), 40.0, BLUE),
        shell(Vec3::new(230.0, 20.0, 40.0), 70.0, WHITE),
        shell(Vec3::new(-60.0, 40.0, -400.0), 160.0, BLUE),
        shell(Vec3::new(-270.0, -30.0, 60.0), 90.0, GREEN),
        shell(Vec3::new(-330.0, 40.0, 40.0), 70.0, RED),
    ]
}

/// Nothing but shells before an empty sky.
fn scene(shells: Vec<SphereShell>) -> Scene {
    let document = Document { display: [].into_iter().collect(), ..Document::default() };
    let mut scene = Scene::new(&document.at(0.0), &Overlays::default(), Theme::Dark);
    scene.solids.clear();
    scene.balls.clear();
    scene.camera =
        Camera { target: Vec3::ZERO, yaw: 0.4, pitch: 0.3, distance: 900.0, orthographic: false };
    scene.shells = shells;
    scene
}

fn seen_from(camera: Camera, shells: Vec<SphereShell>) -> Scene {
    let mut scene = scene(shells);
    scene.camera = camera;
    scene
}

#[test]
fn nested_and_separate_shells() {
    let mut scene = scene(shells());
    // One inside of all, one between, one in front.
    for (centre, radius) in
        [(Vec3::new(30.0, 0.0, 20.0), 18.0), (Vec3::new(-100.0, 30.0, 20.0), 22.0)]
    {
        scene.balls.push(Ball { centre, radius, colour: WHITE });
    }
    check("shells", &scene);
}

#[test]
fn each_shell_is_visible() {
    let all = draw(&scene(shells()));
    for left_out in 0..shells().len() {
        let mut others = shells();
        others.remove(left_out);
        let without = draw(&scene(others));
        assert!(compare(&all, &without).is_err(), "shell {left_out} is not missed");
    }
}

#[test]
fn the_order_of_the_list_changes_no_pixel() {
    let mut globe = scene(shells());
    globe.add_globe(Globe {
        centre: Vec3::ZERO,
        radius: 150.0,
        reference: TwistReference::Up,
        axes: Mat3::IDENTITY,
    });
    for mut scene in [scene(shells()), globe] {
        let expected = draw(&scene);
        for _ in 1..scene.shells.len() {
            scene.shells.rotate_left(1);
            assert!(draw(&scene) == expected, "{:?}", scene.shells);
        }
        scene.shells.reverse();
        assert!(draw(&scene) == expected);
    }
}

#[test]
fn a_shell_without_a_size_is_not_drawn() {
    let expected = draw(&scene(shells()));
    let mut with = scene(shells());
    for (centre, radius) in [
        (Vec3::ZERO, 0.0),
        (Vec3::ZERO, -10.0),
        (Vec3::ZERO, f32::NAN),
        (Vec3::ZERO, f32::INFINITY),
        (Vec3::ZERO, f32::MAX),
        (Vec3::NAN, 10.0),
    ] {
        with.shells.insert(2, shell(centre, radius, WHITE));
    }
    assert!(draw(&with) == expected);
}

const SIDE: u32 = 240;

fn square(scene: &Scene) -> RgbaImage {
    let gpu = GPU.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
    block_on(PictureRenderer::new(&gpu, SIDE, SIDE, 1.0).draw(scene)).expect("drawn")
}

/// Colour at a pixel, from the sides of the shells that its ray meets, from the farthest to the
/// nearest, and in reverse order; `None` near a rim.
fn expected(scene: &Scene, at: (u32, u32), sky: [f64; 3]) -> Option<(usize, [[f64; 3]; 2])> {
    let ray = scene.camera.projection(1.0).ray(Vec2::new(
        (at.0 as f32 + 0.5) / SIDE as f32 * 2.0 - 1.0,
        1.0 - (at.1 as f32 + 0.5) / SIDE as f32 * 2.0,
    ));
    let (origin, direction) = (ray.origin.as_dvec3(), ray.direction.as_dvec3().normalize());
    // Near a rim a pixel is only partly covered.
    const RIM: f64 = 4.0;
    let mut sides = Vec::new();
    for shell in &scene.shells {
        let (from_centre, radius) = (origin - shell.centre.as_dvec3(), f64::from(shell.radius));
        let middle = -from_centre.dot(direction);
        let miss = (from_centre + direction * middle).length();
        if (miss - radius).abs() < RIM {
            return None;
        }
        let half = (radius * radius - miss * miss).max(0.0).sqrt();
        let opacity = 0.045 + 0.5 * (1.0 - half / radius).powi(5);
        for along in [middle - half, middle + half] {
            if half > 0.0 && (along > 0.0 || scene.camera.orthographic) {
                sides.push((along, opacity, shell.colour.channels().map(f64::from)));
            }
        }
    }
    sides.sort_by(|a, b| b.0.total_cmp(&a.0));
    let right = sides.iter().fold(sky, laid_over);
    Some((sides.len(), [right, sides.iter().rev().fold(sky, laid_over)]))
}

fn laid_over(behind: [f64; 3], (_, opacity, colour): &(f64, f64, [f64; 4])) -> [f64; 3] {
    [0, 1, 2].map(|channel| behind[channel] * (1.0 - opacity) + colour[channel] * opacity)
}

#[test]
fn every_pixel_has_the_sides_of_the_shells_from_back_to_front() {
    // Each side is laid over in steps of the picture's colours.
    let off = |sides: usize| (1.5 + 0.5 * sides as f64) / 255.0;
    let nested = (1_u8..=5).map(|step| {
        let (part, colour) = (f32::from(step), [RED, GREEN, BLUE][usize::from(step) % 3]);
        shell(Vec3::new(3.0 * part, -2.0 * part, 4.0 * part), 160.0 - 27.0 * part, colour)
    });
    let apart = shells()[3..5].to_vec();
    let shells: Vec<_> = nested.chain(apart).collect();
    let outside = scene(shells.clone()).camera;
    let mut told_apart = 0;
    for camera in [
        outside,
        Camera { yaw: 3.6, ..outside },
        Camera { orthographic: true, ..outside },
        Camera { target: Vec3::new(20.0, 0.0, 10.0), distance: 60.0, yaw: 2.0, ..outside },
    ] {
        let scene = seen_from(camera, shells.clone());
        let drawn = square(&scene);
        let sky = square(&seen_from(camera, Vec::new()));
        let screen =
            |pixel: &image::Rgba<u8>| [0, 1, 2].map(|channel| f64::from(pixel.0[channel]) / 255.0);
        let mut compared = 0;
        for (x, y, pixel) in drawn.enumerate_pixels().step_by(7) {
            let Some((sides, [expected, reversed])) =
                expected(&scene, (x, y), screen(sky.get_pixel(x, y)))
            else {
                continue;
            };
            let seen = screen(pixel);
            let is_near =
                |a: [f64; 3], b: [f64; 3]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < off(sides));
            assert!(is_near(seen, expected), "{camera:?} at {x}, {y}: {seen:?}, not {expected:?}");
            compared += 1;
            told_apart += u32::from(!is_near(expected, reversed));
        }
        assert!(compared > 2000, "only {compared} pixels");
    }
    assert!(told_apart > 50, "only {told_apart} pixels tell the order");
}

#[test]
fn solids_hide_only_the_shells_behind_them() {
    let ball = |z: f32| Ball { centre: Vec3::Z * z, radius: 60.0, colour: WHITE };
    let middle = |scene: &Scene| *draw(scene).get_pixel(SIZE.0 / 2, SIZE.1 / 2);
    let camera = Camera { yaw: 0.0, pitch: 0.0, ..scene(Vec::new()).camera };
    let drawn = |shells: Vec<SphereShell>, z| {
        let mut scene = seen_from(camera, shells);
        scene.balls.push(ball(z));
        middle(&scene)
    };
    let around = vec![shell(Vec3::ZERO, 200.0, RED)];
    let before = drawn(Vec::new(), 300.0);
    assert_eq!(drawn(around.clone(), 300.0), before, "in front of both sides");
    let inside = drawn(Vec::new(), 0.0);
    assert_ne!(drawn(around.clone(), 0.0), inside, "behind the near side");
    let behind = drawn(Vec::new(), -400.0);
    let [one, both] =
        [drawn(around.clone(), 0.0), drawn(around, -400.0)].map(|pixel| i16::from(pixel.0[1]));
    let [without_one, without_both] = [inside, behind].map(|pixel| i16::from(pixel.0[1]));
    assert!(without_both - both > without_one - one, "two sides hide more than one");
}

#[test]
fn a_hundred_shells_are_drawn() {
    let many = |count: u16| {
        let shells = (0..count).map(|step| {
            let (column, row) = (f32::from(step % 12), f32::from(step / 12));
            let centre = Vec3::new(column * 60.0 - 330.0, row * 50.0 - 200.0, -row * 20.0);
            shell(centre, 22.0, [RED, GREEN, BLUE, WHITE][usize::from(step) % 4])
        });
        let camera = Camera { yaw: 0.0, pitch: 0.0, distance: 1100.0, ..scene(Vec::new()).camera };
        draw(&seen_from(camera, shells.collect()))
    };
    let (most, all) = (many(99), many(100));
    let changed = most.pixels().zip(all.pixels()).filter(|(a, b)| a != b).count();
    assert!((50..2000).contains(&changed), "the last one is {changed} pixels");
}
