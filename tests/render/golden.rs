//! Pictures of scenes, compared with those in `tests/golden`.
//!
//! `UPDATE_GOLDEN=1 cargo test --test render` writes new ones; look at them before committing.

use crate::common::arm::{Arm, ArmDocument, Cursor, HandOrientation, HandSpace};
use glam::Vec3;
use ik_arm::document::{AxisView, Camera, Document, Overlay, Theme, Track, TwistReferenceKind};
use ik_arm::io::Example;
use ik_arm::kinematics::chain_ik::Method;
use ik_arm::kinematics::fk::Fk;
use ik_arm::kinematics::skeleton::JointId;
use ik_arm::kinematics::soft_reach::SoftReach;
use ik_arm::render::PictureRenderer;
use ik_arm::scene::{Colour, Scene};
use ik_arm::session::{Overlays, SolverGhost};
use pollster::block_on;

use crate::pictures::{self, GPU, SIZE, compare, draw, kept};

fn scene(document: &Document, theme: Theme) -> Scene {
    let posed = document.at(0.0);
    let twist_references = Overlays::new(&Track::new(document), &posed).twist_references;
    Scene::new(&posed, &Overlays { twist_references, ..Overlays::default() }, theme)
}

fn check(name: &str, document: &Document, theme: Theme) {
    pictures::check(name, &scene(document, theme));
}

fn posed(cursor: Vec3) -> Document {
    Arm { cursor: Cursor::unpinned(cursor), ..Arm::default() }.document()
}

fn showing(mut document: Document, layers: &[Overlay]) -> Document {
    for layer in layers {
        document.display = document.display.with(*layer, true);
    }
    document
}

fn from(mut document: Document, target: Vec3, distance: f32) -> Document {
    document.camera = Camera { target, distance, ..document.camera };
    document
}

fn all_guides() -> Document {
    from(showing(Document::default(), &Overlay::GUIDES), Vec3::ZERO, 1650.0)
}

fn walls() -> Document {
    showing(Document::default(), &[Overlay::GridXy, Overlay::GridYz])
}

/// Close view of a hand whose Cursor is out of reach.
fn too_far() -> Document {
    let document = posed(Vec3::new(420.0, 330.0, 120.0));
    from(document, Vec3::new(395.0, 310.0, 110.0), 420.0)
}

fn folded() -> Document {
    let document = showing(posed(Vec3::new(30.0, 40.0, 20.0)), &[Overlay::InnerLimit]);
    from(document, Vec3::new(-40.0, 20.0, -20.0), 640.0)
}

fn inside_the_outer_limit() -> Document {
    let document = showing(posed(Vec3::new(150.0, 180.0, -120.0)), &Overlay::GUIDES);
    from(document, Vec3::new(60.0, 120.0, -40.0), 380.0)
}

fn soft(mut document: Document, stretch: f32, elbow_degrees: f32) -> Document {
    let soft_reach = SoftReach::new(0.0, stretch, elbow_degrees.to_radians());
    document.edit_arm(|arm| arm.soft_reach = soft_reach.expect("soft limits"));
    document
}

/// Limbs that are half as long again, with the hand on the Outer Limit.
fn stretched() -> Document {
    let document = soft(posed(Vec3::new(560.0, 520.0, 100.0)), 1.5, 0.0);
    from(showing(document, &Overlay::GUIDES), Vec3::ZERO, 2600.0)
}

/// A Cursor near the shoulder, with the hand on the Inner Limit at the minimum elbow angle.
fn held_open() -> Document {
    let document = soft(posed(Vec3::new(60.0, 80.0, 40.0)), 1.0, 75.0);
    from(showing(document, &[Overlay::InnerLimit]), Vec3::new(40.0, 40.0, 0.0), 1200.0)
}

fn top_view() -> Document {
    let mut document = posed(Vec3::new(220.0, 150.0, 160.0));
    document.camera = document.camera.along(AxisView::Top);
    document
}

#[test]
fn the_arm_in_a_new_window() {
    check("default", &Document::default(), Theme::Dark);
}

#[test]
fn the_arm_in_the_light_theme() {
    check("light", &Document::default(), Theme::Light);
}

#[test]
fn the_arm_with_all_its_guides() {
    check("all_guides", &all_guides(), Theme::Dark);
    check("walls", &walls(), Theme::Light);
}

#[test]
fn the_arm_seen_from_inside_its_outer_limit() {
    let document = inside_the_outer_limit();
    let eye = document.camera.projection(1.0).eye;
    assert!(eye.distance(document.arm().root) < document.arm().bones.outer_limit());
    check("inside", &document, Theme::Light);
}

#[test]
fn a_cursor_too_far_with_the_gap_to_it() {
    check("too_far", &too_far(), Theme::Light);
}

#[test]
fn a_folded_arm_with_its_inner_limit() {
    check("folded", &folded(), Theme::Dark);
}

#[test]
fn a_stretched_hand_on_its_outer_limit() {
    let arm = stretched().arm();
    assert_eq!(arm.reach_limits().outer, 750.0);
    assert!((arm.pose().distance - 750.0).abs() < 1e-3);
    check("stretched", &stretched(), Theme::Dark);
}

#[test]
fn a_hand_at_the_minimum_elbow_angle_on_its_inner_limit() {
    let arm = held_open().arm();
    assert_eq!(arm.pose().distance, arm.reach_limits().inner);
    check("min_elbow_angle", &held_open(), Theme::Light);
}

#[test]
fn the_arm_from_above() {
    check("top", &top_view(), Theme::Light);
}

#[test]
fn a_guide_that_is_missing_is_noticed() {
    let cases = [
        (Overlay::Cursor, "too_far", too_far(), Theme::Light),
        (Overlay::Pointer, "default", Document::default(), Theme::Dark),
        (Overlay::InnerLimit, "folded", folded(), Theme::Dark),
        (Overlay::OuterLimit, "all_guides", all_guides(), Theme::Dark),
        (Overlay::OuterLimit, "stretched", stretched(), Theme::Dark),
        (Overlay::Pointer, "min_elbow_angle", held_open(), Theme::Light),
        (Overlay::InnerLimit, "min_elbow_angle", held_open(), Theme::Light),
        (Overlay::Shadow, "default", Document::default(), Theme::Dark),
        (Overlay::Axes, "folded", folded(), Theme::Dark),
        (Overlay::Ground, "light", Document::default(), Theme::Light),
        (Overlay::GridXy, "walls", walls(), Theme::Light),
        (Overlay::GridXz, "default", Document::default(), Theme::Dark),
        (Overlay::GridYz, "walls", walls(), Theme::Light),
        (Overlay::Labels, "default", Document::default(), Theme::Dark),
    ];
    for (layer, name, document, theme) in cases {
        assert!(document.display.shows(layer), "{layer:?} is not in {name}");
        let hidden = Document { display: document.display.with(layer, false), ..document };
        let without = draw(&scene(&hidden, theme));
        assert!(compare(&without, &kept(name)).is_err(), "{layer:?} is not missed in {name}");
    }
}

/// An example scene, seen from nearer.
fn example(name: &str) -> Document {
    let example = Example::find(name).expect("an example");
    nearer(example.open().expect("it opens").document)
}

/// The snake whose head has keys.
fn snake() -> Document {
    nearer(crate::common::documents::keyed_snake())
}

fn nearer(mut document: Document) -> Document {
    document.camera.distance *= 0.9;
    document
}

#[test]
fn the_human_with_hands_and_feet_at_their_targets() {
    check("human", &example("human"), Theme::Dark);
    check("human-light", &example("human"), Theme::Light);
}

#[test]
fn figures_and_an_arm_whose_hands_and_feet_stay() {
    for name in ["walk", "wheel", "table"] {
        check(name, &example(name), Theme::Dark);
    }
    check("walk-light", &example("walk"), Theme::Light);
}

#[test]
fn the_snake_along_its_path() {
    check("snake", &snake(), Theme::Dark);
}

#[test]
fn tadpoles_on_the_paths_of_their_targets() {
    let posed = example("tadpoles").at(1.3);
    pictures::check("tadpoles", &Scene::new(&posed, &Overlays::default(), Theme::Light));
}

#[test]
fn the_snake_some_seconds_later_is_another_picture() {
    let posed = snake().at(1.5);
    let drawn = draw(&Scene::new(&posed, &Overlays::default(), Theme::Dark));
    assert!(compare(&drawn, &kept("snake")).is_err());
}

#[test]
fn a_selected_joint_a_missing_target_and_ghosts_are_noticed() {
    let document = example("human");
    let selected = Overlays { selection: vec![JointId::new(6)], ..Overlays::default() };
    let drawn = draw(&Scene::new(&document.at(0.0), &selected, Theme::Dark));
    assert!(compare(&drawn, &kept("human")).is_err(), "a selected joint");
    let bind = document.skeleton().bind_pose();
    let ghosts = vec![SolverGhost { method: Method::Ccd, pose: bind, ..SolverGhost::default() }];
    let drawn = draw(&Scene::new(
        &document.at(0.0),
        &Overlays { ghosts, ..Overlays::default() },
        Theme::Dark,
    ));
    assert!(compare(&drawn, &kept("human")).is_err(), "a ghost");
    let mut unsolved = document;
    for target in &mut unsolved.rig.targets {
        (target.influence, target.home) = (0.0, target.home + Vec3::splat(0.15));
    }
    let drawn = draw(&scene(&unsolved, Theme::Dark));
    assert!(compare(&drawn, &kept("human")).is_err(), "targets that are not reached");
}

#[test]
fn a_limb_of_another_colour_is_noticed() {
    let limbs = |scene: &Scene| [scene.palette.upper, scene.palette.lower];
    for limb in 0..2 {
        let mut recoloured = scene(&Document::default(), Theme::Dark);
        let colour = limbs(&recoloured)[limb];
        let solids = recoloured.solids.iter_mut().filter(|solid| solid.colour == colour);
        let count = solids.map(|solid| solid.colour = Colour([90, 160, 90, 255])).count();
        assert_eq!(count, 1);
        assert!(compare(&draw(&recoloured), &kept("default")).is_err(), "limb {limb}");
    }
}

#[test]
fn a_large_picture_is_the_same_picture() {
    let gpu = GPU.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
    let scene = scene(&Document::default(), Theme::Dark);
    let large = block_on(PictureRenderer::new(&gpu, SIZE.0 * 2, SIZE.1 * 2, 2.0).draw(&scene))
        .expect("drawn");
    let shrunk =
        image::imageops::resize(&large, SIZE.0, SIZE.1, image::imageops::FilterType::Triangle);
    let small = kept("default");
    let sum: u64 = shrunk
        .pixels()
        .zip(small.pixels())
        .map(|(a, b)| (0..3).map(|c| u64::from(a.0[c].abs_diff(b.0[c]))).sum::<u64>())
        .sum();
    let mean = sum as f64 / f64::from(SIZE.0 * SIZE.1 * 3);
    assert!(mean < 2.5, "the mean differs by {mean}");
}

fn with(arm: Arm, layers: &[Overlay]) -> Document {
    showing(arm.document(), layers)
}

#[test]
fn the_arm_with_all_overlays_of_an_animator() {
    let pole = Arm { twist_reference: TwistReferenceKind::Pole, ..Arm::default() };
    let cursor = Cursor::pinned(Arm::default().cursor_in_world());
    let pinned = Arm { root: Vec3::new(-60.0, 40.0, 30.0), cursor, ..Arm::default() };
    let twisted = Arm { twist: 1.0, ..pole };
    let hand_orientation =
        HandOrientation { space: HandSpace::World, angles: Vec3::new(2.5, 0.3, 0.1) };
    let turned = Arm { hand_orientation, ..Arm::default() };
    let angles = Fk { shoulder: Vec3::new(0.3, 0.6, 0.9), bend: 1.3, stretch: 1.0 };
    let led = Arm { fk: angles, influence: 0.0, ..Arm::default() };
    let cases: [(&str, Arm, &[Overlay]); 5] = [
        ("pole", pole, &[]),
        ("pin", pinned, &[]),
        ("references", twisted, &[Overlay::TwistReferences]),
        ("turned", turned, &[]),
        ("led", led, &[Overlay::SingularityGlobe]),
    ];
    for (name, arm, layers) in cases {
        check(name, &with(arm, layers), Theme::Dark);
        check(&format!("{name}-light"), &with(arm, layers), Theme::Light);
    }
}

fn with_selection(document: &Document, joint: usize) -> Overlays {
    Overlays {
        selection: vec![JointId::new(joint)],
        ..Overlays::new(&Track::new(document), &document.at(0.0))
    }
}

/// The Human in its bind pose.
fn bind_pose() -> Document {
    let mut human = example("human");
    let joints = human.skeleton().ids();
    human.rig.targets.clear();
    for joint in joints {
        let _ = human.rig.skeleton_mut().set_rotation(joint, Vec3::ZERO);
    }
    human
}

#[test]
fn the_skin_of_the_human_in_its_bind_pose() {
    check("skin_bind", &bind_pose(), Theme::Dark);
    check("skin_bind-light", &bind_pose(), Theme::Light);
}

#[test]
fn the_weights_of_a_joint_colour_the_skin() {
    let document = showing(bind_pose(), &[Overlay::SkinWeights]);
    for (name, theme) in [("skin_weights", Theme::Dark), ("skin_weights-light", Theme::Light)] {
        pictures::check(
            name,
            &Scene::new(&document.at(0.0), &with_selection(&document, 13), theme),
        );
    }
}

#[test]
fn the_parts_of_a_skin_that_are_selected_or_under_the_mouse_light_up() {
    let document = bind_pose();
    let selected = with_selection(&document, 13);
    let hovered = Overlays { hovered: Some(JointId::new(4)), ..Overlays::default() };
    let scene = |overlays: &Overlays| Scene::new(&document.at(0.0), overlays, Theme::Light);
    pictures::check("skin_selected-light", &scene(&selected));
    pictures::check("skin_hovered-light", &scene(&hovered));
    for other in [&hovered, &Overlays::default()] {
        assert!(compare(&draw(&scene(other)), &kept("skin_selected-light")).is_err());
    }
}

#[test]
fn the_wireframe_and_the_bones_of_a_skin() {
    for (name, theme) in [("skin_wireframe", Theme::Dark), ("skin_wireframe-light", Theme::Light)] {
        check(name, &showing(example("two-targets"), &[Overlay::Wireframe]), theme);
    }
    for (name, theme) in [("skin_and_bones", Theme::Dark), ("skin_and_bones-light", Theme::Light)] {
        check(name, &showing(example("human"), &[Overlay::Bones]), theme);
    }
}

#[test]
fn the_candy_wrapper_half_way_and_at_its_end() {
    let document = example("candy-wrapper");
    for (name, time, theme) in
        [("candy_wrapper", 3.0, Theme::Dark), ("candy_wrapper-light", 2.0, Theme::Light)]
    {
        let posed = document.at(time);
        let scene = Scene::new(&posed, &Overlays::new(&Track::new(&document), &posed), theme);
        pictures::check(name, &scene);
    }
}

#[test]
fn the_human_reaches_up_in_its_skin() {
    let mut human = bind_pose();
    for (joint, angles) in [(6, Vec3::Z * 1.7), (10, Vec3::Z * -1.2), (11, Vec3::X * -1.0)] {
        let _ = human.rig.skeleton_mut().set_rotation(JointId::new(joint), angles);
    }
    check("skin_reach", &human, Theme::Dark);
    check("skin_reach-light", &human, Theme::Light);
}
