use glam::Vec3;

use super::{OnionSkin, Session};
use crate::document::{Document, Layer, RigKind};

/// Where the hand, or the selected joint's tip, is at every frame.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Trail {
    points: Vec<Vec3>,
}

impl Trail {
    const MOST_POINTS: usize = 2000;
    /// What a long motion of a large skeleton may cost: joints times points.
    const MOST_POSES: usize = 100_000;

    fn new(document: &Document, joint: Option<usize>) -> Self {
        let timeline = document.timeline;
        let joints = match document.rig {
            RigKind::Arm => 1,
            RigKind::Skeleton => document.skeleton.skeleton.joints().len().max(1),
        };
        let frames = timeline.frames();
        let most = (Self::MOST_POSES / joints).clamp(1, Self::MOST_POINTS);
        let stride = frames.div_ceil(most);
        let mut posed = document.clone();
        let point = |frame| {
            let time = timeline.time(frame);
            posed.keys_to(time);
            match document.rig {
                RigKind::Arm => Some(posed.arm.root + posed.arm.pose().hand),
                RigKind::Skeleton => Some(posed.skeleton.at(time).tip(joint?)),
            }
        };
        Self { points: (0..frames).step_by(stride).filter_map(point).collect() }
    }

    pub fn points(&self) -> &[Vec3] {
        &self.points
    }
}

/// What is shown of other times.
impl Session {
    /// How many skins there are before and after, and how many frames lie between two.
    const SKINS: (usize, f64) = (3, 5.0);

    pub(super) fn refresh_trail(&mut self) {
        self.trail = if self.document.is_posed_by_time() && self.shown.display.shows(Layer::Trail) {
            Trail::new(&self.document, self.selected())
        } else {
            Trail::default()
        };
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
