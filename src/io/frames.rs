use crate::document::{Document, RigKind, Timeline};

use super::MotionError;

/// The frames of an export: how many there are, and when each is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frames {
    timeline: Timeline,
    count: usize,
}

impl Frames {
    /// Those of the document's timeline, `fps` in a second where that is said, in which the rig's pose
    /// changes; only the first where nothing poses it.
    ///
    /// # Errors
    ///
    /// Refuses a frame rate that no timeline can have.
    pub fn of_pose(document: &Document, fps: Option<u32>) -> Result<Self, MotionError> {
        Self::new(document, fps, document.is_posed_by_time())
    }

    /// As [`Frames::of_pose`], with whatever else moves in a picture.
    ///
    /// # Errors
    ///
    /// As [`Frames::of_pose`].
    pub fn of_picture(document: &Document, fps: Option<u32>) -> Result<Self, MotionError> {
        let moves = document.rig == RigKind::Skeleton && document.skeleton_rig.is_moving();
        Self::new(document, fps, moves || !document.keys.is_empty())
    }

    fn new(document: &Document, fps: Option<u32>, moves: bool) -> Result<Self, MotionError> {
        let frame_rate = fps.unwrap_or(document.timeline.frame_rate);
        let timeline = Timeline { frame_rate, ..document.timeline };
        if !(1..=Timeline::HIGHEST_FRAME_RATE).contains(&frame_rate) {
            return Err(MotionError::FrameRate(frame_rate));
        }
        Ok(Self { timeline, count: if moves { timeline.frames() } else { 1 } })
    }

    pub fn count(&self) -> usize {
        self.count
    }

    /// In a second.
    pub fn rate(&self) -> u32 {
        self.timeline.frame_rate
    }

    /// When a frame is in the document, in seconds.
    pub fn time(&self, frame: usize) -> f64 {
        self.timeline.time(frame)
    }

    /// When a frame is in a file, in seconds from its first one.
    pub fn since_first(&self, frame: usize) -> f64 {
        frame as f64 / f64::from(self.rate())
    }
}

/// A document that is brought to one time after the other, without a copy for each.
pub struct Playback {
    document: Document,
}

impl Playback {
    pub fn new(document: &Document) -> Self {
        Self { document: document.clone() }
    }

    /// As [`Document::at`].
    pub fn at(&mut self, time: f64) -> &Document {
        self.document.keys_to(time);
        &self.document
    }
}
