//! Settings kept between two runs, and options for the program's own tests.

use std::env;
use std::path::PathBuf;
use std::time::{Duration, Instant};

use egui::util::IdTypeMap;
use egui_winit::WindowSettings;
use serde::{Deserialize, Serialize};
use winit::event::{ElementState, KeyEvent, WindowEvent};
use winit::keyboard::{KeyCode, PhysicalKey};

use crate::io;
use crate::session::Preferences;

/// Everything that is kept from one start of the program to the next: preferences, recent files,
/// position of the window, layout of the panels.
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
    /// The text that was written or found unchanged last.
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

/// Options from the environment variable `IK_ARM_DEBUG`, for the program's own tests. With any
/// value, F12 destroys the graphics device, like the reset of a driver; with `fail-devices:3`, the
/// first three attempts to create the device again fail.
#[derive(Debug, Default, PartialEq, Eq)]
pub(super) struct DebugOptions {
    is_enabled: bool,
    failing_devices: u32,
}

impl DebugOptions {
    pub fn from_env() -> Self {
        env::var("IK_ARM_DEBUG").map_or_else(|_| Self::default(), |value| Self::new(&value))
    }

    fn new(value: &str) -> Self {
        let count = value.strip_prefix("fail-devices:").and_then(|count| count.parse().ok());
        Self { is_enabled: !value.is_empty(), failing_devices: count.unwrap_or(0) }
    }

    /// True if the event asks to destroy the graphics device.
    pub fn destroys_device(&self, event: &WindowEvent) -> bool {
        self.is_enabled
            && matches!(
                event,
                WindowEvent::KeyboardInput {
                    event: KeyEvent {
                        physical_key: PhysicalKey::Code(KeyCode::F12),
                        state: ElementState::Pressed,
                        ..
                    },
                    ..
                }
            )
    }

    /// True if the next attempt to create the device is to fail; counts this attempt.
    pub fn fails_device(&mut self) -> bool {
        let fails = self.failing_devices > 0;
        self.failing_devices = self.failing_devices.saturating_sub(1);
        fails
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_is_enabled_by_default() {
        let mut options = DebugOptions::new("");
        assert!(!options.is_enabled && !options.fails_device());
    }

    #[test]
    fn the_requested_number_of_devices_fails() {
        let mut options = DebugOptions::new("fail-devices:2");
        assert!(options.is_enabled);
        assert_eq!([(); 4].map(|()| options.fails_device()), [true, true, false, false]);
        assert!(!DebugOptions::new("fail-devices:many").fails_device());
        assert!(DebugOptions::new("1").is_enabled && !DebugOptions::new("1").fails_device());
    }
}
