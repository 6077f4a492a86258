use std::time::Duration;

/// How often the graphics were made anew since a frame was last seen.
#[derive(Debug, Default)]
pub(super) struct Failures {
    tries: usize,
}

impl Failures {
    /// Drivers that are reset or updated are back within seconds.
    const PAUSES: [Duration; 3] =
        [Duration::ZERO, Duration::from_millis(500), Duration::from_secs(2)];

    /// How long to wait before the graphics, which have failed, are made anew; nothing if that was
    /// tried often enough.
    pub fn pause(&mut self) -> Option<Duration> {
        let pause = Self::PAUSES.get(self.tries).copied();
        self.tries += 1;
        pause
    }

    /// Whether what was made anew has not shown a frame yet.
    pub fn is_trying(&self) -> bool {
        self.tries > 0
    }

    /// A frame is seen.
    pub fn forget(&mut self) {
        self.tries = 0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_lost_is_made_anew_at_once_and_then_more_and_more_patiently() {
        let mut failures = Failures::default();
        assert!(!failures.is_trying());
        assert_eq!(failures.pause(), Some(Duration::ZERO));
        assert!(failures.is_trying());
        let (second, third) = (failures.pause(), failures.pause());
        assert!(Some(Duration::ZERO) < second && second < third, "{second:?}, {third:?}");
    }

    #[test]
    fn three_failures_in_a_row_are_enough() {
        let mut failures = Failures::default();
        let pauses: Vec<_> = std::iter::repeat_with(|| failures.pause()).take(5).collect();
        assert_eq!(
            pauses.iter().map(Option::is_some).collect::<Vec<_>>(),
            [true, true, true, false, false]
        );
    }

    #[test]
    fn a_frame_that_is_seen_forgives_all_before() {
        let mut failures = Failures::default();
        for _ in 0..10 {
            for _ in 0..3 {
                assert!(failures.pause().is_some());
            }
            failures.forget();
            assert!(!failures.is_trying());
        }
        assert_eq!(failures.pause(), Some(Duration::ZERO));
    }
}
