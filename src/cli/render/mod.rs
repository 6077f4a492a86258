//! `ik-arm render`: the arm, a file or a crowd as a picture.

mod args;
mod crowd;
mod timings;

use super::open;
use super::report::{CommandError, print_json};
use super::view_name::ViewName;
use crate::document::{Arm, Cursor, Document, Posed, Track};
use crate::kinematics::two_bone::{LengthError, TwoBone};
use crate::render::{self, Gpu, PictureRenderer};
use crate::scene::Scene;
use crate::session::Overlays;
pub use args::RenderArgs;
use timings::{TimingsLine, milliseconds};

pub fn run(args: &RenderArgs) -> Result<(), CommandError> {
    if let Some(arms) = args.crowd {
        return crowd::render(args, arms);
    }
    let (track, posed) = posed(args)?;
    let theme = args.theme.into();
    let overlays = Overlays::new(&track, &posed);
    let gpu = Gpu::headless()?;
    let mut picture = PictureRenderer::of_size(&gpu, args.size.width, args.size.height)?;
    let scene = || Scene::new(&posed, &overlays, theme);
    if let Some(path) = &args.output {
        render::save(&picture.draw(&scene())?, path)?;
    }
    if args.timings {
        let timings = picture.time(args.frames, |_| scene())?;
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
        None => Track::new(&Document { arm: arm(args)?, ..Document::default() }),
    };
    let mut document = track.at(args.time.0).into_document();
    if let Some(guides) = &args.guides {
        document.display = guides.shown_in(document.display);
    }
    let view = args.view.or(args.file.is_none().then_some(ViewName::Perspective));
    if let Some(view) = view {
        document.camera = view.framing(&document, args.size);
    }
    let posed = track.pose(document, args.time.0);
    Ok((track, posed))
}

fn arm(args: &RenderArgs) -> Result<Arm, LengthError> {
    let mut arm = Arm::default();
    arm.bones = TwoBone::new(args.upper.0, args.lower.0)?;
    arm.cursor = Cursor::unpinned(args.hand.map_or(arm.cursor_in_root(), |hand| hand.0));
    arm.twist = (args.twist.0 % 360.0).to_radians();
    arm.root = args.root.0;
    Ok(arm)
}
