use glam::Vec3;

use super::{Arm, Cursor, Document, Overlay, RigKind, SkeletonRig, TwistReferenceKind, Wrist};
use crate::kinematics::skeleton::{JointId, JointRemap};

/// One thing of a document that keys can change in time.
///
/// All values are vectors, so that they can be handled alike: a number is in x, with y and z 0, and a
/// switch is 0 or 1 in x.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Channel {
    /// The arm's cursor, in Root space, while it is not pinned.
    Hand,
    /// ψ in radians, unwrapped; with transport it is measured from the map.
    Twist,
    /// The arm's shoulder, in the world.
    Root,
    /// The upper limb's length.
    Upper,
    /// The lower limb's length.
    Lower,
    /// The arm's cursor, in the world, while it is pinned.
    Pin,
    /// What the elbow points at, in Root space.
    Pole,
    /// How far the arm's hand leads rather than its joints' angles, from 0 to 1.
    Influence,
    /// The shoulder's own angles in radians, unwrapped.
    Shoulder,
    /// The elbow's own bend in radians, unwrapped.
    Bend,
    /// How many times as long as at rest the limbs are while their angles lead.
    Stretch,
    /// The hand's angles in radians, unwrapped.
    Wrist,
    /// Where the skeleton's own origin is, in the world.
    Translation,
    /// A joint's Euler angles in radians, unwrapped.
    Rotation(JointId),
    /// A joint's offset from its parent's base.
    Offset(JointId),
    /// Where the target of a joint is, in the world: its home.
    Target(JointId),
    /// Whether the target of a joint counts.
    Enabled(JointId),
    /// Whether a layer is shown.
    Overlay(Overlay),
}

/// What the values of a channel are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// In units of the scene.
    Point,
    /// In units of the scene, above 0.
    Length,
    /// From 0 to 1.
    Fraction,
    /// In radians.
    Angle,
    /// Three of them, in radians.
    Angles,
    /// 0 or 1; it steps.
    Switch,
}

impl Quantity {
    /// How many numbers a value has.
    pub fn width(self) -> usize {
        match self {
            Self::Point | Self::Angles => 3,
            Self::Length | Self::Fraction | Self::Angle | Self::Switch => 1,
        }
    }
}

impl Channel {
    pub fn quantity(self) -> Quantity {
        match self {
            Self::Hand
            | Self::Root
            | Self::Pin
            | Self::Pole
            | Self::Translation
            | Self::Offset(_)
            | Self::Target(_) => Quantity::Point,
            Self::Upper | Self::Lower | Self::Stretch => Quantity::Length,
            Self::Influence => Quantity::Fraction,
            Self::Twist | Self::Bend => Quantity::Angle,
            Self::Shoulder | Self::Wrist | Self::Rotation(_) => Quantity::Angles,
            Self::Enabled(_) | Self::Overlay(_) => Quantity::Switch,
        }
    }

    pub fn is_switch(self) -> bool {
        self.quantity() == Quantity::Switch
    }

    /// All that can shape a document's arm.
    pub const OF_ARM: [Self; 12] = [
        Self::Hand,
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
        Self::Wrist,
    ];

    /// What the arm's hand leads by.
    pub const OF_HAND: [Self; 3] = [Self::Hand, Self::Pin, Self::Twist];

    /// What the arm's joints lead by, and which of the two does.
    pub const OF_JOINTS: [Self; 4] = [Self::Influence, Self::Shoulder, Self::Bend, Self::Stretch];

    /// Whether it shapes an arm as that is set.
    pub fn shapes(self, arm: &Arm) -> bool {
        match self {
            Self::Hand => !arm.is_pinned(),
            Self::Pin => arm.is_pinned(),
            Self::Pole => arm.twist_reference == TwistReferenceKind::Pole,
            Self::Influence | Self::Shoulder | Self::Bend => arm.influence < 1.0,
            Self::Stretch => arm.influence < 1.0 && arm.is_stretching(),
            Self::Wrist => arm.wrist != Wrist::default(),
            other => other.rig() == Some(RigKind::Arm),
        }
    }

    /// All that shapes the rig that is shown. Of a skeleton where it is, where its roots are, how its
    /// joints are turned, and where its targets are.
    pub fn of_rig(document: &Document) -> Vec<Self> {
        if document.rig == RigKind::Arm {
            let shapes = |channel: &Self| channel.shapes(&document.arm);
            return Self::OF_ARM.into_iter().filter(shapes).collect();
        }
        let SkeletonRig { skeleton, targets, .. } = &document.skeleton_rig;
        let joints = skeleton.iter();
        let roots = joints.clone().filter(|(_, joint)| joint.parent.is_none());
        let mut channels = vec![Self::Translation];
        channels.extend(roots.map(|(joint, _)| Self::Offset(joint)));
        channels.extend(joints.map(|(joint, _)| Self::Rotation(joint)));
        channels.extend(targets.iter().map(|target| Self::Target(target.joint)));
        channels
    }

    /// The rig that it belongs to, if to one.
    pub fn rig(self) -> Option<RigKind> {
        match self {
            Self::Hand
            | Self::Twist
            | Self::Root
            | Self::Upper
            | Self::Lower
            | Self::Pin
            | Self::Pole
            | Self::Influence
            | Self::Shoulder
            | Self::Bend
            | Self::Stretch
            | Self::Wrist => Some(RigKind::Arm),
            Self::Translation
            | Self::Rotation(_)
            | Self::Offset(_)
            | Self::Target(_)
            | Self::Enabled(_) => Some(RigKind::Skeleton),
            Self::Overlay(_) => None,
        }
    }

    /// Whether it changes the pose of a rig; targets pose nothing before a solver runs.
    pub fn poses(self, rig: RigKind) -> bool {
        self.rig() == Some(rig) && !matches!(self, Self::Target(_) | Self::Enabled(_))
    }

    /// The joint that it belongs to.
    pub fn joint(self) -> Option<JointId> {
        match self {
            Self::Rotation(joint)
            | Self::Offset(joint)
            | Self::Target(joint)
            | Self::Enabled(joint) => Some(joint),
            _ => None,
        }
    }

    /// The same where the joints have new places; nothing if its joint is gone.
    #[must_use]
    pub fn moved(self, moved: &JointRemap) -> Option<Self> {
        Some(match self {
            Self::Rotation(joint) => Self::Rotation(moved.get(joint)?),
            Self::Offset(joint) => Self::Offset(moved.get(joint)?),
            Self::Target(joint) => Self::Target(moved.get(joint)?),
            Self::Enabled(joint) => Self::Enabled(moved.get(joint)?),
            other => other,
        })
    }

    /// The value that a document has; nothing if it has no such joint or target,
    /// or its hand is pinned or not.
    pub fn value(self, document: &Document) -> Option<Vec3> {
        let Document { arm, skeleton_rig: rig, display, .. } = document;
        let number = |value| Vec3::new(value, 0.0, 0.0);
        let switch = |on: bool| number(f32::from(u8::from(on)));
        let target = |joint| Some(rig.targets[rig.target(joint)?]);
        Some(match self {
            Self::Hand => match arm.goal {
                Cursor::Root(cursor) => cursor,
                Cursor::World(_) => return None,
            },
            Self::Pin => match arm.goal {
                Cursor::World(cursor) => cursor,
                Cursor::Root(_) => return None,
            },
            Self::Twist => number(arm.keyed_spin()),
            Self::Pole => arm.pole,
            Self::Influence => number(arm.influence),
            Self::Shoulder => arm.fk.shoulder,
            Self::Bend => number(arm.fk.bend),
            Self::Stretch => number(arm.fk.stretch),
            Self::Wrist => arm.wrist.angles,
            Self::Root => arm.root,
            Self::Upper => number(arm.bones.upper()),
            Self::Lower => number(arm.bones.lower()),
            Self::Translation => rig.skeleton.transform().translation.into(),
            Self::Rotation(joint) => rig.skeleton.joint(joint)?.rotation,
            Self::Offset(joint) => rig.skeleton.joint(joint)?.offset,
            Self::Target(joint) => target(joint)?.home,
            Self::Enabled(joint) => switch(target(joint)?.enabled),
            Self::Overlay(layer) => switch(display.shows(layer)),
        })
    }

    /// Gives a document the value, brought within what is valid; nothing happens where it has no
    /// such joint or target.
    pub fn set(self, document: &mut Document, value: Vec3) {
        let Document { arm, skeleton_rig: rig, display, .. } = document;
        let value = value.clamp(Vec3::MIN, Vec3::MAX);
        if value.is_nan() {
            return;
        }
        let on = value.x >= 0.5;
        match self {
            Self::Hand => {
                if let Cursor::Root(cursor) = &mut arm.goal {
                    *cursor = value;
                }
            }
            Self::Pin => {
                if let Cursor::World(cursor) = &mut arm.goal {
                    *cursor = value;
                }
            }
            Self::Twist => arm.set_keyed_spin(value.x),
            Self::Pole => arm.pole = value,
            Self::Influence => arm.influence = value.x.clamp(0.0, 1.0),
            Self::Shoulder => arm.fk.shoulder = value,
            Self::Bend => arm.fk.bend = value.x,
            Self::Stretch => arm.fk.stretch = value.x.max(f32::MIN_POSITIVE),
            Self::Wrist => arm.wrist.angles = value,
            Self::Root => arm.root = value,
            Self::Upper => arm.set_lengths(value.x, arm.bones.lower()),
            Self::Lower => arm.set_lengths(arm.bones.upper(), value.x),
            Self::Translation => translate(rig, value),
            Self::Rotation(joint) => {
                if let Some(before) = rig.skeleton.joint(joint) {
                    let rotation = before.clamped(value);
                    if !is_identical(before.rotation, rotation) {
                        rig.skeleton_mut().turn(joint, |joint| joint.rotation = rotation);
                    }
                }
            }
            Self::Offset(joint) => {
                if let Some(before) = rig.skeleton.joint(joint)
                    && !is_identical(before.offset, value)
                {
                    rig.skeleton_mut().turn(joint, |joint| joint.offset = value);
                }
            }
            Self::Target(joint) => {
                if let Some(target) = rig.target(joint) {
                    rig.targets[target].home = value;
                }
            }
            Self::Enabled(joint) => {
                if let Some(target) = rig.target(joint) {
                    rig.targets[target].enabled = on;
                }
            }
            Self::Overlay(layer) => *display = display.with(layer, on),
        }
    }
}

fn translate(rig: &mut SkeletonRig, translation: Vec3) {
    let mut transform = rig.skeleton.transform();
    if !is_identical(transform.translation.into(), translation) {
        transform.translation = translation.into();
        // Refused only where it is not finite, which it is.
        let _ = rig.skeleton_mut().set_transform(transform);
    }
}

/// Whether two values have the same bits: a value that stays copies nothing that documents share.
fn is_identical(a: Vec3, b: Vec3) -> bool {
    a.to_array().map(f32::to_bits) == b.to_array().map(f32::to_bits)
}
