use crate::document::{Arm, Document, Overlay};
use crate::kinematics::skeleton::SkeletonPose;

/// The rig in a frame before or after the playhead.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct OnionSkin {
    /// The arm.
    pub arm: Arm,
    /// The skeleton's pose, in world space.
    pub pose: SkeletonPose,
    /// Whether the frame is before the playhead.
    pub past: bool,
    /// Opacity: 1 nearest to the playhead, less farther away.
    pub opacity: f32,
}

/// Writes into `skins` the rig in frames before and after `time` (in seconds) that are on the
/// timeline, or nothing if onion skins are hidden. Reuses the memory of `skins`.
pub(super) fn write_onion_skins(
    document: &Document,
    shown: &Document,
    time: f64,
    skins: &mut Vec<OnionSkin>,
) {
    /// Number of onion skins on each side of `time`, and number of frames from one skin to the
    /// next.
    const SKINS: (isize, f64) = (3, 5.0);
    if !shown.display.shows(Overlay::OnionSkins) || !document.is_animated() {
        return skins.clear();
    }
    let (count, frames) = SKINS;
    let timeline = document.timeline;
    let step = frames / timeline.frame_rate;
    let is_played = |time: f64| time >= timeline.start - 1e-9 && time <= timeline.end + 1e-9;
    let all = (-count..=count).filter(|place| *place != 0);
    let times = all.map(|place| (place, time + place as f64 * step));
    let mut posed = document.evaluate(time);
    let mut made = 0;
    for (place, time) in times.filter(|(_, time)| is_played(*time)) {
        posed.apply_keys(time);
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
