//! `ik-arm examples`: the built-in example scenes.

use std::io::{self, Write as _};
use std::path::PathBuf;
use std::process::ExitCode;

use clap::builder::PossibleValuesParser;
use thiserror::Error;

use super::report::fail;
use crate::io::{self as files, Example, WriteError, system_reason};

#[derive(clap::Args)]
#[command(after_help = "Without NAME it lists the examples. With NAME it prints one as a document:
  ik-arm examples human > human.json
  ik-arm examples human | ik-arm pose --solver dls -")]
pub struct ExamplesArgs {
    /// Example to print
    #[arg(value_name = "NAME", value_parser = names())]
    name: Option<String>,
    /// Write it to this file instead of standard output
    #[arg(short, long, value_name = "FILE", requires = "name")]
    output: Option<PathBuf>,
}

fn names() -> PossibleValuesParser {
    PossibleValuesParser::new(Example::ALL.map(|example| example.name))
}

/// Reasons why no example is written.
#[derive(Debug, Error)]
enum ExamplesError {
    #[error(transparent)]
    File(#[from] WriteError),
    #[error("cannot write to standard output: {}", system_reason(.0))]
    Write(#[from] io::Error),
}

pub fn run(args: &ExamplesArgs) -> ExitCode {
    match print(args) {
        Ok(()) => ExitCode::SUCCESS,
        Err(ExamplesError::Write(error)) if error.kind() == io::ErrorKind::BrokenPipe => {
            ExitCode::SUCCESS
        }
        Err(error) => fail(&error),
    }
}

fn print(args: &ExamplesArgs) -> Result<(), ExamplesError> {
    let mut stdout = io::stdout().lock();
    let Some(example) = args.name.as_deref().and_then(Example::find) else {
        let width = Example::ALL.map(|example| example.name.len()).into_iter().max().unwrap_or(0);
        for Example { name, title, sentence, .. } in Example::ALL {
            writeln!(stdout, "{name:<width$} {title}: {sentence}")?;
        }
        return Ok(());
    };
    match &args.output {
        Some(path) => files::write(path, example.text.as_bytes())?,
        None => stdout.write_all(example.text.as_bytes())?,
    }
    Ok(())
}
