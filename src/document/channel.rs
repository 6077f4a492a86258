use core::mem::discriminant;

use glam::Vec3;

use super::arm::Arm;
use super::display::Overlay;
use super::hand_orientation::HandOrientation;
use super::rig_kind::RigKind;
use crate::kinematics::limb_ik::ElbowReference;
use crate::kinematics::skeleton::{Joint, JointId, JointRemap, Skeleton};
use crate::kinematics::twist::TwistReferenceKind;
use crate::rig::{LimbSettings, SkeletonRig, Target};

/// A value of a document that keys can animate.
///
/// Every channel has a vector as its value, so that all channels are handled alike: a number is in
/// x, with y and z 0, and a switch is 0 or 1 in x.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Channel {
    /// The Cursor in Root space while it is not pinned.
    Hand,
    /// Socket twist in radians, unwrapped; with Transport it is measured from the stereographic
    /// direction.
    Twist,
    /// Position of the shoulder in the world.
    Root,
    /// Length of the upper limb.
    Upper,
    /// Length of the lower limb.
    Lower,
    /// The Cursor in the world while it is pinned.
    Pin,
    /// Switch: the Cursor is pinned to the world.
    Pinned,
    /// The pole: the point in Root space towards which the elbow turns.
    Pole,
    /// Influence of IK, from 0 (FK alone) to 1 (IK alone).
    Influence,
    /// FK angles of the shoulder in radians, unwrapped.
    Shoulder,
    /// FK bend of the elbow in radians, unwrapped.
    Bend,
    /// FK stretch: the length of the limbs as a multiple of their unstretched length.
    Stretch,
    /// Angles of the hand in radians, unwrapped.
    HandOrientation,
    /// Position of the skeleton's origin in the world.
    Translation,
    /// Euler angles of a joint in radians, unwrapped.
    Rotation(JointId),
    /// Vector from the base of a joint's parent to the joint's base, in the parent's space; from
    /// the skeleton's origin for a root.
    Offset(JointId),
    /// Position of a joint's target at time 0, in the target's space.
    Target(JointId),
    /// Influence of a joint's target, from 0 (FK pose) to 1 (solved pose).
    TargetInfluence(JointId),
    /// Euler angles in radians, unwrapped, of the hand in the space of a limb's target.
    TargetOrientation(JointId),
    /// Angle in radians, unwrapped, by which the elbow of a limb's target is turned.
    TargetTwist(JointId),
    /// The pole of a limb's target, in the pole's space.
    TargetPole(JointId),
    /// Switch: a joint's target is enabled.
    Enabled(JointId),
    /// Switch: an overlay is shown.
    Overlay(Overlay),
}

/// The kind of a channel's values: how many numbers they have, their unit and their range.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// A point or vector, in units of the rig.
    Point,
    /// A length above 0, in units of the rig.
    Length,
    /// A number from 0 to 1.
    Fraction,
    /// An angle in radians.
    Angle,
    /// Three angles in radians.
    Angles,
    /// Euler angles in radians of a rotation, R_z · R_y · R_x. Keys can turn it the shortest way:
    /// see [`Interpolation::Slerp`](crate::kinematics::spline::Interpolation::Slerp).
    Rotation,
    /// 0 or 1, not interpolated.
    Switch,
}

impl Quantity {
    /// Number of components in use: 1 or 3.
    pub fn width(self) -> usize {
        match self {
            Self::Point | Self::Angles | Self::Rotation => 3,
            Self::Length | Self::Fraction | Self::Angle | Self::Switch => 1,
        }
    }
}

/// A row of the table of channels: all that is particular to one channel.
struct Row {
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
pub(super) enum Access {
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
    ) -> Row {
        Row { heading: self, access: Access::Arm { get, set, shapes } }
    }

    fn of_skeleton(self, get: fn(&Skeleton) -> Vec3, set: fn(&mut SkeletonRig, Vec3)) -> Row {
        Row { heading: self, access: Access::Skeleton { get, set } }
    }

    fn of_joint(
        self,
        joint: JointId,
        get: fn(&Joint) -> Vec3,
        set: fn(&mut SkeletonRig, JointId, Vec3),
    ) -> Row {
        Row { heading: self, access: Access::Joint { joint, get, set } }
    }

    fn of_target(
        self,
        joint: JointId,
        get: fn(&Target) -> Option<Vec3>,
        set: fn(&mut Target, Vec3),
        shapes: fn(Vec3) -> bool,
    ) -> Row {
        Row { heading: self, access: Access::Target { joint, get, set, shapes } }
    }

    fn of_overlay(self, overlay: Overlay) -> Row {
        Row { heading: self, access: Access::Overlay(overlay) }
    }
}

/// The table.
impl Channel {
    fn row(self) -> Row {
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
                |it| Some(it.limb()?.pole()?.1),
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

/// Lists of channels. A new channel must be in one of them, or files cannot name it.
impl Channel {
    /// All channels of the arm.
    pub const ARM: [Self; 13] = [
        Self::Hand,
        Self::Pinned,
        Self::Pin,
        Self::Twist,
        Self::Pole,
        Self::Root,
        Self::Upper,
        Self::Lower,
        Self::Influence,
        Self::Shoulder,
        Self::Bend,
        Self::Stretch,
        Self::HandOrientation,
    ];

    /// The channels that pose the arm by IK.
    pub const IK: [Self; 4] = [Self::Hand, Self::Pinned, Self::Pin, Self::Twist];

    /// The channels that pose the arm by FK, and the influence of IK.
    pub const FK: [Self; 4] = [Self::Influence, Self::Shoulder, Self::Bend, Self::Stretch];

    /// The channels of a joint and of its target.
    pub fn of_joint(joint: JointId) -> impl Iterator<Item = Self> {
        let own = [Self::Rotation(joint), Self::Offset(joint)];
        own.into_iter().chain(Self::of_target(joint))
    }

    /// The channels of the target of a joint.
    pub fn of_target(joint: JointId) -> [Self; 6] {
        [
            Self::Target(joint),
            Self::TargetInfluence(joint),
            Self::TargetOrientation(joint),
            Self::TargetTwist(joint),
            Self::TargetPole(joint),
            Self::Enabled(joint),
        ]
    }
}

/// Facts from the table.
impl Channel {
    /// The part of a document that holds the channel's value.
    pub(super) fn access(self) -> Access {
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

    /// True if the channel's values are switches, 0 or 1.
    pub fn is_switch(self) -> bool {
        self.quantity() == Quantity::Switch
    }

    /// True if the channel's values are the Euler angles of one rotation.
    pub fn is_rotation(self) -> bool {
        self.quantity() == Quantity::Rotation
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
        match self.access() {
            Access::Target { joint, .. } => Some(joint),
            Access::Arm { .. }
            | Access::Skeleton { .. }
            | Access::Joint { .. }
            | Access::Overlay(_) => None,
        }
    }

    /// The same channel after its joint was renumbered; `None` if its joint was removed.
    #[must_use]
    pub fn remapped(self, remap: &JointRemap) -> Option<Self> {
        let Some(joint) = self.joint() else { return Some(self) };
        let is_same = |other: &Self| discriminant(other) == discriminant(&self);
        Self::of_joint(remap.get(joint)?).find(is_same)
    }
}

fn number(value: f32) -> Vec3 {
    Vec3::new(value, 0.0, 0.0)
}

pub(super) fn switch(is_on: bool) -> Vec3 {
    number(f32::from(u8::from(is_on)))
}

pub(super) fn is_on(value: Vec3) -> bool {
    value.x >= 0.5
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
    if let Some(limb) = target.limb_mut().filter(|limb| limb.pole().is_some()) {
        limb.reference = ElbowReference::Pole(pole);
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
