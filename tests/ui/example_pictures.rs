//! The examples as pictures, and what opening one does.

use egui::accesskit::Role;
use egui::{Key, pos2};
use ik_arm::document::Theme;
use ik_arm::io::{Example, ExampleGroup};
use ik_arm::session::{Dialog, FileAction, Preferences};

use crate::bench::{Bench, LARGE, SMALL};

fn opened() -> Bench {
    let mut bench = Bench::new();
    bench.choose(&["Examples", "Pictures of all…"]);
    bench
}

fn is_open(bench: &Bench) -> bool {
    matches!(bench.session().shell().dialog(), Some(Dialog::Examples(_)))
}

#[test]
fn every_example_has_a_picture_and_those_that_move_have_several_frames() {
    let [width, height] = Example::FRAME_SIZE.map(|pixels| pixels as u32);
    let both = |example| [(example, Theme::Dark), (example, Theme::Light)];
    for (example, theme) in Example::ALL.into_iter().flat_map(both) {
        let picture = image::load_from_memory(example.picture(theme)).expect("a picture");
        let picture = picture.into_rgb8();
        assert_eq!((picture.width() % width, picture.height() % height), (0, 0), "{example:?}");
        let frames = (picture.width() / width) * (picture.height() / height);
        let document = example.open().expect("opens").document;
        let expected = if document.is_moving() { 24 } else { 1 };
        assert_eq!(frames, expected, "{}", example.name);
        let differs = |one: u32| {
            let at = |frame: u32| [frame % 6 * width, frame / 6 * height];
            let pixel =
                |frame: u32, x: u32, y: u32| *picture.get_pixel(at(frame)[0] + x, at(frame)[1] + y);
            let pixels = (0..width).flat_map(|x| (0..height).map(move |y| (x, y)));
            let far = |(x, y): &(u32, u32)| {
                let (a, b) = (pixel(0, *x, *y), pixel(one, *x, *y));
                a.0.iter().zip(b.0).any(|(a, b)| a.abs_diff(b) > 60)
            };
            pixels.filter(far).count() > 20
        };
        assert!(frames == 1 || (1..24).any(differs), "{} moves in its picture", example.name);
    }
}

#[test]
fn a_picture_tells_what_its_example_shows_and_opens_it() {
    for size in [LARGE, SMALL] {
        let mut bench = Bench::of_size(size);
        bench.choose(&["File", "New", "Example…"]);
        bench.move_to(pos2(2.0, 2.0));
        bench.settle();
        assert!(bench.says("Point at a picture"));
        let picture = bench.rect(Role::Button, "Human");
        bench.move_to(picture.center());
        bench.settle();
        assert!(bench.says("Drag hands, feet or pelvis"));
        bench.click_at(picture.center());
        bench.settle();
        assert!(!is_open(&bench));
        assert!(bench.session().skeleton().find("left_forearm").is_some(), "it is open");
    }
}

#[test]
fn the_groups_of_examples_are_pages_and_escape_closes_them() {
    let mut bench = opened();
    for group in ExampleGroup::ALL {
        bench.click(Role::Tab, group.title());
        let titles: Vec<&str> = Example::of(group).map(|example| example.title).collect();
        assert!(titles.iter().all(|title| bench.shows(Role::Button, title)), "{titles:?}");
    }
    bench.key(Key::Escape);
    bench.settle();
    assert!(!is_open(&bench));
}

#[test]
fn a_picture_moves_under_the_mouse_alone() {
    let mut bench = opened();
    bench.settle();
    for (name, moves) in [("Walk", true), ("Human", false)] {
        bench.move_to(bench.rect(Role::Button, name).center());
        bench.frame([]);
        let before = bench.harness.render().expect("a picture");
        bench.wait(0.7);
        assert_eq!(bench.harness.render().expect("a picture") != before, moves, "{name}");
    }
}

#[test]
fn examples_that_move_play_when_they_are_opened_and_others_stand_still() {
    for example in Example::ALL {
        let mut bench = Bench::new();
        bench.apply_moving([FileAction::OpenExample(example)]);
        let document = bench.session().document();
        let (plays, moves) = (bench.session().playback().is_playing(), document.is_animated());
        assert_eq!(plays, moves, "{}", example.name);
    }
}

#[test]
fn the_offer_at_the_start_shows_the_examples() {
    let mut bench = Bench::first(LARGE, Preferences::default());
    bench.click(Role::Button, "Examples…");
    assert!(is_open(&bench));
    bench.click(Role::Button, "Close");
    assert!(!is_open(&bench) && bench.shows(Role::Button, "Take the tour"));
    bench.click(Role::Button, "Examples…");
    bench.settle();
    bench.click(Role::Button, "Human");
    bench.settle();
    assert!(!bench.shows(Role::Button, "Take the tour"), "the offer covers the example");
}
