use std::path::PathBuf;

use egui::util::IdTypeMap;
use egui_winit::WindowSettings;
use serde::{Deserialize, Serialize};

use crate::io;
use crate::session::Preferences;

/// What is kept from one start to the next: preferences, recent files, the window's
/// place, the panels' layout.
#[derive(Default, Serialize, Deserialize)]
#[serde(default)]
pub(super) struct Settings {
    pub preferences: Preferences,
    /// Files that were opened or saved, the last one first.
    pub recent: Vec<PathBuf>,
    /// Of the last export or picture.
    pub export_folder: Option<PathBuf>,
    pub window: Option<WindowSettings>,
    pub layout: IdTypeMap,
}

impl Settings {
    /// Settings that cannot be read are as at first; the reason is logged.
    pub fn load() -> Self {
        let Some(path) = path().filter(|path| path.exists()) else {
            return Self::default();
        };
        let read = std::fs::read_to_string(&path).map_err(|error| error.to_string());
        read.and_then(|text| ron::from_str(&text).map_err(|error| error.to_string()))
            .unwrap_or_else(|error| {
                log::warn!("{} is not read: {error}", path.display());
                Self::default()
            })
    }

    /// Settings that cannot be written are lost; the reason is logged.
    pub fn save(&self) {
        if let (Some(path), Err(error)) = (path(), self.try_save()) {
            log::warn!("{} is not written: {error}", path.display());
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
