use std::io::{self, Write as _};
use std::path::Path;

use crate::io::{OpenError, Opened, open as open_file, read};

const STANDARD_INPUT: &str = "-";

/// What a file is called in messages.
pub fn name(path: &Path) -> String {
    if path == Path::new(STANDARD_INPUT) {
        return "standard input".to_owned();
    }
    path.display().to_string()
}

/// Opens a file, or standard input where it is `-`; says what is odd in it.
pub fn open(path: &Path, skeleton: Option<&str>) -> Result<Opened, OpenError> {
    let opened = if path == Path::new(STANDARD_INPUT) {
        read(&name(path), io::stdin().lock(), skeleton)?
    } else {
        open_file(path, skeleton)?
    };
    for warning in &opened.warnings {
        let _ = writeln!(io::stderr(), "ik-arm: {}, {warning}", name(path));
    }
    Ok(opened)
}
