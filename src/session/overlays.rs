use glam::Vec3;

use super::trail::write_onion_skins;
use super::{Comparison, Session};
use crate::document::Arm;
use crate::kinematics::chain_ik::Method;
use crate::kinematics::skeleton::{JointId, SkeletonPose};
use crate::kinematics::twist::TransportedFrame;
use crate::rig::Crowd;

/// What a picture shows beside the document.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Overlays {
    /// In seconds.
    pub time: f64,
    /// Joints that are selected; the last one is the one that is worked on.
    pub selection: Vec<JointId>,
    /// The joint that the pointer is on.
    pub pointed: Option<JointId>,
    /// The skeleton as solvers in a race have it.
    pub ghosts: Vec<Ghost>,
    /// What was carried along with the Pointer, from which transport would measure the elbow.
    pub transported: Option<TransportedFrame>,
    /// Where the hand or the selected joint's tip is at every frame, in the world.
    pub trail: Vec<Vec3>,
    pub onion_skins: Vec<OnionSkin>,
    /// What is shown in the rig's place.
    pub crowd: Option<Crowd>,
}

/// The rig as it stands somewhat before or after.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct OnionSkin {
    pub arm: Arm,
    pub pose: SkeletonPose,
    /// Whether it is before.
    pub past: bool,
    /// How well it is seen: 1 is nearest in time.
    pub opacity: f32,
}

/// A skeleton as a solver has it.
#[derive(Clone, Debug, PartialEq)]
pub struct Ghost {
    pub method: Method,
    pub pose: SkeletonPose,
}

impl Session {
    /// What a picture shows beside the document.
    pub fn overlays(&self) -> Overlays {
        let mut overlays = Overlays::default();
        self.write_overlays(&mut overlays);
        overlays
    }

    /// [`Session::overlays`] in the memory that another staging has: none is taken anew, except that
    /// onion skins take a copy of a document with keys.
    pub fn write_overlays(&self, overlays: &mut Overlays) {
        overlays.time = self.playback.time;
        overlays.crowd = self.crowd();
        overlays.selection.clone_from(&self.selection);
        overlays.pointed = self.pointed;
        overlays.transported = Some(self.transport_path.transported());
        overlays.trail.clear();
        overlays.trail.extend_from_slice(self.trail());
        write_ghosts(self.comparison.as_ref(), &mut overlays.ghosts);
        let (document, skins) = (&self.document, &mut overlays.onion_skins);
        write_onion_skins(document, &self.shown, self.playback.time, skins);
    }
}

fn write_ghosts(comparison: Option<&Comparison>, ghosts: &mut Vec<Ghost>) {
    let runners = comparison.into_iter().flat_map(Comparison::runners);
    let mut count = 0;
    for runner in runners.filter(|runner| runner.report().is_ok()) {
        let method = runner.method;
        match ghosts.get_mut(count) {
            Some(ghost) => {
                ghost.method = method;
                runner.skeleton.write_pose(&mut ghost.pose);
            }
            None => ghosts.push(Ghost { method, pose: runner.skeleton.pose() }),
        }
        count += 1;
    }
    ghosts.truncate(count);
}
