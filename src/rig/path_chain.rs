use glam::{Affine3A, Mat3A, Vec3, Vec3A};

use super::head_path::HeadPath;
use super::wavy_ring::WavyRing;
use crate::kinematics::skeleton::{JointId, Skeleton, SkeletonPose};
use crate::kinematics::spline::Spline;
use crate::kinematics::{follow, rotation_between};

/// The first chain of a skeleton, to be laid along a path behind its head.
pub(super) struct PathChain<'a> {
    skeleton: &'a Skeleton,
    /// The joints, the head first, each with the vector to the next joint in its own space; the last
    /// with its bone.
    bones: Vec<(JointId, Vec3)>,
    path: Path<'a>,
}

enum Path<'a> {
    Ring { ring: WavyRing, turns: f64, height: f32 },
    Head(HeadPath<'a>),
}

impl<'a> PathChain<'a> {
    /// The chain on a ring, at the height of its head, at a time in seconds; `None` without joints.
    pub fn on_ring(skeleton: &'a Skeleton, ring: WavyRing, time: f64) -> Option<Self> {
        let height = skeleton[head(skeleton)?].offset.y;
        let path = Path::Ring { ring, turns: ring.turns_at(time), height };
        Some(Self { skeleton, bones: bones(skeleton), path })
    }

    /// The chain behind a head with keys at a time in seconds; `None` if the head has not moved from its
    /// first key yet.
    pub fn behind_head(skeleton: &'a Skeleton, track: &'a Spline<Vec3>, time: f64) -> Option<Self> {
        let now = skeleton[head(skeleton)?].offset;
        let first = track.knots().first()?;
        if time <= first.time && now == first.value {
            return None;
        }
        let bones = bones(skeleton);
        let posed = bones.iter().scan(Mat3A::IDENTITY, |above, (joint, bone)| {
            *above *= skeleton[*joint].rotation_by(skeleton[*joint].rotation);
            Some(Vec3::from(*above * Vec3A::from(*bone)))
        });
        let path = Path::Head(HeadPath::new(track, time, now, posed)?);
        Some(Self { skeleton, bones, path })
    }

    /// The skeleton with the chain on the path.
    pub fn posed(&self) -> Skeleton {
        let mut posed = self.skeleton.clone();
        for (joint, offset, rotation) in self.joints() {
            posed.write_local(joint, |joint| (joint.offset, joint.rotation) = (offset, rotation));
        }
        posed
    }

    /// Writes the pose of [`PathChain::posed`].
    pub fn write(&self, pose: &mut SkeletonPose) {
        let mut chain = self.joints().peekable();
        self.skeleton.write_pose_with(pose, |index, joint| {
            match chain.next_if(|(followed, ..)| *followed == JointId::new(index)) {
                Some((_, offset, rotation)) => {
                    Affine3A { matrix3: joint.rotation_by(rotation), translation: offset.into() }
                }
                None => joint.local(),
            }
        });
    }

    /// Each joint on the path, parents first, with its offset and Euler angles (radians).
    fn joints(&self) -> impl Iterator<Item = (JointId, Vec3, Vec3)> + '_ {
        let lengths = self.bones.iter().map(|(_, bone)| bone.length());
        let (head, stride) = (self.path.head(), self.path.stride());
        let tips = follow::behind(|at| self.path.point(at), head, stride, lengths);
        let mut base = self.path.point(head);
        let mut above = Mat3A::IDENTITY;
        self.bones.iter().zip(tips).map(move |(&(index, bone), tip)| {
            let joint = &self.skeleton[index];
            let own = self.path.unturned(joint.rotation_by(joint.rotation));
            let bone = Vec3A::from(bone);
            let turn = rotation_between(own * bone, above.transpose() * Vec3A::from(tip - base));
            let mut rotation = joint.clamped(joint.angles_of(Mat3A::from_quat(turn) * own));
            let mut offset = if joint.parent.is_none() { base } else { joint.offset };
            // The squared length of a very long bone overflows; the joint is left unchanged.
            if !(rotation.is_finite() && offset.is_finite()) {
                (offset, rotation) = (joint.offset, joint.rotation);
            }
            above *= joint.rotation_by(rotation);
            // Where limits, or a bone longer than the path, leave the tip off the path.
            let end = base + Vec3::from(above * bone);
            base = if end.is_finite() { end } else { tip };
            (index, offset, rotation)
        })
    }
}

impl Path<'_> {
    /// The parameter of the head.
    fn head(&self) -> f64 {
        match self {
            Self::Ring { turns, .. } => *turns,
            Self::Head(path) => path.head(),
        }
    }

    /// Step of the parameter over which the path is nearly straight.
    fn stride(&self) -> f64 {
        match self {
            Self::Ring { ring, .. } => ring.stride(),
            Self::Head(_) => HeadPath::STRIDE,
        }
    }

    fn point(&self, at: f64) -> Vec3 {
        match self {
            Self::Ring { ring, height, .. } => ring.point(at) + Vec3::Y * *height,
            Self::Head(path) => path.point(at),
        }
    }

    /// The rotation from which a joint is turned onto the path: none on a ring; behind a head the joint's
    /// own, so that it keeps its roll.
    fn unturned(&self, own: Mat3A) -> Mat3A {
        match self {
            Self::Ring { .. } => Mat3A::IDENTITY,
            Self::Head(_) => own,
        }
    }
}

/// The first root, the head of the chain that follows a path; `None` without joints.
pub(super) fn head(skeleton: &Skeleton) -> Option<JointId> {
    skeleton.ids().find(|joint| skeleton[*joint].parent.is_none())
}

fn bones(skeleton: &Skeleton) -> Vec<(JointId, Vec3)> {
    let mut bones: Vec<(JointId, Vec3)> = Vec::new();
    for (index, joint) in skeleton.iter() {
        let last = bones.last_mut();
        // Children come after their parents, the first child first.
        if joint.parent == last.as_ref().map(|(last, _)| *last) {
            if let Some((_, bone)) = last {
                *bone = joint.offset;
            }
            bones.push((index, joint.axis));
        }
    }
    bones
}
