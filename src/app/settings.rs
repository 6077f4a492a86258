use std::path::PathBuf;

use egui::util::IdTypeMap;
use egui_winit::WindowSettings;
use serde::{Deserialize, Serialize};

use crate::io;
use crate::session::Preferences;

/// Everything that is saved when the program ends: preferences, recent files, position of the window, layout
/// of the panels.
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
    /// Loads the settings; if they cannot be read, logs the reason and returns the defaults.
    pub fn load() -> Self {
        let Some(path) = path().filter(|path| path.exists()) else {
            return Self::default();
        };
        let read = std::fs::read_to_string(&path).map_err(|error| error.to_string());
        read.and_then(|text| ron::from_str(&text).map_err(|error| error.to_string()))
            .unwrap_or_else(|error| {
                log::warn!("cannot read {}: {error}", path.display());
                Self::default()
            })
    }

    /// Saves the settings, or logs the reason why they cannot be saved.
    pub fn save(&self) {
        if let (Some(path), Err(error)) = (path(), self.try_save()) {
            log::warn!("cannot write {}: {error}", path.display());
        }
    }

    fn try_save(&self) -> Result<(), Box<dyn std::error::Error>> {
        let Some(path) = path() else {
            return Ok(());
        };
        let folder = path.parent().ok_or("it has no folder")?;
        std::fs::create_dir_all(folder)?;
        Ok(io::write(&path, ron::to_string(self)?.as_bytes())?)
    }
}

fn path() -> Option<PathBuf> {
    let folders = directories::ProjectDirs::from("", "", "ik-arm")?;
    Some(folders.config_dir().join("settings.ron"))
}
