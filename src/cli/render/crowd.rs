use super::args::RenderArgs;
use super::timings::{CrowdTimingsLine, FrameProgress, milliseconds};
use crate::cli::report::{CommandError, print_json};
use crate::cli::view_name::ViewName;
use crate::document::{Document, Theme};
use crate::kinematics::two_bone::TwoBone;
use crate::render::{self, Gpu, PictureRenderer};
use crate::rig::Crowd;
use crate::scene::Scene;
use crate::session::Overlays;

/// Time that the crowd's motion advances from one measured frame to the next, in seconds.
const STEP: f32 = 1.0 / 60.0;

/// Draws a crowd of arms to a file, prints its frame times, or both.
pub fn render(args: &RenderArgs, arms: u32) -> Result<(), CommandError> {
    let crowd = Crowd {
        arms,
        bones: TwoBone::new(args.upper.0, args.lower.0)?,
        time: (args.time.0 % f64::from(Crowd::PERIOD)) as f32,
        processor: args.solve.into(),
    };
    let document = document(args, &crowd);
    let theme = args.theme.into();
    if scene(&document, crowd, theme).crowd.is_none() {
        let (min, max) = (Scene::CROWD_RADII.start, Scene::CROWD_RADII.end);
        let (upper, lower) = (args.upper.0, args.lower.0);
        return Err(CommandError::CrowdLength { min, max, upper, lower });
    }
    let gpu = Gpu::headless()?;
    let mut picture = PictureRenderer::of_size(&gpu, args.size.width, args.size.height)?;
    if let Some(path) = &args.output {
        let image = picture.draw(&scene(&document, crowd, theme))?;
        picture.crowd_times()?;
        render::save(&image, path)?;
    }
    if args.timings {
        let progress = FrameProgress::new(args.frames);
        let timings = picture.time(args.frames, |frame| {
            progress.show(frame);
            let time = crowd.time + frame as f32 * STEP;
            scene(&document, Crowd { time, ..crowd }, theme)
        })?;
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

fn scene(document: &Document, crowd: Crowd, theme: Theme) -> Scene {
    let overlays = Overlays { crowd: Some(crowd), ..Overlays::default() };
    Scene::new(&document.at(0.0), &overlays, theme)
}

/// A document whose camera frames the whole crowd.
fn document(args: &RenderArgs, crowd: &Crowd) -> Document {
    let mut document = Document::default();
    let (centre, radius) = crowd.bounds();
    let aspect = args.size.width as f32 / args.size.height as f32;
    let view = args.view.unwrap_or(ViewName::Perspective);
    document.camera = view.camera().framing(centre, radius, aspect);
    document
}
