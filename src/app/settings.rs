use std::path::PathBuf;
use std::time::{Duration, Instant};

use egui::util::IdTypeMap;
use egui_winit::WindowSettings;
use serde::{Deserialize, Serialize};

use crate::io;
use crate::session::Preferences;

/// Everything that is kept from one start of the program to the next: preferences, recent files, position of
/// the window, layout of the panels.
#[derive(Default, Serialize, Deserialize)]
#[serde(default)]
pub(super) struct Settings {
    pub preferences: Preferences,
    /// Files that were opened or saved, the most recent first.
    pub recent: Vec<PathBuf>,
    /// Folder of the last export or picture; `None` before the first.
    pub export_folder: Option<PathBuf>,
    pub window: Option<WindowSettings>,
    pub layout: IdTypeMap,
}

impl Settings {
    /// Loads the settings. If they cannot be read, returns the defaults and the reason, which names
    /// the file.
    pub fn load() -> (Self, Option<String>) {
        let Some(path) = path().filter(|path| path.exists()) else {
            return (Self::default(), None);
        };
        let read = io::read_text(&path).map_err(|error| error.to_string());
        match read.and_then(|text| ron::from_str(&text).map_err(|error| error.to_string())) {
            Ok(settings) => (settings, None),
            Err(error) => {
                let reason = format!("the settings in {} cannot be read: {error}", path.display());
                log::warn!("{reason}");
                (Self::default(), Some(format!("{reason}; defaults are used")))
            }
        }
    }

    /// Saves the settings, or logs the reason why they cannot be saved.
    pub fn save(&self) {
        if let (Some(path), Err(error)) = (path(), self.try_save()) {
            log::warn!("cannot write {}: {error}", path.display());
        }
    }

    fn try_save(&self) -> Result<(), Box<dyn std::error::Error>> {
        write(&ron::to_string(self)?)
    }
}

fn write(text: &str) -> Result<(), Box<dyn std::error::Error>> {
    let Some(path) = path() else {
        return Ok(());
    };
    let folder = path.parent().ok_or("it has no folder")?;
    std::fs::create_dir_all(folder)?;
    Ok(io::write(&path, text.as_bytes())?)
}

/// Writes the settings soon after they change, so that a program that is killed loses none.
#[derive(Default)]
pub(super) struct SettingsWriter {
    /// What was written or found unchanged last.
    written: String,
    /// Time to look for changes; `None` if nothing has happened since the last look.
    due: Option<Instant>,
}

impl SettingsWriter {
    const INTERVAL: Duration = Duration::from_secs(2);

    /// Notes that something happened that may have changed the settings.
    pub fn note_change(&mut self) {
        self.due.get_or_insert_with(|| Instant::now() + Self::INTERVAL);
    }

    pub fn due(&self) -> Option<Instant> {
        self.due
    }

    /// Writes the settings if they are due and differ from those written last; logs an error.
    pub fn write_if_due(&mut self, now: Instant, settings: impl FnOnce() -> Settings) {
        if self.due.is_none_or(|due| now < due) {
            return;
        }
        self.due = None;
        let text = match ron::to_string(&settings()) {
            Ok(text) if text != self.written => text,
            Ok(_) => return,
            Err(error) => return log::warn!("the settings cannot be written: {error}"),
        };
        if let Err(error) = write(&text) {
            log::warn!("the settings cannot be written: {error}");
        }
        self.written = text;
    }
}

fn path() -> Option<PathBuf> {
    let folders = directories::ProjectDirs::from("", "", "ik-arm")?;
    Some(folders.config_dir().join("settings.ron"))
}
