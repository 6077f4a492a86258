use glam::Vec3;

use super::{OnionSkin, Overlays, Session};
use crate::document::{Document, Overlay, RigKind};
use crate::kinematics::skeleton::JointId;

impl Session {
    /// Where the hand, or the selected joint's tip, is at every frame.
    pub(super) fn trail(&self) -> &[Vec3] {
        if has_trail(&self.document, &self.shown) {
            self.trail.get_or_init(|| walk(&self.document, self.selected()))
        } else {
            &[]
        }
    }

    /// The trail is another one; it is walked when it is next shown.
    pub(super) fn forget_trail(&mut self) {
        self.trail.take();
    }
}

impl Overlays {
    /// What a picture of a document at a time shows beside it, as the document's display has it:
    /// nothing is selected.
    pub fn new(document: &Document, time: f64) -> Self {
        let shown = document.at(time);
        let has_trail = has_trail(document, &shown);
        let mut overlays = Self {
            time,
            trail: if has_trail { walk(document, None) } else { Vec::new() },
            ..Self::default()
        };
        write_onion_skins(document, &shown, time, &mut overlays.onion_skins);
        overlays
    }

    /// The same at another time, at which the document is.
    #[must_use]
    pub fn at(mut self, document: &Document, time: f64) -> Self {
        self.time = time;
        write_onion_skins(document, document, time, &mut self.onion_skins);
        self
    }
}

fn has_trail(document: &Document, shown: &Document) -> bool {
    document.is_posed_by_time() && shown.display.shows(Overlay::Trail)
}

/// The rig some frames before and after, as far as the timeline goes, in the memory that `skins` have.
pub(super) fn write_onion_skins(
    document: &Document,
    shown: &Document,
    time: f64,
    skins: &mut Vec<OnionSkin>,
) {
    /// How many there are before and after, and how many frames lie between two.
    const SKINS: (isize, f64) = (3, 5.0);
    if !shown.display.shows(Overlay::OnionSkins) || !document.is_posed_by_time() {
        return skins.clear();
    }
    let (count, frames) = SKINS;
    let timeline = document.timeline;
    let step = frames / f64::from(timeline.frame_rate);
    let is_played = |time: f64| time >= timeline.start - 1e-9 && time <= timeline.end + 1e-9;
    let all = (-count..=count).filter(|place| *place != 0);
    let times = all.map(|place| (place, time + place as f64 * step));
    let mut posed = document.at(time);
    let mut made = 0;
    for (place, time) in times.filter(|(_, time)| is_played(*time)) {
        posed.keys_to(time);
        if made == skins.len() {
            skins.push(OnionSkin::default());
        }
        let skin = &mut skins[made];
        skin.arm = posed.arm;
        posed.skeleton_rig.write_pose(time, &mut skin.pose);
        (skin.past, skin.opacity) = (place < 0, 1.0 / place.unsigned_abs() as f32);
        made += 1;
    }
    skins.truncate(made);
}

/// Where the hand, or a joint's tip, is at every frame; of a long motion not every frame.
fn walk(document: &Document, joint: Option<JointId>) -> Vec<Vec3> {
    const MOST_POINTS: usize = 2000;
    /// Joints times points: what a large skeleton may cost.
    const MOST_POSES: usize = 100_000;
    let timeline = document.timeline;
    let joints = match (document.rig, joint) {
        (RigKind::Arm, _) => 1,
        (RigKind::Skeleton, Some(_)) => document.skeleton().joints().len(),
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
            RigKind::Skeleton => Some(posed.skeleton_rig.at(time).tip(joint?)),
        }
    };
    (0..frames).step_by(stride).filter_map(point).collect()
}
