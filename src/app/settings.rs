//! Settings kept between two runs, and options for the program's own tests.

use std::env;
use std::path::PathBuf;
use std::time::Duration;

use egui::util::IdTypeMap;
use egui_winit::WindowSettings;
use serde::{Deserialize, Serialize};
use web_time::Instant;
use winit::event::{ElementState, KeyEvent, WindowEvent};
use winit::keyboard::{KeyCode, PhysicalKey};

use super::platform;
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
        let read = platform::saved_settings().and_then(|text| {
            let Some(text) = text else { return Ok(Self::default()) };
            let place = platform::settings_place();
            ron::from_str(&text)
                .map_err(|error| format!("the settings in {place} cannot be read: {error}"))
        });
        match read {
            Ok(settings) => (settings, None),
            Err(reason) => {
                log::warn!("{reason}");
                (Self::default(), Some(format!("{reason}; defaults are used")))
            }
        }
    }

    /// Saves the settings, or logs the reason why they cannot be saved.
    pub fn save(&self) {
        if let Err(error) = self.try_save() {
            log::warn!("cannot write {}: {error}", platform::settings_place());
        }
    }

    fn try_save(&self) -> Result<(), Box<dyn std::error::Error>> {
        platform::save_settings(&ron::to_string(self)?)
    }
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

    /// Returns whether it is time to look for changes, which it is once for each note.
    pub fn is_due(&mut self, now: Instant) -> bool {
        self.due.take_if(|due| *due <= now).is_some()
    }

    /// Writes the settings if they differ from those written last; logs an error.
    pub fn write(&mut self, settings: &Settings) {
        let text = match ron::to_string(settings) {
            Ok(text) if text != self.written => text,
            Ok(_) => return,
            Err(error) => return log::warn!("the settings cannot be written: {error}"),
        };
        if let Err(error) = platform::save_settings(&text) {
            log::warn!("the settings cannot be written: {error}");
        }
        self.written = text;
    }
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
