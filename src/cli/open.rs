use std::io;
use std::path::Path;

use super::report::{CommandError, say};
use crate::io::{
    FileFormat, OpenError, OpenOptions, Opened, Remark, open as open_file, read, undrawn_textures,
};

const STANDARD_INPUT: &str = "-";

/// Name of a file in messages.
pub fn name(path: &Path) -> String {
    if path == Path::new(STANDARD_INPUT) {
        return "standard input".to_owned();
    }
    path.display().to_string()
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

/// True if a path has the extension of a document.
pub fn is_document(path: &Path) -> bool {
    FileFormat::DOCUMENT.is_written_to(path)
}

/// Opens a file, or standard input for `-`, to draw its skin, too, and prints its warnings.
pub fn open_to_draw(path: &Path, options: &OpenOptions) -> Result<Opened, OpenError> {
    let opened = open(path, options)?;
    warn(path, &undrawn_textures(&opened.document));
    Ok(opened)
}

/// Checks that a command which writes documents is to write one.
pub fn require_document(command: &'static str, output: &Path) -> Result<(), CommandError> {
    if is_document(output) {
        return Ok(());
    }
    Err(CommandError::Extension { command, output: output.display().to_string() })
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

fn warn(path: &Path, warnings: &[Remark]) {
    for warning in warnings {
        say(&format_args!("{}, {warning}", name(path)));
    }
}
