//! Files that commands open, and what the help says about files.

use std::io;
use std::path::{Path, PathBuf};

use clap::builder::PossibleValue;
use clap::{Args, ValueEnum};

use super::report::{CommandError, say};
use crate::document::{Document, Track};
use crate::io::{
    FileFormat, OpenError, OpenOptions, Opened, Remark, Upwards, open as open_file, read,
    undrawn_textures,
};

/// The path that stands for standard input.
pub const STANDARD_INPUT: &str = "-";

/// The file that a command opens. Each command has a help text of its own for it.
#[derive(Args)]
pub struct InputArgs {
    #[arg(value_name = "FILE")]
    pub file: PathBuf,
    #[command(flatten)]
    choice: OpenArgs,
}

/// The choice of one of a file's skeletons and animations.
#[derive(Args, Default)]
#[group(requires = "file")]
pub struct OpenArgs {
    /// Skeleton to open, if the file has several [default: the first]
    #[arg(long, value_name = "NAME")]
    skeleton: Option<String>,
    /// Animation to open, by its name or its number from 0 [default: the first that moves]
    #[arg(long, value_name = "NAME|N")]
    animation: Option<String>,
    /// Axis that points up in the file; z turns the skeleton, auto if its bind pose stands along z
    /// [default: y, with a remark if it seems to be z]
    #[arg(long, value_enum)]
    up: Option<Upwards>,
}

impl ValueEnum for Upwards {
    fn value_variants<'a>() -> &'a [Self] {
        &[Self::Y, Self::Z, Self::Auto]
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        Some(PossibleValue::new(match self {
            Self::Y => "y",
            Self::Z => "z",
            Self::Auto => "auto",
        }))
    }
}

impl InputArgs {
    /// Name of the file in messages.
    pub fn name(&self) -> String {
        name(&self.file)
    }

    pub fn options(&self) -> OpenOptions {
        self.choice.options()
    }

    /// Opens the file, or standard input for `-`, and prints its warnings.
    pub fn open(&self) -> Result<Opened, OpenError> {
        open(&self.file, &self.options())
    }
}

impl OpenArgs {
    pub fn options(&self) -> OpenOptions {
        OpenOptions {
            skeleton: self.skeleton.clone(),
            animation: self.animation.clone(),
            up: self.up,
            without_camera: false,
        }
    }
}

/// Adds targets to the hands, feet and head of a human-like figure, where they are at a time in
/// seconds. Errors call the file `name`.
pub fn add_targets(document: &mut Document, time: f64, name: &str) -> Result<(), CommandError> {
    let posed = Track::new(document).at(time);
    let added = document.rig.add_humanoid_targets(&posed.evaluated_skeleton().solved);
    added.map(drop).map_err(|why| CommandError::of_file(name.to_owned(), why))
}

/// Opens a file, or standard input for `-`, and prints its warnings.
pub fn open(path: &Path, options: &OpenOptions) -> Result<Opened, OpenError> {
    let opened = if path == Path::new(STANDARD_INPUT) {
        read(&name(path), io::stdin().lock(), options)?
    } else {
        open_file(path, options)?
    };
    warn(path, &opened.warnings);
    Ok(opened)
}

/// Opens another skeleton of a file that was opened, without its warnings; `None` if it cannot be
/// read, or for standard input, which cannot be read twice.
pub fn another(path: &Path, skeleton: &str) -> Option<Opened> {
    if path == Path::new(STANDARD_INPUT) {
        return None;
    }
    open_file(path, &OpenOptions { without_camera: true, ..OpenOptions::of_skeleton(skeleton) })
        .ok()
}

/// Opens a file, or standard input for `-`, to draw its skin, too, and prints its warnings.
pub fn open_to_draw(path: &Path, options: &OpenOptions) -> Result<Opened, OpenError> {
    let opened = open(path, options)?;
    warn(path, &undrawn_textures(&opened.document));
    Ok(opened)
}

fn warn(path: &Path, warnings: &[Remark]) {
    for warning in warnings {
        say(&format_args!("{}, {warning}", name(path)));
    }
}

/// Name of a file in messages.
pub fn name(path: &Path) -> String {
    if path == Path::new(STANDARD_INPUT) {
        return "standard input".to_owned();
    }
    path.display().to_string()
}

/// Checks that a command which writes documents is to write one.
pub fn require_document(command: &'static str, output: &Path) -> Result<(), CommandError> {
    if FileFormat::DOCUMENT.is_written_to(output) {
        return Ok(());
    }
    let output = output.display();
    Err(CommandError::Usage(format!(
        "{command} writes a document, so OUT must end in .json, got {output}"
    )))
}

/// Help of an argument for a file of any format that can be read.
pub fn input_help(purpose: &str) -> String {
    format!("{purpose}: {}; - reads standard input", FileFormat::inputs())
}

/// Rows of a help text: a name and its description.
pub fn help_rows<'a>(rows: impl IntoIterator<Item = (String, &'a str)>) -> String {
    let rows: Vec<_> = rows.into_iter().collect();
    let width = 4 + rows.iter().map(|(name, _)| name.len()).max().unwrap_or_default();
    rows.iter().map(|(name, description)| format!("  {name:width$}{description}\n")).collect()
}
