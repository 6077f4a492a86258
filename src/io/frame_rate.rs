//! Frame rates of files, which say times with few digits.

/// Whole frame rates in use, in frames per second, ascending.
pub const WHOLE: [f64; 8] = [24.0, 25.0, 30.0, 48.0, 50.0, 60.0, 100.0, 120.0];

/// Frame rates of television in North America, in frames per second, ascending: about 23.976,
/// 29.97, 59.94 and 119.88.
pub const BROADCAST: [f64; 4] = [24e3 / 1001.0, 30e3 / 1001.0, 60e3 / 1001.0, 120e3 / 1001.0];

/// The frame rate that a file means by the time from frame to frame, in frames per second. `unit`
/// is the value of the last digit of `step`, in seconds, and `step` is above 0.
///
/// It is a whole or a broadcast rate if the step can be this rate's step, rounded or cut off to
/// the digits of the file. Otherwise it is 1 / `step`.
pub fn of_frame_time(step: f64, unit: f64) -> f64 {
    /// Relative distance of a rate from 1 / `step` beyond which it is another rate, however few
    /// digits the step has.
    const FARTHEST: f64 = 2e-3;
    let exact = step.recip();
    let whole = [exact.round()];
    let is_within = |rate: f64, error: f64| {
        rate >= 1.0
            && (rate - exact).abs() <= FARTHEST * exact
            && (rate.recip() - step).abs() <= error
    };
    let find = |error: f64| whole.into_iter().chain(BROADCAST).find(|rate| is_within(*rate, error));
    let rounded = (0.5 * unit).max(step * f64::EPSILON);
    find(rounded).or_else(|| find(2.0 * rounded)).unwrap_or(exact)
}

/// The lowest common frame rate that has a frame at each of `times`, in seconds from the first
/// frame; `None` if there is none. Times are ascending and differ by up to `tolerance` (of a time)
/// from those of their frames.
///
/// Whole rates come first, then broadcast rates, then any rate between whose frames at least half
/// have a key.
pub fn of_times(times: &[f64], tolerance: impl Fn(f64) -> f64) -> Option<f64> {
    let has_all = |rate: &f64| {
        times.iter().all(|time| {
            let frame = time * rate;
            (frame - frame.round()).abs() <= tolerance(*time) * rate
        })
    };
    let common = WHOLE.into_iter().chain(BROADCAST).find(has_all);
    common.or_else(|| even(times).and_then(|rate| tidy(rate, has_all)))
}

/// The number of the shortest steps between `times` in a second, if at least half of the steps
/// have a time.
fn even(times: &[f64]) -> Option<f64> {
    /// Keys that are farther apart than this, in seconds, are not frames.
    const LONGEST: f64 = 0.1;
    let last = *times.last()?;
    let gaps = times.windows(2).map(|pair| pair[1] - pair[0]).filter(|gap| *gap > 0.0);
    let shortest = gaps.reduce(f64::min).filter(|gap| *gap <= LONGEST)?;
    let steps = (last / shortest).round();
    (2 * times.len() > steps as usize).then_some(steps / last)
}

/// `rate` with the fewest decimals that `is_right` accepts.
fn tidy(rate: f64, is_right: impl Fn(&f64) -> bool) -> Option<f64> {
    let rounded = (0..=9).map(|decimals| {
        let unit = 10_f64.powi(decimals);
        (rate * unit).round() / unit
    });
    rounded.chain([rate]).find(|rate| *rate > 0.0 && is_right(rate))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rounded_and_cut_frame_times_mean_the_rate_that_was_written() {
        for rate in (1..=240).map(f64::from).chain(BROADCAST) {
            for decimals in 5..=12 {
                let unit = 10_f64.powi(-decimals);
                for step in [(1.0 / rate / unit).round() * unit, (1.0 / rate / unit).floor() * unit]
                {
                    let found = of_frame_time(step, unit);
                    // Two rates that give the same digits cannot be told apart.
                    let is_same = (found.recip() - rate.recip()).abs() <= 2.0 * unit;
                    assert!(is_same, "{rate} as {step}: {found}");
                }
                let found = of_frame_time((1.0 / rate / unit).round() * unit, unit);
                assert!(decimals < 7 || found == rate, "{rate} with {decimals} decimals: {found}");
            }
        }
        assert_eq!(of_frame_time(0.0333, 1e-4), 30.0);
        assert_eq!(of_frame_time(0.0167, 1e-4), 60.0);
        assert_eq!(of_frame_time(0.0334, 1e-4), 30e3 / 1001.0);
        assert_eq!(of_frame_time(0.01666, 1e-5), 60.0);
    }

    #[test]
    fn other_frame_times_are_kept_exactly() {
        for (step, unit) in [(0.03, 1e-2), (0.030_003, 1e-6), (0.07, 1e-2), (2.5, 0.1)] {
            assert_eq!(of_frame_time(step, unit), 1.0 / step);
        }
    }

    #[test]
    fn every_rate_is_found_from_the_times_of_its_frames_in_single_precision() {
        let tolerance = |time: f64| (time * f64::from(f32::EPSILON)).max(1e-7);
        for rate in WHOLE.into_iter().chain(BROADCAST).chain([33.33, 29.97, 119.88, 72.0]) {
            let times: Vec<f64> =
                (0..400).map(|frame| f64::from((f64::from(frame) / rate) as f32)).collect();
            let found = of_times(&times, tolerance).expect("a rate");
            assert!((found / rate - 1.0).abs() < 1e-9, "{rate}: {found}");
        }
        assert_eq!(of_times(&[0.0, 0.013, 1.7001, 3.3], tolerance), None);
    }
}
