//! The time that a command may take.

use std::path::Path;
use std::process::exit;
use std::str::FromStr;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use clap::Args;

use super::open;
use super::report::say;
use crate::io::Progress;

#[derive(Args)]
pub struct TimeLimitArgs {
    /// Seconds after which the command gives up and writes nothing [default: 60 for pose, else 600]
    #[arg(long, value_name = "SECONDS", allow_hyphen_values = true)]
    time_limit: Option<Seconds>,
}

/// A finite time above 0.
#[derive(Clone, Copy, Debug)]
struct Seconds(Duration);

impl FromStr for Seconds {
    type Err = &'static str;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        const RULE: &str = "time limit must be a finite number of seconds above 0";
        let seconds: f64 = text.trim().parse().map_err(|_| RULE)?;
        let limit = Duration::try_from_secs_f64(seconds).map_err(|_| RULE)?;
        if limit.is_zero() { Err(RULE) } else { Ok(Self(limit)) }
    }
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
        let limit = self.time_limit.map_or(default, |Seconds(limit)| limit);
        TimeLimit::start(open::name(file), limit)
    }
}

/// A limit after which the process ends with an error.
pub struct TimeLimit {
    file: String,
    limit: Duration,
    started: Instant,
    /// Progress of the command's job, which is cancelled when the time is over.
    pub progress: Progress,
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

    /// Ends the process with an error if the time is over.
    pub fn check(&self) {
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
