use glam::{Affine3A, Mat3A, Vec3, Vec3A};

use super::follow_path::{
    FollowPath, PathKind, WavyRing, body_behind, travelled_by_head, travelled_by_target,
};
use super::skeleton_rig::SkeletonRig;
use super::target::Target;
use crate::limb_ik::{self, Limb};
use crate::skeleton::{JointId, Skeleton, SkeletonPose};
use crate::spline::Spline;
use crate::{Shared, follow, rotation_between};

/// The chain of a root, to be laid along a path behind its head. Locked joints follow, too.
struct PathChain<'a> {
    skeleton: &'a Skeleton,
    /// The joints, the head first, each with the vector to the next joint in its own space; the
    /// last with its bone.
    bones: Vec<(JointId, Vec3)>,
    /// Position of the head in skeleton space.
    head: Vec3,
    /// Points of the path at which the bones end.
    tips: Vec<Vec3>,
    /// True if joints keep their roll: they are turned onto the path from their own rotation, not
    /// from the bind pose.
    keeps_roll: bool,
}

impl<'a> PathChain<'a> {
    /// The chain on a ring, at the height of its head, at a time in seconds.
    fn on_ring(skeleton: &'a Skeleton, root: JointId, ring: WavyRing, time: f64) -> Self {
        let height = Vec3::Y * skeleton[root].offset.y;
        let bones = bones(skeleton, root);
        let (point, turns) = (|turns| ring.point(turns) + height, ring.turns_at(time));
        let lengths = bones.iter().map(|(_, bone)| bone.length());
        let tips = follow::behind(point, turns, ring.stride(), lengths).collect();
        Self { skeleton, bones, head: point(turns), tips, keeps_roll: false }
    }

    /// The chain behind a head with keys at a time in seconds; `None` if its own angles pose it
    /// because the head has not left its first key yet, or if a point of the body is not finite.
    fn behind_keys(
        skeleton: &'a Skeleton,
        root: JointId,
        keys: &Spline<Vec3>,
        time: f64,
    ) -> Option<Self> {
        let at = skeleton[root].offset;
        if !Self::has_left_first_key(keys, time, at) {
            return None;
        }
        let bones = bones(skeleton, root);
        let body = posed(skeleton, &bones)?;
        let path = travelled_by_head(at, keys, time, &body);
        Some(Self::behind(skeleton, bones, path))
    }

    /// The chain behind a target of its head at a time in seconds; `keys` are those of the target's
    /// home. `None` if a point of the body is not finite, or if the target's space is singular.
    fn behind_target(
        skeleton: &'a Skeleton,
        target: &Target,
        keys: Option<&Spline<Vec3>>,
        time: f64,
    ) -> Option<Self> {
        let bones = bones(skeleton, target.joint);
        let body = posed(skeleton, &bones)?;
        let to_skeleton = target.present_space().to_skeleton(skeleton);
        let to_target = to_skeleton.inverse();
        let body = body.into_iter().map(|bone| to_target.transform_vector3(bone)).collect();
        let path = travelled_by_target(target, keys, time, body);
        let path = path.map(|point| to_skeleton.transform_point3(point));
        (to_skeleton.is_finite() && to_target.is_finite())
            .then(|| Self::behind(skeleton, bones, path))
    }

    /// True if a head with keys, which is at `head` at a time in seconds, has left its first key.
    fn has_left_first_key(keys: &Spline<Vec3>, time: f64, head: Vec3) -> bool {
        keys.knots().first().is_some_and(|first| time > first.time || head != first.value)
    }

    /// The chain after its head has moved through `points` of skeleton space; `None` without
    /// points, or if a point of the body is not finite.
    fn pulled_through(skeleton: &'a Skeleton, root: JointId, points: &[Vec3]) -> Option<Self> {
        let start = skeleton[root].offset;
        points.first()?;
        let bones = bones(skeleton, root);
        let body = posed(skeleton, &bones)?;
        let path = points.iter().rev().copied().chain(body_behind(start, &body));
        Some(Self::behind(skeleton, bones, path))
    }

    /// The chain along a path, which begins at the head.
    fn behind(
        skeleton: &'a Skeleton,
        bones: Vec<(JointId, Vec3)>,
        path: impl Iterator<Item = Vec3>,
    ) -> Self {
        let mut path = path.peekable();
        let head = path.peek().copied().unwrap_or_default();
        let lengths = bones.iter().map(|(_, bone)| bone.length());
        let tips = follow::along_line(path, lengths).collect();
        Self { skeleton, bones, head, tips, keeps_roll: true }
    }

    /// Lays the chain of a skeleton with the same bones along the path.
    fn write(&self, skeleton: &mut Skeleton) {
        for (joint, offset, rotation) in self.joints() {
            skeleton
                .write_local(joint, |joint| (joint.offset, joint.rotation) = (offset, rotation));
        }
    }

    /// Each joint on the path, parents first, with its offset and Euler angles (radians).
    fn joints(&self) -> impl Iterator<Item = (JointId, Vec3, Vec3)> + '_ {
        let mut base = self.head;
        let mut above = Mat3A::IDENTITY;
        self.bones.iter().zip(&self.tips).map(move |(&(index, bone), &tip)| {
            let joint = &self.skeleton[index];
            let start =
                if self.keeps_roll { joint.rotation_by(joint.rotation) } else { Mat3A::IDENTITY };
            let bone = Vec3A::from(bone);
            let turn = rotation_between(start * bone, above.transpose() * Vec3A::from(tip - base));
            let mut rotation =
                joint.limits.project(joint.angles_of(Mat3A::from_quat(turn) * start));
            let mut offset = if joint.parent.is_none() { base } else { joint.offset };
            // Squared lengths of very long bones overflow; such a joint stays unchanged.
            if !(rotation.is_finite() && offset.is_finite()) {
                (offset, rotation) = (joint.offset, joint.rotation);
            }
            above *= joint.rotation_by(rotation);
            // Limits, or a bone longer than the ring is wide, can leave the tip off the path. The
            // next joint starts where this bone ends.
            let end = base + Vec3::from(above * bone);
            base = if end.is_finite() { end } else { tip };
            (index, offset, rotation)
        })
    }
}

/// The joints of the chain of a root, the head first, each with the vector to the next joint in its
/// own space; the last with its bone.
fn bones(skeleton: &Skeleton, root: JointId) -> Vec<(JointId, Vec3)> {
    let (mut bones, mut last, mut bone) = (Vec::new(), root, skeleton[root].axis);
    // Children come after their parents, the first child first.
    for (index, joint) in skeleton.iter().skip(root.index() + 1) {
        if joint.parent == Some(last) {
            bones.push((last, joint.offset));
            (last, bone) = (index, joint.axis);
        }
    }
    bones.push((last, bone));
    bones
}

/// The bones of a chain in skeleton space, posed by the joints' own angles; `None` if one is not
/// finite.
fn posed(skeleton: &Skeleton, bones: &[(JointId, Vec3)]) -> Option<Vec<Vec3>> {
    let posed = bones.iter().scan(Mat3A::IDENTITY, |above, (joint, bone)| {
        *above *= skeleton[*joint].rotation_by(skeleton[*joint].rotation);
        Some(Vec3::from(*above * Vec3A::from(*bone)))
    });
    posed.map(|bone| bone.is_finite().then_some(bone)).collect()
}

/// A skeleton of which chains follow paths.
impl SkeletonRig {
    /// The path that moves the chain of a root; `None` if no path does.
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

    /// True if any chain follows a path at a time in seconds, so that its own angles do not pose
    /// it: on a ring always, behind a target while it is enabled, behind a head from its first key
    /// on.
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

    /// The FK pose at a time in seconds: on the followed paths if there are any, else by the
    /// skeleton's own angles.
    pub fn fk_at(&self, time: f64) -> Shared<Skeleton> {
        let mut fk = self.skeleton.clone();
        self.chains_at(time).for_each(|chain| chain.write(fk.make_mut()));
        for (target, stretch) in self.fk_stretches() {
            if let Ok(limb) = Limb::ending_at(&fk, target.joint) {
                limb_ik::lengthen(fk.make_mut(), limb, stretch);
            }
        }
        fk
    }

    /// The limb targets that lengthen their bones in the FK pose, each with the factor.
    pub(super) fn fk_stretches(&self) -> impl Iterator<Item = (&Target, f32)> {
        let stretch = |target: &Target| target.limb().map_or(1.0, |limb| limb.fk_stretch);
        let all = self.targets.iter().map(move |target| (target, stretch(target)));
        all.filter(|(_, stretch)| *stretch != 1.0)
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

    /// Moves the head of a chain through points of skeleton space. With [`PathKind::Head`] and
    /// without keys, the chain follows; otherwise only the head moves.
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
