use glam::{Mat3A, Vec3, Vec3A};

use super::follow_path::WavyRing;
use super::head_path;
use super::target::Target;
use crate::skeleton::{JointId, Skeleton};
use crate::spline::Spline;
use crate::{follow, rotation_between};

/// The chain of a root, to be laid along a path behind its head. Locked joints follow, too.
pub(super) struct PathChain<'a> {
    skeleton: &'a Skeleton,
    /// The joints, the head first, each with the vector to the next joint in its own space; the last
    /// with its bone.
    bones: Vec<(JointId, Vec3)>,
    /// Position of the head in skeleton space.
    head: Vec3,
    /// Points of the path at which the bones end.
    tips: Vec<Vec3>,
    /// True if joints keep their roll: they are turned onto the path from their own rotation, not from
    /// the bind pose.
    keeps_roll: bool,
}

impl<'a> PathChain<'a> {
    /// The chain on a ring, at the height of its head, at a time in seconds.
    pub fn on_ring(skeleton: &'a Skeleton, root: JointId, ring: WavyRing, time: f64) -> Self {
        let height = Vec3::Y * skeleton[root].offset.y;
        let bones = bones(skeleton, root);
        let (point, turns) = (|turns| ring.point(turns) + height, ring.turns_at(time));
        let lengths = bones.iter().map(|(_, bone)| bone.length());
        let tips = follow::behind(point, turns, ring.stride(), lengths).collect();
        Self { skeleton, bones, head: point(turns), tips, keeps_roll: false }
    }

    /// The chain behind a head with keys at a time in seconds; `None` if its own angles pose it because
    /// the head has not left its first key yet, or if a point of the body is not finite.
    pub fn behind_keys(
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
        let path = head_path::points(at, keys, time, &body);
        Some(Self::behind(skeleton, bones, path))
    }

    /// The chain behind a target of its head at a time in seconds; `keys` are those of the target's
    /// home. `None` if a point of the body is not finite, or if the target's space is singular.
    pub fn behind_target(
        skeleton: &'a Skeleton,
        target: &Target,
        keys: Option<&Spline<Vec3>>,
        time: f64,
    ) -> Option<Self> {
        let bones = bones(skeleton, target.joint);
        let body = posed(skeleton, &bones)?;
        let to_skeleton = target.space.to_skeleton(skeleton);
        let to_target = to_skeleton.inverse();
        let body = body.into_iter().map(|bone| to_target.transform_vector3(bone)).collect();
        let path = head_path::of_target(target, keys, time, body);
        let path = path.map(|point| to_skeleton.transform_point3(point));
        (to_skeleton.is_finite() && to_target.is_finite())
            .then(|| Self::behind(skeleton, bones, path))
    }

    /// True if a head with keys, which is at `head` at a time in seconds, has left its first key.
    pub fn has_left_first_key(keys: &Spline<Vec3>, time: f64, head: Vec3) -> bool {
        keys.knots().first().is_some_and(|first| time > first.time || head != first.value)
    }

    /// The chain after its head has moved through `points` of skeleton space; `None` without points, or
    /// if a point of the body is not finite.
    pub fn pulled_through(skeleton: &'a Skeleton, root: JointId, points: &[Vec3]) -> Option<Self> {
        let start = skeleton[root].offset;
        points.first()?;
        let bones = bones(skeleton, root);
        let body = posed(skeleton, &bones)?;
        let path = points.iter().rev().copied().chain(head_path::behind(start, &body));
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
    pub fn write(&self, skeleton: &mut Skeleton) {
        for (joint, offset, rotation) in self.joints() {
            skeleton
                .write_local(joint, |joint| (joint.offset, joint.rotation) = (offset, rotation));
        }
    }

    /// Each joint on the path, parents first, with its offset and Euler angles (radians).
    pub fn joints(&self) -> impl Iterator<Item = (JointId, Vec3, Vec3)> + '_ {
        let mut base = self.head;
        let mut above = Mat3A::IDENTITY;
        self.bones.iter().zip(&self.tips).map(move |(&(index, bone), &tip)| {
            let joint = &self.skeleton[index];
            let start = match self.keeps_roll {
                true => joint.rotation_by(joint.rotation),
                false => Mat3A::IDENTITY,
            };
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
            // Limits, or a bone longer than the ring is wide, can leave the tip off the path. The next
            // joint starts where this bone ends.
            let end = base + Vec3::from(above * bone);
            base = if end.is_finite() { end } else { tip };
            (index, offset, rotation)
        })
    }
}

/// The joints of the chain of a root, the head first, each with the vector to the next joint in its own
/// space; the last with its bone.
pub(super) fn bones(skeleton: &Skeleton, root: JointId) -> Vec<(JointId, Vec3)> {
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

/// The bones of a chain in skeleton space, posed by the joints' own angles; `None` if one is not finite.
fn posed(skeleton: &Skeleton, bones: &[(JointId, Vec3)]) -> Option<Vec<Vec3>> {
    let posed = bones.iter().scan(Mat3A::IDENTITY, |above, (joint, bone)| {
        *above *= skeleton[*joint].rotation_by(skeleton[*joint].rotation);
        Some(Vec3::from(*above * Vec3A::from(*bone)))
    });
    posed.map(|bone| bone.is_finite().then_some(bone)).collect()
}
