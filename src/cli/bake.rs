//! `ik-arm bake`: a document whose skeleton moves by keys instead of targets.

use std::path::PathBuf;

use super::argument::{frame_rate, number};
use super::open::{self, InputArgs};
use super::report::{CommandError, say};
use super::time_limit::TimeLimitArgs;
use crate::document::{Bake, BakeError, Baked, Document, ShortenedBone, Timeline};
use crate::io::{Progress, save};

#[derive(clap::Args)]
#[command(
    after_help = r#"Evaluates every frame of the file's timeline and keys the rotations of joints, and the
offsets that solvers move. Then removes keys while every base and tip stays within the tolerance at
every frame. The targets stay in the document, with their influence keyed to 0; a followed path is
removed. The numbers of keys, and bones whose stretch keys cannot hold, are listed on stderr. Ctrl+C
cancels: no file is written, and the exit code is 130."#,
    mut_arg("file", |file| file.help(
        "File to bake, an ik-arm document (.json); - reads standard input"
    ))
)]
pub struct BakeArgs {
    /// Document to write (.json)
    #[arg(short, long, value_name = "OUT")]
    output: PathBuf,
    #[command(flatten)]
    input: InputArgs,
    /// Frames per second [default: the timeline's]
    #[arg(long, value_name = "N", allow_hyphen_values = true, value_parser = frame_rate)]
    fps: Option<f64>,
    /// Largest distance from the evaluated motion at a frame, as a fraction of the skeleton's
    /// reach, 0.00001 to 1 [default: 0.001]
    #[arg(long, value_name = "T", allow_hyphen_values = true, value_parser = number)]
    tolerance: Option<f32>,
    #[command(flatten)]
    time_limit: TimeLimitArgs,
}

pub fn run(args: &BakeArgs) -> Result<(), CommandError> {
    let BakeArgs { input, output, .. } = args;
    open::require_document("bake", output)?;
    let limit = args.time_limit.start_long(&input.file);
    let document = input.open()?.document;
    let settings = args.settings(&document);
    let bake = async |progress: &Progress| {
        let step = async |done, total| progress.step(done, total).await.is_ok();
        settings.run(&document, step).await
    };
    let baked = limit.run(bake)?.map_err(|error| match error {
        BakeError::Cancelled => CommandError::Cancelled { output: output.clone() },
        error => CommandError::of_file(input.name(), error),
    })?;
    save(&baked.document, output)?;
    report(&settings, &baked);
    Ok(())
}

impl BakeArgs {
    fn settings(&self, document: &Document) -> Bake {
        let whole = Bake::of_timeline(document);
        let frame_rate = self.fps.unwrap_or(whole.frames.frame_rate);
        Bake {
            frames: Timeline { frame_rate, ..whole.frames },
            tolerance: self.tolerance.unwrap_or(whole.tolerance),
        }
    }
}

/// Prints the number of keys, and the bones whose stretch has none.
fn report(settings: &Bake, baked: &Baked) {
    let Baked { document, keys_at_frames, keys, error, shortened } = baked;
    let frames = settings.frames.frames();
    say(&format_args!(
        "{frames} frames baked: {keys} of {keys_at_frames} keys left, at most {error} from the \
         evaluated motion"
    ));
    for ShortenedBone { joint, error } in shortened {
        let name = &document.skeleton()[*joint].name;
        say(&format_args!("the stretch of the bone of {name:?}, up to {error}, has no keys"));
    }
}
