//! The real program in a real window: a mouse drags a slider and the hand, and the screen follows.
//!
//! Needs a display without a window manager, `xdotool` and ImageMagick's `import`; the script that
//! runs all tests makes one: `scripts/test.sh`. By hand, within such a display:
//! `cargo test --test window -- --ignored`.
#![cfg(all(feature = "app", target_os = "linux"))]

use std::io::Read as _;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;
use ik_arm::document::Document;
use ik_arm::session::Session;
use ik_arm::ui::{self, Machine};
use image::RgbImage;

const SIZE: (f32, f32) = (1280.0, 800.0);
/// What the harness leaves free around the panels, and the window does not.
const HARNESS_MARGIN: egui::Vec2 = egui::Vec2::splat(8.0);
const PATIENCE: Duration = Duration::from_secs(60);

/// Where things are in the window, in points: the same panels laid out without one.
struct Places {
    thumb: egui::Pos2,
    rail_end: egui::Pos2,
    hand: egui::Pos2,
    elbow: egui::Pos2,
    help: egui::Pos2,
    /// In the menu Help, while that is open.
    lose_device: egui::Pos2,
}

impl Places {
    fn new() -> Self {
        let session = Session::default();
        let machine = Machine { shows_debug_actions: true, ..Machine::default() };
        let mut harness = Harness::builder()
            .with_size(egui::vec2(SIZE.0, SIZE.1) + 2.0 * HARNESS_MARGIN)
            .with_context_setup(ui::style::install)
            .build_ui(|ui| {
                ui::show(ui, &Session::default(), &machine, None, &mut Vec::new());
            });
        let rail = harness.get_by_role_and_label(egui::accesskit::Role::Slider, "Hand x").rect();
        let rail = rail.translate(-HARNESS_MARGIN);
        let viewport = harness
            .get_by(|node| {
                node.role() == egui::accesskit::Role::Image
                    && node.label().is_some_and(|label| label.starts_with("Viewport"))
            })
            .rect()
            .translate(-HARNESS_MARGIN);
        let help = harness.get_by_label("Help");
        let help_place = help.rect().center() - HARNESS_MARGIN;
        help.click();
        harness.run();
        let lose_device = harness.get_by_label("Lose the graphics device").rect().center();
        let projection = session.camera().projection(viewport.aspect_ratio());
        let place = |point| {
            let at = projection.project(point).expect("in the picture");
            viewport.center() + egui::vec2(at.x, -at.y) * viewport.size() / 2.0
        };
        let track = rail.x_range().shrink(8.5);
        let part = (session.arm().cursor().x / session.arm().bones.outer_limit() + 1.0) / 2.0;
        Self {
            thumb: egui::pos2(track.min + part * track.span(), rail.center().y),
            rail_end: egui::pos2(track.min + 0.2 * track.span(), rail.center().y),
            hand: place(session.arm().root + session.pose().hand),
            elbow: place(session.arm().root + session.pose().elbow),
            help: help_place,
            lose_device: lose_device - HARNESS_MARGIN,
        }
    }
}

/// The program, ended with the test.
struct Program(Child);

impl Program {
    fn start(settings: &Path) -> Self {
        Self(Self::command(settings).spawn().expect("started"))
    }

    /// With what `IK_ARM_DEBUG` asks for, and its errors kept.
    fn start_to_debug(settings: &Path, asked: &str) -> Self {
        let mut command = Self::command(settings);
        let command = command.env("IK_ARM_DEBUG", asked).stderr(Stdio::piped());
        Self(command.spawn().expect("started"))
    }

    fn command(settings: &Path) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_ik-arm"));
        command
            .env("XDG_CONFIG_HOME", settings)
            .env("XDG_DATA_HOME", settings)
            .env_remove("IK_ARM_DEBUG")
            .env_remove("WAYLAND_DISPLAY");
        command
    }

    /// What it has said on stderr until its end.
    fn errors(&mut self) -> String {
        let mut said = String::new();
        let mut stderr = self.0.stderr.take().expect("kept");
        stderr.read_to_string(&mut said).expect("text");
        said
    }

    fn end(&mut self) -> Option<i32> {
        let given_up = Instant::now() + PATIENCE;
        while Instant::now() < given_up {
            if let Some(status) = self.0.try_wait().expect("waited for") {
                return status.code();
            }
            sleep(Duration::from_millis(100));
        }
        None
    }
}

impl Drop for Program {
    fn drop(&mut self) {
        // It has ended already, unless the test failed.
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

fn xdotool(arguments: &[&str]) -> String {
    let output = Command::new("xdotool").args(arguments).output().expect("xdotool runs");
    String::from_utf8_lossy(&output.stdout).trim().to_owned()
}

fn mouse_to(at: egui::Pos2) {
    xdotool(&["mousemove", &at.x.round().to_string(), &at.y.round().to_string()]);
    sleep(Duration::from_millis(60));
}

fn drag(from: egui::Pos2, to: egui::Pos2) {
    const STEPS: u8 = 12;
    mouse_to(from);
    sleep(Duration::from_millis(300));
    xdotool(&["mousedown", "1"]);
    for step in 1..=STEPS {
        mouse_to(from + (to - from) * f32::from(step) / f32::from(STEPS));
    }
    sleep(Duration::from_millis(300));
    xdotool(&["mouseup", "1"]);
}

fn screenshot(folder: &Path) -> RgbImage {
    let path = folder.join("screen.png");
    let taken = Command::new("import").args(["-window", "root"]).arg(&path).status();
    assert!(taken.expect("import runs").success());
    image::open(path).expect("a picture").into_rgb8()
}

/// The screen once something is on it that does not change any more.
fn settled(folder: &Path) -> RgbImage {
    let given_up = Instant::now() + PATIENCE;
    let mut last = screenshot(folder);
    while Instant::now() < given_up {
        sleep(Duration::from_millis(400));
        let now = screenshot(folder);
        if now == last && now.pixels().any(|pixel| pixel != now.get_pixel(0, 0)) {
            return now;
        }
        last = now;
    }
    panic!("the screen does not come to rest");
}

/// How many pixels differ within `radius` of a place.
fn changed(a: &RgbImage, b: &RgbImage, at: egui::Pos2, radius: f32) -> usize {
    let near = |x: u32, y: u32| egui::pos2(x as f32, y as f32).distance(at) <= radius;
    let differs = |a: &image::Rgb<u8>, b: &image::Rgb<u8>| {
        (0..3).any(|channel| a.0[channel].abs_diff(b.0[channel]) > 24)
    };
    let pixels = a.enumerate_pixels().zip(b.pixels());
    pixels.filter(|((x, y, a), b)| near(*x, *y) && differs(a, b)).count()
}

/// Puts the window where the screen begins, and gives it the keyboard.
fn place_window() {
    let window = await_window();
    xdotool(&["windowmove", &window, "0", "0"]);
    xdotool(&["windowfocus", &window]);
}

fn await_window() -> String {
    let given_up = Instant::now() + PATIENCE;
    while Instant::now() < given_up {
        let found = xdotool(&["search", "--onlyvisible", "--name", "^ik-arm"]);
        if let Some(window) = found.lines().next() {
            return window.to_owned();
        }
        sleep(Duration::from_millis(200));
    }
    panic!("no window appears");
}

#[test]
#[ignore = "needs a display of its own"]
fn a_mouse_drags_a_slider_and_the_hand_and_the_screen_follows() {
    let folder = tempfile::tempdir().expect("a folder");
    let places = Places::new();
    let mut program = Program::start(folder.path());
    place_window();
    let first = settled(folder.path());

    drag(places.thumb, places.rail_end);
    let slid = settled(folder.path());
    assert!(changed(&first, &slid, places.thumb, 6.0) > 40, "the thumb has not moved");
    assert!(changed(&first, &slid, places.hand, 30.0) > 300, "the hand has not moved");
    assert!(changed(&first, &slid, places.elbow, 40.0) > 300, "the elbow has not followed");

    // Double-click on the rail resets it: the hand is back where it was.
    mouse_to(places.rail_end);
    xdotool(&["click", "--repeat", "2", "--delay", "80", "1"]);
    let reset = settled(folder.path());
    assert!(changed(&first, &reset, places.elbow, 40.0) < 40, "the hand has not been reset");

    let to = places.hand + egui::vec2(90.0, -140.0);
    drag(places.hand, to);
    let dragged = settled(folder.path());
    assert!(changed(&reset, &dragged, to, 30.0) > 300, "the hand is not where it was dragged");
    assert!(changed(&reset, &dragged, places.elbow, 40.0) > 300, "the elbow has not followed");

    // Without changes it does not ask whether to save them.
    xdotool(&["key", "ctrl+z"]);
    let undone = settled(folder.path());
    assert!(changed(&reset, &undone, places.elbow, 40.0) < 40, "the drag has not been undone");
    xdotool(&["key", "--repeat", "10", "--delay", "50", "ctrl+z"]);
    xdotool(&["key", "ctrl+q"]);
    assert_eq!(program.end(), Some(0), "the program ends cleanly");
}

/// Where the program keeps what is not saved, in case it ends before.
fn kept(settings: &Path) -> Vec<PathBuf> {
    let folder = settings.join("ik-arm/recovery");
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let files = entries.map(|entry| entry.path());
    files.filter(|path| path.extension().is_some_and(|extension| extension == "json")).collect()
}

fn document_of(kept: &Path) -> Document {
    let kept = std::fs::read_to_string(kept).expect("whole");
    let kept: serde_json::Value = serde_json::from_str(&kept).expect("JSON");
    let text = kept["document"].as_str().expect("a document");
    ik_arm::io::parse("kept", text, None).expect("it opens").document
}

/// The hand, dragged to the left end of its slider.
fn change(places: &Places, folder: &Path) {
    place_window();
    settled(folder);
    drag(places.thumb, places.rail_end);
    settled(folder);
}

#[test]
#[ignore = "needs a display of its own"]
fn what_is_not_saved_is_kept_when_the_program_is_ended_and_offered_when_it_starts_again() {
    let folder = tempfile::tempdir().expect("a folder");
    let places = Places::new();
    let mut program = Program::start(folder.path());
    change(&places, folder.path());
    assert!(kept(folder.path()).is_empty(), "half a minute is not over");
    let ended = Command::new("kill").arg(program.0.id().to_string()).status().expect("kill runs");
    assert!(ended.success());
    assert_eq!(program.end(), Some(130));
    let [first] = &kept(folder.path())[..] else { panic!("nothing is kept") };
    let hand = document_of(first).arm.cursor();
    assert!(hand.x < 0.0, "{hand} is not where it was dragged");

    let mut program = Program::start(folder.path());
    place_window();
    let offered = settled(folder.path());
    // Opened by the keyboard: the dialog has it.
    xdotool(&["key", "Return"]);
    let opened = settled(folder.path());
    assert!(changed(&offered, &opened, places.thumb, 6.0) > 40, "the document is not opened");
    // Left alone, it is kept again after half a minute, whatever happens to the program then.
    let given_up = Instant::now() + PATIENCE;
    let second = loop {
        match &kept(folder.path())[..] {
            [one] if one != first => break one.clone(),
            _ => assert!(Instant::now() < given_up, "it is not kept"),
        }
        sleep(Duration::from_millis(500));
    };
    program.0.kill().expect("killed");
    program.end();
    assert_eq!(document_of(&second).arm.cursor(), hand);
}

/// Through the menu Help, until that is seen no more; the pointer stays where it was.
fn lose_device(places: &Places, folder: &Path) {
    mouse_to(places.help);
    xdotool(&["click", "1"]);
    sleep(Duration::from_millis(700));
    mouse_to(places.lose_device);
    let open = settled(folder);
    xdotool(&["click", "1"]);
    let given_up = Instant::now() + PATIENCE;
    let in_menu = places.help + (places.lose_device - places.help) / 2.0;
    while changed(&open, &screenshot(folder), in_menu, 30.0) == 0 {
        assert!(Instant::now() < given_up, "nothing is drawn any more");
    }
}

/// How many pixels differ above the line at the bottom, which says what has happened.
fn changed_above_the_status(a: &RgbImage, b: &RgbImage) -> usize {
    const STATUS: u32 = 30;
    let pixels = a.enumerate_pixels().zip(b.pixels());
    pixels.filter(|((_, y, a), b)| *y + STATUS < SIZE.1 as u32 && a != b).count()
}

#[test]
#[ignore = "needs a display of its own"]
fn a_lost_device_is_made_anew_again_and_again_with_the_document_and_the_picture_intact() {
    let folder = tempfile::tempdir().expect("a folder");
    let places = Places::new();
    let mut program = Program::start_to_debug(folder.path(), "1");
    place_window();
    let first = settled(folder.path());
    drag(places.thumb, places.rail_end);
    // Pressed twice, the menu is closed again; then all is as after the device is lost.
    mouse_to(places.help);
    xdotool(&["click", "1", "sleep", "1", "click", "1"]);
    mouse_to(places.lose_device);
    let before = settled(folder.path());
    assert!(changed(&first, &before, places.elbow, 40.0) > 300, "the elbow has not followed");

    for time in 1..=4 {
        lose_device(&places, folder.path());
        let after = settled(folder.path());
        let differing = changed_above_the_status(&before, &after);
        assert_eq!(differing, 0, "pixels are others after the device was lost {time} times");
    }
    drag(places.rail_end, places.thumb);
    let dragged = settled(folder.path());
    assert!(changed(&before, &dragged, places.elbow, 40.0) > 300, "nothing moves any more");
    for _ in 0..2 {
        xdotool(&["key", "ctrl+z"]);
        settled(folder.path());
    }
    let undone = settled(folder.path());
    assert!(
        changed(&first, &undone, places.elbow, 40.0) < 40,
        "what was done before the loss is not undone"
    );
    xdotool(&["key", "ctrl+q"]);
    assert_eq!(program.end(), Some(0), "the program ends cleanly");
    let errors = program.errors();
    assert_eq!(errors.matches("ERROR").count(), 4, "{errors}");
    assert!(!errors.contains("panicked"), "{errors}");
}

#[test]
#[ignore = "needs a display of its own"]
fn a_device_that_fails_twice_while_it_is_made_anew_is_there_at_the_third_try() {
    let folder = tempfile::tempdir().expect("a folder");
    let places = Places::new();
    let mut program = Program::start_to_debug(folder.path(), "fail-devices:2");
    place_window();
    settled(folder.path());
    mouse_to(places.help);
    xdotool(&["click", "1", "sleep", "1", "click", "1"]);
    mouse_to(places.lose_device);
    let before = settled(folder.path());
    lose_device(&places, folder.path());
    let after = settled(folder.path());
    assert_eq!(changed_above_the_status(&before, &after), 0);
    xdotool(&["key", "ctrl+q"]);
    assert_eq!(program.end(), Some(0), "the program ends cleanly");
}

#[test]
#[ignore = "needs a display of its own"]
fn a_device_that_fails_three_times_while_it_is_made_anew_ends_the_program_with_all_kept() {
    let folder = tempfile::tempdir().expect("a folder");
    let places = Places::new();
    let mut program = Program::start_to_debug(folder.path(), "fail-devices:3");
    change(&places, folder.path());
    lose_device(&places, folder.path());
    assert_eq!(program.end(), Some(1));
    let [first] = &kept(folder.path())[..] else { panic!("nothing is kept") };
    let errors = program.errors();
    assert!(errors.contains("three tries to make it anew failed"), "{errors}");
    assert!(errors.contains(&first.display().to_string()), "{errors}");
    let hand = document_of(first).arm.cursor();
    assert!(hand.x < 0.0, "{hand} is not where it was dragged");

    let mut program = Program::start(folder.path());
    place_window();
    let offered = settled(folder.path());
    xdotool(&["key", "Return"]);
    let opened = settled(folder.path());
    assert!(changed(&offered, &opened, places.thumb, 6.0) > 40, "the document is not opened");
    program.0.kill().expect("killed");
    program.end();
}
