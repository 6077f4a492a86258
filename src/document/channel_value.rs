use glam::Vec3;

use super::channel::Channel;
use super::document::Document;
use super::rig_kind::RigKind;
use crate::kinematics::limb_ik::ElbowReference;
use crate::kinematics::skeleton::JointId;
use crate::rig::{LimbSettings, SkeletonRig, Target};

/// Access to the values of channels in a document.
impl Channel {
    /// Channels that affect the pose of the shown rig. For a skeleton: its translation, the offsets
    /// of its roots, the rotations of its joints and its targets; a target's influence only below 1, and
    /// a twist of 0 not at all.
    pub fn of_rig(document: &Document) -> Vec<Self> {
        if document.rig == RigKind::Arm {
            let shapes = |channel: &Self| channel.shapes(&document.arm);
            return Self::ARM.into_iter().filter(shapes).collect();
        }
        let SkeletonRig { skeleton, targets, .. } = &document.skeleton_rig;
        let joints = skeleton.iter();
        let roots = joints.clone().filter(|(_, joint)| joint.parent.is_none());
        let mut channels = vec![Self::Translation];
        channels.extend(roots.map(|(joint, _)| Self::Offset(joint)));
        channels.extend(joints.map(|(joint, _)| Self::Rotation(joint)));
        let of_targets = targets.iter().flat_map(|target| Self::of_target(target.joint));
        let poses = |channel: &Self| match (channel, channel.value(document)) {
            (_, None) | (Self::Enabled(_), _) => false,
            (Self::TargetInfluence(_), Some(influence)) => influence.x < 1.0,
            (Self::TargetTwist(_), Some(twist)) => twist.x != 0.0,
            (_, Some(_)) => true,
        };
        channels.extend(of_targets.filter(poses));
        channels
    }

    /// The channel's value in a document; `None` for a joint or target that the document does not
    /// have.
    pub fn value(self, document: &Document) -> Option<Vec3> {
        let Document { arm, skeleton_rig: rig, display, .. } = document;
        let number = |value| Vec3::new(value, 0.0, 0.0);
        let switch = |on: bool| number(f32::from(u8::from(on)));
        let target = |joint| Some(rig.targets[rig.target(joint)?]);
        Some(match self {
            Self::Hand => arm.cursor.in_root,
            Self::Pin => arm.cursor.in_world,
            Self::Pinned => switch(arm.cursor.is_pinned),
            Self::Twist => number(arm.keyed_twist()),
            Self::Pole => arm.pole,
            Self::Influence => number(arm.influence),
            Self::Shoulder => arm.fk.shoulder,
            Self::Bend => number(arm.fk.bend),
            Self::Stretch => number(arm.fk.stretch),
            Self::HandOrientation => arm.hand_orientation.angles,
            Self::Root => arm.root,
            Self::Upper => number(arm.bones.upper()),
            Self::Lower => number(arm.bones.lower()),
            Self::Translation => rig.skeleton.transform().translation.into(),
            Self::Rotation(joint) => rig.skeleton.joint(joint)?.rotation,
            Self::Offset(joint) => rig.skeleton.joint(joint)?.offset,
            Self::Target(joint) => target(joint)?.home,
            Self::TargetInfluence(joint) => number(target(joint)?.influence),
            Self::TargetOrientation(joint) => target(joint)?.limb()?.orientation?,
            Self::TargetTwist(joint) => number(target(joint)?.limb()?.twist),
            Self::TargetPole(joint) => target(joint)?.limb()?.pole()?.1,
            Self::Enabled(joint) => switch(target(joint)?.enabled),
            Self::Overlay(overlay) => switch(display.shows(overlay)),
        })
    }

    /// Sets the channel's value in a document, clamped to the channel's range. Changes nothing if
    /// `value` contains NaN or is an invalid length of a limb, or if [`Self::value`] is `None`.
    pub fn set(self, document: &mut Document, value: Vec3) {
        let Document { arm, skeleton_rig: rig, display, .. } = document;
        let value = value.clamp(Vec3::MIN, Vec3::MAX);
        if value.is_nan() {
            return;
        }
        match self {
            Self::Hand => arm.cursor.in_root = value,
            Self::Pin => arm.cursor.in_world = value,
            Self::Pinned => arm.cursor.is_pinned = value.x >= 0.5,
            Self::Twist => arm.set_keyed_twist(value.x),
            Self::Pole => arm.pole = value,
            Self::Influence => arm.influence = value.x.clamp(0.0, 1.0),
            Self::Shoulder => arm.fk.shoulder = value,
            Self::Bend => arm.fk.bend = value.x,
            Self::Stretch => arm.fk.stretch = value.x.max(f32::MIN_POSITIVE),
            Self::HandOrientation => arm.hand_orientation.angles = value,
            Self::Root => arm.root = value,
            Self::Upper => arm.set_lengths(value.x, arm.bones.lower()),
            Self::Lower => arm.set_lengths(arm.bones.upper(), value.x),
            Self::Translation => translate(rig, value),
            Self::Rotation(joint) => rotate(rig, joint, value),
            Self::Offset(joint) => offset(rig, joint, value),
            Self::Target(joint)
            | Self::TargetInfluence(joint)
            | Self::TargetOrientation(joint)
            | Self::TargetTwist(joint)
            | Self::TargetPole(joint)
            | Self::Enabled(joint) => {
                if let Some(index) = rig.target(joint) {
                    self.set_of_target(&mut rig.targets[index], value);
                }
            }
            Self::Overlay(overlay) => *display = display.with(overlay, value.x >= 0.5),
        }
    }
}

/// Access to the values of a target's channels.
impl Channel {
    fn set_of_target(self, target: &mut Target, value: Vec3) {
        match (self, target.limb_mut()) {
            (Self::Target(_), _) => target.home = value,
            (Self::TargetInfluence(_), _) => target.influence = value.x.clamp(0.0, 1.0),
            (Self::Enabled(_), _) => target.enabled = value.x >= 0.5,
            (Self::TargetTwist(_), Some(limb)) => limb.twist = value.x,
            (Self::TargetOrientation(_), Some(LimbSettings { orientation: Some(to), .. })) => {
                *to = value;
            }
            (Self::TargetPole(_), Some(limb)) if limb.pole().is_some() => {
                limb.reference = ElbowReference::Pole(value);
            }
            _ => {}
        }
    }
}

// Documents share the skeleton. Setting an identical value must not copy it.

fn translate(rig: &mut SkeletonRig, translation: Vec3) {
    let mut transform = rig.skeleton.transform();
    if !is_identical(transform.translation.into(), translation) {
        transform.translation = translation.into();
        // Only a transform that is not finite is refused; this one is finite.
        let _ = rig.skeleton_mut().set_transform(transform);
    }
}

fn rotate(rig: &mut SkeletonRig, joint: JointId, rotation: Vec3) {
    let Some(before) = rig.skeleton.joint(joint) else { return };
    let rotation = before.clamped(rotation);
    if !is_identical(before.rotation, rotation) {
        rig.skeleton_mut().write_local(joint, |joint| joint.rotation = rotation);
    }
}

/// Sets the offset of a joint, and for a connected one its parent's bone.
fn offset(rig: &mut SkeletonRig, joint: JointId, offset: Vec3) {
    let Some(before) = rig.skeleton.joint(joint) else { return };
    let above = before.parent.filter(|_| before.connected);
    if !is_identical(before.offset, offset) {
        rig.skeleton_mut().write_local(joint, |joint| joint.offset = offset);
    }
    if let Some(above) = above.filter(|it| !is_identical(rig.skeleton[*it].axis, offset)) {
        rig.skeleton_mut().write_local(above, |above| above.axis = offset);
    }
}

/// Whether two vectors are bit-identical.
fn is_identical(a: Vec3, b: Vec3) -> bool {
    a.to_array().map(f32::to_bits) == b.to_array().map(f32::to_bits)
}
