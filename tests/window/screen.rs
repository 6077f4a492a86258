//! The program, the mouse and the screen.

use std::io::Read as _;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;
use ik_arm::session::Session;
use ik_arm::ui::{self, Machine};
use image::RgbImage;

pub const SIZE: (f32, f32) = (1280.0, 800.0);
/// What the harness leaves free around the panels, and the window does not.
const HARNESS_MARGIN: egui::Vec2 = egui::Vec2::splat(8.0);
pub const PATIENCE: Duration = Duration::from_secs(60);

/// Where things are in the window, in points: the same panels laid out without one.
pub struct Places {
    pub thumb: egui::Pos2,
    pub rail_end: egui::Pos2,
    pub hand: egui::Pos2,
    pub elbow: egui::Pos2,
    pub help: egui::Pos2,
    /// In the menu Help, while that is open.
    pub lose_device: egui::Pos2,
}

impl Places {
    pub fn new() -> Self {
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
pub struct Program(pub Child);

impl Program {
    pub fn start(settings: &Path) -> Self {
        Self(Self::command(settings).spawn().expect("started"))
    }

    /// With what `IK_ARM_DEBUG` asks for, and its errors kept.
    pub fn start_to_debug(settings: &Path, asked: &str) -> Self {
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
    pub fn errors(&mut self) -> String {
        let mut said = String::new();
        let mut stderr = self.0.stderr.take().expect("kept");
        stderr.read_to_string(&mut said).expect("text");
        said
    }

    pub fn end(&mut self) -> Option<i32> {
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

pub fn xdotool(arguments: &[&str]) -> String {
    let output = Command::new("xdotool").args(arguments).output().expect("xdotool runs");
    String::from_utf8_lossy(&output.stdout).trim().to_owned()
}

pub fn mouse_to(at: egui::Pos2) {
    xdotool(&["mousemove", &at.x.round().to_string(), &at.y.round().to_string()]);
    sleep(Duration::from_millis(60));
}

pub fn drag(from: egui::Pos2, to: egui::Pos2) {
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

pub fn screenshot(folder: &Path) -> RgbImage {
    let path = folder.join("screen.png");
    let taken = Command::new("import").args(["-window", "root"]).arg(&path).status();
    assert!(taken.expect("import runs").success());
    image::open(path).expect("a picture").into_rgb8()
}

/// The screen once something is on it that does not change any more.
pub fn settled(folder: &Path) -> RgbImage {
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
pub fn changed(a: &RgbImage, b: &RgbImage, at: egui::Pos2, radius: f32) -> usize {
    let near = |x: u32, y: u32| egui::pos2(x as f32, y as f32).distance(at) <= radius;
    let differs = |a: &image::Rgb<u8>, b: &image::Rgb<u8>| {
        (0..3).any(|channel| a.0[channel].abs_diff(b.0[channel]) > 24)
    };
    let pixels = a.enumerate_pixels().zip(b.pixels());
    pixels.filter(|((x, y, a), b)| near(*x, *y) && differs(a, b)).count()
}

/// Puts the window where the screen begins, and gives it the keyboard.
pub fn place_window() {
    let window = await_window();
    xdotool(&["windowmove", &window, "0", "0"]);
    xdotool(&["windowfocus", &window]);
}

pub fn await_window() -> String {
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
