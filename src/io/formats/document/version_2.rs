//! Documents of version 2, which had two rigs, an arm and a skeleton, of which one is shown.
//! Conversion to a document of the shown rig: the arm becomes joints with the target of a limb.

use glam::{Mat3A, Vec2, Vec3};
use serde::Deserialize;

use super::keys::{ChannelFields, keys};
use super::targets::SoftReachFields;
use crate::document::{Channel, Display, Document, Overlay, Quantity, SkeletonRig};
use crate::io::json::{
    Above0, AtField, FieldError, FieldWarnings, Fraction, JsonNumber, JsonNumbers, JsonObject,
    JsonPath, JsonPoint, value_or,
};
use crate::kinematics::angle;
use crate::kinematics::fk::{Fk, blended, limb_rotations};
use crate::kinematics::ik::{Ik, IkState};
use crate::kinematics::limb_ik::LimbPosture;
use crate::kinematics::skeleton::{JointId, nearest_angles};
use crate::kinematics::soft_reach::SoftReach;
use crate::kinematics::spline::{Interpolation, Knot, Slopes};
use crate::kinematics::twist::{
    Stereographic, TransportedFrame, TwistReference, TwistReferenceKind, remeasured,
};
use crate::kinematics::two_bone::{LengthError, Pointer, TwoBone};
use crate::rig::Posture;

/// The rig that a document of version 2 shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum RigName {
    Arm,
    Skeleton,
}

/// Fields of a document of version 2 that later versions do not have.
pub struct RigFields {
    pub shown: Option<RigName>,
    pub arm: Option<JsonObject<ArmFields>>,
}

impl RigFields {
    /// Converts a document that has the skeleton of the file to one of the shown rig.
    pub fn document(
        self,
        figure: Document,
        overlays: Option<Display>,
        channels: Vec<JsonObject<ChannelFields>>,
        is_of_version_2: bool,
        warnings: &mut FieldWarnings,
    ) -> Result<Document, FieldError> {
        let shows_arm =
            self.shown.ok_or("must have `rig`, \"arm\" or \"skeleton\"")? == RigName::Arm;
        let arm = self.arm.map(|JsonObject(fields)| fields.arm().at("arm")).transpose()?;
        let (of_arm, of_figure) = channels
            .into_iter()
            .enumerate()
            .partition::<Vec<_>, _>(|(_, JsonObject(fields))| ArmChannel::named(fields).is_some());
        let overlays = overlays.unwrap_or_else(shown_by_default);
        if !shows_arm {
            if !of_arm.is_empty() || arm.is_some_and(|arm| arm != Arm::default()) {
                warn_left_out(warnings, "arm", "skeleton");
            }
            let mut figure = figure;
            figure.display = of_a_figure(overlays);
            let channels = of_figure.into_iter().map(|(_, fields)| fields).collect();
            figure.keys = keys(channels, &figure).at("channels")?;
            if is_of_version_2 {
                convert_limbs(&mut figure);
                warn_of_track(&figure, warnings);
            }
            return Ok(figure);
        }
        if figure.rig != SkeletonRig::default() {
            warn_left_out(warnings, "skeleton", "arm");
        }
        let arm = arm.unwrap_or_default();
        let keyed = |names: &[ArmChannel]| {
            let is_named = |fields| ArmChannel::named(fields).is_some_and(|it| names.contains(&it));
            of_arm.iter().any(|(_, JsonObject(fields))| is_named(fields))
        };
        use ArmChannel::{Hand, Pin, Pinned, Root, Twist};
        let is_unkeyed = !keyed(&[Hand, Pin, Pinned, Root, Twist]);
        let mut document = Document {
            timeline: figure.timeline,
            camera: figure.camera,
            metres_per_unit: figure.metres_per_unit.or(Some(1e-3)),
            animation_name: figure.animation_name,
            display: overlays.with(Overlay::Cylinders, true),
            ..Document::new(arm.rig(is_unkeyed))
        };
        for (index, JsonObject(fields)) in of_arm {
            arm.add_keys(&fields, &mut document).at(index).at("channels")?;
        }
        for (index, JsonObject(fields)) in of_figure {
            if let Some(overlay) = fields.overlay {
                let keys = fields.knots(Quantity::Switch).at(index).at("channels")?;
                let channel = Channel::Overlay(overlay);
                keys.into_iter().for_each(|knot| document.keys.insert_key(channel, knot));
            }
        }
        Ok(document)
    }
}

fn warn_left_out(warnings: &mut FieldWarnings, rig: &str, shown: &str) {
    let remark = format!("is left out: a document has one rig now, and this one shows the {shown}");
    warnings.push(JsonPath::root().key(rig), &remark);
}

/// Warns of a figure whose poses now depend on those before them.
fn warn_of_track(figure: &Document, warnings: &mut FieldWarnings) {
    if figure.is_tracked() && figure.is_animated() {
        let remark = "is 2: a figure now moves from frame to frame, so that it may be posed \
                      otherwise than before; `track: false` of the solver poses each frame by \
                      itself";
        warnings.push(JsonPath::root().key("version"), remark);
    }
}

/// The overlays that a document of version 2 shows unless it lists them.
fn shown_by_default() -> Display {
    [Overlay::Pointer, Overlay::Hand]
        .into_iter()
        .fold(Display::default(), |display, overlay| display.with(overlay, true))
}

/// The overlays of a document that shows a figure: those of the arm were not drawn, and the Pointer
/// was the path of a head.
fn of_a_figure(overlays: Display) -> Display {
    const OF_ARM: [Overlay; 7] = [
        Overlay::Pointer,
        Overlay::InnerLimit,
        Overlay::OuterLimit,
        Overlay::Hand,
        Overlay::Frames,
        Overlay::SingularityGlobe,
        Overlay::TwistReferences,
    ];
    let display = overlays.with(Overlay::Paths, overlays.shows(Overlay::Pointer));
    OF_ARM.into_iter().fold(display, |display, overlay| display.with(overlay, false))
}

/// Measures the limbs of a figure as later versions do: stereographic maps in Root space instead of
/// that of the upper joint's parent, orientations of hands in the frames of their joints.
fn convert_limbs(figure: &mut Document) {
    for index in 0..figure.rig.targets.len() {
        let target = figure.rig.targets[index];
        let axes = figure.rig.limb_axes(target.joint);
        let frame = Mat3A::from_quat(target.hand_frame(figure.skeleton()));
        let Some(limb) = figure.rig.targets[index].limb_mut() else { continue };
        if let Some(axes) = axes.filter(|_| limb.reference == TwistReferenceKind::Stereographic) {
            let in_root = |direction: Vec3| axes.transpose() * direction;
            let map = Stereographic::default();
            let map = Stereographic::from_saved(in_root(map.singular()), in_root(map.up()));
            limb.map = map.unwrap_or_default();
        }
        if frame == Mat3A::IDENTITY {
            continue;
        }
        let turned = |Vec3 { x, y, z }: Vec3, near| {
            let rotation = Mat3A::from_euler(glam::EulerRot::ZYX, z, y, x);
            nearest_angles(frame.transpose() * rotation * frame, near)
        };
        limb.orientation = limb.orientation.map(|angles| turned(angles, angles));
        let channel = Channel::TargetOrientation(target.joint);
        let mut last = None;
        let knots = figure.keys.track(channel).map_or(Vec::new(), |keys| keys.knots().to_vec());
        for knot in knots {
            let value = turned(knot.value, last.unwrap_or(knot.value));
            last = Some(value);
            figure.keys.insert_key(channel, Knot { value, slopes: None, ..knot });
        }
    }
}

/// The arm of a document of version 2.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Arm {
    /// The Cursor in Root space.
    cursor: Vec3,
    /// The Cursor in the world, while it is pinned.
    pin: Vec3,
    is_pinned: bool,
    twist: f32,
    /// The shoulder in the world.
    root: Vec3,
    bones: TwoBone,
    reference: TwistReferenceKind,
    pole: Vec3,
    /// State from which the pose continues.
    state: IkState,
    soft_reach: SoftReach,
    influence: f32,
    fk: Fk,
    hand_space: HandSpace,
    hand_angles: Vec3,
    /// Roll of the forearm, whole turns included.
    roll: f32,
}

impl Default for Arm {
    fn default() -> Self {
        let cursor = Vec3::new(250.0, 120.0, 60.0);
        let pointer = Pointer::towards(cursor, Pointer::default());
        Self {
            cursor,
            pin: cursor,
            is_pinned: false,
            twist: 0.0,
            root: Vec3::ZERO,
            bones: TwoBone::default(),
            reference: TwistReferenceKind::default(),
            pole: Vec3::new(100.0, 300.0, -100.0),
            state: IkState { pointer, transported: None },
            soft_reach: SoftReach::default(),
            influence: 1.0,
            fk: Fk::default(),
            hand_space: HandSpace::default(),
            hand_angles: Vec3::ZERO,
            roll: 0.0,
        }
    }
}

/// Angles of a joint for the angles of a ball joint of the arm, R_y · R_z · R_x: see
/// [`SkeletonRig::BALL_FRAME`].
fn ball(angles: Vec3) -> Vec3 {
    Vec3::new(angles.x, -angles.z, angles.y)
}

/// Angles of the hinge for a bend of the elbow.
fn hinge(bend: Vec3) -> Vec3 {
    Vec3::new(0.0, 0.0, bend.x)
}

impl Arm {
    /// The arm as a rig. The twist of a target without keys is transported from the frame of the
    /// file; that of one with keys was measured from the stereographic direction.
    fn rig(&self, is_unkeyed: bool) -> SkeletonRig {
        let mut rig = SkeletonRig::arm(self.bones);
        let rotations = [
            (SkeletonRig::UPPER, ball(self.fk.shoulder)),
            (SkeletonRig::LOWER, Vec3::Z * self.fk.bend),
        ];
        let (turns_hand, hand) = (self.hand_space == HandSpace::World, ball(self.hand_angles));
        let own_hand = (SkeletonRig::HAND, if turns_hand { Vec3::ZERO } else { hand });
        let skeleton = rig.skeleton_mut();
        skeleton.write_local(SkeletonRig::ROOT, |joint| joint.offset = self.root);
        for (joint, rotation) in rotations.into_iter().chain([own_hand]) {
            skeleton.write_local(joint, |joint| joint.rotation = rotation);
        }
        let is_transported = self.reference == TwistReferenceKind::Transport;
        let posture = self.posture(is_unkeyed);
        let target = &mut rig.targets[0];
        (target.home, target.pin, target.is_pinned) = (self.cursor, self.pin, self.is_pinned);
        target.influence = self.influence;
        if let Some(limb) = target.limb_mut() {
            (limb.reference, limb.twist) = match self.state.transported {
                Some(frame) if is_transported && !is_unkeyed => {
                    (TwistReferenceKind::Stereographic, self.stereographic_twist(frame))
                }
                None if is_transported && !is_unkeyed => {
                    (TwistReferenceKind::Stereographic, self.twist)
                }
                _ => (self.reference, self.twist),
            };
            limb.pole = Some(self.pole);
            limb.soft_reach = self.soft_reach;
            limb.fk_stretch = self.fk.stretch;
            limb.orientation = turns_hand.then_some(hand);
        }
        rig.posture = posture.map(|posture| {
            let limbs = [(SkeletonRig::LOWER, posture)].into_iter().collect();
            Posture { limbs, ..Posture::default() }.into()
        });
        rig
    }

    /// The twist measured from the stereographic direction instead of a transported one.
    fn stereographic_twist(&self, transported: TransportedFrame) -> f32 {
        let pointer = Pointer::towards(transported.direction, self.state.pointer);
        remeasured(self.twist, TransportedFrame::new(pointer).turn_to(transported), 0.0)
    }

    /// The posture that continues from the state of the arm; `None` if its pose does not depend on
    /// that.
    fn posture(&self, is_unkeyed: bool) -> Option<LimbPosture> {
        let cursor = if self.is_pinned { self.pin - self.root } else { self.cursor };
        let pointer = self.state.pointer;
        let transported = self.state.transported.filter(|_| is_unkeyed);
        let is_transported = self.reference == TwistReferenceKind::Transport;
        let is_singular = Vec2::new(cursor.x, cursor.z) == Vec2::ZERO;
        let whole_turns = self.hand_space == HandSpace::World && self.roll.abs() > 3.0;
        let [pointer, elbow] = match transported {
            Some(frame) if is_transported => [frame.direction, frame.outward],
            _ if is_singular => [pointer.direction, self.reference().outward(pointer, transported)],
            _ if whole_turns => {
                let pointer = Pointer::towards(cursor, pointer);
                [pointer.direction, self.reference().outward(pointer, transported)]
            }
            _ => return None,
        };
        let hand = whole_turns.then(|| self.hand_in_pose(cursor));
        Some(LimbPosture { pointer, elbow, bend_axis: Vec3::NEG_Z, bend: Vec3::Y, hand })
    }

    fn reference(&self) -> TwistReference {
        match self.reference {
            TwistReferenceKind::Up => TwistReference::Up,
            TwistReferenceKind::Pole => TwistReference::Pole(self.pole),
            TwistReferenceKind::Transport => TwistReference::Transport,
            TwistReferenceKind::Stereographic | TwistReferenceKind::Fk => {
                TwistReference::Stereographic(Stereographic::default())
            }
        }
    }

    /// Angles of the hand's joint in the pose, with the whole turns of its roll.
    fn hand_in_pose(&self, cursor: Vec3) -> Vec3 {
        let ik = Ik { bones: self.bones, reference: self.reference(), soft_reach: self.soft_reach };
        let solved = ik.solve(cursor, self.twist, self.state).pose;
        let pose = blended(self.fk, &solved, self.influence, self.bones, cursor);
        let lower = limb_rotations(&pose).1;
        let own = lower.transpose() * angle::euler_rotation(self.hand_angles);
        ball(angle::euler_angles(own, Vec3::new(self.roll, 0.0, 0.0)))
    }

    /// Adds the keys of a channel of the arm to the document of its rig.
    fn add_keys(&self, fields: &ChannelFields, document: &mut Document) -> Result<(), FieldError> {
        let Some(channel) = ArmChannel::named(fields) else { return Ok(()) };
        let (quantity, to, converted) = channel.row(self.hand_space);
        if document.keys.has(to) {
            return Err("channel must have one entry, got a second".into());
        }
        for knot in fields.knots(quantity)? {
            let slopes = knot.slopes.map(|Slopes { arriving, leaving }| Slopes {
                arriving: converted(arriving),
                leaving: converted(leaving),
            });
            // Angles of the arm were never interpolated along the shortest way.
            let interpolation = match knot.interpolation {
                Interpolation::Slerp => Interpolation::Linear,
                other => other,
            };
            let value = converted(knot.value);
            document.keys.insert_key(to, Knot { value, slopes, interpolation, ..knot });
        }
        Ok(())
    }
}

/// A channel of the arm in version 2.
#[derive(Clone, Copy, PartialEq, Eq)]
enum ArmChannel {
    Hand,
    Twist,
    Root,
    Upper,
    Lower,
    Pin,
    Pinned,
    Pole,
    Influence,
    Shoulder,
    Bend,
    Stretch,
    HandOrientation,
}

impl ArmChannel {
    /// The channel of the arm that fields name; `None` for one of the skeleton or of an overlay.
    fn named(fields: &ChannelFields) -> Option<Self> {
        Some(match fields.channel.as_str() {
            "hand" => Self::Hand,
            "twist" => Self::Twist,
            "root" => Self::Root,
            "upper" => Self::Upper,
            "lower" => Self::Lower,
            "pin" => Self::Pin,
            "pinned" => Self::Pinned,
            "pole" => Self::Pole,
            "influence" => Self::Influence,
            "shoulder" => Self::Shoulder,
            "bend" => Self::Bend,
            "stretch" => Self::Stretch,
            "hand_orientation" => Self::HandOrientation,
            _ => return None,
        })
    }

    /// Kind of the values, the channel of the rig, and the conversion of values and slopes.
    fn row(self, hand: HandSpace) -> (Quantity, Channel, fn(Vec3) -> Vec3) {
        use SkeletonRig as Rig;
        let same: fn(Vec3) -> Vec3 = |value| value;
        let lower: JointId = Rig::LOWER;
        match self {
            Self::Hand => (Quantity::Point, Channel::Target(lower), same),
            Self::Pin => (Quantity::Point, Channel::Pin(lower), same),
            Self::Pinned => (Quantity::Switch, Channel::Pinned(lower), same),
            Self::Twist => (Quantity::Angle, Channel::TargetTwist(lower), same),
            Self::Root => (Quantity::Point, Channel::Offset(Rig::ROOT), same),
            Self::Upper => (Quantity::Length, Channel::Length(Rig::UPPER), same),
            Self::Lower => (Quantity::Length, Channel::Length(lower), same),
            Self::Pole => (Quantity::Point, Channel::TargetPole(lower), same),
            Self::Influence => (Quantity::Fraction, Channel::TargetInfluence(lower), same),
            Self::Stretch => (Quantity::Length, Channel::Stretch(lower), same),
            Self::Shoulder => (Quantity::Rotation, Channel::Rotation(Rig::UPPER), ball),
            Self::Bend => (Quantity::Angle, Channel::Rotation(lower), hinge),
            Self::HandOrientation => {
                let channel = match hand {
                    HandSpace::LowerLimb => Channel::Rotation(Rig::HAND),
                    HandSpace::World => Channel::TargetOrientation(lower),
                };
                (Quantity::Rotation, channel, ball)
            }
        }
    }
}

/// The space that the hand's angles are measured in.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
enum HandSpace {
    #[default]
    LowerLimb,
    World,
}

#[derive(Deserialize)]
pub struct ArmFields {
    cursor: Option<JsonPoint>,
    pin: Option<JsonPoint>,
    pinned: Option<bool>,
    twist: Option<JsonNumber>,
    root: Option<JsonPoint>,
    upper: Option<JsonNumber>,
    lower: Option<JsonNumber>,
    facing: Option<JsonObject<FacingFields>>,
    twist_reference: Option<JsonObject<TwistReferenceFields>>,
    soft_reach: Option<JsonObject<SoftReachFields>>,
    influence: Option<Fraction>,
    fk: Option<JsonObject<FkFields>>,
    hand_orientation: Option<JsonObject<HandOrientationFields>>,
}

#[derive(Deserialize)]
struct FacingFields {
    direction: JsonPoint,
    heading: JsonNumbers<2>,
}

#[derive(Deserialize)]
struct TwistReferenceFields {
    kind: Option<TwistReferenceKind>,
    pole: Option<JsonPoint>,
    transported: Option<JsonObject<TransportedFields>>,
}

#[derive(Deserialize)]
struct TransportedFields {
    direction: JsonPoint,
    outward: JsonPoint,
}

#[derive(Deserialize)]
struct FkFields {
    shoulder: Option<JsonPoint>,
    bend: Option<JsonNumber>,
    stretch: Option<Above0>,
}

#[derive(Deserialize)]
struct HandOrientationFields {
    space: Option<HandSpace>,
    angles: Option<JsonPoint>,
    roll: Option<JsonNumber>,
}

impl ArmFields {
    fn arm(self) -> Result<Arm, FieldError> {
        let default = Arm::default();
        let bones = TwoBone::new(
            value_or(self.upper, default.bones.upper()),
            value_or(self.lower, default.bones.lower()),
        )
        .or_else(|LengthError { bone, value }| {
            let reason = format!("must be finite and above 0, got {value}");
            Err(reason).at(bone.to_string().as_str())
        })?;
        let mut arm = Arm {
            cursor: value_or(self.cursor, default.cursor),
            pin: value_or(self.pin, default.pin),
            is_pinned: self.pinned.unwrap_or(self.pin.is_some()),
            twist: value_or(self.twist, default.twist),
            root: value_or(self.root, default.root),
            bones,
            influence: value_or(self.influence, default.influence),
            ..default
        };
        let cursor = if arm.is_pinned { arm.pin - arm.root } else { arm.cursor };
        arm.state.pointer = Pointer::towards(cursor, Pointer::default());
        if let Some(JsonObject(fields)) = self.twist_reference {
            arm.reference = fields.kind.unwrap_or(arm.reference);
            arm.pole = value_or(fields.pole, arm.pole);
            let frame = fields.transported.map(|JsonObject(fields)| fields.frame());
            arm.state.transported = frame.transpose().at("transported").at("twist_reference")?;
        }
        if let Some(JsonObject(fields)) = self.soft_reach {
            arm.soft_reach = fields.soft_reach().at("soft_reach")?;
        }
        if let Some(JsonObject(fields)) = self.fk {
            arm.fk = fields.fk();
        }
        if let Some(JsonObject(fields)) = self.hand_orientation {
            arm.hand_space = fields.space.unwrap_or_default();
            arm.hand_angles = value_or(fields.angles, arm.hand_angles);
            arm.roll = value_or(fields.roll, arm.roll);
        }
        if let Some(JsonObject(fields)) = self.facing {
            arm.state.pointer = fields.facing().at("facing")?;
        }
        Ok(arm)
    }
}

/// Tolerance for unit vectors in a file: the maximum difference of a length from 1, and the maximum
/// absolute cosine of the angle between two vectors that must be perpendicular.
const UNIT_TOLERANCE: f32 = 1e-3;

/// Checks that the length of a vector is 1 within [`UNIT_TOLERANCE`], and returns the normalized
/// vector. If the length is 1 within rounding, returns the vector unchanged, bit for bit.
fn unit_vector(vector: Vec3) -> Result<Vec3, String> {
    const ROUNDING: f32 = 1e-6;
    let length = vector.length();
    if (length - 1.0).abs() > UNIT_TOLERANCE {
        return Err(format!("must have length 1, got {length}"));
    }
    Ok(if (length - 1.0).abs() <= ROUNDING { vector } else { vector.normalize() })
}

impl FacingFields {
    fn facing(self) -> Result<Pointer, FieldError> {
        let direction = unit_vector(self.direction.0).at("direction")?;
        let [x, z] = self.heading.0;
        let heading = unit_vector(Vec3::new(x, z, 0.0)).at("heading")?.truncate();
        let flat = Vec2::new(direction.x, direction.z);
        if flat.length() > UNIT_TOLERANCE && flat.normalize().distance(heading) > UNIT_TOLERANCE {
            let reason = format!("must be `direction` as seen from above, got [{x}, {z}]");
            return Err(reason).at("heading");
        }
        Ok(Pointer { direction, heading })
    }
}

impl TransportedFields {
    fn frame(self) -> Result<TransportedFrame, FieldError> {
        let direction = unit_vector(self.direction.0).at("direction")?;
        let outward = unit_vector(self.outward.0).at("outward")?;
        if self.direction.0.dot(self.outward.0).abs() > UNIT_TOLERANCE {
            let [x, y, z] = self.outward.0.to_array();
            let reason = format!("must be perpendicular to `direction`, got [{x}, {y}, {z}]");
            return Err(reason).at("outward");
        }
        Ok(TransportedFrame { direction, outward })
    }
}

impl FkFields {
    fn fk(self) -> Fk {
        let default = Fk::default();
        Fk {
            shoulder: value_or(self.shoulder, default.shoulder),
            bend: value_or(self.bend, default.bend),
            stretch: value_or(self.stretch, default.stretch),
        }
    }
}
