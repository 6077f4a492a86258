use glam::{Affine3A, Vec3};

use super::{Joint, Skeleton, SkeletonError};

/// Where the joints of a skeleton have gone: for each, its new place in the list, if it has one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct JointRemap(Vec<Option<usize>>);

impl JointRemap {
    /// The new place of what was at `joint`.
    pub fn get(&self, joint: usize) -> Option<usize> {
        self.0.get(joint).copied().flatten()
    }
}

/// Building. Each leaves a skeleton that is one, or as it was.
impl Skeleton {
    /// Adds a joint and returns its place. Places of other joints stay.
    ///
    /// # Errors
    ///
    /// Refuses what no skeleton can have.
    pub fn add(&mut self, joint: Joint) -> Result<usize, SkeletonError> {
        let index = self.joints.len();
        if index >= Self::MOST_JOINTS {
            return Err(SkeletonError::TooMany);
        }
        joint.check(index)?;
        self.check_name(&joint.name, index)?;
        self.joints.push(joint);
        self.joints[index].clamp();
        Ok(index)
    }

    /// A bone vector for a child of `parent`: like the parent's, or like a bone of length 1 up where
    /// the parent is a point.
    pub fn next_axis(&self, parent: usize) -> Vec3 {
        let like = self.ancestors(parent).find_map(|joint| {
            let axis = self.joints.get(joint)?.axis;
            (axis != Vec3::ZERO).then_some(axis)
        });
        like.unwrap_or_else(|| {
            let any = self.joints.iter().map(|joint| joint.axis.length()).fold(0.0, f32::max);
            Vec3::Y * if any > 0.0 { any } else { 1.0 }
        })
    }

    /// A name that no joint has, made from `stem`.
    pub fn free_name(&self, stem: &str) -> String {
        let taken = |name: &str| self.find(name).is_some();
        if !stem.is_empty() && !taken(stem) {
            return stem.to_owned();
        }
        let stem = stem.trim_end_matches(|c: char| c.is_ascii_digit() || c == '_');
        let mut numbered = (1..).map(|number| format!("{stem}_{number}"));
        numbered.find(|name| !taken(name)).unwrap_or_default()
    }

    /// Removes joints with all that hangs from them.
    pub fn remove(&mut self, joints: &[usize]) -> JointRemap {
        let mut moved = Vec::with_capacity(self.joints.len());
        let mut kept = Vec::with_capacity(self.joints.len());
        for (index, mut joint) in std::mem::take(&mut self.joints).into_iter().enumerate() {
            let parent = joint.parent.map(|parent| moved[parent]);
            if joints.contains(&index) || parent == Some(None) {
                moved.push(None);
                continue;
            }
            joint.parent = parent.flatten();
            moved.push(Some(kept.len()));
            kept.push(joint);
        }
        self.joints = kept;
        JointRemap(moved)
    }

    /// Removes joints and attaches their children to the next ancestor that stays, or makes them
    /// roots. No child moves: limits that would keep one from its new angles are widened.
    ///
    /// # Errors
    ///
    /// If a child's place below its new parent would not be finite; the skeleton is unchanged then.
    pub fn dissolve(&mut self, joints: &[usize]) -> Result<JointRemap, SkeletonError> {
        let before = self.clone();
        for child in 0..self.joints.len() {
            let above = self.joints[child].parent;
            if !above.is_some_and(|parent| joints.contains(&parent)) || joints.contains(&child) {
                continue;
            }
            let parent = before.ancestors(child).skip(1).find(|above| !joints.contains(above));
            let near = before.joints[child].rotation;
            let (offset, rotation) = before.placed_under(child, parent, near);
            if let Err(error) = check_place(child, offset, rotation) {
                *self = before;
                return Err(error);
            }
            let joint = &mut self.joints[child];
            (joint.parent, joint.offset, joint.rotation) = (parent, offset, rotation);
            joint.widen_limits(rotation);
        }
        Ok(self.remove(joints))
    }

    /// The offset and the angles, nearest to `near`, with which a joint would stand where it does now
    /// as a child of `parent`.
    pub fn placed_under(&self, joint: usize, parent: Option<usize>, near: Vec3) -> (Vec3, Vec3) {
        let pose = self.pose_in_skeleton();
        let above = parent.map_or(Affine3A::IDENTITY, |parent| pose.full(parent));
        let local = above.inverse() * pose.full(joint);
        let like = Joint { rotation: near, ..self.joints[joint].clone() };
        (local.translation.into(), like.angles_of(local.matrix3))
    }

    /// Hangs a joint, with all that hangs from it, from another parent, or from none. It stays where
    /// it is in the world, as far as its limits let it.
    ///
    /// # Errors
    ///
    /// Refuses a parent that hangs from the joint, and one from which it would be beyond numbers.
    pub fn reparent(
        &mut self,
        joint: usize,
        parent: Option<usize>,
    ) -> Result<JointRemap, SkeletonError> {
        for index in [Some(joint), parent].into_iter().flatten() {
            self.known(index)?;
        }
        if let Some(parent) = parent.filter(|parent| self.hangs_from(*parent, joint)) {
            return Err(SkeletonError::Cycle { joint, parent });
        }
        let near = self.joints[joint].rotation;
        let (offset, rotation) = self.placed_under(joint, parent, near);
        check_place(joint, offset, rotation)?;
        let moved = &mut self.joints[joint];
        (moved.parent, moved.offset, moved.rotation) = (parent, offset, rotation);
        moved.clamp();
        Ok(self.sort())
    }

    /// # Errors
    ///
    /// Refuses a name that is empty or another joint's.
    pub fn rename(&mut self, joint: usize, name: &str) -> Result<(), SkeletonError> {
        self.known(joint)?;
        self.check_name(name, joint)?;
        name.clone_into(&mut self.joints[joint].name);
        Ok(())
    }

    /// Turns a joint, as far as its limits let it.
    ///
    /// # Errors
    ///
    /// Refuses angles that are not finite.
    pub fn set_rotation(&mut self, joint: usize, rotation: Vec3) -> Result<(), SkeletonError> {
        self.change(joint, |joint| joint.rotation = rotation)
    }

    /// Changes a bone; children that sit on its tip stay there.
    ///
    /// # Errors
    ///
    /// Refuses a vector that is not finite.
    pub fn set_axis(&mut self, joint: usize, axis: Vec3) -> Result<(), SkeletonError> {
        let before = self.known(joint)?.axis;
        self.change(joint, |joint| joint.axis = axis)?;
        for child in self.joints.iter_mut().filter(|child| child.parent == Some(joint)) {
            if child.offset == before {
                child.offset = axis;
            }
        }
        Ok(())
    }

    /// Changes a joint in place: all but its name and parent.
    ///
    /// # Errors
    ///
    /// Refuses what no joint can have, and leaves the joint as it was.
    pub fn change(
        &mut self,
        joint: usize,
        change: impl FnOnce(&mut Joint),
    ) -> Result<(), SkeletonError> {
        let before = self.known(joint)?;
        let mut changed = before.clone();
        change(&mut changed);
        changed.parent = before.parent;
        changed.name.clone_from(&before.name);
        changed.check(joint)?;
        changed.clamp();
        self.joints[joint] = changed;
        Ok(())
    }

    /// What solvers write: angles within limits, and offsets. Where bones are so long that squares of
    /// them are no numbers (from about 1e19), what is found is none either, and changes nothing.
    pub(crate) fn turn(&mut self, joint: usize, change: impl FnOnce(&mut Joint)) {
        let Some(joint) = self.joints.get_mut(joint) else { return };
        let (rotation, offset) = (joint.rotation, joint.offset);
        change(joint);
        if !(joint.rotation.is_finite() && joint.offset.is_finite()) {
            (joint.rotation, joint.offset) = (rotation, offset);
        }
    }

    fn known(&self, joint: usize) -> Result<&Joint, SkeletonError> {
        self.joints.get(joint).ok_or(SkeletonError::NoJoint(joint))
    }

    fn check_name(&self, name: &str, joint: usize) -> Result<(), SkeletonError> {
        match self.find(name) {
            _ if name.trim().is_empty() => Err(SkeletonError::NoName),
            Some(other) if other != joint => Err(SkeletonError::Name(name.to_owned())),
            _ => Ok(()),
        }
    }

    /// Brings parents before their children again, otherwise in the order that there is.
    fn sort(&mut self) -> JointRemap {
        let mut order = Vec::with_capacity(self.joints.len());
        let mut moved = vec![None; self.joints.len()];
        while order.len() < self.joints.len() {
            for (index, joint) in self.joints.iter().enumerate() {
                let is_next = joint.parent.is_none_or(|parent| moved[parent].is_some());
                if moved[index].is_none() && is_next {
                    moved[index] = Some(order.len());
                    order.push(index);
                }
            }
        }
        let mut joints: Vec<_> =
            order.into_iter().map(|index| self.joints[index].clone()).collect();
        for joint in &mut joints {
            joint.parent = joint.parent.and_then(|parent| moved[parent]);
        }
        self.joints = joints;
        JointRemap(moved)
    }
}

fn check_place(joint: usize, offset: Vec3, rotation: Vec3) -> Result<(), SkeletonError> {
    for (field, value) in [("offset", offset), ("rotation", rotation)] {
        if !value.is_finite() {
            return Err(SkeletonError::NotFinite { joint, field, value });
        }
    }
    Ok(())
}
