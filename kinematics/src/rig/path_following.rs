use glam::Vec3;

use super::follow_path::FollowPath;
use super::path_chain::{PathChain, bones, head};
use super::skeleton_rig::SkeletonRig;
use crate::Shared;
use crate::skeleton::{JointId, Skeleton, SkeletonPose};
use crate::spline::Spline;

/// A skeleton on a path.
impl SkeletonRig {
    /// The first root, the head of the chain that follows a path; `None` without joints.
    pub fn head(&self) -> Option<JointId> {
        head(&self.skeleton)
    }

    /// Whether the first chain follows a path at a time in seconds, so that its own angles do not pose
    /// it: on a ring always, behind a head from its first key on.
    pub fn is_on_path(&self, time: f64) -> bool {
        let Some(head) = self.head() else { return false };
        match (self.follow_path, &self.head_track) {
            (Some(FollowPath::Ring(_)), _) => true,
            (Some(FollowPath::Head), Some(keys)) => {
                PathChain::has_left_first_key(keys, time, self.skeleton[head].offset)
            }
            _ => false,
        }
    }

    /// The FK pose at a time in seconds: on the followed path if there is one, else by the
    /// skeleton's own angles.
    pub fn fk_at(&self, time: f64) -> Shared<Skeleton> {
        match self.chain_at(time) {
            None => self.skeleton.clone(),
            Some(chain) => Shared::from(chain.posed()),
        }
    }

    /// Writes the pose of [`SkeletonRig::fk_at`] into an existing pose, reusing its memory.
    pub(super) fn write_fk(&self, time: f64, pose: &mut SkeletonPose) {
        match self.chain_at(time) {
            None => self.skeleton.write_pose(pose),
            Some(chain) => chain.write(pose),
        }
    }

    /// The path's extent in the world: the corners of a ring, or where the keys put the head.
    pub(super) fn path_points(&self) -> impl Iterator<Item = Vec3> + '_ {
        let (ring, track) = match self.follow_path {
            Some(FollowPath::Ring(ring)) => (Some(ring), None),
            Some(FollowPath::Head) => (None, self.head_track.as_deref()),
            None => (None, None),
        };
        let corners = ring.into_iter().flat_map(|ring| ring.corners(&self.skeleton));
        let knots = track.into_iter().flat_map(Spline::knots);
        let to_world = self.skeleton.transform();
        corners.chain(knots.map(move |knot| to_world.transform_point3(knot.value)))
    }

    /// The chain on its path at a time in seconds; `None` if its own angles pose it.
    fn chain_at(&self, time: f64) -> Option<PathChain<'_>> {
        match self.follow_path? {
            FollowPath::Ring(ring) => PathChain::on_ring(&self.skeleton, ring, time),
            FollowPath::Head => {
                PathChain::behind_keys(&self.skeleton, self.head_track.as_deref()?, time)
            }
        }
    }

    /// Moves the head through points of skeleton space. With [`FollowPath::Head`] and without keys, the
    /// chain follows; keys of the head give the path otherwise.
    pub fn pull_head(&mut self, points: &[Vec3]) {
        let (Some(head), Some(last)) = (self.head(), points.last()) else { return };
        let is_pulled = self.follow_path == Some(FollowPath::Head) && self.head_track.is_none();
        let pulled = || Some(PathChain::pulled_through(&self.skeleton, points)?.posed());
        if let Some(pulled) = is_pulled.then(pulled).flatten() {
            self.skeleton = Shared::from(pulled);
        } else {
            self.skeleton_mut().write_local(head, |head| head.offset = *last);
        }
    }

    /// The joints of the chain that follows a path, the head first.
    pub fn path_joints(&self) -> impl Iterator<Item = JointId> {
        bones(&self.skeleton).into_iter().map(|(joint, _)| joint)
    }
}
