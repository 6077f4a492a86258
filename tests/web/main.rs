//! The page in a real browser: headless Chromium with a software adapter.
//!
//! `scripts/test.sh` builds the page and runs these tests where the tools for it are there. By hand:
//! `scripts/web.sh && IK_ARM_PAGE=target/web cargo test --test web -- --ignored`.
#![cfg(all(feature = "app", target_os = "linux"))]

mod browser;

use std::fs;
use std::time::Instant;

use ik_arm::document::Document;
use ik_arm::io::{self, Example, Link, OpenOptions, Progress};
use ik_arm::render::{Gpu, PictureRenderer};
use ik_arm::scene::Scene;
use ik_arm::session::Session;
use image::RgbaImage;
use pollster::block_on;

use browser::Browser;

/// Where the hand of the arm is in the page, in a window of 1280 points in width: its distance from the
/// middle of the view grows with the height of the view.
fn hand_on_screen(browser: &Browser) -> [i32; 2] {
    const MENU: f64 = 26.0;
    const BELOW: f64 = 62.0;
    let height = browser.run("return innerHeight").as_f64().expect("a height");
    let view = height - MENU - BELOW;
    [634.0 + 0.1336 * view, MENU + (0.5 - 0.0088) * view].map(|it| it.round() as i32)
}

/// Clicks on the empty view, which gives the keyboard to the page.
fn click_beside_the_hand(browser: &Browser) {
    let [x, y] = hand_on_screen(browser);
    browser.click([x - 250, y - 120]);
}

fn distance(one: [f64; 3], other: [f64; 3]) -> f64 {
    one.iter().zip(other).map(|(one, other)| (one - other).powi(2)).sum::<f64>().sqrt()
}

#[test]
#[ignore = "needs the page and Chromium"]
fn the_hand_is_dragged_with_the_mouse() {
    let folder = tempfile::tempdir().expect("a folder");
    let browser = Browser::open("", folder.path());
    let before = browser.hand();
    assert_eq!(before, [250.0, 120.0, 60.0]);
    let hand = hand_on_screen(&browser);
    browser.drag(hand, [hand[0] - 90, hand[1] - 80]);
    let after = browser.hand();
    assert!(distance(before, after) > 40.0, "{after:?}, {}", browser.failure());
    assert_eq!(browser.failure(), "");
}

#[test]
#[ignore = "needs the page and Chromium"]
fn links_open_examples_steps_of_the_tour_and_documents() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut browser = Browser::open("#tour=1", folder.path());
    assert_eq!(browser.hand(), [180.0, 320.0, 0.0], "the scene of the first step");

    let mut document = Document::default();
    document.rig.targets[0].home = glam::Vec3::new(-100.0, 250.0, 90.0);
    browser.go(&format!("#{}", Link::to(&document).expect("it fits")));
    let off = distance(browser.hand(), [-100.0, 250.0, 90.0]);
    assert!(off < 1e-3, "{off}");

    browser.go("#example=walk&time=0.6");
    assert!(browser.pose()["elbow_angle_deg"].as_f64().expect("a knee") < 179.0);
    for broken in ["#example=nothing", "#document=AAAA", "#time=soon", "#%00&&=&example", "#a=b"] {
        browser.go(broken);
        assert_eq!(browser.failure(), "", "{broken}");
        assert_eq!(browser.hand(), [250.0, 120.0, 60.0], "{broken} opens the arm");
    }
}

#[test]
#[ignore = "needs the page and Chromium"]
fn figures_are_opened_from_files_and_a_document_is_downloaded() {
    let folder = tempfile::tempdir().expect("a folder");
    let human = Example::find("human").expect("an example").open().expect("valid").document;
    let glb = block_on(io::glb(&human, None, &Progress::default())).expect("a figure");

    let browser = Browser::open("", folder.path());
    click_beside_the_hand(&browser);
    browser.drop_file("human.glb", &glb);
    // Joints of a file have no targets, and so no limb whose pose is told.
    browser.eventually("the figure", |browser| browser.pose().is_null().then_some(()));
    assert_eq!(browser.failure(), "");

    browser.press_with_ctrl("s");
    let saved = browser.eventually("the download", |_| {
        let files = fs::read_dir(folder.path()).expect("a folder");
        let mut paths = files.map(|file| file.expect("a file").path());
        let saved = paths.find(|path| path.extension().is_some_and(|it| it == "json"))?;
        io::open(&saved, &OpenOptions::default()).ok()
    });
    assert_eq!(saved.document.skeleton().joints().len(), human.skeleton().joints().len());

    let walk = folder.path().join("walk.json");
    fs::write(&walk, Example::find("walk").expect("an example").text).expect("written");
    browser.choose_file(&walk);
    browser.eventually("the limb of the file", |browser| browser.pose().as_object().map(drop));
}

#[test]
#[ignore = "needs the page and Chromium"]
fn one_finger_drags_the_hand_and_two_zoom() {
    let folder = tempfile::tempdir().expect("a folder");
    let browser = Browser::open("", folder.path());
    let hand = hand_on_screen(&browser);
    browser.drag_with_finger(hand, [hand[0] - 90, hand[1] - 80]);
    let after = browser.hand();
    assert!(distance(after, [250.0, 120.0, 60.0]) > 40.0, "{after:?}, {}", browser.failure());
    // A touch beside it orbits, and leaves the hand.
    browser.drag_with_finger([hand[0] - 250, hand[1] - 120], [hand[0] - 150, hand[1] - 120]);
    assert_eq!(browser.hand(), after);

    let view = [634, hand[1]];
    let before = browser.screenshot();
    browser.spread_fingers(view);
    assert_eq!(browser.hand(), after);
    assert!(browser.screenshot() != before, "the view is zoomed");
}

/// The picture of the view that a session on this computer shows, in pixels of the page's picture.
fn native_picture(session: &Session, width: u32, height: u32) -> RgbaImage {
    let gpu = block_on(Gpu::headless()).expect("a graphics adapter");
    let scene = Scene::new(session.posed(), &session.overlays(), session.preferences().theme);
    let mut renderer = PictureRenderer::new(&gpu, width, height, 1.0);
    block_on(renderer.draw(&scene)).expect("a picture")
}

#[test]
#[ignore = "needs the page and Chromium"]
fn pictures_of_the_page_are_those_of_the_program_on_a_computer() {
    let folder = tempfile::tempdir().expect("a folder");
    let browser = Browser::open("", folder.path());
    click_beside_the_hand(&browser);
    browser.press_with_ctrl("p");
    let bytes = browser.downloaded(&folder.path().join("ik-arm.png"));
    let page = image::load_from_memory(&bytes).expect("a picture").into_rgba8();
    let native = native_picture(&Session::default(), page.width(), page.height());
    native.save("/tmp/native.png").unwrap();
    let pairs = page.pixels().zip(native.pixels());
    let off = pairs.map(|(one, other)| {
        one.0.iter().zip(other.0).map(|(one, other)| one.abs_diff(other)).max().unwrap_or(0)
    });
    let (mut differing, mut sum) = (0, 0.0);
    for off in off {
        differing += u32::from(off > 16);
        sum += f64::from(off);
    }
    let all = f64::from(page.width() * page.height());
    let (part, mean) = (f64::from(differing) / all, sum / all);
    println!(
        "{:.3} % of the pixels differ by more than 16 of 255; {mean:.3} on average",
        100.0 * part
    );
    assert!(part < 0.005 && mean < 0.5, "{part}, {mean}");
}

#[test]
#[ignore = "needs the page and Chromium"]
fn the_page_goes_on_while_a_motion_is_exported() {
    let folder = tempfile::tempdir().expect("a folder");
    let browser = Browser::open("#example=walk", folder.path());
    click_beside_the_hand(&browser);
    browser.run(
        "window.longest = 0; window.frames = 0; let last;
         const look = now => {
             window.longest = Math.max(window.longest, now - (last ?? now));
             window.frames++; last = now; requestAnimationFrame(look);
         };
         requestAnimationFrame(look);",
    );
    browser.press_with_ctrl("e");
    browser.enter("walk.apng");
    let started = Instant::now();
    let bytes = browser.downloaded(&folder.path().join("walk.apng"));
    let took = started.elapsed();
    let [longest, frames] = ["longest", "frames"]
        .map(|name| browser.run(&format!("return window.{name}")).as_f64().expect("a number"));
    println!("exported in {took:?}: {frames} frames of the page, the longest {longest} ms");
    assert!(bytes.windows(4).any(|name| name == b"acTL"), "an animated picture");
    assert!(longest < 1000.0, "{longest} ms");
    assert!(frames > 20.0, "{frames}");
}

#[test]
#[ignore = "needs the page and Chromium"]
fn an_embedded_page_shows_the_view_and_its_controls_alone() {
    let folder = tempfile::tempdir().expect("a folder");
    let browser = Browser::open("?embed=view", folder.path());
    assert_eq!(browser.hand(), [250.0, 120.0, 60.0]);
    // Where the whole program has the slider of x.
    browser.drag([160, 74], [110, 74]);
    assert_eq!(browser.hand(), [250.0, 120.0, 60.0], "there is no slider");
    browser.run("postMessage({ open: '#example=keyframes&time=1' })");
    browser.eventually("the example", |browser| {
        (browser.hand() != [250.0, 120.0, 60.0]).then_some(())
    });
}
