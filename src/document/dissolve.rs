use super::{Channel, Document};
use crate::kinematics::skeleton::{JointId, JointRemap, Skeleton, SkeletonError};

/// A child that loses its parent and is attached to the next ancestor that stays.
struct Orphan {
    child: JointId,
    /// `None` makes it a root.
    parent: Option<JointId>,
    /// The deleted joints between both.
    between: Vec<JointId>,
}

impl Document {
    /// Deletes joints and attaches their children to the next ancestor that stays. No child moves: at
    /// this time, nor at a key of its own or of a joint that is deleted above it. Limits that would
    /// keep a child from its new angles are widened.
    ///
    /// # Errors
    ///
    /// If a child's place below its new parent would not be finite.
    pub fn dissolve(&mut self, joints: &[JointId]) -> Result<JointRemap, SkeletonError> {
        let before = self.clone();
        let moved = self.skeleton_mut().dissolve(joints)?;
        self.follow(&moved);
        for orphan in orphans(before.skeleton(), joints) {
            self.key_orphan(&before, &orphan, &moved)?;
        }
        Ok(moved)
    }

    /// Keys an orphan anew at every key that moved it against its new parent.
    fn key_orphan(
        &mut self,
        before: &Self,
        orphan: &Orphan,
        moved: &JointRemap,
    ) -> Result<(), SkeletonError> {
        let Some(child) = moved.get(orphan.child) else { return Ok(()) };
        let keys = &before.keys;
        let above = orphan.between.iter().copied();
        let of_above = above.flat_map(|joint| [Channel::Rotation(joint), Channel::Offset(joint)]);
        let is_swung = of_above.clone().any(|channel| keys.has(channel));
        let own = [Channel::Rotation(orphan.child), Channel::Offset(orphan.child)];
        let mut times: Vec<f64> = of_above
            .chain(own)
            .filter_map(|channel| keys.track(channel))
            .flat_map(|track| track.knots().iter().map(|knot| knot.time))
            .collect();
        times.sort_by(f64::total_cmp);
        times.dedup();

        let mut angles = before.skeleton()[orphan.child].rotation;
        for time in times {
            let posed = before.at(time);
            let skeleton = posed.skeleton();
            let offset;
            (offset, angles) = skeleton.placed_under(orphan.child, orphan.parent, angles);
            self.keys.insert(Channel::Rotation(child), time, angles);
            if is_swung || keys.has(Channel::Offset(orphan.child)) {
                self.keys.insert(Channel::Offset(child), time, offset);
            }
            self.skeleton_mut().change(child, |joint| joint.widen_limits(angles))?;
        }
        Ok(())
    }
}

fn orphans(skeleton: &Skeleton, deleted: &[JointId]) -> Vec<Orphan> {
    let orphan = |child: JointId| {
        let mut above = skeleton.ancestors(child).skip(1).peekable();
        let mut between = Vec::new();
        while let Some(joint) = above.next_if(|joint| deleted.contains(joint)) {
            between.push(joint);
        }
        let is_orphan = !between.is_empty() && !deleted.contains(&child);
        is_orphan.then(|| Orphan { child, parent: above.next(), between })
    };
    skeleton.ids().filter_map(orphan).collect()
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;
    use crate::io::Example;

    /// Where bases and tips are in the world, by joint name.
    fn places(document: &Document, time: f64) -> Vec<(String, Vec3, Vec3)> {
        let posed = document.at(time);
        let pose = posed.skeleton_rig.at(time).pose();
        let joints = posed.skeleton().joints().iter().enumerate();
        joints
            .map(|(at, joint)| {
                (joint.name.clone(), pose.base(JointId::new(at)), pose.tip(JointId::new(at)))
            })
            .collect()
    }

    fn assert_children_stay(document: &Document, deleted: &[JointId], times: &[f64]) {
        let mut after = document.clone();
        after.dissolve(deleted).expect("dissolved");
        let names: Vec<_> =
            deleted.iter().map(|at| &document.skeleton().joints()[at.index()].name).collect();
        for time in times {
            let mut before = places(document, *time);
            before.retain(|(name, ..)| !names.contains(&name));
            let now = places(&after, *time);
            assert_eq!(now.len(), before.len());
            for ((name, base, tip), (other, now_base, now_tip)) in before.into_iter().zip(now) {
                assert_eq!(name, other);
                let moved = base.distance(now_base).max(tip.distance(now_tip));
                assert!(moved < 1e-4, "{name} moves by {moved} at {time} s");
            }
        }
    }

    fn human() -> Document {
        let mut document = Example::find("human").expect("there").open().expect("opens").document;
        let count = document.skeleton().joints().len();
        for joint in 0..count {
            let turn = |axis: f32| (joint as f32 * 1.7 + axis).sin() * 0.8;
            let rotation = Vec3::new(turn(0.0), turn(1.0), turn(2.0));
            document.skeleton_mut().set_rotation(JointId::new(joint), rotation).expect("turned");
        }
        document
    }

    #[test]
    fn children_of_a_deleted_joint_stay_where_they_are() {
        let document = human();
        let count = document.skeleton().joints().len();
        for joint in 0..count {
            assert_children_stay(&document, &[JointId::new(joint)], &[0.0]);
        }
        assert_children_stay(
            &document,
            &[JointId::new(0), JointId::new(1), JointId::new(2), JointId::new(5)],
            &[0.0],
        );
    }

    #[test]
    fn at_every_key_children_stay_too() {
        let mut document = human();
        let shoulder = 1;
        for (time, angle) in [(0.0, 0.2), (1.0, -0.7), (2.5, 1.1)] {
            let rotation = Vec3::new(angle, -angle, 0.5 * angle);
            document.keys.insert(Channel::Rotation(JointId::new(shoulder)), time, rotation);
        }
        document.keys.insert(Channel::Rotation(JointId::new(shoulder + 1)), 0.5, Vec3::splat(0.3));
        document.keys.insert(Channel::Rotation(JointId::new(shoulder + 1)), 2.0, Vec3::splat(-0.2));
        assert_children_stay(&document, &[JointId::new(shoulder)], &[0.0, 0.5, 1.0, 2.0, 2.5]);
    }
}
