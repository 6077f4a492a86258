use std::env;

use winit::event::{ElementState, KeyEvent, WindowEvent};
use winit::keyboard::{KeyCode, PhysicalKey};

/// Faults that `IK_ARM_DEBUG` asks for in the program's own tests: with any value F12 destroys the
/// graphics device, as the reset of a driver does, and with `fail-devices:3` the first three devices
/// that are created after a loss fail.
#[derive(Debug, Default, PartialEq, Eq)]
pub(super) struct Debug {
    is_on: bool,
    failing_devices: u32,
}

impl Debug {
    pub fn from_env() -> Self {
        env::var("IK_ARM_DEBUG").map_or_else(|_| Self::default(), |value| Self::new(&value))
    }

    fn new(value: &str) -> Self {
        let count = value.strip_prefix("fail-devices:").and_then(|count| count.parse().ok());
        Self { is_on: !value.is_empty(), failing_devices: count.unwrap_or(0) }
    }

    /// Whether the event asks to destroy the graphics device.
    pub fn destroys_device(&self, event: &WindowEvent) -> bool {
        self.is_on
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

    /// Whether the device that is created now fails.
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
    fn nothing_fails_unless_it_is_asked_for() {
        let mut debug = Debug::new("");
        assert!(!debug.is_on && !debug.fails_device());
    }

    #[test]
    fn as_many_devices_fail_as_are_asked_for() {
        let mut debug = Debug::new("fail-devices:2");
        assert!(debug.is_on);
        assert_eq!([(); 4].map(|()| debug.fails_device()), [true, true, false, false]);
        assert!(!Debug::new("fail-devices:many").fails_device());
        assert!(Debug::new("1").is_on && !Debug::new("1").fails_device());
    }
}
