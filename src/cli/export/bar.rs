use std::thread;
use std::time::Duration;

use indicatif::ProgressBar;

use crate::io::Progress;

/// Does a job elsewhere, and shows on stderr meanwhile how far it is, if that is a terminal.
pub fn shown<T: Send>(progress: &Progress, job: impl FnOnce() -> T + Send) -> T {
    /// How finely the bar counts, and how often it is looked at.
    const STEPS: u64 = 1000;
    const PAUSE: Duration = Duration::from_millis(50);
    let bar = ProgressBar::new(STEPS);
    let done = thread::scope(|scope| {
        let job = scope.spawn(job);
        while !job.is_finished() {
            bar.set_position((progress.part() * STEPS as f32) as u64);
            thread::park_timeout(PAUSE);
        }
        job.join()
    });
    bar.finish_and_clear();
    done.unwrap_or_else(|panic| std::panic::resume_unwind(panic))
}
