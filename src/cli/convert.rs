//! `ik-arm convert`: a file of another program as a document, or in another format.

use std::path::{Path, PathBuf};

use super::argument::frame_rate;
use super::export;
use super::open::{self, InputArgs};
use super::report::CommandError;
use super::time_limit::TimeLimitArgs;
use crate::export::ExportOptions;
use crate::io::{BvhUnit, ExportOption, FileFormat, dotted, enumerated, save};

/// The command's line in the list of commands.
pub fn about() -> String {
    let written = FileFormat::convertible().map(|format| {
        if format.is_document() {
            "a document (.json)".to_owned()
        } else {
            dotted(&format.extension())
        }
    });
    format!("Convert a file to {}", enumerated(&written.collect::<Vec<_>>(), "or"))
}

/// The extensions that OUT can have.
fn extensions() -> String {
    let extensions: Vec<_> =
        FileFormat::convertible().map(|format| dotted(&format.extension())).collect();
    enumerated(&extensions, "or")
}

fn after_help() -> String {
    let row = |format: FileFormat| (dotted(&format.extension()), format.holds);
    let rows = open::help_rows(FileFormat::convertible().map(row));
    format!(
        "The extension of OUT chooses the format:\n{rows}\
         What the format cannot hold is listed on stderr. ik-arm export also writes tables, meshes and pictures."
    )
}

#[derive(clap::Args)]
#[command(
    after_help = after_help(),
    mut_arg("file", |file| file.help(open::input_help("File to convert")))
)]
pub struct ConvertArgs {
    #[arg(help = format!("File to write: {}", extensions()), short, long, value_name = "OUT")]
    output: PathBuf,
    #[command(flatten)]
    input: InputArgs,
    /// Frames per second of .glb and .bvh [default: the timeline's]
    #[arg(long, value_name = "N", allow_hyphen_values = true, value_parser = frame_rate)]
    fps: Option<f64>,
    /// Length unit of .bvh; scene writes the file's numbers unchanged [default: cm]
    #[arg(long, value_enum)]
    unit: Option<BvhUnit>,
    /// Add targets to the hands, feet and head of a human-like figure in a document
    #[arg(long)]
    add_targets: bool,
    #[command(flatten)]
    time_limit: TimeLimitArgs,
}

pub fn run(args: &ConvertArgs) -> Result<(), CommandError> {
    let ConvertArgs { input, output, fps, unit, .. } = args;
    let format = format_of(output)?;
    for (is_given, option, argument) in [
        (fps.is_some(), ExportOption::FrameRate, "--fps"),
        (unit.is_some(), ExportOption::Unit, "--unit"),
    ] {
        if is_given && !format.takes(option) {
            let error = format!("{argument} does not apply to this format");
            return Err(CommandError::Usage(error));
        }
    }
    if args.add_targets && !format.is_document() {
        let error = "--add-targets does not apply to this format".to_owned();
        return Err(CommandError::Usage(error));
    }
    let limit = args.time_limit.start_long(&input.file);
    let mut document = input.open()?.document;
    if args.add_targets {
        open::add_targets(&mut document, 0.0, &input.name())?;
    }
    if format.is_document() {
        return save(&document, output).map_err(|error| CommandError::of_file(input.name(), error));
    }
    let unit = unit.unwrap_or_default();
    let options = ExportOptions { fps: *fps, unit, ..ExportOptions::default() };
    export::write(input, &document, output, &options, &limit)
}

/// The format of the file to write.
fn format_of(output: &Path) -> Result<FileFormat, CommandError> {
    let format = FileFormat::convertible().find(|format| format.is_written_to(output));
    format.ok_or_else(|| {
        CommandError::Usage(format!(
            "OUT must end in {}, got {}; ik-arm export writes other formats",
            extensions(),
            output.display()
        ))
    })
}
