use std::time::Duration;

/// Counter of attempts to create a lost graphics device again since the last presented frame.
#[derive(Debug, Default)]
pub(super) struct DeviceRetries {
    count: usize,
}

impl DeviceRetries {
    /// Pauses before the attempts: a driver that is reset or updated is back within seconds.
    const PAUSES: [Duration; 3] =
        [Duration::ZERO, Duration::from_millis(500), Duration::from_secs(2)];

    /// Counts an attempt and returns the pause before it; `None` if no attempt is left.
    pub fn next_pause(&mut self) -> Option<Duration> {
        let pause = Self::PAUSES.get(self.count).copied();
        self.count += 1;
        pause
    }

    /// Whether the device was lost and no frame was presented since.
    pub fn is_retrying(&self) -> bool {
        self.count > 0
    }

    /// Forgets all attempts, after a frame was presented.
    pub fn reset(&mut self) {
        self.count = 0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_retry_is_at_once_and_later_ones_after_longer_pauses() {
        let mut retries = DeviceRetries::default();
        assert!(!retries.is_retrying());
        assert_eq!(retries.next_pause(), Some(Duration::ZERO));
        assert!(retries.is_retrying());
        let (second, third) = (retries.next_pause(), retries.next_pause());
        assert!(Some(Duration::ZERO) < second && second < third, "{second:?}, {third:?}");
    }

    #[test]
    fn there_are_three_retries() {
        let mut retries = DeviceRetries::default();
        let pauses: Vec<_> = std::iter::repeat_with(|| retries.next_pause()).take(5).collect();
        assert_eq!(
            pauses.iter().map(Option::is_some).collect::<Vec<_>>(),
            [true, true, true, false, false]
        );
    }

    #[test]
    fn a_presented_frame_resets_the_retries() {
        let mut retries = DeviceRetries::default();
        for _ in 0..10 {
            for _ in 0..3 {
                assert!(retries.next_pause().is_some());
            }
            retries.reset();
            assert!(!retries.is_retrying());
        }
        assert_eq!(retries.next_pause(), Some(Duration::ZERO));
    }
}
