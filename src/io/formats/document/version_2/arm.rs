use glam::{Vec2, Vec3};
use serde::Deserialize;

use crate::document::{Channel, Document, Quantity, SkeletonRig};
use crate::io::formats::document::keys::ChannelFields;
use crate::io::json::FieldError;
use crate::kinematics::angle;
use crate::kinematics::fk::{Fk, blended, limb_rotations};
use crate::kinematics::ik::{Ik, IkState};
use crate::kinematics::limb_ik::LimbPosture;
use crate::kinematics::skeleton::JointId;
use crate::kinematics::soft_reach::SoftReach;
use crate::kinematics::spline::{Interpolation, Knot, Slopes};
use crate::kinematics::twist::{
    Stereographic, TransportedFrame, TwistReference, TwistReferenceKind, remeasured,
};
use crate::kinematics::two_bone::{Pointer, TwoBone};
use crate::rig::Posture;

/// The arm of a document of version 2.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Arm {
    /// The Cursor in Root space.
    pub(super) cursor: Vec3,
    /// The Cursor in the world, while it is pinned.
    pub(super) pin: Vec3,
    pub(super) is_pinned: bool,
    pub(super) twist: f32,
    /// The shoulder in the world.
    pub(super) root: Vec3,
    pub(super) bones: TwoBone,
    pub(super) reference: TwistReferenceKind,
    pub(super) pole: Vec3,
    /// State from which the pose continues.
    pub(super) state: IkState,
    pub(super) soft_reach: SoftReach,
    pub(super) influence: f32,
    pub(super) fk: Fk,
    pub(super) hand_space: HandSpace,
    pub(super) hand_angles: Vec3,
    /// Roll of the forearm, whole turns included.
    pub(super) roll: f32,
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
    pub(super) fn rig(&self, is_unkeyed: bool) -> SkeletonRig {
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
        target.orientation = turns_hand.then_some(hand);
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
    pub(super) fn add_keys(
        &self,
        fields: &ChannelFields,
        document: &mut Document,
    ) -> Result<(), FieldError> {
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
pub(super) enum ArmChannel {
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
    pub(super) fn named(fields: &ChannelFields) -> Option<Self> {
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
pub(super) enum HandSpace {
    #[default]
    LowerLimb,
    World,
}
