use std::io::{self, Write as _};
use std::path::PathBuf;
use std::process::ExitCode;
use std::str::FromStr;

use clap::ValueEnum;
use glam::Vec3;
use serde::Serialize;
use thiserror::Error;

use crate::document::{Arm, AxisView, Camera, Display, Document, Layer, Theme};
use crate::kinematics::two_bone::{LengthError, TwoBone};
use crate::render::{self, Gpu, GpuError, Picture, ReadError, SaveError, Timings};
use crate::scene::Scene;

#[derive(clap::Args)]
pub struct Args {
    /// Where the picture goes, as PNG
    #[arg(short, long, value_name = "OUT.png", required_unless_present = "timings")]
    output: Option<PathBuf>,
    /// Pixels across and down, each 1 to 8192
    #[arg(long, value_name = "WxH", default_value = "1280x800")]
    size: Size,
    /// Where the hand is asked to be, relative to the root
    #[arg(long, value_name = "x,y,z", allow_hyphen_values = true)]
    hand: Option<Point>,
    /// Turn of the elbow about the Pointer, in degrees
    #[arg(long, value_name = "DEG", allow_hyphen_values = true, default_value = "0")]
    elbow_spin: Number,
    /// Where the shoulder is in the world
    #[arg(long, value_name = "x,y,z", allow_hyphen_values = true, default_value = "0,0,0")]
    root: Point,
    /// Length of the upper limb
    #[arg(long, value_name = "N", allow_hyphen_values = true, default_value = "200")]
    upper: Length,
    /// Length of the lower limb
    #[arg(long, value_name = "N", allow_hyphen_values = true, default_value = "300")]
    lower: Length,
    /// Which guides are shown
    #[arg(long, value_name = "LIST", default_value = "cursor,pointer")]
    guides: Guides,
    /// Where the arm is looked at from
    #[arg(long, value_enum, default_value_t = View::Perspective)]
    view: View,
    #[arg(long, value_enum, default_value_t = ThemeName::Dark)]
    theme: ThemeName,
    /// How many frames to time
    #[arg(
        long,
        value_name = "N",
        requires = "timings",
        default_value_t = 60,
        value_parser = clap::value_parser!(u32).range(1..=100_000)
    )]
    frames: u32,
    /// Print how long a frame takes, as JSON
    #[arg(long)]
    timings: bool,
}

#[derive(Clone, Copy, ValueEnum)]
enum View {
    Front,
    Right,
    Top,
    Perspective,
}

#[derive(Clone, Copy, ValueEnum)]
enum ThemeName {
    Dark,
    Light,
}

/// Why an argument is not what it stands for.
#[derive(Debug, Error, PartialEq)]
enum ArgumentError {
    #[error("{0:?} is not a size; it must be like 1280x800, each side 1 to {max}", max = Size::MAX)]
    Size(String),
    #[error("{0:?} is not a point; it must be three numbers like 250,120,60")]
    Point(String),
    #[error("{0:?} is not a number that a 32-bit float can hold")]
    Number(String),
    #[error(transparent)]
    Length(#[from] LengthError),
    #[error("{0:?} is not a guide; they are cursor, pointer, inner, outer, or none alone")]
    Guide(String),
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Size {
    width: u32,
    height: u32,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Number(f32);

#[derive(Clone, Copy, Debug, PartialEq)]
struct Length(f32);

#[derive(Clone, Copy, Debug, PartialEq)]
struct Point(Vec3);

#[derive(Clone, Copy, Debug, PartialEq)]
struct Guides(Display);

/// Why there is no picture.
#[derive(Debug, Error)]
enum RenderError {
    #[error(transparent)]
    Length(#[from] LengthError),
    #[error(transparent)]
    Gpu(#[from] GpuError),
    #[error("a picture of {width}x{height} is larger than this device draws: {longest} at most")]
    TooLarge { width: u32, height: u32, longest: u32 },
    #[error("the device could not draw the picture: {0}")]
    Device(String),
    #[error(transparent)]
    Read(#[from] ReadError),
    #[error(transparent)]
    Save(#[from] SaveError),
    #[error("the timings could not be written: {0}")]
    Write(#[from] io::Error),
}

#[derive(Serialize)]
struct TimingsLine<'a> {
    frames: u32,
    cpu_ms_median: f64,
    frame_ms_median: f64,
    adapter: &'a str,
}

pub fn run(args: &Args) -> ExitCode {
    match render(args) {
        Ok(()) => ExitCode::SUCCESS,
        Err(RenderError::Write(error)) if error.kind() == io::ErrorKind::BrokenPipe => {
            ExitCode::SUCCESS
        }
        Err(error) => super::fail(&error),
    }
}

fn render(args: &Args) -> Result<(), RenderError> {
    let document = args.document()?;
    let theme = args.theme.into();
    let Size { width, height } = args.size;
    let gpu = Gpu::headless()?;
    let longest = gpu.longest_side();
    if width.max(height) > longest {
        return Err(RenderError::TooLarge { width, height, longest });
    }

    let faults = [
        wgpu::ErrorFilter::Internal,
        wgpu::ErrorFilter::Validation,
        wgpu::ErrorFilter::OutOfMemory,
    ]
    .map(|kind| gpu.device.push_error_scope(kind));
    let mut picture = Picture::new(&gpu, width, height, args.size.scale());
    let scene = || Scene::new(&document, &document.arm.pose(), theme);
    let image = args.output.is_some().then(|| picture.draw(&scene())).transpose();
    for fault in faults.into_iter().rev() {
        if let Some(error) = pollster::block_on(fault.pop()) {
            return Err(RenderError::Device(error.to_string()));
        }
    }
    if let (Some(image), Some(path)) = (image?, &args.output) {
        render::save(&image, path)?;
    }
    if args.timings {
        print(picture.time(args.frames, scene)?, &gpu.name())?;
    }
    Ok(())
}

fn print(timings: Timings, adapter: &str) -> Result<(), io::Error> {
    let milliseconds = |time: std::time::Duration| (time.as_secs_f64() * 1e6).round() / 1e3;
    let line = serde_json::to_string(&TimingsLine {
        frames: timings.frames,
        cpu_ms_median: milliseconds(timings.cpu),
        frame_ms_median: milliseconds(timings.frame),
        adapter,
    })?;
    writeln!(io::stdout(), "{line}")
}

impl Args {
    fn document(&self) -> Result<Document, LengthError> {
        let mut arm = Arm::default();
        arm.bones = TwoBone::new(self.upper.0, self.lower.0)?;
        arm.cursor = self.hand.map_or(arm.cursor, |hand| hand.0);
        arm.elbow_spin = (self.elbow_spin.0 % 360.0).to_radians();
        arm.root = self.root.0;
        let display = self.guides.0;
        let (centre, radius) = framed(&arm, display);
        let aspect = self.size.width as f32 / self.size.height as f32;
        let camera = self.view.camera().framing(centre, radius, aspect);
        Ok(Document { arm, camera, display })
    }
}

/// A sphere around all that is to be seen: the arm, its Cursor, its Outer Limit.
fn framed(arm: &Arm, display: Display) -> (Vec3, f32) {
    let (centre, radius) = arm.bounds(&arm.pose());
    if display.shows(Layer::OuterLimit) {
        (arm.root, arm.bones.outer_limit().max(arm.root.distance(centre) + radius))
    } else if display.shows(Layer::Cursor) {
        let cursor = arm.cursor_world();
        let far = centre.distance(cursor);
        let beyond = (far - radius).max(0.0);
        let centre = centre.move_towards(cursor, beyond / 2.0);
        (centre, radius + beyond / 2.0)
    } else {
        (centre, radius)
    }
}

impl View {
    fn camera(self) -> Camera {
        let camera = Camera::default();
        match self {
            Self::Front => camera.along(AxisView::Front),
            Self::Right => camera.along(AxisView::Right),
            Self::Top => camera.along(AxisView::Top),
            Self::Perspective => camera,
        }
    }
}

impl From<ThemeName> for Theme {
    fn from(name: ThemeName) -> Self {
        match name {
            ThemeName::Dark => Self::Dark,
            ThemeName::Light => Self::Light,
        }
    }
}

impl Size {
    const MAX: u32 = 8192;

    /// Lines and letters are as large as in a window of 1280×800, in larger pictures larger.
    fn scale(self) -> f32 {
        (self.width.min(self.height) as f32 / 800.0).max(1.0)
    }
}

impl FromStr for Size {
    type Err = ArgumentError;

    fn from_str(text: &str) -> Result<Self, ArgumentError> {
        let side = |text: &str| {
            text.parse()
                .ok()
                .filter(|side| (1..=Self::MAX).contains(side) && !text.starts_with('+'))
        };
        text.split_once('x')
            .and_then(|(width, height)| Some(Self { width: side(width)?, height: side(height)? }))
            .ok_or_else(|| ArgumentError::Size(text.to_owned()))
    }
}

impl FromStr for Number {
    type Err = ArgumentError;

    fn from_str(text: &str) -> Result<Self, ArgumentError> {
        let number = text.trim().parse().ok().filter(|number: &f32| number.is_finite());
        number.map(Self).ok_or_else(|| ArgumentError::Number(text.to_owned()))
    }
}

impl FromStr for Length {
    type Err = ArgumentError;

    fn from_str(text: &str) -> Result<Self, ArgumentError> {
        let Number(length) = text.parse()?;
        TwoBone::new(length, length)
            .map(|bones| Self(bones.upper()))
            .map_err(|_| ArgumentError::Length(LengthError { bone: "limb", value: length }))
    }
}

impl FromStr for Point {
    type Err = ArgumentError;

    fn from_str(text: &str) -> Result<Self, ArgumentError> {
        let numbers: Result<Vec<Number>, _> = text.split(',').map(str::parse).collect();
        match numbers.as_deref() {
            Ok([x, y, z]) => Ok(Self(Vec3::new(x.0, y.0, z.0))),
            _ => Err(ArgumentError::Point(text.to_owned())),
        }
    }
}

impl FromStr for Guides {
    type Err = ArgumentError;

    fn from_str(text: &str) -> Result<Self, ArgumentError> {
        let hidden = Layer::GUIDES
            .into_iter()
            .fold(Display::default(), |display, guide| display.with(guide, false));
        if text == "none" {
            return Ok(Self(hidden));
        }
        let shown = text.split(',').try_fold(hidden, |display, name| {
            let guide = match name.trim() {
                "cursor" => Layer::Cursor,
                "pointer" => Layer::Pointer,
                "inner" => Layer::InnerLimit,
                "outer" => Layer::OuterLimit,
                _ => return Err(ArgumentError::Guide(name.to_owned())),
            };
            Ok(display.with(guide, true))
        });
        shown.map(Self)
    }
}
