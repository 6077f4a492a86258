//! `ik-arm examples`: the built-in example scenes.

use std::io::{self, Write as _};
use std::path::PathBuf;

use clap::builder::PossibleValuesParser;

use super::report::CommandError;
use crate::io::{self as files, Example};

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

pub fn run(args: &ExamplesArgs) -> Result<(), CommandError> {
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
