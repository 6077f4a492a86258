use glam::Vec3;

use super::session::Session;
use super::wiggle::{Wiggle, WiggleTarget, WiggleView};
use crate::document::RigKind;
use crate::kinematics::skeleton::{JointId, RotationAxis, Skeleton};
use crate::kinematics::swing::Swing;

/// Angles that swing.
impl Session {
    /// The angle that swings; `None` if none does.
    pub fn wiggled(&self) -> Option<(JointId, RotationAxis)> {
        self.wiggle.map(|wiggle| (wiggle.joint, wiggle.axis))
    }

    /// The angle that swings, with the paths of the tip.
    pub fn wiggle_view(&self) -> Option<WiggleView> {
        /// Number of points of the path, and its length as a multiple of the swing.
        const POINTS: usize = 33;
        const LONGER: f32 = 4.0;
        let wiggle = self.wiggle.filter(|_| self.rig() == RigKind::Skeleton)?;
        let skeleton = &*self.evaluated_skeleton().solved;
        skeleton.joint(wiggle.joint)?;
        let (tip, target) = self.wiggled_tip(skeleton, wiggle.joint);
        let swing = Swing { joint: wiggle.joint, axis: wiggle.axis, tip };
        let by = wiggle.by();
        let most = LONGER * Wiggle::MOST;
        let angle = |nth: usize| most * (2.0 * nth as f32 / (POINTS - 1) as f32 - 1.0);
        let path = (0..POINTS).map(|nth| swing.tip_at(skeleton, angle(nth))).collect();
        let target = target.map(|position| WiggleTarget {
            position,
            before: skeleton.tip(tip).distance(position),
            now: swing.tip_at(skeleton, by).distance(position),
            predicted: swing.predicted_at(skeleton, by).distance(position),
        });
        Some(WiggleView {
            swing,
            pose: swing.posed(skeleton, by).pose(),
            path,
            predicted: [-most, most].map(|by| swing.predicted_at(skeleton, by)),
            by,
            target,
        })
    }

    /// The joint at or below `joint` whose tip is farthest from its target, with the target; without
    /// targets there, the joint whose tip is farthest away.
    fn wiggled_tip(&self, skeleton: &Skeleton, joint: JointId) -> (JointId, Option<Vec3>) {
        let rig = self.skeleton_rig();
        let targets = rig.targets.iter().zip(&self.evaluated_skeleton().targets);
        let below = targets.filter(|(it, _)| it.enabled && skeleton.is_in_subtree(it.joint, joint));
        let farthest = below.max_by(|(_, one), (_, other)| one.error.total_cmp(&other.error));
        if let Some((target, report)) = farthest {
            return (target.joint, Some(report.position));
        }
        let base = skeleton.base(joint);
        let below = skeleton.ids().filter(|it| skeleton.is_in_subtree(*it, joint));
        let distance = |it: &JointId| skeleton.tip(*it).distance(base);
        let farthest = below.max_by(|one, other| distance(one).total_cmp(&distance(other)));
        (farthest.unwrap_or(joint), None)
    }

    /// Lets an angle swing, or stops the one that does.
    pub(super) fn set_wiggle(&mut self, wiggled: Option<(JointId, RotationAxis)>) {
        if self.wiggled() != wiggled {
            self.wiggle = wiggled.map(|(joint, axis)| Wiggle::new(joint, axis));
        }
    }
}
