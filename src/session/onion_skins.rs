use super::overlays::OnionSkin;
use crate::document::{Document, Overlay};

/// The rig some frames before and after, as far as the timeline goes, in the memory that `skins` have.
pub(super) fn write_onion_skins(
    document: &Document,
    shown: &Document,
    time: f64,
    skins: &mut Vec<OnionSkin>,
) {
    /// How many there are before and after, and how many frames lie between two.
    const SKINS: (isize, f64) = (3, 5.0);
    if !shown.display.shows(Overlay::OnionSkins) || !document.is_animated() {
        return skins.clear();
    }
    let (count, frames) = SKINS;
    let timeline = document.timeline;
    let step = frames / f64::from(timeline.frame_rate);
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
