use glam::{Affine3A, Vec3};

use super::{Joint, JointId, Skeleton, SkeletonError};

/// Where the joints of a skeleton have gone: for each, its new place in the list, if it has one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct JointRemap(Vec<Option<JointId>>);

impl JointRemap {
    /// The new place of what was at `joint`.
    pub fn get(&self, joint: JointId) -> Option<JointId> {
        self.0.get(joint.index()).copied().flatten()
    }
}

/// Building. Each leaves a skeleton that is one, or as it was.
impl Skeleton {
    /// Adds a joint and returns its place. Places of other joints stay.
    ///
    /// # Errors
    ///
    /// Refuses what no skeleton can have.
    pub fn add(&mut self, mut joint: Joint) -> Result<JointId, SkeletonError> {
        let added = JointId::new(self.joints.len());
        if added.index() >= Self::MOST_JOINTS {
            return Err(SkeletonError::TooMany);
        }
        joint.check(added)?;
        self.check_name(&joint.name, added)?;
        joint.clamp();
        self.joints.push(joint);
        Ok(added)
    }

    /// A bone vector for a child of `parent`: like the parent's, or like a bone of length 1 up where
    /// the parent is a point.
    pub fn next_axis(&self, parent: JointId) -> Vec3 {
        let like = self.ancestors(parent).find_map(|joint| {
            let axis = self.joint(joint)?.axis;
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
    ///
    /// # Errors
    ///
    /// [`SkeletonError::NoJoint`], and the skeleton is unchanged.
    pub fn remove(&mut self, joints: &[JointId]) -> Result<JointRemap, SkeletonError> {
        for joint in joints {
            self.known(*joint)?;
        }
        let mut moved: Vec<Option<JointId>> = Vec::with_capacity(self.joints.len());
        let mut kept = Vec::with_capacity(self.joints.len());
        for (index, mut joint) in std::mem::take(&mut self.joints).into_iter().enumerate() {
            let parent = joint.parent.map(|parent| moved[parent.index()]);
            if joints.contains(&index.into()) || parent == Some(None) {
                moved.push(None);
                continue;
            }
            joint.parent = parent.flatten();
            moved.push(Some(kept.len().into()));
            kept.push(joint);
        }
        self.joints = kept;
        Ok(JointRemap(moved))
    }

    /// Removes joints and attaches their children to the next ancestor that stays, or makes them
    /// roots. No child moves: limits that would keep one from its new angles are widened.
    ///
    /// # Errors
    ///
    /// If a child's place below its new parent would not be finite; the skeleton is unchanged then.
    pub fn dissolve(&mut self, joints: &[JointId]) -> Result<JointRemap, SkeletonError> {
        let before = self.clone();
        for child in self.ids() {
            let above = self[child].parent;
            if !above.is_some_and(|parent| joints.contains(&parent)) || joints.contains(&child) {
                continue;
            }
            let parent = before.ancestors(child).skip(1).find(|above| !joints.contains(above));
            let near = before[child].rotation;
            let (offset, rotation) = before.placed_under(child, parent, near);
            if let Err(error) = check_place(child, offset, rotation) {
                *self = before;
                return Err(error);
            }
            let joint = &mut self.joints[child.index()];
            (joint.parent, joint.offset, joint.rotation) = (parent, offset, rotation);
            joint.widen_limits(rotation);
        }
        self.remove(joints)
    }

    /// The offset and the angles, nearest to `near`, with which a joint would stand where it does now
    /// as a child of `parent`.
    pub fn placed_under(
        &self,
        joint: JointId,
        parent: Option<JointId>,
        near: Vec3,
    ) -> (Vec3, Vec3) {
        let pose = self.pose_in_skeleton();
        let above = parent.map_or(Affine3A::IDENTITY, |parent| pose.full(parent));
        let local = above.inverse() * pose.full(joint);
        let like = Joint { rotation: near, ..self[joint].clone() };
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
        joint: JointId,
        parent: Option<JointId>,
    ) -> Result<JointRemap, SkeletonError> {
        for index in [Some(joint), parent].into_iter().flatten() {
            self.known(index)?;
        }
        if let Some(parent) = parent.filter(|parent| self.hangs_from(*parent, joint)) {
            return Err(SkeletonError::Cycle { joint, parent });
        }
        let near = self[joint].rotation;
        let (offset, rotation) = self.placed_under(joint, parent, near);
        check_place(joint, offset, rotation)?;
        let moved = &mut self.joints[joint.index()];
        (moved.parent, moved.offset, moved.rotation) = (parent, offset, rotation);
        moved.clamp();
        Ok(self.sort())
    }

    /// # Errors
    ///
    /// Refuses a name that is empty or another joint's.
    pub fn rename(&mut self, joint: JointId, name: &str) -> Result<(), SkeletonError> {
        self.known(joint)?;
        self.check_name(name, joint)?;
        name.clone_into(&mut self.joints[joint.index()].name);
        Ok(())
    }

    /// Turns a joint, as far as its limits let it.
    ///
    /// # Errors
    ///
    /// Refuses angles that are not finite.
    pub fn set_rotation(&mut self, joint: JointId, rotation: Vec3) -> Result<(), SkeletonError> {
        self.change(joint, |joint| joint.rotation = rotation)
    }

    /// Changes a bone; children that sit on its tip stay there.
    ///
    /// # Errors
    ///
    /// Refuses a vector that is not finite.
    pub fn set_axis(&mut self, joint: JointId, axis: Vec3) -> Result<(), SkeletonError> {
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
        joint: JointId,
        change: impl FnOnce(&mut Joint),
    ) -> Result<(), SkeletonError> {
        let before = self.known(joint)?;
        let mut changed = before.clone();
        change(&mut changed);
        changed.parent = before.parent;
        changed.name.clone_from(&before.name);
        changed.check(joint)?;
        changed.clamp();
        self.joints[joint.index()] = changed;
        Ok(())
    }

    /// What solvers write: angles within limits, and offsets. Where bones are so long that squares of
    /// them are no numbers (from about 1e19), what is found is none either, and changes nothing.
    pub(crate) fn turn(&mut self, joint: JointId, change: impl FnOnce(&mut Joint)) {
        let Some(joint) = self.joints.get_mut(joint.index()) else { return };
        let (rotation, offset) = (joint.rotation, joint.offset);
        change(joint);
        if !(joint.rotation.is_finite() && joint.offset.is_finite()) {
            (joint.rotation, joint.offset) = (rotation, offset);
        }
    }

    fn known(&self, joint: JointId) -> Result<&Joint, SkeletonError> {
        self.joint(joint).ok_or(SkeletonError::NoJoint(joint))
    }

    fn check_name(&self, name: &str, joint: JointId) -> Result<(), SkeletonError> {
        match self.find(name) {
            _ if name.trim().is_empty() => Err(SkeletonError::NoName),
            Some(other) if other != joint => Err(SkeletonError::Name(name.to_owned())),
            _ => Ok(()),
        }
    }

    /// Brings parents before their children again, otherwise in the order that there is.
    fn sort(&mut self) -> JointRemap {
        let mut order = Vec::with_capacity(self.joints.len());
        let mut moved: Vec<Option<JointId>> = vec![None; self.joints.len()];
        while order.len() < self.joints.len() {
            for (index, joint) in self.joints.iter().enumerate() {
                let is_next = joint.parent.is_none_or(|parent| moved[parent.index()].is_some());
                if moved[index].is_none() && is_next {
                    moved[index] = Some(order.len().into());
                    order.push(index);
                }
            }
        }
        let mut joints: Vec<_> =
            order.into_iter().map(|index| self.joints[index].clone()).collect();
        for joint in &mut joints {
            joint.parent = joint.parent.and_then(|parent| moved[parent.index()]);
        }
        self.joints = joints;
        JointRemap(moved)
    }
}

fn check_place(joint: JointId, offset: Vec3, rotation: Vec3) -> Result<(), SkeletonError> {
    for (field, value) in [("offset", offset), ("rotation", rotation)] {
        if !value.is_finite() {
            return Err(SkeletonError::NotFinite { joint, field, value });
        }
    }
    Ok(())
}
