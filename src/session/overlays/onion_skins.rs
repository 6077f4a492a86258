use glam::Vec3;

use crate::document::{Overlay, Posed, Track};
use crate::kinematics::chain_ik::ChainSolver;
use crate::kinematics::skeleton::SkeletonPose;
use crate::rig::ArmPart;

/// The rig in a frame before or after the playhead.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct OnionSkin {
    /// Shoulder, elbow and hand of the arm, in the world.
    pub arm: [Vec3; 3],
    /// The skeleton's pose, in world space.
    pub pose: SkeletonPose,
    /// True if the frame is before the playhead.
    pub past: bool,
    /// Opacity: 1 nearest to the playhead, less farther away.
    pub opacity: f32,
}

/// Writes into `skins` the rig in frames before and after those of `posed` that are on the
/// timeline, or nothing if onion skins are hidden. Reuses the memory of `skins`.
pub(in crate::session) fn write_onion_skins(
    track: &Track,
    posed: &Posed,
    skins: &mut Vec<OnionSkin>,
) {
    /// Number of onion skins on each side of the playhead.
    const MOST: isize = 3;
    /// Number of frames from one skin to the next.
    const FRAMES: f64 = 5.0;
    /// Work of a pose above which only the nearest skins are shown: they are posed in every frame.
    const MOST_WORK: u64 = ChainSolver::POSE_WORK / 16;
    let document = track.document();
    if !posed.document().display.shows(Overlay::OnionSkins) || !document.is_animated() {
        return skins.clear();
    }
    let count = if posed.evaluated_skeleton().work() > MOST_WORK { 1 } else { MOST };
    let timeline = document.timeline;
    let step = FRAMES / timeline.frame_rate;
    let is_played = |time: f64| time >= timeline.start - 1e-9 && time <= timeline.end + 1e-9;
    let all = (-count..=count).filter(|place| *place != 0);
    let times = all.map(|place| (place, posed.time() + place as f64 * step));
    let mut made = 0;
    for (place, time) in times.filter(|(_, time)| is_played(*time)) {
        let posed = track.at(time);
        if made == skins.len() {
            skins.push(OnionSkin::default());
        }
        let skin = &mut skins[made];
        let rig = posed.arm().rig(posed.arm_pose());
        skin.arm = [ArmPart::Root, ArmPart::Elbow, ArmPart::Hand].map(|part| rig.origin(part));
        posed.skeleton().write_pose(&mut skin.pose);
        (skin.past, skin.opacity) = (place < 0, 1.0 / place.unsigned_abs() as f32);
        made += 1;
    }
    skins.truncate(made);
}
