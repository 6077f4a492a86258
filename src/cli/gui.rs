//! `ik-arm gui`: opens the window.

use std::path::{Path, PathBuf};

use clap::value_parser;

use super::open::{self, OpenArgs};
use super::report::CommandError;
use crate::app;
use crate::io::{FileFormat, Link};
use crate::session::{FileAction, TourAction, TourStep, link_actions};

#[derive(clap::Args)]
pub struct GuiArgs {
    #[arg(help = format!("File to open: {}, or a link, of which nothing is fetched", FileFormat::inputs()),
        value_name = "FILE")]
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
    let link = args.file.as_deref().and_then(Path::to_str).filter(|file| is_link(file));
    let mut start = match (link, &args.file) {
        (Some(link), _) => link_actions(Ok(Link::parse(link)?)),
        (None, Some(file)) => vec![open(file)?.into()],
        (None, None) => Vec::new(),
    };
    start.extend(args.tour.map(|step| TourAction::Enter(usize::from(step) - 1).into()));
    Ok(app::run(start)?)
}

/// True for a link instead of a file.
fn is_link(file: &str) -> bool {
    ["ik-arm:", "http://", "https://", "file://"].iter().any(|scheme| file.starts_with(scheme))
}
