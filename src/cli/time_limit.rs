//! The time that a command may take.

use std::path::Path;
use std::process::exit;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use clap::Args;
use indicatif::ProgressBar;

use super::open;
use super::report::say;
use crate::io::Progress;

#[derive(Args)]
pub struct TimeLimitArgs {
    /// Seconds after which the command gives up and writes nothing [default: 60 for pose, else 600]
    #[arg(long, value_name = "SECONDS", allow_hyphen_values = true, value_parser = seconds)]
    time_limit: Option<Duration>,
}

/// Reads a finite time above 0, in seconds.
fn seconds(text: &str) -> Result<Duration, &'static str> {
    const RULE: &str = "time limit must be a finite number of seconds above 0";
    let seconds = text.trim().parse().map_err(|_| RULE)?;
    let limit = Duration::try_from_secs_f64(seconds).map_err(|_| RULE)?;
    if limit.is_zero() { Err(RULE) } else { Ok(limit) }
}

impl TimeLimitArgs {
    /// Starts the time of a command that poses once.
    pub fn start_short(&self, file: &Path) -> Arc<TimeLimit> {
        self.start(file, Duration::from_secs(60))
    }

    /// Starts the time of a command that poses in every frame.
    pub fn start_long(&self, file: &Path) -> Arc<TimeLimit> {
        self.start(file, Duration::from_secs(600))
    }

    fn start(&self, file: &Path, default: Duration) -> Arc<TimeLimit> {
        TimeLimit::start(open::name(file), self.time_limit.unwrap_or(default))
    }
}

/// A limit after which the process ends with an error.
pub struct TimeLimit {
    file: String,
    limit: Duration,
    started: Instant,
    /// Progress of the command's job, which is cancelled when the time is over.
    progress: Progress,
    is_reported: AtomicBool,
}

impl TimeLimit {
    fn start(file: String, limit: Duration) -> Arc<Self> {
        /// Time in which a cancelled job can remove its temporary files.
        const GRACE: Duration = Duration::from_secs(1);
        let started = Arc::new(Self {
            file,
            limit,
            started: Instant::now(),
            progress: Progress::default(),
            is_reported: AtomicBool::new(false),
        });
        let watched = Arc::clone(&started);
        thread::spawn(move || {
            thread::sleep(limit);
            watched.progress.cancel();
            thread::sleep(GRACE);
            watched.end_process();
        });
        started
    }

    /// Runs a job on a thread of its own; Ctrl+C and the end of the time cancel its progress. Shows
    /// the progress on standard error if standard error is a terminal.
    ///
    /// # Errors
    ///
    /// If Ctrl+C cannot be handled; the job is then not run.
    pub fn run<T: Send>(
        self: &Arc<Self>,
        job: impl AsyncFnOnce(&Progress) -> T + Send,
    ) -> Result<T, ctrlc::Error> {
        const STEPS: u64 = 1000;
        const UPDATE_INTERVAL: Duration = Duration::from_millis(50);
        let interrupted = Arc::clone(self);
        ctrlc::set_handler(move || interrupted.progress.cancel())?;
        let progress = &self.progress;
        let bar = ProgressBar::new(STEPS);
        let done = thread::scope(|scope| {
            let job = scope.spawn(|| pollster::block_on(job(progress)));
            while !job.is_finished() {
                bar.set_position((progress.part() * STEPS as f32) as u64);
                thread::park_timeout(UPDATE_INTERVAL);
            }
            job.join()
        });
        bar.finish_and_clear();
        self.check();
        Ok(done.unwrap_or_else(|panic| std::panic::resume_unwind(panic)))
    }

    /// Ends the process with an error if the time is over.
    fn check(&self) {
        if self.started.elapsed() >= self.limit {
            self.end_process();
        }
    }

    fn end_process(&self) -> ! {
        if self.is_reported.swap(true, Ordering::SeqCst) {
            // The other thread ends the process.
            loop {
                thread::park();
            }
        }
        let Self { file, limit, .. } = self;
        say(&format_args!(
            "{file}: not done within the time limit of {} s; --time-limit SECONDS sets another",
            limit.as_secs_f64()
        ));
        exit(1);
    }
}
