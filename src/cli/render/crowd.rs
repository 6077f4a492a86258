use std::io::IsTerminal as _;

use indicatif::ProgressBar;
use serde::Serialize;

use super::{Args, RenderError, SolverName, View, milliseconds, print};
use crate::document::{Document, Theme};
use crate::kinematics::two_bone::TwoBone;
use crate::render::{self, Gpu, Picture};
use crate::rig::{Crowd, SolvedBy};
use crate::scene::Scene;
use crate::session::Overlays;

/// From one frame that is timed to the next, in seconds of the crowd.
const STEP: f32 = 1.0 / 60.0;

#[derive(Serialize)]
struct CrowdLine<'a> {
    arms: u32,
    frames: u32,
    solve_ms_median: f64,
    frame_ms_median: f64,
    adapter: &'a str,
}

pub fn render(args: &Args, arms: u32) -> Result<(), RenderError> {
    let crowd = Crowd {
        arms,
        bones: TwoBone::new(args.upper.0, args.lower.0)?,
        time: (args.time.0 % f64::from(Crowd::PERIOD)) as f32,
        solved_by: match args.solve {
            SolverName::Cpu => SolvedBy::Cpu,
            SolverName::Gpu => SolvedBy::Gpu,
        },
    };
    let document = document(args, &crowd);
    let theme = args.theme.into();
    let gpu = Gpu::headless()?;
    let mut picture = Picture::of_size(&gpu, args.size.width, args.size.height)?;
    if let Some(path) = &args.output {
        let image = picture.draw(&scene(&document, crowd, theme))?;
        if !picture.has_crowd() {
            return Err(RenderError::NoCrowd(gpu.name()));
        }
        render::save(&image, path)?;
    }
    if args.timings {
        let progress = Progress::new(args.frames);
        let timings = picture.time(args.frames, |frame| {
            progress.tell(frame);
            let time = crowd.time + frame as f32 * STEP;
            scene(&document, Crowd { time, ..crowd }, theme)
        })?;
        progress.end();
        let adapter = gpu.name();
        let solve = timings.solve.ok_or_else(|| RenderError::NoCrowd(adapter.clone()))?;
        print(&CrowdLine {
            arms,
            frames: timings.frames,
            solve_ms_median: milliseconds(solve),
            frame_ms_median: milliseconds(timings.frame),
            adapter: &adapter,
        })?;
    }
    Ok(())
}

fn scene(document: &Document, crowd: Crowd, theme: Theme) -> Scene {
    let overlays = Overlays { crowd: Some(crowd), ..Overlays::default() };
    Scene::new(document, &overlays, theme)
}

/// Looks at all arms, from where it is said.
fn document(args: &Args, crowd: &Crowd) -> Document {
    let mut document = Document::default();
    let (centre, radius) = crowd.bounds();
    let aspect = args.size.width as f32 / args.size.height as f32;
    let view = args.view.unwrap_or(View::Perspective);
    document.camera = view.camera().framing(centre, radius, aspect);
    document
}

/// How many frames are drawn: a bar in a terminal, else a line for each tenth.
struct Progress {
    bar: ProgressBar,
    frames: u32,
}

impl Progress {
    fn new(frames: u32) -> Self {
        Self { bar: ProgressBar::new(u64::from(frames)), frames }
    }

    fn tell(&self, frame: u32) {
        self.bar.set_position(u64::from(frame));
        let tenth = (self.frames / 10).max(1);
        if !std::io::stderr().is_terminal() && frame.is_multiple_of(tenth) {
            eprintln!("frame {} of {}", frame + 1, self.frames);
        }
    }

    fn end(&self) {
        self.bar.finish_and_clear();
    }
}
