use std::collections::BTreeMap;

use glam::Vec3;

use crate::document::{Channel, Document};
use crate::kinematics::Shared;
use crate::kinematics::skeleton::Joint;
use crate::rig::SkinSource;

/// Unkeyed edits: values of keyed channels that differ from their keys, until the time changes.
pub(super) type Overrides = BTreeMap<Channel, Vec3>;

/// All that undo restores: a document and its unkeyed edits. A snapshot shares memory with those
/// before and after it.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Snapshot {
    document: Document,
    overrides: Overrides,
    /// The playhead, in seconds: the time at which the overrides were made.
    pub time: f64,
    /// Number of the document's state: equal numbers mean equal documents, except for their
    /// cameras.
    pub revision: u64,
    /// Number of the document's content: equal numbers mean documents that are equal except for
    /// their cameras, shown rig and overlays.
    pub content: u64,
}

impl Snapshot {
    pub fn new(
        document: &Document,
        overrides: &Overrides,
        time: f64,
        revision: u64,
        content: u64,
    ) -> Self {
        let (document, overrides) = (document.clone(), overrides.clone());
        Self { document, overrides, time, revision, content }
    }

    /// The snapshot's document, with the cameras of the `open` document.
    pub fn document(&self, open: &Document) -> Document {
        let mut document = Document {
            rig: open.rig,
            camera: open.camera,
            other_rig_camera: open.other_rig_camera,
            ..self.document.clone()
        };
        document.show(self.document.rig);
        document
    }

    /// Whether the snapshot's document differs from `document` in more than cameras.
    pub fn differs_from(&self, document: &Document) -> bool {
        self.document.rig != document.rig
            || self.document.display != document.display
            || self.differs_in_content_from(document)
    }

    /// Whether the snapshot's document differs from `other` in more than cameras, shown rig and
    /// overlays.
    pub fn differs_in_content_from(&self, other: &Document) -> bool {
        let Document { arm, skeleton_rig, keys, timeline, metres_per_unit, .. } = &self.document;
        *arm != other.arm
            || *skeleton_rig != other.skeleton_rig
            || *keys != other.keys
            || *timeline != other.timeline
            || *metres_per_unit != other.metres_per_unit
    }

    pub fn overrides(&self) -> &Overrides {
        &self.overrides
    }

    /// Whether restoring this state from `now` would change nothing.
    pub fn is_restored_in(&self, now: &Self) -> bool {
        let is_same_time = self.overrides.is_empty() || self.time == now.time;
        self.revision == now.revision && self.overrides == now.overrides && is_same_time
    }

    /// Approximate number of bytes that the snapshot does not share with `other`.
    pub fn unshared_bytes(&self, other: Option<&Self>) -> usize {
        let other = other.map(|other| &other.document);
        size_of::<Self>()
            + self.unshared_joint_bytes(other)
            + self.unshared_mesh_bytes(other)
            + size_of_val(&*self.document.skeleton_rig.targets)
            + self.overrides.len() * size_of::<(Channel, Vec3)>()
            + self.document.keys.unshared_bytes(other.map(|other| &other.keys))
    }

    /// Bytes of the mesh of a skin from a file. That of a skin from bones is made again when it is needed.
    fn unshared_mesh_bytes(&self, other: Option<&Document>) -> usize {
        let mesh = |document: &Document| match &document.skeleton_rig.skin.as_ref()?.source {
            SkinSource::Mesh(mesh) => mesh.mesh().ok().cloned(),
            SkinSource::Bones(_) => None,
        };
        let Some(own) = mesh(&self.document) else { return 0 };
        let is_shared = other.and_then(mesh).is_some_and(|theirs| own.is_same(&theirs));
        if is_shared { 0 } else { own.mesh.bytes() }
    }

    fn unshared_joint_bytes(&self, other: Option<&Document>) -> usize {
        let skeleton = &self.document.skeleton_rig.skeleton;
        let theirs = other.map(|other| &other.skeleton_rig.skeleton);
        if theirs.is_some_and(|theirs| skeleton.is_same(theirs)) {
            return 0;
        }
        let theirs = theirs.map_or(&[][..], |theirs| theirs.joints());
        let is_shared = |index: usize, joint: &Shared<Joint>| {
            theirs.get(index).is_some_and(|theirs| theirs.is_same(joint))
        };
        let joints = skeleton.joints();
        let own = joints.iter().enumerate().filter(|(index, joint)| !is_shared(*index, joint));
        let own = own.map(|(_, joint)| size_of::<Joint>() + joint.name.len());
        size_of_val(joints) + own.sum::<usize>()
    }
}
