//! The table of channels: the names of each, and where a document holds its value.

use glam::Vec3;

use super::Document;
use super::arm::{Arm, HandOrientation};
use super::channel::{Channel, Quantity, is_on};
use super::display::{Overlay, RigKind};
use crate::kinematics::skeleton::{Joint, JointId, Skeleton};
use crate::kinematics::twist::TwistReferenceKind;
use crate::rig::{LimbSettings, SkeletonRig, Target};

/// A row of the table of channels: all that is particular to one channel.
struct ChannelRow {
    heading: Heading,
    access: Access,
}

/// The names of a channel and the kind of its values.
struct Heading {
    /// Name in files and on the command line, without the joint or overlay.
    name: &'static str,
    /// Name on screen, beside that of the joint or overlay.
    label: &'static str,
    quantity: Quantity,
}

/// The part of a document that holds a channel's value, and the functions that read and write it.
enum Access {
    Arm {
        get: fn(&Arm) -> Vec3,
        set: fn(&mut Arm, Vec3),
        /// True if the channel affects the pose with the arm's present settings.
        shapes: fn(&Arm) -> bool,
    },
    Skeleton {
        get: fn(&Skeleton) -> Vec3,
        set: fn(&mut SkeletonRig, Vec3),
    },
    Joint {
        joint: JointId,
        get: fn(&Joint) -> Vec3,
        set: fn(&mut SkeletonRig, JointId, Vec3),
    },
    Target {
        joint: JointId,
        /// `None` if the target has no such setting.
        get: fn(&Target) -> Option<Vec3>,
        set: fn(&mut Target, Vec3),
        /// True if the channel affects the pose with this value.
        shapes: fn(Vec3) -> bool,
    },
    Overlay(Overlay),
}

fn named(name: &'static str, label: &'static str, quantity: Quantity) -> Heading {
    Heading { name, label, quantity }
}

impl Heading {
    fn of_arm(
        self,
        get: fn(&Arm) -> Vec3,
        set: fn(&mut Arm, Vec3),
        shapes: fn(&Arm) -> bool,
    ) -> ChannelRow {
        ChannelRow { heading: self, access: Access::Arm { get, set, shapes } }
    }

    fn of_skeleton(
        self,
        get: fn(&Skeleton) -> Vec3,
        set: fn(&mut SkeletonRig, Vec3),
    ) -> ChannelRow {
        ChannelRow { heading: self, access: Access::Skeleton { get, set } }
    }

    fn of_joint(
        self,
        joint: JointId,
        get: fn(&Joint) -> Vec3,
        set: fn(&mut SkeletonRig, JointId, Vec3),
    ) -> ChannelRow {
        ChannelRow { heading: self, access: Access::Joint { joint, get, set } }
    }

    fn of_target(
        self,
        joint: JointId,
        get: fn(&Target) -> Option<Vec3>,
        set: fn(&mut Target, Vec3),
        shapes: fn(Vec3) -> bool,
    ) -> ChannelRow {
        ChannelRow { heading: self, access: Access::Target { joint, get, set, shapes } }
    }

    fn of_overlay(self, overlay: Overlay) -> ChannelRow {
        ChannelRow { heading: self, access: Access::Overlay(overlay) }
    }
}

/// The table.
impl Channel {
    fn row(self) -> ChannelRow {
        use Quantity::{Angle, Angles, Fraction, Length, Point, Rotation, Switch};
        match self {
            Self::Hand => named("hand", "Hand", Point).of_arm(
                |arm| arm.cursor.in_root,
                |arm, to| arm.cursor.in_root = to,
                |arm| !arm.is_pinned(),
            ),
            Self::Twist => named("twist", "Socket twist", Angle).of_arm(
                |arm| number(arm.keyed_twist()),
                |arm, to| arm.set_keyed_twist(to.x),
                |_| true,
            ),
            Self::Root => named("root", "Root", Point).of_arm(
                |arm| arm.root,
                |arm, to| arm.root = to,
                |_| true,
            ),
            Self::Upper => named("upper", "Upper length", Length).of_arm(
                |arm| number(arm.bones.upper()),
                |arm, to| arm.set_lengths(to.x, arm.bones.lower()),
                |_| true,
            ),
            Self::Lower => named("lower", "Lower length", Length).of_arm(
                |arm| number(arm.bones.lower()),
                |arm, to| arm.set_lengths(arm.bones.upper(), to.x),
                |_| true,
            ),
            Self::Pin => named("pin", "Pinned hand", Point).of_arm(
                |arm| arm.cursor.in_world,
                |arm, to| arm.cursor.in_world = to,
                Arm::is_pinned,
            ),
            Self::Pinned => named("pinned", "Pinned to world", Switch).of_arm(
                |arm| switch(arm.cursor.is_pinned),
                |arm, to| arm.cursor.is_pinned = is_on(to),
                Arm::is_pinned,
            ),
            Self::Pole => named("pole", "Pole", Point).of_arm(
                |arm| arm.pole,
                |arm, to| arm.pole = to,
                |arm| arm.twist_reference == TwistReferenceKind::Pole,
            ),
            Self::Influence => named("influence", "IK influence", Fraction).of_arm(
                |arm| number(arm.influence),
                |arm, to| arm.influence = fraction(to),
                |arm| arm.influence < 1.0,
            ),
            Self::Shoulder => named("shoulder", "Shoulder angles", Angles).of_arm(
                |arm| arm.fk.shoulder,
                |arm, to| arm.fk.shoulder = to,
                |arm| arm.influence < 1.0,
            ),
            Self::Bend => named("bend", "Elbow bend", Angle).of_arm(
                |arm| number(arm.fk.bend),
                |arm, to| arm.fk.bend = to.x,
                |arm| arm.influence < 1.0,
            ),
            Self::Stretch => named("stretch", "FK stretch", Length).of_arm(
                |arm| number(arm.fk.stretch),
                |arm, to| arm.fk.stretch = to.x.max(f32::MIN_POSITIVE),
                |arm| arm.influence < 1.0 && arm.is_stretching(),
            ),
            Self::HandOrientation => named("hand_orientation", "Hand orientation", Angles).of_arm(
                |arm| arm.hand_orientation.angles,
                |arm, to| arm.hand_orientation.angles = to,
                |arm| arm.hand_orientation != HandOrientation::default(),
            ),
            Self::Translation => named("translation", "Skeleton translation", Point)
                .of_skeleton(|skeleton| skeleton.transform().translation.into(), translate),
            Self::Rotation(joint) => {
                named("rotation", "rotation", Rotation).of_joint(joint, |it| it.rotation, rotate)
            }
            Self::Offset(joint) => {
                named("offset", "offset", Point).of_joint(joint, |it| it.offset, offset)
            }
            Self::Target(joint) => named("target", "target", Point).of_target(
                joint,
                |it| Some(it.home),
                |it, to| it.home = to,
                |_| true,
            ),
            Self::TargetInfluence(joint) => named("target_influence", "target influence", Fraction)
                .of_target(
                    joint,
                    |it| Some(number(it.influence)),
                    |it, to| it.influence = fraction(to),
                    |value| value.x < 1.0,
                ),
            Self::TargetOrientation(joint) => named(
                "target_orientation",
                "target orientation",
                Rotation,
            )
            .of_target(joint, |it| it.limb()?.orientation, set_orientation, |_| true),
            Self::TargetTwist(joint) => named("target_twist", "target twist", Angle).of_target(
                joint,
                |it| Some(number(it.limb()?.twist)),
                set_twist,
                |value| value.x != 0.0,
            ),
            Self::TargetPole(joint) => named("target_pole", "target pole", Point).of_target(
                joint,
                |it| it.limb()?.pole,
                set_pole,
                |_| true,
            ),
            Self::Enabled(joint) => named("enabled", "target enabled", Switch).of_target(
                joint,
                |it| Some(switch(it.enabled)),
                |it, to| it.enabled = is_on(to),
                |_| false,
            ),
            Self::Overlay(overlay) => named("overlay", "shown", Switch).of_overlay(overlay),
        }
    }
}

/// Facts from the table.
impl Channel {
    /// The part of a document that holds the channel's value.
    fn access(self) -> Access {
        self.row().access
    }

    /// Name of the channel in files, without its joint or overlay.
    pub fn name(self) -> &'static str {
        self.row().heading.name
    }

    /// Name of the channel on screen, beside that of its joint or overlay.
    pub fn label(self) -> &'static str {
        self.row().heading.label
    }

    /// The kind of the channel's values.
    pub fn quantity(self) -> Quantity {
        self.row().heading.quantity
    }

    /// True if the channel affects the pose of `arm` with its present settings.
    pub fn shapes(self, arm: &Arm) -> bool {
        matches!(self.access(), Access::Arm { shapes, .. } if shapes(arm))
    }

    /// The rig that the channel belongs to; `None` for overlays.
    pub fn rig(self) -> Option<RigKind> {
        match self.access() {
            Access::Arm { .. } => Some(RigKind::Arm),
            Access::Skeleton { .. } | Access::Joint { .. } | Access::Target { .. } => {
                Some(RigKind::Skeleton)
            }
            Access::Overlay(_) => None,
        }
    }

    /// The joint that the channel belongs to; `None` if it belongs to no joint.
    pub fn joint(self) -> Option<JointId> {
        match self.access() {
            Access::Joint { joint, .. } | Access::Target { joint, .. } => Some(joint),
            Access::Arm { .. } | Access::Skeleton { .. } | Access::Overlay(_) => None,
        }
    }

    /// The joint whose target the channel belongs to; `None` if it belongs to no target.
    pub fn target(self) -> Option<JointId> {
        let Access::Target { joint, .. } = self.access() else { return None };
        Some(joint)
    }
}

/// Channels in a document.
impl Channel {
    /// The channel of the point that the Cursor of `arm` has: in the world if it is pinned, else in
    /// Root space.
    pub fn of_cursor(arm: &Arm) -> Self {
        if arm.is_pinned() { Self::Pin } else { Self::Hand }
    }

    /// True if the channel is the point that the Cursor of `arm` does not have at present.
    pub fn is_idle(self, arm: &Arm) -> bool {
        matches!(self, Self::Hand | Self::Pin) && self != Self::of_cursor(arm)
    }

    /// Channels that affect the pose of the shown rig. For a skeleton: its translation, the offsets
    /// of its roots, the rotations of its joints and its targets; a target's influence only below
    /// 1, and a twist of 0 not at all.
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
        channels.extend(of_targets.filter(|channel| channel.shapes_by_target(document)));
        channels
    }

    /// True if this channel of a target affects the pose with its present value.
    fn shapes_by_target(self, document: &Document) -> bool {
        let value = self.value(document);
        matches!(self.access(), Access::Target { shapes, .. } if value.is_some_and(shapes))
    }

    /// The channel's value in a document; `None` for a joint or target that the document does not
    /// have.
    pub fn value(self, document: &Document) -> Option<Vec3> {
        let Document { arm, skeleton_rig: rig, display, .. } = document;
        match self.access() {
            Access::Arm { get, .. } => Some(get(arm)),
            Access::Skeleton { get, .. } => Some(get(&rig.skeleton)),
            Access::Joint { joint, get, .. } => rig.skeleton.joint(joint).map(get),
            Access::Target { joint, get, .. } => get(&rig.targets[rig.target(joint)?]),
            Access::Overlay(overlay) => Some(switch(display.shows(overlay))),
        }
    }

    /// Sets the channel's value in a document, clamped to the channel's range. Changes nothing if
    /// `value` contains NaN or is an invalid length of a limb, or if [`Self::value`] is `None`.
    pub fn set(self, document: &mut Document, value: Vec3) {
        let Document { arm, skeleton_rig: rig, display, .. } = document;
        let value = value.clamp(Vec3::MIN, Vec3::MAX);
        if value.is_nan() {
            return;
        }
        match self.access() {
            Access::Arm { set, .. } => set(arm, value),
            Access::Skeleton { set, .. } => set(rig, value),
            Access::Joint { joint, set, .. } => set(rig, joint, value),
            Access::Target { joint, set, .. } => {
                if let Some(index) = rig.target(joint) {
                    set(&mut rig.targets[index], value);
                }
            }
            Access::Overlay(overlay) => *display = display.with(overlay, is_on(value)),
        }
    }
}

fn number(value: f32) -> Vec3 {
    Vec3::new(value, 0.0, 0.0)
}

fn switch(is_on: bool) -> Vec3 {
    number(f32::from(u8::from(is_on)))
}

fn fraction(value: Vec3) -> f32 {
    value.x.clamp(0.0, 1.0)
}

fn set_orientation(target: &mut Target, angles: Vec3) {
    if let Some(LimbSettings { orientation: Some(orientation), .. }) = target.limb_mut() {
        *orientation = angles;
    }
}

fn set_twist(target: &mut Target, twist: Vec3) {
    if let Some(limb) = target.limb_mut() {
        limb.twist = twist.x;
    }
}

fn set_pole(target: &mut Target, pole: Vec3) {
    if let Some(limb) = target.limb_mut().filter(|limb| limb.pole.is_some()) {
        limb.pole = Some(pole);
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
    let rotation = before.limits.project(rotation);
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

/// True if two vectors are bit-identical.
fn is_identical(a: Vec3, b: Vec3) -> bool {
    a.to_array().map(f32::to_bits) == b.to_array().map(f32::to_bits)
}
