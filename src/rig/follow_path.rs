use core::f64::consts::TAU;

use glam::{Affine3A, Mat3A, Vec3, Vec3A};

use crate::kinematics::skeleton::{JointId, Skeleton, SkeletonPose};
use crate::kinematics::{follow, rotation_between};

/// A closed path that the first chain of a skeleton (its first root, that root's first child, and
/// so on) follows over time, as a snake does.
///
/// The path is in skeleton space, at the height of the root: a circle around the origin with waves
/// on it. A joint whose limits keep it off the path is followed by the next one from where it
/// ends, back towards the path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FollowPath {
    /// Radius of the circle, in skeleton space.
    pub radius: f32,
    /// Amplitude of the waves, in skeleton space.
    pub amplitude: f32,
    /// Number of waves on the circle.
    pub waves: u32,
    /// Duration of one revolution in seconds.
    pub period: f32,
}

impl FollowPath {
    /// Point of the path in skeleton space, at height 0, after `turns` revolutions around the
    /// circle.
    pub fn point(&self, turns: f64) -> Vec3 {
        let turn = turns.rem_euclid(1.0) * TAU;
        let wave = f64::from(self.amplitude) * (turn * f64::from(self.waves)).sin();
        let radius = f64::from(self.radius) + wave;
        Vec3::new((radius * turn.cos()) as f32, 0.0, (-radius * turn.sin()) as f32)
    }

    /// Number of revolutions around the circle up to a time in seconds.
    pub fn turns_at(&self, time: f64) -> f64 {
        time / f64::from(self.period)
    }

    /// The skeleton at a time in seconds: its first root is on the path, and the chain of first
    /// children lies along the part of the path behind the root.
    pub fn pose(&self, skeleton: &Skeleton, time: f64) -> Skeleton {
        let mut posed = skeleton.clone();
        for (joint, offset, rotation) in self.chain(skeleton, time) {
            posed.write_local(joint, |joint| (joint.offset, joint.rotation) = (offset, rotation));
        }
        posed
    }

    /// Writes the pose of [`FollowPath::pose`] into an existing pose, reusing its memory.
    pub fn write_pose(&self, skeleton: &Skeleton, time: f64, pose: &mut SkeletonPose) {
        let mut chain = self.chain(skeleton, time).peekable();
        skeleton.write_pose_with(pose, |index, joint| {
            match chain.next_if(|(followed, ..)| *followed == JointId::new(index)) {
                Some((_, offset, rotation)) => {
                    Affine3A { matrix3: joint.rotation_by(rotation), translation: offset.into() }
                }
                None => joint.local(),
            }
        });
    }

    /// Index, offset and Euler angles (radians) of each joint of the chain, parents first.
    fn chain(&self, skeleton: &Skeleton, time: f64) -> impl Iterator<Item = (JointId, Vec3, Vec3)> {
        const STRIDES_PER_WAVE: f64 = 64.0;
        let joints = skeleton.joints();
        let lengths = chain(skeleton).map(|joint| joints[joint.index()].axis.length());
        let stride = 1.0 / (STRIDES_PER_WAVE * f64::from(self.waves.max(1)));
        let head = self.turns_at(time);
        let tips = follow::behind(|s| self.point(s), head, stride, lengths);

        let mut base = self.point(head);
        let mut above = Mat3A::IDENTITY;
        chain(skeleton).zip(tips).map(move |(index, tip)| {
            let joint = &joints[index.index()];
            let turn =
                rotation_between(joint.axis.into(), above.transpose() * Vec3A::from(tip - base));
            let mut rotation = joint.clamped(joint.angles_of(Mat3A::from_quat(turn)));
            let is_root = joint.parent.is_none();
            let mut offset = if is_root { base + Vec3::Y * joint.offset.y } else { joint.offset };
            // The squared length of a very long bone overflows; the joint is left unchanged.
            if !(rotation.is_finite() && offset.is_finite()) {
                (offset, rotation) = (joint.offset, joint.rotation);
            }
            above *= joint.rotation_by(rotation);
            // Where limits, or a bone longer than the path, leave the tip off the path.
            let end = base + Vec3::from(above * Vec3A::from(joint.axis));
            base = if end.is_finite() { end } else { tip };
            (index, offset, rotation)
        })
    }

    /// Ends of two perpendicular diameters of the circle that encloses the path, at height 0, in
    /// the world.
    pub fn corners(&self, skeleton: &Skeleton) -> [Vec3; 4] {
        let far = self.radius.abs() + self.amplitude.abs();
        [Vec3::X, Vec3::NEG_X, Vec3::Z, Vec3::NEG_Z]
            .map(|side| skeleton.transform().transform_point3(side * far))
    }

    /// Points of the path in the world, from `from` to `to` revolutions. `transform` maps skeleton
    /// space to the world; `height` is the path's height in skeleton space.
    pub fn trail(
        &self,
        transform: Affine3A,
        height: f32,
        from: f64,
        to: f64,
    ) -> impl Iterator<Item = Vec3> {
        const POINTS: usize = 256;
        let at = move |fraction: f64| from + (to - from) * fraction;
        (0..=POINTS)
            .map(move |index| self.point(at(index as f64 / POINTS as f64)) + Vec3::Y * height)
            .map(move |point| transform.transform_point3(point))
    }
}

/// The first root of a skeleton, that root's first child, and so on.
fn chain(skeleton: &Skeleton) -> impl Iterator<Item = JointId> {
    let root = skeleton.ids().find(|joint| skeleton[*joint].parent.is_none());
    std::iter::successors(root, |joint| skeleton.children(*joint).next())
}
