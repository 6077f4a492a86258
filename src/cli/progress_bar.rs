use std::sync::Arc;
use std::thread;
use std::time::Duration;

use indicatif::ProgressBar;

use super::time_limit::TimeLimit;
use crate::io::Progress;

/// Runs a job on a thread of its own; Ctrl+C and the end of the time cancel its progress. Shows the
/// progress on standard error if standard error is a terminal.
///
/// # Errors
///
/// If Ctrl+C cannot be handled; the job is then not run.
pub fn run_with_bar<T: Send>(
    limit: &Arc<TimeLimit>,
    job: impl FnOnce(&Progress) -> T + Send,
) -> Result<T, ctrlc::Error> {
    const STEPS: u64 = 1000;
    const UPDATE_INTERVAL: Duration = Duration::from_millis(50);
    let interrupted = Arc::clone(limit);
    ctrlc::set_handler(move || interrupted.progress.cancel())?;
    let progress = &limit.progress;
    let bar = ProgressBar::new(STEPS);
    let done = thread::scope(|scope| {
        let job = scope.spawn(|| job(progress));
        while !job.is_finished() {
            bar.set_position((progress.part() * STEPS as f32) as u64);
            thread::park_timeout(UPDATE_INTERVAL);
        }
        job.join()
    });
    bar.finish_and_clear();
    limit.check();
    Ok(done.unwrap_or_else(|panic| std::panic::resume_unwind(panic)))
}
