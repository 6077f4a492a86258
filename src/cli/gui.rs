//! `ik-arm gui`: opens the window.

use std::path::PathBuf;

use clap::value_parser;

use super::open::{self, OpenArgs};
use super::report::CommandError;
use crate::app;
use crate::io::FileFormat;
use crate::session::{FileAction, TourStep};

#[derive(clap::Args)]
pub struct GuiArgs {
    #[arg(help = format!("File to open: {}", FileFormat::inputs()), value_name = "FILE")]
    file: Option<PathBuf>,
    #[command(flatten)]
    open: OpenArgs,
    /// Begin the tour at this step [default: 1]
    #[arg(long, value_name = "STEP", num_args = 0..=1, default_missing_value = "1",
        value_parser = value_parser!(u16).range(1..=steps()))]
    tour: Option<u16>,
}

fn steps() -> i64 {
    TourStep::all().len() as i64
}

pub fn run(args: &GuiArgs) -> Result<(), CommandError> {
    let open = |path: &PathBuf| -> Result<FileAction, CommandError> {
        let options = args.open.options();
        let opened = open::open_to_draw(path, &options)?;
        Ok(FileAction::opened(path.clone(), options, opened))
    };
    let document = args.file.as_ref().map(open).transpose()?;
    Ok(app::run(document, args.tour.map(|step| usize::from(step) - 1))?)
}
