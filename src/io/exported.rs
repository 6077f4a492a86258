//! Options, frames and results of exports, with their progress and the errors that formats share.

use std::future::poll_fn;
use std::mem::replace;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::task::Poll;

use thiserror::Error;

use crate::document::{Document, Theme, Timeline};
use crate::kinematics::skin::Skinning;

/// A kind of file that an export offers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ExportKind {
    /// Name on its button.
    pub name: &'static str,
    /// Name in the help, with which the path is recognized.
    pub label: &'static str,
    /// End of a file name.
    pub ending: &'static str,
    /// Description in the help.
    pub help: &'static str,
    /// Description on screen.
    pub tooltip: &'static str,
    /// The options that apply.
    pub options: &'static [ExportOption],
}

impl ExportKind {
    /// The file extension without the dot.
    pub fn extension(&self) -> &'static str {
        self.ending.rsplit('.').next().unwrap_or_default()
    }

    /// Returns whether an option applies.
    pub fn takes(&self, option: ExportOption) -> bool {
        self.options.contains(&option)
    }
}

/// An option of an export.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ExportOption {
    /// Frames per second, for files that hold a motion.
    FrameRate,
    /// Size, theme and camera, for files of pictures.
    Picture,
    /// The one time that the file holds.
    Time,
    /// Length unit of the file.
    Unit,
    /// Length of a unit of the document in metres.
    Metres,
    /// Blending of joints in a mesh.
    Skinning,
}

/// Options of an export. Each format uses only the options that apply to it.
#[derive(Clone, Debug, PartialEq)]
pub struct ExportOptions {
    /// Frames per second; `None` for the timeline's frame rate.
    pub fps: Option<f64>,
    /// Width and height of a picture in pixels.
    pub size: (u32, u32),
    /// Theme of a picture.
    pub theme: Theme,
    /// Time of a single picture or mesh in seconds; `None` for the timeline's start.
    pub time: Option<f64>,
    /// Unit of lengths in a BVH file.
    pub unit: BvhUnit,
    /// Blending of the joints of an OBJ file's mesh; `None` for the document's.
    pub skinning: Option<Skinning>,
}

impl ExportOptions {
    /// Maximum width and height that the program offers for a picture. A graphics device may have a
    /// lower limit.
    pub const MAX_SIDE: u32 = 8192;
}

impl Default for ExportOptions {
    fn default() -> Self {
        Self {
            fps: None,
            size: (1280, 800),
            theme: Theme::Dark,
            time: None,
            unit: BvhUnit::default(),
            skinning: None,
        }
    }
}

/// The unit of lengths in an exported BVH file. The file itself does not name its unit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum BvhUnit {
    /// The usual unit of BVH.
    #[default]
    Centimetres,
    /// Metres.
    Metres,
    /// The unit of the document.
    Scene,
}

impl BvhUnit {
    /// Assumed length of the unit of an imported BVH file, in metres: one centimetre.
    pub const METRES: f32 = 0.01;

    /// Length of one unit of the document, measured in this unit.
    pub fn per_unit(self, document: &Document) -> f64 {
        let per_metre = match self {
            Self::Centimetres => Self::METRES.recip(),
            Self::Metres => 1.0,
            Self::Scene => return 1.0,
        };
        f64::from(document.metres_per_unit() * per_metre)
    }
}

/// The times of all frames of an export.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ExportFrames {
    timeline: Timeline,
    count: usize,
}

impl ExportFrames {
    /// The frames of the document's timeline at `fps` frames per second, or at the timeline's own
    /// frame rate if `fps` is `None`. If the pose of the rig does not change over time, there is
    /// only the first frame.
    ///
    /// # Errors
    ///
    /// Fails if the timeline cannot have the frame rate: see [`Timeline::is_frame_rate`].
    pub fn of_pose(document: &Document, fps: Option<f64>) -> Result<Self, MotionError> {
        Self::new(document, fps, document.is_animated())
    }

    /// Like [`ExportFrames::of_pose`], but for pictures: if nothing visible changes over time,
    /// there is only the first frame.
    ///
    /// # Errors
    ///
    /// Fails for the same reason as [`ExportFrames::of_pose`].
    pub fn of_picture(document: &Document, fps: Option<f64>) -> Result<Self, MotionError> {
        Self::new(document, fps, document.is_moving())
    }

    fn new(document: &Document, fps: Option<f64>, is_moving: bool) -> Result<Self, MotionError> {
        let frame_rate = fps.unwrap_or(document.timeline.frame_rate);
        let timeline = Timeline { frame_rate, ..document.timeline };
        if !Timeline::is_frame_rate(frame_rate) {
            return Err(MotionError::FrameRate(frame_rate));
        }
        Ok(Self { timeline, count: if is_moving { timeline.frames() } else { 1 } })
    }

    /// Number of frames, at least 1.
    pub fn count(&self) -> usize {
        self.count
    }

    /// Frames per second.
    pub fn rate(&self) -> f64 {
        self.timeline.frame_rate
    }

    /// Time of a frame in the document, in seconds.
    pub fn time(&self, frame: usize) -> f64 {
        self.timeline.time(frame)
    }

    /// Time of a frame in a format that has no times of its own, in seconds from the first frame.
    pub fn since_first(&self, frame: usize) -> f64 {
        frame as f64 / self.rate()
    }
}

/// The content of an exported file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Exported {
    /// The bytes of the file.
    pub bytes: Vec<u8>,
    /// Descriptions of content of the document that the format cannot hold.
    pub notes: Vec<String>,
}

/// Progress and cancellation of a long job, shared between the job and those who wait for it.
#[derive(Debug, Default)]
pub struct Progress {
    done: AtomicUsize,
    total: AtomicUsize,
    cancelled: AtomicBool,
}

/// The error of a job that was cancelled.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error("cancelled")]
pub struct Cancelled;

impl Progress {
    /// Reports that `done` of `total` steps are done, and gives way once to what else waits. The job
    /// calls this method often, so that it stops soon when it is cancelled, and holds up no page.
    ///
    /// # Errors
    ///
    /// Fails if the job was cancelled.
    pub async fn step(&self, done: usize, total: usize) -> Result<(), Cancelled> {
        self.done.store(done, Ordering::Relaxed);
        self.total.store(total, Ordering::Relaxed);
        give_way().await;
        if self.cancelled.load(Ordering::Relaxed) { Err(Cancelled) } else { Ok(()) }
    }

    /// Asks the job to stop at its next step.
    pub fn cancel(&self) {
        self.cancelled.store(true, Ordering::Relaxed);
    }

    /// Returns whether the job is to stop.
    pub fn is_cancelled(&self) -> bool {
        self.cancelled.load(Ordering::Relaxed)
    }

    /// Fraction of the job that is done, from 0 to 1.
    pub fn part(&self) -> f32 {
        let (done, total) = (self.done.load(Ordering::Relaxed), self.total.load(Ordering::Relaxed));
        if total == 0 { 0.0 } else { (done as f32 / total as f32).min(1.0) }
    }
}

/// Ends at the second poll. On a thread of its own that is at once; a page polls a job as long as a
/// frame has time.
async fn give_way() {
    let mut has_given_way = false;
    poll_fn(|context| {
        if replace(&mut has_given_way, true) {
            return Poll::Ready(());
        }
        context.waker().wake_by_ref();
        Poll::Pending
    })
    .await;
}

/// The reason why a motion cannot be exported.
#[derive(Debug, Error)]
pub enum MotionError {
    /// The export was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// The frame rate, in frames per second, is not one that a timeline can have.
    #[error(
        "frames per second must be from {min} to {max}, got {0}",
        min = Timeline::MIN_FRAME_RATE, max = Timeline::MAX_FRAME_RATE
    )]
    FrameRate(f64),
    /// The skeleton has no joints.
    #[error("the skeleton must have at least one joint")]
    NoJoints,
    /// A position overflows in the file's unit.
    #[error("the position of {joint:?} must be within ±3.4028235e38")]
    TooFar {
        /// Name of the joint or point.
        joint: String,
    },
    /// The motion has more than [`MotionError::MOST_NUMBERS`] numbers.
    #[error(
        "a motion must have at most {max} numbers, got {frames} frames of {numbers}; export a \
         shorter time or fewer frames per second",
        max = MotionError::MOST_NUMBERS
    )]
    TooMuch {
        /// Number of frames.
        frames: usize,
        /// Numbers per frame.
        numbers: usize,
    },
    /// The CSV table cannot be written.
    #[error("the table could not be written: {0}")]
    Table(#[from] csv::Error),
}

impl MotionError {
    /// Maximum count of numbers in a motion. As text they take about a gigabyte.
    pub const MOST_NUMBERS: usize = 100_000_000;

    /// Checks the size of a motion that has `frames` frames of `numbers` numbers each.
    ///
    /// # Errors
    ///
    /// Fails if the motion has more than [`MotionError::MOST_NUMBERS`] numbers.
    pub(super) fn check_size(frames: usize, numbers: usize) -> Result<(), Self> {
        if frames.saturating_mul(numbers) > Self::MOST_NUMBERS {
            return Err(Self::TooMuch { frames, numbers });
        }
        Ok(())
    }
}
