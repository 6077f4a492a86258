//! The settings in the user's folder.

use std::path::PathBuf;

use crate::io;

/// The settings of the last run as text; `None` if there are none.
///
/// # Errors
///
/// The sentence of a file that cannot be read, which names the file.
pub(in crate::app) fn saved_settings() -> Result<Option<String>, String> {
    let Some(path) = settings_path().filter(|path| path.exists()) else { return Ok(None) };
    let text = io::read_text(&path);
    text.map(Some)
        .map_err(|error| format!("the settings in {} cannot be read: {error}", path.display()))
}

/// Where the settings are, for sentences.
pub(in crate::app) fn settings_place() -> String {
    settings_path().map_or_else(|| "no folder".to_owned(), |path| path.display().to_string())
}

/// Saves the settings.
///
/// # Errors
///
/// If the file cannot be written.
pub(in crate::app) fn save_settings(text: &str) -> Result<(), Box<dyn std::error::Error>> {
    let Some(path) = settings_path() else { return Ok(()) };
    let folder = path.parent().ok_or("it has no folder")?;
    std::fs::create_dir_all(folder)?;
    Ok(io::write(&path, text.as_bytes())?)
}

fn settings_path() -> Option<PathBuf> {
    let folders = directories::ProjectDirs::from("", "", "ik-arm")?;
    Some(folders.config_dir().join("settings.ron"))
}
