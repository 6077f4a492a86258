//! Spheres around the shown rig, at one time and over the timeline, and cameras that frame them.

use glam::Vec3;

use super::arm::Arm;
use super::camera::Camera;
use super::document::Document;
use super::rig_kind::RigKind;
use super::track::{Posed, Track};
use crate::kinematics::skeleton::SkeletonPose;
use crate::rig::Target;

impl Document {
    /// Centre and radius of a bounding sphere of the shown rig over the timeline, in world space.
    /// At each time it contains [`SkeletonRig::bounds`](super::SkeletonRig::bounds) or
    /// [`Arm::bounds`].
    ///
    /// A long motion is sampled: at most 1,000 times, or 100 if targets pose the skeleton.
    pub fn motion_bounds(&self) -> (Vec3, f32) {
        self.motion_bounds_by(|posed| posed.arm().bounds(posed.arm_pose()))
    }

    /// [`Document::motion_bounds`] with another sphere for the posed arm.
    pub(crate) fn motion_bounds_by(&self, arm: impl Fn(&Posed) -> (Vec3, f32)) -> (Vec3, f32) {
        let track = Track::new(self);
        let mut pose = SkeletonPose::default();
        let reach = self.skeleton_rig.reach();
        let sphere_at = |time| {
            let posed = track.at(time);
            match self.rig {
                RigKind::Arm => arm(&posed),
                RigKind::Skeleton => {
                    posed.skeleton().write_pose(&mut pose);
                    posed.document().skeleton_rig.bounds_with_reach(reach, &pose, time)
                }
            }
        };
        around(&self.bounds_times().map(sphere_at).collect::<Vec<_>>())
    }

    /// The times at which [`Document::motion_bounds`] looks at the rig: frames of the timeline at
    /// even distances, with the first and the last; the start alone if nothing moves.
    fn bounds_times(&self) -> impl Iterator<Item = f64> + use<> {
        const MOST: usize = 1000;
        const MOST_SOLVED: usize = 100;
        let is_solved = self.rig == RigKind::Skeleton
            && self.skeleton_rig.targets.iter().any(Target::is_posing);
        let most = if is_solved { MOST_SOLVED } else { MOST };
        let timeline = self.timeline;
        let last = if self.is_moving() { timeline.frames() - 1 } else { 0 };
        let step = last.div_ceil(most - 1).max(1);
        (0..last).step_by(step).chain([last]).map(move |frame| timeline.time(frame))
    }

    /// A camera with the default direction that frames the shown rig over the timeline. A still arm
    /// with the default lengths is seen by the default camera.
    #[must_use]
    pub fn framing_camera(&self) -> Camera {
        let is_default = self.rig == RigKind::Arm && self.arm.bones == Arm::default().bones;
        if is_default && !self.is_moving() {
            return Camera::default();
        }
        let (centre, radius) = self.motion_bounds();
        Camera::default().framing(centre, radius, 1.0)
    }
}

/// Centre and radius of a sphere that contains `spheres`: around the middle of the box around their
/// centres.
fn around(spheres: &[(Vec3, f32)]) -> (Vec3, f32) {
    let centres = || spheres.iter().map(|(centre, _)| *centre);
    let Some(low) = centres().reduce(Vec3::min) else { return Default::default() };
    let high = centres().fold(low, Vec3::max);
    // Halved first, so that the sum does not overflow.
    let middle = low * 0.5 + high * 0.5;
    let farthest = |(centre, radius): &(Vec3, f32)| centre.distance(middle) + radius;
    (middle, spheres.iter().map(farthest).fold(0.0, f32::max).min(f32::MAX))
}
