//! `ik-arm gui`: opens the window.

use std::path::PathBuf;
use std::process::ExitCode;

use clap::value_parser;

use super::open;
use super::open_args::OpenArgs;
use super::report::fail;
use crate::app;
use crate::session::{FileAction, TourStep};

#[derive(clap::Args)]
pub struct GuiArgs {
    /// File to open: ik-arm document (.json), Scotty3D scene (.js3d), .bvh, .glb or .gltf
    #[arg(value_name = "FILE")]
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

pub fn run(args: &GuiArgs) -> ExitCode {
    let mut document = None;
    if let Some(path) = &args.file {
        let options = args.open.options();
        match open::open_to_draw(path, &options) {
            Ok(opened) => document = Some(FileAction::opened(path.clone(), options, opened)),
            Err(error) => return fail(&error),
        }
    }
    match app::run(document, args.tour.map(|step| usize::from(step) - 1)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => fail(&error),
    }
}
