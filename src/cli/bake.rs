//! `ik-arm bake`: a document whose skeleton moves by keys instead of targets.

use std::path::PathBuf;

use super::argument::{FrameRateArgument, NumberArgument};
use super::open;
use super::open_args::OpenArgs;
use super::progress_bar::run_with_bar;
use super::report::{CommandError, say};
use super::time_limit::TimeLimitArgs;
use crate::document::{Bake, BakeError, Baked, Document, Timeline};
use crate::io::save;

#[derive(clap::Args)]
#[command(
    after_help = r#"Evaluates every frame of the file's timeline and keys the rotations of joints, and the
offsets that solvers move. Then removes keys while every base and tip stays within the tolerance at
every frame. The targets stay in the document, with their influence keyed to 0; a followed path is
removed. The numbers of keys, and bones whose stretch keys cannot hold, are listed on stderr. Ctrl+C
cancels: no file is written, and the exit code is 130."#
)]
pub struct BakeArgs {
    /// File to bake, an ik-arm document (.json); - reads standard input
    #[arg(value_name = "FILE")]
    file: PathBuf,
    /// Document to write (.json)
    #[arg(short, long, value_name = "OUT")]
    output: PathBuf,
    #[command(flatten)]
    open: OpenArgs,
    /// Frames per second [default: the timeline's]
    #[arg(long, value_name = "N", allow_hyphen_values = true)]
    fps: Option<FrameRateArgument>,
    /// Largest distance from the evaluated motion at a frame, as a fraction of the skeleton's
    /// reach, 0.00001 to 1 [default: 0.001]
    #[arg(long, value_name = "T", allow_hyphen_values = true)]
    tolerance: Option<NumberArgument>,
    #[command(flatten)]
    time_limit: TimeLimitArgs,
}

pub fn run(args: &BakeArgs) -> Result<(), CommandError> {
    let BakeArgs { file, output, .. } = args;
    open::require_document("bake", output)?;
    let limit = args.time_limit.start_long(file);
    let document = open::open(file, &args.open.options())?.document;
    let settings = args.settings(&document);
    let baked = run_with_bar(&limit, |progress| {
        settings.run(&document, |done, total| progress.step(done, total).is_ok())
    })?;
    let baked = baked.map_err(|error| match error {
        cancelled @ BakeError::Cancelled => {
            CommandError::Cancelled { cancelled, output: output.display().to_string() }
        }
        error => CommandError::of_file(open::name(file), error),
    })?;
    save(&baked.document, output)?;
    report(&settings, &baked).iter().for_each(|line| say(line));
    Ok(())
}

impl BakeArgs {
    fn settings(&self, document: &Document) -> Bake {
        let whole = Bake::of_timeline(document);
        let frame_rate = self.fps.map_or(whole.frames.frame_rate, |FrameRateArgument(rate)| rate);
        Bake {
            frames: Timeline { frame_rate, ..whole.frames },
            tolerance: self.tolerance.map_or(whole.tolerance, |tolerance| tolerance.0),
        }
    }
}

fn report(settings: &Bake, baked: &Baked) -> Vec<String> {
    let Baked { document, keys_at_frames, keys, error, shortened } = baked;
    let frames = settings.frames.frames();
    let mut lines = vec![format!(
        "{frames} frames baked: {keys} of {keys_at_frames} keys left, at most {error} from the \
         evaluated motion"
    )];
    lines.extend(shortened.iter().map(|bone| {
        let name = &document.skeleton()[bone.joint].name;
        format!("the stretch of the bone of {name:?}, up to {}, has no keys", bone.error)
    }));
    lines
}
