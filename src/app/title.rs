use std::path::Path;

/// Name of the program, as in the window's title.
pub const TITLE: &str = "ik-arm";

/// Title of the window: the file's name, an asterisk for unsaved changes, and the program.
pub fn title(file: Option<&Path>, is_unsaved: bool) -> String {
    let unsaved = if is_unsaved { "*" } else { "" };
    match file.and_then(Path::file_name) {
        Some(name) => format!("{}{unsaved} – {TITLE}", name.to_string_lossy()),
        None if is_unsaved => format!("untitled* – {TITLE}"),
        None => TITLE.to_owned(),
    }
}
