use std::thread;
use std::time::Duration;

use indicatif::ProgressBar;

use crate::io::Progress;

/// Runs a job on a thread of its own. Shows its progress on standard error if standard error is a
/// terminal.
pub fn run_with_bar<T: Send>(progress: &Progress, job: impl FnOnce() -> T + Send) -> T {
    const STEPS: u64 = 1000;
    const UPDATE_INTERVAL: Duration = Duration::from_millis(50);
    let bar = ProgressBar::new(STEPS);
    let done = thread::scope(|scope| {
        let job = scope.spawn(job);
        while !job.is_finished() {
            bar.set_position((progress.part() * STEPS as f32) as u64);
            thread::park_timeout(UPDATE_INTERVAL);
        }
        job.join()
    });
    bar.finish_and_clear();
    done.unwrap_or_else(|panic| std::panic::resume_unwind(panic))
}
