use glam::{Affine3A, Vec3};

use super::{Joint, JointField, JointId, JointRemap, Skeleton, SkeletonError, SkeletonPose};

/// Editing. An edit that fails leaves the skeleton unchanged.
impl Skeleton {
    /// Adds a joint after all others and returns its index.
    ///
    /// # Errors
    ///
    /// See [`SkeletonError`].
    pub fn add(&mut self, mut joint: Joint) -> Result<JointId, SkeletonError> {
        let added = JointId::new(self.joints.len());
        if added.index() >= Self::MOST_JOINTS {
            return Err(SkeletonError::TooMany);
        }
        joint.check(added)?;
        self.check_name(&joint.name, added)?;
        joint.clamp();
        let parent = joint.parent;
        self.joints.push(joint.into());
        self.fit_cone(added);
        parent.into_iter().for_each(|parent| self.fit_cone(parent));
        Ok(added)
    }

    /// Default bone vector for a new child of `parent`: that of the nearest joint with a bone, from
    /// `parent` towards the root. Without such a joint it is upwards (+y), as long as the longest
    /// bone of the skeleton, or of length 1 if the skeleton has no bones.
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

    /// An unused joint name: `stem` if that is free, otherwise `stem` with another number at its
    /// end.
    pub fn free_name(&self, stem: &str) -> String {
        let taken = |name: &str| self.find(name).is_some();
        if !stem.is_empty() && !taken(stem) {
            return stem.to_owned();
        }
        let stem = stem.trim_end_matches(|c: char| c.is_ascii_digit() || c == '_');
        let mut numbered = (1..).map(|number| format!("{stem}_{number}"));
        numbered.find(|name| !taken(name)).unwrap_or_default()
    }

    /// Removes joints with all their descendants.
    ///
    /// # Errors
    ///
    /// [`SkeletonError::NoJoint`] for an index without a joint.
    pub fn remove(&mut self, joints: &[JointId]) -> Result<JointRemap, SkeletonError> {
        for joint in joints {
            self.known(*joint)?;
        }
        let mut remap: Vec<Option<JointId>> = Vec::with_capacity(self.joints.len());
        let mut kept = Vec::with_capacity(self.joints.len());
        for (index, mut joint) in std::mem::take(&mut self.joints).into_iter().enumerate() {
            let parent = joint.parent.map(|parent| remap[parent.index()]);
            if joints.contains(&index.into()) || parent == Some(None) {
                remap.push(None);
                continue;
            }
            if joint.parent != parent.flatten() {
                joint.make_mut().parent = parent.flatten();
            }
            remap.push(Some(kept.len().into()));
            kept.push(joint);
        }
        self.joints = kept;
        self.ids().for_each(|joint| self.fit_cone(joint));
        Ok(JointRemap(remap))
    }

    /// Removes joints and attaches their children to the next ancestor that stays, or makes the
    /// children roots. No child moves: if a child's limits exclude its new angles, they are
    /// widened.
    ///
    /// # Errors
    ///
    /// [`SkeletonError::NoJoint`] for an index without a joint; [`SkeletonError::NotFinite`] if the
    /// new offset or rotation of a child overflows.
    pub fn dissolve(&mut self, joints: &[JointId]) -> Result<JointRemap, SkeletonError> {
        for joint in joints {
            self.known(*joint)?;
        }
        let before = self.clone();
        let pose = before.pose_in_skeleton();
        for child in self.ids() {
            let above = self[child].parent;
            if !above.is_some_and(|parent| joints.contains(&parent)) || joints.contains(&child) {
                continue;
            }
            let parent = before.ancestors(child).skip(1).find(|above| !joints.contains(above));
            let near = before[child].rotation;
            let (offset, rotation) = before.placed_under_in(&pose, child, parent, near);
            if let Err(error) = check_finite(child, offset, rotation) {
                *self = before;
                return Err(error);
            }
            let joint = self.joints[child.index()].make_mut();
            (joint.parent, joint.offset, joint.rotation) = (parent, offset, rotation);
            joint.connected = false;
            joint.limits.widen(rotation);
        }
        self.remove(joints)
    }

    /// Offset and Euler angles with which a joint would keep its transform as a child of `parent`
    /// (`None`: as a root). Of all equivalent angles, these are the ones nearest to `near`.
    ///
    /// # Panics
    ///
    /// If there is no such joint or parent.
    pub fn placed_under(
        &self,
        joint: JointId,
        parent: Option<JointId>,
        near: Vec3,
    ) -> (Vec3, Vec3) {
        self.placed_under_in(&self.pose_in_skeleton(), joint, parent, near)
    }

    /// Like [`Skeleton::placed_under`], but with a given pose in skeleton space instead of the
    /// skeleton's own.
    pub fn placed_under_in(
        &self,
        pose: &SkeletonPose,
        joint: JointId,
        parent: Option<JointId>,
        near: Vec3,
    ) -> (Vec3, Vec3) {
        let above = parent.map_or(Affine3A::IDENTITY, |parent| pose.full(parent));
        let local = above.inverse() * pose.full(joint);
        let like = Joint { rotation: near, ..self[joint].clone() };
        (local.translation.into(), like.angles_of(local.matrix3))
    }

    /// Moves a joint with its descendants to another parent; `None` makes the joint a root. The
    /// joint keeps its transform in the world as far as its limits allow.
    ///
    /// # Errors
    ///
    /// [`SkeletonError::NoJoint`]; [`SkeletonError::Cycle`] if the parent is a descendant of the
    /// joint; [`SkeletonError::NotFinite`] if the new offset or rotation overflows.
    pub fn reparent(
        &mut self,
        joint: JointId,
        parent: Option<JointId>,
    ) -> Result<JointRemap, SkeletonError> {
        for index in [Some(joint), parent].into_iter().flatten() {
            self.known(index)?;
        }
        if let Some(parent) = parent.filter(|parent| self.is_in_subtree(*parent, joint)) {
            return Err(SkeletonError::Cycle { joint, parent });
        }
        let near = self[joint].rotation;
        let (offset, rotation) = self.placed_under(joint, parent, near);
        check_finite(joint, offset, rotation)?;
        let moved = self.joints[joint.index()].make_mut();
        (moved.parent, moved.offset, moved.rotation) = (parent, offset, rotation);
        moved.connected = false;
        moved.clamp();
        let remap = self.sort();
        self.ids().for_each(|joint| self.fit_cone(joint));
        Ok(remap)
    }

    /// Renames a joint.
    ///
    /// # Errors
    ///
    /// [`SkeletonError::NoJoint`]; [`SkeletonError::NoName`] for an empty name;
    /// [`SkeletonError::Name`] for the name of another joint.
    pub fn rename(&mut self, joint: JointId, name: &str) -> Result<(), SkeletonError> {
        self.known(joint)?;
        self.check_name(name, joint)?;
        name.clone_into(&mut self.joints[joint.index()].make_mut().name);
        Ok(())
    }

    /// Sets a joint's Euler angles in radians, clamped to its limits.
    ///
    /// # Errors
    ///
    /// [`SkeletonError::NoJoint`]; [`SkeletonError::NotFinite`].
    pub fn set_rotation(&mut self, joint: JointId, rotation: Vec3) -> Result<(), SkeletonError> {
        self.change(joint, |joint| joint.rotation = rotation)
    }

    /// Sets a joint's bone vector; children at its tip move with the tip.
    ///
    /// # Errors
    ///
    /// [`SkeletonError::NoJoint`]; [`SkeletonError::NotFinite`].
    pub fn set_axis(&mut self, joint: JointId, axis: Vec3) -> Result<(), SkeletonError> {
        let before = self.known(joint)?.axis;
        self.change(joint, |joint| joint.axis = axis)?;
        let is_at_tip = |child: &Joint| child.parent == Some(joint) && child.offset == before;
        for child in self.joints.iter_mut().filter(|child| is_at_tip(child)) {
            child.make_mut().offset = axis;
        }
        Ok(())
    }

    /// Edits a joint. Changes of its name and parent are ignored; its rotation is clamped to its
    /// limits.
    ///
    /// # Errors
    ///
    /// See [`SkeletonError`].
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
        let parent = changed.parent;
        self.joints[joint.index()] = changed.into();
        self.fit_cone(joint);
        parent.into_iter().for_each(|parent| self.fit_cone(parent));
        Ok(())
    }

    /// Puts the cone of a joint around its bone, or around the offset of its first child if it has
    /// none, and clamps its rotation.
    pub(super) fn fit_cone(&mut self, joint: JointId) {
        let of = &self[joint];
        if of.limits.as_cone().is_none() {
            return;
        }
        let offsets = self.children(joint).map(|child| self[child].offset);
        let bone = [of.axis].into_iter().chain(offsets).find(|bone| *bone != Vec3::ZERO);
        let limits = bone.map_or(of.limits, |bone| of.limits.along(of.frame, bone));
        if limits != of.limits || !limits.contains(of.rotation) {
            let joint = self.joints[joint.index()].make_mut();
            joint.limits = limits;
            joint.rotation = limits.project(joint.rotation);
        }
    }

    /// Edits a joint without checks; ignored for an index without a joint. If rotation or offset
    /// are not finite afterwards, both keep their old values; that happens when the squares of bone
    /// lengths above about 1e19 overflow.
    pub fn write_local(&mut self, joint: JointId, change: impl FnOnce(&mut Joint)) {
        let Some(joint) = self.joints.get_mut(joint.index()) else { return };
        let joint = joint.make_mut();
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

    /// Sorts the joints so that parents precede their children, keeping the order otherwise.
    fn sort(&mut self) -> JointRemap {
        let mut order = Vec::with_capacity(self.joints.len());
        let mut remap: Vec<Option<JointId>> = vec![None; self.joints.len()];
        while order.len() < self.joints.len() {
            for (index, joint) in self.joints.iter().enumerate() {
                let is_next = joint.parent.is_none_or(|parent| remap[parent.index()].is_some());
                if remap[index].is_none() && is_next {
                    remap[index] = Some(order.len().into());
                    order.push(index);
                }
            }
        }
        let mut joints: Vec<_> =
            order.into_iter().map(|index| self.joints[index].clone()).collect();
        for joint in &mut joints {
            let parent = joint.parent.and_then(|parent| remap[parent.index()]);
            if joint.parent != parent {
                joint.make_mut().parent = parent;
            }
        }
        self.joints = joints;
        JointRemap(remap)
    }
}

fn check_finite(joint: JointId, offset: Vec3, rotation: Vec3) -> Result<(), SkeletonError> {
    for (field, value) in [(JointField::Offset, offset), (JointField::Rotation, rotation)] {
        if !value.is_finite() {
            return Err(SkeletonError::NotFinite { joint, field, value });
        }
    }
    Ok(())
}
