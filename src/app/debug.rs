use std::env;

/// What `IK_ARM_DEBUG` asks for, which is for the program's own tests: any value shows what is for
/// them in the menu Help, and `fail-devices:3` lets the first three devices fail that are made anew
/// after a loss.
#[derive(Debug, Default, PartialEq, Eq)]
pub(super) struct Debug {
    pub shows_actions: bool,
    failing_devices: u32,
}

impl Debug {
    pub fn from_env() -> Self {
        env::var("IK_ARM_DEBUG").map_or_else(|_| Self::default(), |value| Self::new(&value))
    }

    fn new(value: &str) -> Self {
        let count = value.strip_prefix("fail-devices:").and_then(|count| count.parse().ok());
        Self { shows_actions: !value.is_empty(), failing_devices: count.unwrap_or(0) }
    }

    /// Whether the device that is made now is to fail.
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
    fn nothing_fails_and_nothing_more_is_shown_unless_it_is_asked_for() {
        let mut debug = Debug::new("");
        assert!(!debug.shows_actions && !debug.fails_device());
    }

    #[test]
    fn as_many_devices_fail_as_are_asked_for() {
        let mut debug = Debug::new("fail-devices:2");
        assert!(debug.shows_actions);
        assert_eq!([(); 4].map(|()| debug.fails_device()), [true, true, false, false]);
        assert!(!Debug::new("fail-devices:many").fails_device());
        assert!(Debug::new("1").shows_actions && !Debug::new("1").fails_device());
    }
}
