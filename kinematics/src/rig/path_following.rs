use glam::{Affine3A, Vec3};

use super::follow_path::{FollowPath, PathKind};
use super::path_chain::{PathChain, bones};
use super::skeleton_rig::SkeletonRig;
use super::target::Target;
use crate::Shared;
use crate::skeleton::{JointId, Skeleton, SkeletonPose};
use crate::spline::Spline;

/// A skeleton of which chains follow paths.
impl SkeletonRig {
    /// What moves the chain of a root along a path; `None` if no path does.
    pub fn path_kind(&self, root: JointId) -> Option<PathKind> {
        Some(self.follow_paths.iter().find(|path| path.root == root)?.kind)
    }

    /// The same paths, but with `kind` for the chain of a root; `None` for no path.
    #[must_use]
    pub fn with_path(&self, root: JointId, kind: Option<PathKind>) -> Vec<FollowPath> {
        let others = self.follow_paths.iter().filter(|path| path.root != root).copied();
        let mut paths: Vec<_> = others.chain(kind.map(|kind| FollowPath { root, kind })).collect();
        paths.sort_by_key(|path| path.root);
        paths
    }

    /// The root above a joint, or the joint itself if it has no parent; `None` for a missing joint.
    pub fn root_of(&self, joint: JointId) -> Option<JointId> {
        self.skeleton.joint(joint)?;
        self.skeleton.ancestors(joint).last()
    }

    /// True if any chain follows a path at a time in seconds, so that its own angles do not pose it: on
    /// a ring always, behind a target while it is enabled, behind a head from its first key on.
    pub fn is_on_path(&self, time: f64) -> bool {
        self.paths_at(time).next().is_some()
    }

    /// True if a path poses a joint at a time in seconds.
    pub fn is_joint_on_path(&self, joint: JointId, time: f64) -> bool {
        self.paths_at(time).any(|path| self.path_joints(path.root).any(|other| other == joint))
    }

    /// True if the target moves the head of a chain, which follows its path.
    pub fn leads_path(&self, target: &Target) -> bool {
        self.path_kind(target.joint) == Some(PathKind::Target)
    }

    /// True if the target poses the skeleton by a solver.
    pub fn is_solved_for(&self, target: &Target) -> bool {
        target.is_posing() && !self.leads_path(target)
    }

    /// The FK pose at a time in seconds: on the followed paths if there are any, else by the skeleton's
    /// own angles.
    pub fn fk_at(&self, time: f64) -> Shared<Skeleton> {
        let mut fk = self.skeleton.clone();
        self.chains_at(time).for_each(|chain| chain.write(fk.make_mut()));
        fk
    }

    /// Writes the pose of [`SkeletonRig::fk_at`] into an existing pose, reusing its memory.
    pub(super) fn write_fk(&self, time: f64, pose: &mut SkeletonPose) {
        let mut joints = Vec::new();
        self.chains_at(time).for_each(|chain| joints.extend(chain.joints()));
        joints.sort_unstable_by_key(|(joint, ..)| *joint);
        let mut joints = joints.into_iter().peekable();
        self.skeleton.write_pose_with(pose, |index, joint| {
            match joints.next_if(|(followed, ..)| *followed == JointId::new(index)) {
                Some((_, offset, rotation)) => {
                    Affine3A { matrix3: joint.rotation_by(rotation), translation: offset.into() }
                }
                None => joint.local(),
            }
        });
    }

    /// The paths' extent in the world: the corners of rings, and where keys put heads.
    pub(super) fn path_points(&self) -> impl Iterator<Item = Vec3> + '_ {
        let corners = self.follow_paths.iter().flat_map(|path| match path.kind {
            PathKind::Ring(ring) => ring.corners(&self.skeleton).to_vec(),
            PathKind::Head | PathKind::Target => Vec::new(),
        });
        let heads = self.follow_paths.iter().filter(|path| path.kind == PathKind::Head);
        let tracks = heads.filter_map(|path| self.head_tracks.get(&path.root));
        let knots = tracks.flat_map(|track| track.knots());
        let to_world = self.skeleton.transform();
        corners.chain(knots.map(move |knot| to_world.transform_point3(knot.value)))
    }

    /// The paths that are followed at a time in seconds.
    fn paths_at(&self, time: f64) -> impl Iterator<Item = &FollowPath> {
        self.follow_paths.iter().filter(move |path| {
            self.skeleton.joint(path.root).is_some_and(|head| match path.kind {
                PathKind::Ring(_) => true,
                PathKind::Head => self
                    .head_keys(path.root)
                    .is_some_and(|keys| PathChain::has_left_first_key(keys, time, head.offset)),
                PathKind::Target => self.leader(path.root).is_some(),
            })
        })
    }

    /// The chains on their paths at a time in seconds.
    fn chains_at(&self, time: f64) -> impl Iterator<Item = PathChain<'_>> {
        let skeleton = &*self.skeleton;
        self.paths_at(time).filter_map(move |&FollowPath { root, kind }| match kind {
            PathKind::Ring(ring) => Some(PathChain::on_ring(skeleton, root, ring, time)),
            PathKind::Head => PathChain::behind_keys(skeleton, root, self.head_keys(root)?, time),
            PathKind::Target => {
                let keys = self.head_keys(root);
                PathChain::behind_target(skeleton, self.leader(root)?, keys, time)
            }
        })
    }

    /// Keys of what moves a head: of its offset, or of its target's home.
    fn head_keys(&self, root: JointId) -> Option<&Spline<Vec3>> {
        self.head_tracks.get(&root).map(|track| &**track)
    }

    /// The enabled target of a head.
    fn leader(&self, root: JointId) -> Option<&Target> {
        self.targets.iter().find(|target| target.joint == root && target.enabled)
    }

    /// Moves the head of a chain through points of skeleton space. With [`PathKind::Head`] and without
    /// keys, the chain follows; otherwise only the head moves.
    pub fn pull_head(&mut self, root: JointId, points: &[Vec3]) {
        let (Some(_), Some(last)) = (self.skeleton.joint(root), points.last()) else { return };
        let is_pulled =
            self.path_kind(root) == Some(PathKind::Head) && self.head_keys(root).is_none();
        let pulled = is_pulled.then(|| PathChain::pulled_through(&self.skeleton, root, points));
        if let Some(chain) = pulled.flatten() {
            let mut pulled = Skeleton::clone(&self.skeleton);
            chain.write(&mut pulled);
            self.skeleton = Shared::from(pulled);
        } else {
            self.skeleton_mut().write_local(root, |head| head.offset = *last);
        }
    }

    /// The joints of the chain of a root, the head first; none for a missing joint.
    pub fn path_joints(&self, root: JointId) -> impl Iterator<Item = JointId> {
        let bones = self.skeleton.joint(root).map(|_| bones(&self.skeleton, root));
        bones.into_iter().flatten().map(|(joint, _)| joint)
    }
}
