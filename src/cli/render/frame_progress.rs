use std::io::IsTerminal as _;

use indicatif::ProgressBar;

/// Progress over frames on standard error: in a terminal a bar, otherwise a line for every tenth of
/// the frames.
pub struct FrameProgress {
    bar: ProgressBar,
    frames: u32,
}

impl FrameProgress {
    pub fn new(frames: u32) -> Self {
        Self { bar: ProgressBar::new(u64::from(frames)), frames }
    }

    pub fn show(&self, frame: u32) {
        self.bar.set_position(u64::from(frame));
        let tenth = (self.frames / 10).max(1);
        if !std::io::stderr().is_terminal() && frame.is_multiple_of(tenth) {
            eprintln!("frame {} of {}", frame + 1, self.frames);
        }
    }

    pub fn finish(&self) {
        self.bar.finish_and_clear();
    }
}
