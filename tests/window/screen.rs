//! Drives the program by keyboard and mouse, and waits for pictures on the screen.
//!
//! No helper sleeps for a fixed time: each waits for a frame, a picture or a state, and panics
//! after [`PATIENCE`] with the condition, and a screenshot in a file.

use std::cell::RefCell;
use std::io::{BufRead as _, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::{Arc, Mutex};
use std::thread::{JoinHandle, sleep};
use std::time::{Duration, Instant};

use egui::Pos2;
use image::RgbImage;
use nix::sys::signal::{Signal, kill};
use nix::unistd::Pid;

use crate::display::Display;

/// Size of screen and window, in pixels.
pub const SIZE: (u32, u32) = (1280, 800);
pub const PATIENCE: Duration = Duration::from_secs(60);
/// A screen unchanged for this long counts as settled. Shorter than the blink of a text cursor.
const REST: Duration = Duration::from_millis(300);
const POLL: Duration = Duration::from_millis(50);

/// The running program with its window, killed when dropped.
pub struct Program {
    child: RefCell<Child>,
    display: Display,
    /// Lines of standard error.
    log: Arc<Mutex<Vec<String>>>,
    listener: RefCell<Option<JoinHandle<()>>>,
}

impl Program {
    /// Starts the program with a folder for its settings, and waits for the first picture.
    pub fn open(settings: &Path) -> Self {
        Self::open_to_debug(settings, "")
    }

    /// Also sets `IK_ARM_DEBUG`.
    pub fn open_to_debug(settings: &Path, debug: &str) -> Self {
        Self::start(settings, debug, None, Display::shared())
    }

    /// Opens the window on a display of its own.
    pub fn open_on(settings: &Path, display: Display) -> Self {
        Self::start(settings, "", None, display)
    }

    /// Also opens a document.
    pub fn open_file(settings: &Path, file: &Path) -> Self {
        Self::start(settings, "", Some(file), Display::shared())
    }

    fn start(settings: &Path, debug: &str, file: Option<&Path>, display: Display) -> Self {
        draw_in_full(settings);
        let mut child = Command::new(env!("CARGO_BIN_EXE_ik-arm"))
            .args(file)
            .env("XDG_CONFIG_HOME", settings)
            .env("XDG_DATA_HOME", settings)
            .env("IK_ARM_DEBUG", debug)
            .env("DISPLAY", display.name())
            .env("RUST_LOG", "error,ik_arm::app::frame=trace")
            .env_remove("WAYLAND_DISPLAY")
            .env_remove("XDG_RUNTIME_DIR")
            // Forces the program's own file dialogs instead of the desktop's.
            .env("DBUS_SESSION_BUS_ADDRESS", "unix:path=/nonexistent")
            .stderr(Stdio::piped())
            .spawn()
            .expect("the program starts");
        let stderr = BufReader::new(child.stderr.take().expect("piped"));
        let log = Arc::new(Mutex::new(Vec::new()));
        let lines = Arc::clone(&log);
        let listener = std::thread::spawn(move || {
            for line in stderr.lines().map_while(Result::ok) {
                lines.lock().expect("no panic").push(line);
            }
        });
        let (child, listener) = (RefCell::new(child), RefCell::new(Some(listener)));
        let program = Self { child, display, log, listener };
        program.place_window();
        program.at_rest();
        program
    }

    /// Moves the window to the corner of the screen and gives it the keyboard: there is no window
    /// manager to do so.
    fn place_window(&self) {
        let window = wait_for("the window", || {
            assert!(!self.has_ended(), "{}", self.errors());
            let found = self.display.xdotool(&["search", "--onlyvisible", "--name", "ik-arm"]);
            found.lines().next().map(str::to_owned)
        });
        self.display.xdotool(&["windowmove", &window, "0", "0", "windowfocus", &window]);
        wait_for("the keyboard's focus", || {
            (self.display.xdotool(&["getwindowfocus"]) == window).then_some(())
        });
    }

    // Keyboard and mouse. Each waits until the program has drawn a frame, or has ended.

    /// Presses keys together, by their X names: `"ctrl+s"`, `"Return"`, `"shift+Tab"`.
    pub fn key(&self, keys: &str) {
        self.input(&["key", keys]);
    }

    pub fn type_text(&self, text: &str) {
        for letter in text.chars() {
            self.input(&["type", "--", &letter.to_string()]);
        }
    }

    pub fn mouse_to(&self, at: Pos2) {
        let (x, y) = (at.x.round(), at.y.round());
        // No event follows if the mouse is there already.
        if !self.display.xdotool(&["getmouselocation"]).starts_with(&format!("x:{x} y:{y} ")) {
            self.input(&["mousemove", &x.to_string(), &y.to_string()]);
        }
    }

    pub fn click(&self, at: Pos2) {
        self.mouse_to(at);
        self.input(&["click", "1"]);
    }

    pub fn double_click(&self, at: Pos2) {
        self.mouse_to(at);
        self.input(&["click", "--repeat", "2", "--delay", "80", "1"]);
    }

    pub fn drag(&self, from: Pos2, to: Pos2) {
        const STEPS: u8 = 6;
        self.mouse_to(from);
        self.input(&["mousedown", "1"]);
        for step in 1..=STEPS {
            // The first steps are short: a frame may see them together with the press.
            let part = (f32::from(step) / f32::from(STEPS)).powi(2);
            self.mouse_to(from + (to - from) * part);
        }
        self.input(&["mouseup", "1"]);
    }

    /// Gives xdotool several commands at once, so that keys follow each other without a pause.
    pub fn quickly(&self, arguments: &[&str]) {
        self.input(arguments);
    }

    fn input(&self, arguments: &[&str]) {
        let before = self.frames();
        self.display.xdotool(arguments);
        wait_for(&format!("a frame after {arguments:?}"), || {
            (self.frames() > before || self.has_ended()).then_some(())
        });
    }

    // Screen.

    /// Waits until the program has drawn something, and the screen has not changed for a while.
    pub fn at_rest(&self) -> RgbImage {
        let mut last = (self.frames(), self.display.picture());
        let mut since = Instant::now();
        self.wait_until("the screen at rest", |screen| {
            let now = (self.frames(), screen.clone());
            if now != last {
                (last, since) = (now, Instant::now());
            }
            last.0 > 0 && since.elapsed() > REST
        })
    }

    /// Waits until the screen differs from a picture of it.
    pub fn wait_for_change(&self, before: &RgbImage) -> RgbImage {
        self.wait_until("another picture", |screen| screen != before)
    }

    /// Waits for a picture of the screen that meets a condition.
    pub fn wait_until(&self, what: &str, mut holds: impl FnMut(&RgbImage) -> bool) -> RgbImage {
        wait_for(what, || Some(self.display.picture()).filter(&mut holds))
    }

    /// Number of frames drawn.
    fn frames(&self) -> usize {
        self.log.lock().expect("no panic").iter().filter(|line| is_frame(line)).count()
    }

    // Log.

    /// Standard error so far, without the lines about frames.
    pub fn errors(&self) -> String {
        let log = self.log.lock().expect("no panic");
        log.iter().filter(|line| !is_frame(line)).fold(String::new(), |all, line| all + line + "\n")
    }

    pub fn count_errors(&self) -> usize {
        self.log.lock().expect("no panic").iter().filter(|line| is_error(line)).count()
    }

    /// Returns whether a frame was drawn after the last logged error.
    pub fn has_drawn_since_error(&self) -> bool {
        let log = self.log.lock().expect("no panic");
        log.iter().rev().take_while(|line| !is_error(line)).any(|line| is_frame(line))
    }

    // End.

    /// Sends SIGTERM, as at a system shutdown.
    pub fn terminate(&self) {
        let id = self.child.borrow().id().cast_signed();
        kill(Pid::from_raw(id), Signal::SIGTERM).expect("the program runs");
    }

    /// Time that the program has spent on processors, in hundredths of a second.
    pub fn processor_time(&self) -> u64 {
        let stat = format!("/proc/{}/stat", self.child.borrow().id());
        let stat = std::fs::read_to_string(stat).expect("it runs");
        let after_name = stat.rsplit(')').next().expect("a name");
        let times = after_name.split_whitespace().skip(11).take(2);
        times.map(|time| time.parse::<u64>().expect("a number")).sum()
    }

    /// Kills the program, as a crash would.
    pub fn kill(&self) {
        self.child.borrow_mut().kill().expect("the program runs");
        self.end();
    }

    /// Waits for the end of the program and of its log. Returns the exit code.
    pub fn end(&self) -> Option<i32> {
        let exited = || self.child.borrow_mut().try_wait().expect("a child");
        let status = wait_for("the program's end", exited);
        self.listener.take().map(JoinHandle::join);
        status.code()
    }

    fn has_ended(&self) -> bool {
        self.child.borrow_mut().try_wait().expect("a child").is_some()
    }
}

impl Drop for Program {
    fn drop(&mut self) {
        if std::thread::panicking() {
            eprintln!("{}", self.errors());
        }
        // It has ended already, unless the test failed.
        let _ = self.child.get_mut().kill();
        let _ = self.child.get_mut().wait();
    }
}

fn is_frame(line: &str) -> bool {
    line.contains("TRACE") && line.contains("] frame ")
}

/// Asks in new settings that the scene is always drawn in full: at other resolutions, two pictures of
/// the same scene may differ, depending on how fast the machine is.
fn draw_in_full(settings: &Path) {
    let file = settings.join("ik-arm/settings.ron");
    if file.exists() {
        return;
    }
    std::fs::create_dir_all(settings.join("ik-arm")).expect("a folder");
    std::fs::write(file, "(preferences:(frame_budget:unlimited))").expect("settings");
}

fn is_error(line: &str) -> bool {
    line.contains("ERROR")
}

/// Polls until `found` returns a value.
pub fn wait_for<T>(what: &str, mut found: impl FnMut() -> Option<T>) -> T {
    let deadline = Instant::now() + PATIENCE;
    loop {
        if let Some(found) = found() {
            return found;
        }
        if Instant::now() > deadline {
            let file = keep(&Display::shared().picture(), what);
            panic!("waited {PATIENCE:?} for {what}; the screen is in {}", file.display());
        }
        sleep(POLL);
    }
}

/// Writes a picture to a file named after `what`.
pub fn keep(screen: &RgbImage, what: &str) -> PathBuf {
    let name = what.replace(|letter: char| !letter.is_alphanumeric(), "_");
    let file = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("{name}.png"));
    screen.save(&file).expect("written");
    file
}

/// Number of pixels that differ within `radius` of a point.
pub fn changed(a: &RgbImage, b: &RgbImage, at: Pos2, radius: f32) -> usize {
    let near = |x: u32, y: u32| egui::pos2(x as f32, y as f32).distance(at) <= radius;
    let differs = |a: &image::Rgb<u8>, b: &image::Rgb<u8>| {
        (0..3).any(|channel| a.0[channel].abs_diff(b.0[channel]) > 24)
    };
    let pixels = a.enumerate_pixels().zip(b.pixels());
    pixels.filter(|((x, y, a), b)| near(*x, *y) && differs(a, b)).count()
}
