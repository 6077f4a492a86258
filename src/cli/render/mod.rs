//! `ik-arm render`: the arm, a file or a crowd as a picture.

mod crowd;

use std::io::{self, Write as _};
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Duration;

use clap::ValueEnum;
use glam::Vec3;
use serde::Serialize;
use thiserror::Error;

use super::argument::{Guides, Length, Number, Point, Size, ThemeName, Time};
use super::open;
use crate::document::{Arm, AxisView, Camera, Cursor, Display, Document, Overlay, RigKind};
use crate::io::OpenError;
use crate::kinematics::two_bone::{LengthError, TwoBone};
use crate::render::{self, DrawError, Gpu, GpuError, Picture, ReadError, SaveError, Timings};
use crate::rig::Crowd;
use crate::scene::Scene;
use crate::session::Overlays;

#[derive(clap::Args)]
#[command(after_help = "Without FILE the arm is drawn as --hand and the like have it:
  ik-arm render -o arm.png --hand 250,120,60
With FILE what it shows, from where it is looked at there, unless --view says otherwise:
  ik-arm render human.json -o human.png --view front
How long a crowd takes, without a window:
  ik-arm render --crowd 100000 --frames 60 --timings --solve gpu")]
pub struct Args {
    /// Document of ik-arm, .js3d scene of Scotty3D, .bvh, .glb or .gltf, or - for standard input
    #[arg(
        value_name = "FILE",
        conflicts_with_all = ["hand", "elbow_spin", "root", "upper", "lower"]
    )]
    file: Option<PathBuf>,
    /// Which skeleton of a scene; the first if nothing is said
    #[arg(long, value_name = "NAME", requires = "file")]
    skeleton: Option<String>,
    /// When the picture is taken, in seconds: where keys, targets and what moves by itself are then
    #[arg(long, value_name = "S", allow_hyphen_values = true, default_value = "0")]
    time: Time,
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
    twist: Number,
    /// Where the shoulder is in the world
    #[arg(long, value_name = "x,y,z", allow_hyphen_values = true, default_value = "0,0,0")]
    root: Point,
    /// Length of the upper limb
    #[arg(long, value_name = "N", allow_hyphen_values = true, default_value = "200")]
    upper: Length,
    /// Length of the lower limb
    #[arg(long, value_name = "N", allow_hyphen_values = true, default_value = "300")]
    lower: Length,
    /// Which guides are shown: cursor, pointer, inner, outer, or none [default: the file's, else
    /// cursor,pointer]
    #[arg(long, value_name = "LIST")]
    guides: Option<Guides>,
    /// Where it is looked at from [default: the file's, else perspective]
    #[arg(long, value_enum)]
    view: Option<View>,
    #[arg(long, value_enum, default_value_t = ThemeName::Dark)]
    theme: ThemeName,
    /// Draws so many arms in the arm's place, each after a target of its own
    #[arg(
        long,
        value_name = "N",
        conflicts_with_all = ["file", "hand", "elbow_spin", "root", "guides"],
        value_parser = clap::value_parser!(u32).range(1..=i64::from(Crowd::MOST))
    )]
    crowd: Option<u32>,
    /// What solves them
    #[arg(long, value_enum, requires = "crowd", default_value_t = SolverName::Cpu)]
    solve: SolverName,
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
enum SolverName {
    /// The batch solver, on all cores
    Cpu,
    /// The same mathematics in a shader
    Gpu,
}

#[derive(Clone, Copy, ValueEnum)]
enum View {
    Front,
    Right,
    Top,
    Perspective,
}

/// Why there is no picture.
#[derive(Debug, Error)]
enum RenderError {
    #[error(transparent)]
    Length(#[from] LengthError),
    #[error(transparent)]
    Open(#[from] OpenError),
    #[error(transparent)]
    Gpu(#[from] GpuError),
    #[error(transparent)]
    Draw(#[from] DrawError),
    #[error(transparent)]
    Read(#[from] ReadError),
    #[error(
        "the graphics adapter {0} does not draw this crowd: it lacks the shaders for it, or the arms are too large"
    )]
    NoCrowd(String),
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
    if let Some(arms) = args.crowd {
        return crowd::render(args, arms);
    }
    let document = args.document()?;
    let theme = args.theme.into();
    let overlays = Overlays::new(&document, args.time.0);
    let gpu = Gpu::headless()?;
    let mut picture = Picture::of_size(&gpu, args.size.width, args.size.height)?;
    let scene = || Scene::new(&document, &overlays, theme);
    let image = args.output.is_some().then(|| picture.draw(&scene())).transpose()?;
    if let (Some(image), Some(path)) = (image, &args.output) {
        render::save(&image, path)?;
    }
    if args.timings {
        print(&TimingsLine::new(picture.time(args.frames, |_| scene())?, &gpu.name()))?;
    }
    Ok(())
}

impl<'a> TimingsLine<'a> {
    fn new(timings: Timings, adapter: &'a str) -> Self {
        Self {
            frames: timings.frames,
            cpu_ms_median: milliseconds(timings.cpu),
            frame_ms_median: milliseconds(timings.frame),
            adapter,
        }
    }
}

fn milliseconds(time: Duration) -> f64 {
    (time.as_secs_f64() * 1e6).round() / 1e3
}

fn print(line: &impl Serialize) -> Result<(), io::Error> {
    writeln!(io::stdout(), "{}", serde_json::to_string(line)?)
}

impl Args {
    fn document(&self) -> Result<Document, RenderError> {
        let time = self.time.0;
        let mut document = match &self.file {
            Some(file) => {
                let opened = open::open(file, self.skeleton.as_deref())?;
                opened.document.at(time)
            }
            None => Document { arm: self.arm()?, ..Document::default() },
        };
        if let Some(guides) = &self.guides {
            document.display = guides.shown_in(document.display);
        }
        let view = self.view.or(self.file.is_none().then_some(View::Perspective));
        if let Some(view) = view {
            let (centre, radius) = bounds(&document, time);
            let aspect = self.size.width as f32 / self.size.height as f32;
            document.camera = view.camera().framing(centre, radius, aspect);
        }
        Ok(document)
    }

    fn arm(&self) -> Result<Arm, LengthError> {
        let mut arm = Arm::default();
        arm.bones = TwoBone::new(self.upper.0, self.lower.0)?;
        arm.goal = Cursor::Root(self.hand.map_or(arm.cursor(), |hand| hand.0));
        arm.twist = (self.twist.0 % 360.0).to_radians();
        arm.root = self.root.0;
        Ok(arm)
    }
}

/// A sphere around all that is to be seen.
fn bounds(document: &Document, time: f64) -> (Vec3, f32) {
    match document.rig {
        RigKind::Arm => framed(&document.arm, document.display),
        RigKind::Skeleton => {
            let rig = &document.skeleton_rig;
            rig.bounds(&rig.at(time).pose(), time)
        }
    }
}

/// A sphere around the arm, its Cursor, its Outer Limit.
fn framed(arm: &Arm, display: Display) -> (Vec3, f32) {
    let (centre, radius) = arm.bounds(&arm.pose());
    if display.shows(Overlay::OuterLimit) {
        (arm.root, arm.bones.outer_limit().max(arm.root.distance(centre) + radius))
    } else if display.shows(Overlay::Cursor) {
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
