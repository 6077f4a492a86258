use std::env;

use winit::event::{ElementState, KeyEvent, WindowEvent};
use winit::keyboard::{KeyCode, PhysicalKey};

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

    /// Whether the event asks to destroy the graphics device.
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

    /// Whether the next attempt to create the device is to fail; counts this attempt.
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
