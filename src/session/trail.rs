use glam::Vec3;

use super::{OnionSkin, Session};
use crate::document::{Document, Layer, RigKind};

/// What is shown of other times.
impl Session {
    /// How many skins there are before and after, and how many frames lie between two.
    const SKINS: (usize, f64) = (3, 5.0);

    /// Where the hand, or the selected joint's tip, is at every frame.
    pub(super) fn trail(&self) -> &[Vec3] {
        if self.document.is_posed_by_time() && self.shown.display.shows(Layer::Trail) {
            self.trail.get_or_init(|| trail(&self.document, self.selected()))
        } else {
            &[]
        }
    }

    /// The trail is another one; it is walked when it is next shown.
    pub(super) fn forget_trail(&mut self) {
        self.trail.take();
    }

    /// The rig some frames before and after, as far as the timeline goes.
    pub(super) fn onion_skins(&self) -> Vec<OnionSkin> {
        if !self.shown.display.shows(Layer::OnionSkins) || !self.document.is_posed_by_time() {
            return Vec::new();
        }
        let (count, frames) = Self::SKINS;
        let timeline = self.document.timeline;
        let step = frames / f64::from(timeline.frame_rate);
        let skin = |place: isize| {
            let time = self.clock.time + place as f64 * step;
            let is_played = time >= timeline.start - 1e-9 && time <= timeline.end + 1e-9;
            is_played.then(|| {
                let posed = self.document.at(time);
                OnionSkin {
                    arm: posed.arm,
                    pose: posed.skeleton.at(time).pose(),
                    past: place < 0,
                    opacity: 1.0 / place.unsigned_abs() as f32,
                }
            })
        };
        let count = count as isize;
        (-count..=count).filter(|place| *place != 0).filter_map(skin).collect()
    }
}

/// Of a long motion not every frame.
fn trail(document: &Document, joint: Option<usize>) -> Vec<Vec3> {
    const MOST_POINTS: usize = 2000;
    /// Joints times points: what a large skeleton may cost.
    const MOST_POSES: usize = 100_000;
    let timeline = document.timeline;
    let joints = match (document.rig, joint) {
        (RigKind::Arm, _) => 1,
        (RigKind::Skeleton, Some(_)) => document.skeleton.skeleton.joints().len(),
        (RigKind::Skeleton, None) => return Vec::new(),
    };
    let frames = timeline.frames();
    let stride = frames.div_ceil((MOST_POSES / joints.max(1)).clamp(1, MOST_POINTS));
    let mut posed = document.clone();
    let point = |frame| {
        let time = timeline.time(frame);
        posed.keys_to(time);
        match document.rig {
            RigKind::Arm => Some(posed.arm.root + posed.arm.pose().hand),
            RigKind::Skeleton => Some(posed.skeleton.at(time).tip(joint?)),
        }
    };
    (0..frames).step_by(stride).filter_map(point).collect()
}
