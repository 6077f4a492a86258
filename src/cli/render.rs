//! `ik-arm render`: the arm, a file or a crowd as a picture.

use std::io::{IsTerminal as _, stderr};
use std::path::PathBuf;
use std::time::Duration;

use clap::ValueEnum;
use glam::Vec3;
use indicatif::ProgressBar;
use pollster::block_on;
use serde::Serialize;

use super::argument::{ShownGuides, ViewName, guides, length, number, point, size, time};
use super::open::{self, OpenArgs};
use super::report::{CommandError, print_json};
use super::time_limit::TimeLimitArgs;
use crate::document::{Document, Posed, SkeletonRig, Theme, Track};
use crate::kinematics::two_bone::{LengthError, TwoBone};
use crate::render::{self, Gpu, PictureRenderer};
use crate::rig::{Crowd, Processor};
use crate::scene::Scene;
use crate::session::Overlays;

#[derive(clap::Args)]
#[command(after_help = "Without FILE the arm is drawn, posed by --hand, --twist and the lengths:
  ik-arm render -o arm.png --hand 250,120,60 --twist 30
With FILE its rig is drawn with its own camera, unless --view is given:
  ik-arm render human.json -o human.png --view front
Measure a crowd without drawing a picture:
  ik-arm render --crowd 100000 --frames 60 --timings --solve gpu")]
pub struct RenderArgs {
    #[arg(help = open::input_help("File to draw"), value_name = "FILE", conflicts_with_all = ["hand", "twist", "root", "upper", "lower"])]
    file: Option<PathBuf>,
    #[command(flatten)]
    open: OpenArgs,
    #[command(flatten)]
    time_limit: TimeLimitArgs,
    /// Time of the picture in seconds, at which keys and moving targets are evaluated
    #[arg(long, value_name = "S", allow_hyphen_values = true, default_value = "0", value_parser = time)]
    time: f64,
    /// PNG file to write
    #[arg(short, long, value_name = "OUT.png", required_unless_present = "timings")]
    output: Option<PathBuf>,
    /// Width and height in pixels, each 1 to 8192
    #[arg(long, value_name = "WxH", default_value = "1280x800", value_parser = size)]
    size: (u32, u32),
    /// Position of the Cursor, the hand's target, relative to the Root
    #[arg(long, value_name = "x,y,z", allow_hyphen_values = true, value_parser = point)]
    hand: Option<Vec3>,
    /// Socket twist: rotation of the elbow about the Pointer, in degrees
    #[arg(long, value_name = "DEG", allow_hyphen_values = true, default_value = "0", value_parser = number)]
    twist: f32,
    /// Position of the Root (the shoulder) in the world
    #[arg(long, value_name = "x,y,z", allow_hyphen_values = true, default_value = "0,0,0", value_parser = point)]
    root: Vec3,
    /// Length of the upper limb
    #[arg(long, value_name = "N", allow_hyphen_values = true, default_value = "200", value_parser = length)]
    upper: f32,
    /// Length of the lower limb
    #[arg(long, value_name = "N", allow_hyphen_values = true, default_value = "300", value_parser = length)]
    lower: f32,
    /// Guides to show: any of cursor, pointer, inner, outer, circle; or none [default: the file's,
    /// else cursor,pointer]
    #[arg(long, value_name = "LIST", value_parser = guides)]
    guides: Option<ShownGuides>,
    /// Camera that frames the rig from this side [default: the file's camera, else perspective]
    #[arg(long, value_enum)]
    view: Option<ViewName>,
    /// Colours of the picture
    #[arg(long, value_enum, default_value_t = Theme::Dark)]
    theme: Theme,
    /// Draw this many arms instead, each with a target of its own
    #[arg(
        long,
        value_name = "N",
        conflicts_with_all = ["file", "hand", "twist", "root", "guides"],
        value_parser = clap::value_parser!(u32).range(1..=i64::from(Crowd::MOST))
    )]
    crowd: Option<u32>,
    /// Solver of the crowd
    #[arg(long, value_enum, requires = "crowd", default_value_t = CrowdSolverName::Cpu)]
    solve: CrowdSolverName,
    /// Number of frames to time
    #[arg(
        long,
        value_name = "N",
        requires = "timings",
        default_value_t = 60,
        value_parser = clap::value_parser!(u32).range(1..=100_000)
    )]
    frames: u32,
    /// Print median frame times as one line of JSON
    #[arg(long)]
    timings: bool,
}

#[derive(Clone, Copy, ValueEnum)]
pub enum CrowdSolverName {
    /// Batch solver on all cores
    Cpu,
    /// Compute shader with the same formulas
    Gpu,
}

impl From<CrowdSolverName> for Processor {
    fn from(name: CrowdSolverName) -> Self {
        match name {
            CrowdSolverName::Cpu => Self::Cpu,
            CrowdSolverName::Gpu => Self::Gpu,
        }
    }
}

pub fn run(args: &RenderArgs) -> Result<(), CommandError> {
    if let Some(arms) = args.crowd {
        return draw_crowd(args, arms);
    }
    let (track, posed) = posed(args)?;
    let overlays = Overlays::new(&track, &posed);
    let gpu = block_on(Gpu::headless())?;
    let mut picture = block_on(PictureRenderer::of_size(&gpu, args.size.0, args.size.1))?;
    let scene = || Scene::new(&posed, &overlays, args.theme);
    if let Some(path) = &args.output {
        render::save(&block_on(picture.draw(&scene()))?, path)?;
    }
    if args.timings {
        let timings = block_on(picture.time(args.frames, |_| scene()))?;
        print_json(&TimingsLine {
            frames: timings.frames,
            cpu_ms_median: milliseconds(timings.cpu),
            frame_ms_median: milliseconds(timings.frame),
            adapter: &gpu.name(),
        })?;
    }
    Ok(())
}

/// Returns the pose to draw at the time in `args`, with its track: of the file, or without a file
/// of a document with the arm that the arguments describe.
fn posed(args: &RenderArgs) -> Result<(Track, Posed), CommandError> {
    let track = match &args.file {
        Some(file) => {
            args.time_limit.start_long(file);
            Track::new(&open::open_to_draw(file, &args.open.options())?.document)
        }
        None => Track::new(&arm(args)?),
    };
    let mut document = track.at(args.time).into_document();
    if let Some(guides) = &args.guides {
        document.display = guides.shown_in(document.display);
    }
    let view = args.view.or(args.file.is_none().then_some(ViewName::Perspective));
    if let Some(view) = view {
        document.camera = view.framing(&document, args.size);
    }
    let posed = track.pose(document, args.time);
    Ok((track, posed))
}

/// The document of the arm that the arguments describe.
fn arm(args: &RenderArgs) -> Result<Document, LengthError> {
    let mut document = Document::arm(TwoBone::new(args.upper, args.lower)?);
    document.skeleton_mut().write_local(SkeletonRig::ROOT, |root| root.offset = args.root);
    for target in &mut document.rig.targets {
        target.home = args.hand.unwrap_or(target.home);
        if let Some(limb) = target.limb_mut() {
            limb.twist = (args.twist % 360.0).to_radians();
        }
    }
    Ok(document)
}

/// Time that the crowd's motion advances from one measured frame to the next, in seconds.
const STEP: f32 = 1.0 / 60.0;

/// Draws a crowd of arms to a file, prints its frame times, or both.
fn draw_crowd(args: &RenderArgs, arms: u32) -> Result<(), CommandError> {
    let crowd = Crowd {
        arms,
        bones: TwoBone::new(args.upper, args.lower)?,
        time: (args.time % f64::from(Crowd::PERIOD)) as f32,
        processor: args.solve.into(),
    };
    let document = crowd_document(args, &crowd);
    let scene = |crowd| {
        let overlays = Overlays { crowd: Some(crowd), ..Overlays::default() };
        Scene::new(&document.at(0.0), &overlays, args.theme)
    };
    if scene(crowd).crowd.is_none() {
        let (min, max) = (Scene::CROWD_RADII.start, Scene::CROWD_RADII.end);
        let (upper, lower) = (args.upper, args.lower);
        return Err(CommandError::CrowdLength { min, max, upper, lower });
    }
    let gpu = block_on(Gpu::headless())?;
    let mut picture = block_on(PictureRenderer::of_size(&gpu, args.size.0, args.size.1))?;
    if let Some(path) = &args.output {
        let image = block_on(picture.draw(&scene(crowd)))?;
        picture.crowd_times()?;
        render::save(&image, path)?;
    }
    if args.timings {
        let progress = FrameProgress::new(args.frames);
        let timings = block_on(picture.time(args.frames, |frame| {
            progress.show(frame);
            let time = crowd.time + frame as f32 * STEP;
            scene(Crowd { time, ..crowd })
        }))?;
        progress.finish();
        picture.crowd_times()?;
        print_json(&CrowdTimingsLine {
            arms,
            frames: timings.frames,
            solve_ms_median: milliseconds(timings.solve.unwrap_or_default()),
            frame_ms_median: milliseconds(timings.frame),
            adapter: &gpu.name(),
        })?;
    }
    Ok(())
}

/// A document whose camera frames the whole crowd.
fn crowd_document(args: &RenderArgs, crowd: &Crowd) -> Document {
    let mut document = Document::default();
    let (centre, radius) = crowd.bounds();
    let (width, height) = args.size;
    let view = args.view.unwrap_or(ViewName::Perspective);
    document.camera = view.camera().framing(centre, radius, width as f32 / height as f32);
    document
}

/// Output of `--timings` without a crowd: median times in milliseconds.
#[derive(Serialize)]
struct TimingsLine<'a> {
    frames: u32,
    cpu_ms_median: f64,
    frame_ms_median: f64,
    adapter: &'a str,
}

/// Output of `--timings` with a crowd: median times in milliseconds.
#[derive(Serialize)]
struct CrowdTimingsLine<'a> {
    arms: u32,
    frames: u32,
    solve_ms_median: f64,
    frame_ms_median: f64,
    adapter: &'a str,
}

/// Converts a time to milliseconds, rounded to whole microseconds.
fn milliseconds(time: Duration) -> f64 {
    (time.as_secs_f64() * 1e6).round() / 1e3
}

/// Progress over frames on standard error: in a terminal a bar, otherwise a line for every tenth of
/// the frames.
struct FrameProgress {
    bar: ProgressBar,
    frames: u32,
}

impl FrameProgress {
    fn new(frames: u32) -> Self {
        Self { bar: ProgressBar::new(u64::from(frames)), frames }
    }

    fn show(&self, frame: u32) {
        self.bar.set_position(u64::from(frame));
        let tenth = (self.frames / 10).max(1);
        if !stderr().is_terminal() && frame.is_multiple_of(tenth) {
            eprintln!("frame {} of {}", frame + 1, self.frames);
        }
    }

    fn finish(&self) {
        self.bar.finish_and_clear();
    }
}
