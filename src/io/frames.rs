use super::exported::MotionError;
use crate::document::{Document, Timeline};

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
