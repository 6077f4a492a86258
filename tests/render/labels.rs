//! Pictures of joint names, with letters that fonts have and letters that no font has.

use crate::common::arm::ArmDocument;
use glam::{Vec2, Vec3};
use ik_arm::document::{Display, Document, Overlay, SkeletonRig, Theme};
use ik_arm::kinematics::skeleton::{Joint, JointId, Skeleton};
use ik_arm::render::{Canvas, Gpu, PictureRenderer, Renderer};
use ik_arm::scene::Scene;
use ik_arm::session::Overlays;
use image::RgbaImage;
use pollster::block_on;

use crate::common::Random;
use crate::pictures::{GPU, draw};

/// Private use area: no font has this letter.
const NO_LETTER: char = '\u{10fffd}';

/// Names of joints that are too small to be visible.
fn named(names: &[&str]) -> Scene {
    let mut skeleton = Skeleton::default();
    for (row, name) in names.iter().enumerate() {
        let at = Vec3::new(-300.0, 180.0 - 24.0 * row as f32, 0.0);
        let joint = Joint { offset: at, ..Joint::new(name, None, Vec3::X * 1e-3) };
        skeleton.add(joint).expect("a joint");
    }
    let mut document = Document::new(SkeletonRig::default());
    *document.skeleton_mut() = skeleton;
    document.display = Display::from_iter([Overlay::Labels]);
    let selection = (0..names.len()).map(JointId::new).collect();
    let mut scene =
        Scene::new(&document.at(0.0), &Overlays { selection, ..Overlays::default() }, Theme::Dark);
    assert_eq!(scene.labels.len(), names.len());
    scene.solids.clear();
    scene.balls.clear();
    scene.camera.target = Vec3::ZERO;
    scene
}

/// Number of pixels as light as text.
fn lit(image: &RgbaImage) -> usize {
    lighter_than(180, image)
}

fn lighter_than(light: u8, image: &RgbaImage) -> usize {
    image.pixels().filter(|pixel| pixel.0[1] > light).count()
}

fn lit_by(name: &str) -> usize {
    lit(&draw(&named(&[name])))
}

#[test]
fn a_name_is_drawn() {
    assert_eq!(lit(&draw(&named(&[]))), 0);
    assert!(lit_by("Hand") > 30);
}

#[test]
fn the_dots_of_an_umlaut_are_drawn() {
    let light = |name: &str| -> u64 {
        draw(&named(&[name])).pixels().map(|pixel| u64::from(pixel.0[1])).sum()
    };
    assert!(light("Hüfte") > light("Hufte") + 200);
    assert_eq!(draw(&named(&["Hu\u{308}fte"])), draw(&named(&["Hüfte"])));
}

#[test]
fn a_letter_that_no_font_has_is_a_box() {
    let boxed = lit_by(&NO_LETTER.to_string());
    // The height of a capital letter at 15 points, and at least a pixel wide.
    assert!((16..120).contains(&boxed), "{boxed}");
    assert_eq!(lit_by(&NO_LETTER.to_string().repeat(3)), 3 * boxed);
}

#[test]
fn letters_of_any_script_are_drawn_or_boxes() {
    /// No pixel without text is as light.
    const BACKDROP: u8 = 90;
    assert_eq!(lighter_than(BACKDROP, &draw(&named(&[]))), 0);
    for name in ["左手", "왼손", "يد", "Рука", "χέρι", "हाथ", "🖐"] {
        // Joined letters have thin strokes.
        assert!(lighter_than(BACKDROP, &draw(&named(&[name]))) > 16, "{name}");
    }
}

#[test]
fn invisible_characters_change_nothing() {
    let plain = draw(&named(&["ab"]));
    for letter in ['\n', '\u{200b}', '\u{feff}', '\u{202e}', '\u{7}'] {
        assert!(draw(&named(&[&format!("a{letter}b")])) == plain, "{letter:?}");
    }
}

/// In rows of fifty.
fn rows(letters: impl Iterator<Item = char>) -> Vec<String> {
    let letters: Vec<_> = letters.collect();
    letters.chunks(50).map(|row| row.iter().collect()).collect()
}

#[test]
fn a_thousand_different_letters_are_drawn_at_any_scale() {
    let latin = rows(('\u{a1}'..).filter(|letter| letter.is_alphabetic()).take(1000));
    let ideographs = rows(('\u{4e00}'..).take(1000));
    let gpu = GPU.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
    for names in [latin, ideographs] {
        let names: Vec<_> = names.iter().map(String::as_str).collect();
        let scene = named(&names);
        for (side, scale) in [(600, 1.0), (1200, 3.0), (300, 20.0)] {
            let drawn = block_on(PictureRenderer::new(&gpu, side, side, scale).draw(&scene))
                .expect("drawn");
            assert!(lit(&drawn) > 1000, "{} lit at {scale}", lit(&drawn));
        }
    }
}

#[test]
fn a_picture_does_not_depend_on_what_was_drawn_before() {
    let gpu = block_on(Gpu::headless()).expect("a graphics adapter");
    let canvas = Canvas::new(&gpu, 480, 300);
    let mut renderer = Renderer::new(&gpu);
    let many = rows(('\u{a1}'..).filter(|letter| letter.is_alphabetic()).take(500));
    let many: Vec<_> = many.iter().map(String::as_str).collect();
    let scenes = [named(&["Hüfte", "左手"]), named(&many), named(&["Рука"]), named(&[])];
    for scene in scenes.iter().chain(&scenes) {
        renderer.draw(&gpu, scene, &canvas, 1.0);
        assert!(block_on(canvas.read(&gpu)).expect("read") == draw(scene));
    }
}

#[test]
fn names_of_the_arm_are_on_a_side_without_limbs() {
    let mut random = Random(0x1abe);
    let mut number =
        |low: f32, high: f32| low + (high - low) * (random.below(1_000_000) as f32 * 1e-6);
    for _ in 0..500 {
        let mut document = Document {
            display: Display::from_iter([Overlay::Labels, Overlay::Cylinders]),
            ..Document::default()
        };
        document.edit_arm(|arm| arm.set_cursor(Vec3::from([0; 3].map(|_| number(-350.0, 350.0)))));
        document.edit_arm(|arm| arm.twist = number(-3.0, 3.0));
        (document.camera.yaw, document.camera.pitch) = (number(-3.0, 3.0), number(-1.4, 1.4));
        let scene = Scene::new(&document.at(0.0), &Overlays::default(), Theme::Dark);
        let pose = document.arm().pose();
        let projection = document.camera.projection(1.0);
        let [right, up] = [projection.right, projection.up].map(Vec3::normalize);
        let seen = |from: Vec3, to: Vec3| {
            Vec2::new((to - from).dot(right), (to - from).dot(up)).normalize_or_zero()
        };
        for (name, at, limbs) in [
            ("Shoulder", Vec3::ZERO, vec![pose.elbow]),
            ("Elbow", pose.elbow, vec![Vec3::ZERO, pose.hand]),
            ("Hand", pose.hand, vec![pose.elbow]),
        ] {
            let label = scene.labels.iter().find(|it| scene.text(it) == name).expect("a label");
            let side = Vec2::new(
                if label.side.is_left() { -1.0 } else { 1.0 },
                if label.side.is_above() { 1.0 } else { -1.0 },
            );
            for limb in limbs {
                let nearness = seen(at, limb).dot(side.normalize());
                // Two limbs cannot be within 45° of all four corners.
                assert!(nearness < 0.71, "{name} at {at}, limb to {limb}: {nearness}");
            }
        }
    }
}

#[test]
fn a_hand_with_handles_has_no_name_and_the_others_keep_theirs() {
    let document = Document::default();
    let names = |has_handles| {
        let overlays = Overlays { has_handles, ..Overlays::default() };
        let scene = Scene::new(&document.at(0.0), &overlays, Theme::Dark);
        scene.labels.iter().map(|label| scene.text(label).to_owned()).collect::<Vec<_>>()
    };
    assert_eq!(names(false), ["Shoulder", "Elbow", "Hand", "Pointer"]);
    assert_eq!(names(true), ["Shoulder", "Elbow", "Pointer"]);
}
