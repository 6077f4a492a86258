//! The table of channels: the names of each, and where a document holds its value.

use glam::Vec3;

use super::Document;
use super::channel::{Channel, Quantity, is_on};
use super::display::Overlay;
use crate::kinematics::skeleton::{Joint, JointId, SkinStretch};
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
    Rig {
        /// `None` if the rig has no such setting.
        get: fn(&SkeletonRig) -> Option<Vec3>,
        set: fn(&mut SkeletonRig, Vec3),
    },
    Joint {
        joint: JointId,
        /// `None` if the joint has no such value.
        get: fn(&Joint) -> Option<Vec3>,
        set: fn(&mut SkeletonRig, JointId, Vec3),
    },
    Target {
        joint: JointId,
        /// `None` if the target has no such setting.
        get: fn(&Target) -> Option<Vec3>,
        set: fn(&mut Target, Vec3),
        /// True if the channel affects the pose with the target's present settings.
        shapes: fn(&Target) -> bool,
    },
    /// Weight of a morph target of the skin, by its index.
    Morph(u16),
    Overlay(Overlay),
}

fn named(name: &'static str, label: &'static str, quantity: Quantity) -> Heading {
    Heading { name, label, quantity }
}

impl Heading {
    fn of_rig(
        self,
        get: fn(&SkeletonRig) -> Option<Vec3>,
        set: fn(&mut SkeletonRig, Vec3),
    ) -> ChannelRow {
        ChannelRow { heading: self, access: Access::Rig { get, set } }
    }

    fn of_joint(
        self,
        joint: JointId,
        get: fn(&Joint) -> Option<Vec3>,
        set: fn(&mut SkeletonRig, JointId, Vec3),
    ) -> ChannelRow {
        ChannelRow { heading: self, access: Access::Joint { joint, get, set } }
    }

    fn of_target(
        self,
        joint: JointId,
        get: fn(&Target) -> Option<Vec3>,
        set: fn(&mut Target, Vec3),
        shapes: fn(&Target) -> bool,
    ) -> ChannelRow {
        ChannelRow { heading: self, access: Access::Target { joint, get, set, shapes } }
    }

    fn of_morph(self, morph: u16) -> ChannelRow {
        ChannelRow { heading: self, access: Access::Morph(morph) }
    }

    fn of_overlay(self, overlay: Overlay) -> ChannelRow {
        ChannelRow { heading: self, access: Access::Overlay(overlay) }
    }
}

/// The table.
impl Channel {
    fn row(self) -> ChannelRow {
        use Quantity::{Angle, Fraction, Length, Number, Numbers, Point, Rotation, Switch};
        match self {
            Self::Translation => named("translation", "Skeleton translation", Point)
                .of_rig(|rig| Some(rig.skeleton.transform().translation.into()), translate),
            Self::BalanceInfluence => named("balance_influence", "Balance influence", Fraction)
                .of_rig(|rig| Some(number(rig.balance?.influence)), set_balance),
            Self::Morph(morph) => named("morph", "morph target", Number).of_morph(morph),
            Self::Rotation(joint) => named("rotation", "rotation", Rotation).of_joint(
                joint,
                |it| Some(it.rotation),
                rotate,
            ),
            Self::Offset(joint) => {
                named("offset", "offset", Point).of_joint(joint, |it| Some(it.offset), offset)
            }
            Self::Length(joint) => {
                named("length", "length", Length).of_joint(joint, length, set_length)
            }
            Self::SkinScale(joint) => named("skin_scale", "skin scale", Numbers).of_joint(
                joint,
                |it| Some(it.skin.scale),
                |rig, joint, scale| stretch_skin(rig, joint, |skin| skin.scale = scale),
            ),
            Self::SkinShear(joint) => named("skin_shear", "skin shear", Numbers).of_joint(
                joint,
                |it| Some(it.skin.shear),
                |rig, joint, shear| stretch_skin(rig, joint, |skin| skin.shear = shear),
            ),
            Self::Target(joint) => named("target", "target", Point).of_target(
                joint,
                |it| Some(it.home),
                |it, to| it.home = to,
                |it| !it.is_pinned,
            ),
            Self::Pin(joint) => named("pin", "pinned target", Point).of_target(
                joint,
                |it| Some(it.pin),
                |it, to| it.pin = to,
                |it| it.is_pinned,
            ),
            Self::Pinned(joint) => named("pinned", "pinned to world", Switch).of_target(
                joint,
                |it| Some(switch(it.is_pinned)),
                |it, to| it.is_pinned = is_on(to),
                |it| it.is_pinned,
            ),
            Self::TargetInfluence(joint) => named("target_influence", "target influence", Fraction)
                .of_target(
                    joint,
                    |it| Some(number(it.influence)),
                    |it, to| it.influence = fraction(to),
                    |it| it.influence < 1.0,
                ),
            Self::TargetOrientation(joint) => named(
                "target_orientation",
                "target orientation",
                Rotation,
            )
            .of_target(joint, |it| it.orientation, set_orientation, |_| true),
            Self::TargetAim(joint) => named("target_aim", "target aim", Point).of_target(
                joint,
                |it| it.aim.map(|aim| aim.point),
                set_aim,
                |it| it.aim.is_some(),
            ),
            Self::TargetTwist(joint) => named("target_twist", "Socket twist", Angle).of_target(
                joint,
                |it| Some(number(it.limb()?.twist)),
                set_twist,
                |it| it.limb().is_some_and(has_twist),
            ),
            Self::TargetPole(joint) => named("target_pole", "target pole", Point).of_target(
                joint,
                |it| it.limb()?.pole,
                set_pole,
                |it| it.limb().is_some_and(|limb| limb.pole().is_some()),
            ),
            Self::Stretch(joint) => named("stretch", "FK stretch", Length).of_target(
                joint,
                |it| Some(number(it.limb()?.fk_stretch)),
                set_stretch,
                |it| it.influence < 1.0 && it.limb().is_some_and(LimbSettings::is_stretching),
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

    /// True if the channel belongs to the rig, and not to an overlay.
    pub fn is_of_rig(self) -> bool {
        !matches!(self.access(), Access::Overlay(_))
    }

    /// The joint that the channel belongs to; `None` if it belongs to no joint.
    pub fn joint(self) -> Option<JointId> {
        match self.access() {
            Access::Joint { joint, .. } | Access::Target { joint, .. } => Some(joint),
            Access::Rig { .. } | Access::Morph(_) | Access::Overlay(_) => None,
        }
    }

    /// The joint whose target the channel belongs to; `None` if it belongs to no target.
    pub fn target(self) -> Option<JointId> {
        let Access::Target { joint, .. } = self.access() else { return None };
        Some(joint)
    }
}

impl Document {
    /// The joint that a channel belongs to: for a target of a limb, its hand or foot. `None` if the
    /// channel belongs to no joint.
    pub fn joint_of(&self, channel: Channel) -> Option<JointId> {
        let target = channel.target().and_then(|joint| self.rig.target(joint));
        let end = target.map(|index| self.rig.end_of(&self.rig.targets[index]));
        end.or(channel.joint())
    }
}

/// Channels in a document.
impl Channel {
    /// The channel of the point that a target has at present: in the world if it is pinned, else in
    /// its space.
    pub fn of_point(target: &Target) -> Self {
        if target.is_pinned { Self::Pin(target.joint) } else { Self::Target(target.joint) }
    }

    /// True if the channel is the point that its target does not have at present.
    pub fn is_idle(self, rig: &SkeletonRig) -> bool {
        let (Self::Target(joint) | Self::Pin(joint)) = self else { return false };
        rig.target(joint).is_some_and(|index| self != Self::of_point(&rig.targets[index]))
    }

    /// Channels that affect the pose: the skeleton's translation, the balance, the offsets of its
    /// roots, the rotations of its joints, and of each target those that matter with its present
    /// settings.
    pub fn of_rig(document: &Document) -> Vec<Self> {
        let SkeletonRig { skeleton, targets, balance, .. } = &document.rig;
        let joints = skeleton.iter();
        let roots = joints.clone().filter(|(_, joint)| joint.parent.is_none());
        let mut channels = vec![Self::Translation];
        channels.extend(balance.map(|_| Self::BalanceInfluence));
        channels.extend(roots.map(|(joint, _)| Self::Offset(joint)));
        channels.extend(joints.map(|(joint, _)| Self::Rotation(joint)));
        channels.extend(targets.iter().flat_map(|target| {
            Self::of_target(target.joint).into_iter().filter(|channel| channel.shapes(target))
        }));
        channels
    }

    /// Channels of the lengths of a document's bones.
    pub fn lengths(document: &Document) -> impl Iterator<Item = Self> {
        let lengths = document.skeleton().ids().map(Self::Length);
        lengths.filter(|channel| channel.value(document).is_some())
    }

    /// The channels by which IK poses the joints of a target: its point, the switch of its pin, and
    /// the twist of its limb.
    pub fn of_ik(target: &Target) -> [Self; 4] {
        let joint = target.joint;
        [Self::Target(joint), Self::Pinned(joint), Self::Pin(joint), Self::TargetTwist(joint)]
    }

    /// The channels by which FK poses the limb of a target, and the influence of IK.
    pub fn of_fk(rig: &SkeletonRig, target: &Target) -> Vec<Self> {
        let joint = target.joint;
        let bones = rig.limb_joints(joint).filter(|it| *it != rig.end_of(target) || *it == joint);
        let rotations = bones.map(Self::Rotation);
        let own = [Self::TargetInfluence(joint), Self::Stretch(joint)];
        own.into_iter().chain(rotations).collect()
    }

    /// True if this channel is one of the target's and affects the pose with its present settings.
    pub fn shapes(self, target: &Target) -> bool {
        match self.access() {
            Access::Target { joint, get, shapes, .. } => {
                joint == target.joint && get(target).is_some() && shapes(target)
            }
            _ => false,
        }
    }

    /// The channel's value in a document; `None` for a joint or target that the document does not
    /// have.
    pub fn value(self, document: &Document) -> Option<Vec3> {
        let Document { rig, display, .. } = document;
        match self.access() {
            Access::Rig { get, .. } => get(rig),
            Access::Joint { joint, get, .. } => rig.skeleton.joint(joint).and_then(get),
            Access::Target { joint, get, .. } => get(&rig.targets[rig.target(joint)?]),
            Access::Morph(morph) => Some(number(rig.morph_weight(morph.into())?)),
            Access::Overlay(overlay) => Some(switch(display.shows(overlay))),
        }
    }

    /// Sets the channel's value in a document, clamped to the channel's range. Changes nothing if
    /// `value` contains NaN, or if [`Self::value`] is `None`.
    pub fn set(self, document: &mut Document, value: Vec3) {
        let Document { rig, display, .. } = document;
        let value = value.clamp(Vec3::MIN, Vec3::MAX);
        if value.is_nan() {
            return;
        }
        match self.access() {
            Access::Rig { set, .. } => set(rig, value),
            Access::Joint { joint, set, .. } => set(rig, joint, value),
            Access::Target { joint, set, .. } => {
                if let Some(index) = rig.target(joint) {
                    set(&mut rig.targets[index], value);
                }
            }
            Access::Morph(morph) => rig.set_morph_weight(morph.into(), value.x),
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

/// True if the twist of a limb can turn its elbow: it is measured from a direction that is not that
/// of the FK pose, or is not 0.
fn has_twist(limb: &LimbSettings) -> bool {
    limb.reference != TwistReferenceKind::Fk || limb.twist != 0.0
}

fn set_balance(rig: &mut SkeletonRig, influence: Vec3) {
    if let Some(balance) = &mut rig.balance {
        balance.influence = fraction(influence);
    }
}

fn set_orientation(target: &mut Target, angles: Vec3) {
    if let Some(orientation) = &mut target.orientation {
        *orientation = angles;
    }
}

fn set_aim(target: &mut Target, point: Vec3) {
    if let Some(aim) = &mut target.aim {
        aim.point = point;
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

fn set_stretch(target: &mut Target, stretch: Vec3) {
    if let Some(limb) = target.limb_mut() {
        limb.fk_stretch = stretch.x.max(f32::MIN_POSITIVE);
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

/// Length of a joint's bone; `None` if it has none.
fn length(joint: &Joint) -> Option<Vec3> {
    let length = joint.axis.as_dvec3().length() as f32;
    (length > 0.0 && length.is_finite()).then(|| number(length))
}

/// Sets the length of a joint's bone; children at its tip move with it.
fn set_length(rig: &mut SkeletonRig, joint: JointId, to: Vec3) {
    let Some(before) = rig.skeleton.joint(joint).map(|joint| joint.axis) else { return };
    let direction = before.as_dvec3().normalize_or_zero();
    let axis = (direction * f64::from(to.x.max(f32::MIN_POSITIVE))).as_vec3();
    if axis.is_finite() && !is_identical(before, axis) {
        // Only an axis that is not finite is refused.
        let _ = rig.skeleton_mut().set_axis(joint, axis);
    }
}

/// Changes how a joint stretches the skin.
fn stretch_skin(rig: &mut SkeletonRig, joint: JointId, change: impl FnOnce(&mut SkinStretch)) {
    let Some(before) = rig.skeleton.joint(joint).map(|joint| joint.skin) else { return };
    let mut skin = before;
    change(&mut skin);
    if !(is_identical(skin.scale, before.scale) && is_identical(skin.shear, before.shear)) {
        rig.skeleton_mut().write_local(joint, |joint| joint.skin = skin);
    }
}

/// True if two vectors are bit-identical.
fn is_identical(a: Vec3, b: Vec3) -> bool {
    a.to_array().map(f32::to_bits) == b.to_array().map(f32::to_bits)
}
