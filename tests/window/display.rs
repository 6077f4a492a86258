//! Displays: the one that the tests share, and servers of their own for tests that kill them.

use std::io::{BufRead as _, BufReader};
use std::process::{Child, Command, Stdio};

use image::RgbImage;

use crate::screen::SIZE;

/// An X display, to which keyboard and mouse input is sent and of which pictures are taken.
#[derive(Clone)]
pub struct Display(String);

impl Display {
    /// The display that the tests share.
    pub fn shared() -> Self {
        Self(std::env::var("DISPLAY").expect("DISPLAY is set"))
    }

    /// Value of `DISPLAY` for a program that is to open its window here.
    pub fn name(&self) -> &str {
        &self.0
    }

    pub fn xdotool(&self, arguments: &[&str]) -> String {
        let output = self.command("xdotool").args(arguments).output().expect("xdotool runs");
        String::from_utf8_lossy(&output.stdout).trim().to_owned()
    }

    pub fn picture(&self) -> RgbImage {
        let part = format!("{}x{}+0+0", SIZE.0, SIZE.1);
        let taken = self
            .command("import")
            .args(["-window", "root", "-crop", &part, "-depth", "8", "rgb:-"])
            .output()
            .expect("import runs");
        assert!(taken.status.success(), "{}", String::from_utf8_lossy(&taken.stderr));
        let picture = RgbImage::from_raw(SIZE.0, SIZE.1, taken.stdout);
        picture.expect("the screen is as large as the window")
    }

    fn command(&self, program: &str) -> Command {
        let mut command = Command::new(program);
        command.env("DISPLAY", &self.0);
        command
    }
}

/// A display server of its own, killed when dropped.
pub struct DisplayServer {
    server: Child,
    display: Display,
}

impl DisplayServer {
    /// Starts a server with a display number that is free.
    pub fn start() -> Self {
        let size = format!("{}x{}x24", SIZE.0, SIZE.1);
        let mut server = Command::new("Xvfb")
            .args(["-displayfd", "1", "-screen", "0", &size])
            .args(["-dpi", "96", "-nolisten", "tcp", "-noreset"])
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .expect("Xvfb starts");
        let mut number = String::new();
        let mut answer = BufReader::new(server.stdout.take().expect("piped"));
        answer.read_line(&mut number).expect("Xvfb writes the number of its display");
        Self { server, display: Display(format!(":{}", number.trim())) }
    }

    pub fn display(&self) -> Display {
        self.display.clone()
    }

    pub fn kill(&mut self) {
        self.server.kill().expect("the server runs");
        self.server.wait().expect("the server ends");
    }
}

impl Drop for DisplayServer {
    fn drop(&mut self) {
        // A test has ended it already, unless the test failed.
        let _ = self.server.kill();
        let _ = self.server.wait();
    }
}
