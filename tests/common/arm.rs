//! The arm of a document in the words of E. Palmieri's report: its Cursor, Socket twist and shoulder
//! angles, from and to the joints and the target that a document has.

use glam::{DMat3, Vec3};
use ik_arm::document::{Channel, Document, Posed, SkeletonRig, Target, TwistReferenceKind};
use ik_arm::kinematics::angle;
use ik_arm::kinematics::fk::Fk;
use ik_arm::kinematics::ik::IkSolution;
use ik_arm::kinematics::skeleton::JointId;
use ik_arm::kinematics::soft_reach::{ReachLimits, SoftReach};
use ik_arm::kinematics::two_bone::{LengthError, TwoBone, TwoBonePose};
use ik_arm::rig::LimbFrames;
use ik_arm::session::{
    Action, BakeAction, DisplayEdit, Edit, Effect, FileAction, InspectAction, JointEdit, KeysEdit,
    PathEdit, PlaybackAction, PoseMode, ReachAction, SelectAction, Session, ShellAction, SkinEdit,
    SolverAction, SolverEdit, TargetEdit, TourAction, TransactionAction, ViewAction,
};

pub const ROOT: JointId = SkeletonRig::ROOT;
pub const UPPER: JointId = SkeletonRig::UPPER;
pub const LOWER: JointId = SkeletonRig::LOWER;
pub const WRIST: JointId = SkeletonRig::HAND;

/// The channels of the arm.
pub mod channels {
    use super::{Channel, LOWER, ROOT, UPPER, WRIST};

    pub const HAND: Channel = Channel::Target(LOWER);
    pub const PIN: Channel = Channel::Pin(LOWER);
    pub const PINNED: Channel = Channel::Pinned(LOWER);
    pub const TWIST: Channel = Channel::TargetTwist(LOWER);
    pub const POLE: Channel = Channel::TargetPole(LOWER);
    pub const INFLUENCE: Channel = Channel::TargetInfluence(LOWER);
    pub const STRETCH: Channel = Channel::Stretch(LOWER);
    pub const ROOT_OFFSET: Channel = Channel::Offset(ROOT);
    pub const UPPER_LENGTH: Channel = Channel::Length(UPPER);
    pub const LOWER_LENGTH: Channel = Channel::Length(LOWER);
    /// Its values are those of [`ball`](super::ball).
    pub const SHOULDER: Channel = Channel::Rotation(UPPER);
    /// Its values are those of [`hinge`](super::hinge).
    pub const BEND: Channel = Channel::Rotation(LOWER);
    pub const WRIST_ANGLES: Channel = Channel::Rotation(WRIST);
    pub const HAND_ORIENTATION: Channel = Channel::TargetOrientation(LOWER);

    /// All of them that the arm has by default.
    pub const ALL: [Channel; 13] = [
        HAND,
        PINNED,
        PIN,
        TWIST,
        POLE,
        ROOT_OFFSET,
        UPPER_LENGTH,
        LOWER_LENGTH,
        INFLUENCE,
        SHOULDER,
        BEND,
        STRETCH,
        WRIST_ANGLES,
    ];
}

/// Angles of a ball joint of the arm for a rotation R_y · R_z · R_x by these angles.
pub fn ball(angles: Vec3) -> Vec3 {
    Vec3::new(angles.x, -angles.z, angles.y)
}

/// The opposite of [`ball`].
pub fn of_ball(angles: Vec3) -> Vec3 {
    Vec3::new(angles.x, angles.z, -angles.y)
}

/// Angles of the elbow for a bend.
pub fn hinge(bend: f32) -> Vec3 {
    Vec3::new(0.0, 0.0, bend)
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Arm {
    pub cursor: Cursor,
    pub twist: f32,
    pub root: Vec3,
    pub bones: TwoBone,
    pub twist_reference: TwistReferenceKind,
    pub pole: Vec3,
    pub soft_reach: SoftReach,
    pub influence: f32,
    pub fk: Fk,
    pub hand_orientation: HandOrientation,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cursor {
    pub in_root: Vec3,
    pub in_world: Vec3,
    pub is_pinned: bool,
}

#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct HandOrientation {
    pub space: HandSpace,
    pub angles: Vec3,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum HandSpace {
    #[default]
    LowerLimb,
    World,
}

impl Cursor {
    pub fn unpinned(point: Vec3) -> Self {
        Self { in_root: point, in_world: point, is_pinned: false }
    }

    pub fn pinned(point: Vec3) -> Self {
        Self { is_pinned: true, ..Self::unpinned(point) }
    }
}

impl Default for Arm {
    fn default() -> Self {
        Self::of(&Document::default())
    }
}

impl Arm {
    pub fn new(upper: f32, lower: f32) -> Result<Self, LengthError> {
        Ok(Self { bones: TwoBone::new(upper, lower)?, ..Self::default() })
    }

    /// The arm of a document that has one.
    pub fn of(document: &Document) -> Self {
        let target = target(document);
        let limb = target.limb().expect("the target of a limb");
        let skeleton = document.skeleton();
        let kept = target.orientation.map(of_ball);
        let own = of_ball(skeleton[WRIST].rotation);
        Self {
            cursor: Cursor {
                in_root: target.home,
                in_world: target.pin,
                is_pinned: target.is_pinned,
            },
            twist: limb.twist,
            root: skeleton[ROOT].offset,
            bones: {
                let [upper, lower] =
                    [UPPER, LOWER].map(|joint| skeleton[joint].axis.as_dvec3().length() as f32);
                TwoBone::new(upper, lower).expect("lengths")
            },
            twist_reference: limb.reference,
            pole: limb.pole.expect("a pole"),
            soft_reach: limb.soft_reach,
            influence: target.influence,
            fk: Fk {
                shoulder: of_ball(skeleton[UPPER].rotation),
                bend: skeleton[LOWER].rotation.z,
                stretch: limb.fk_stretch,
            },
            hand_orientation: HandOrientation {
                space: kept.map_or(HandSpace::LowerLimb, |_| HandSpace::World),
                angles: kept.unwrap_or(own),
            },
        }
    }

    /// A document with this arm.
    pub fn document(&self) -> Document {
        let mut document = Document::arm(self.bones);
        self.write(&mut document);
        document
    }

    /// Gives a document of the arm these values.
    pub fn write(&self, document: &mut Document) {
        let HandOrientation { space, angles } = self.hand_orientation;
        let is_kept = space == HandSpace::World;
        for (channel, value) in [
            (channels::UPPER_LENGTH, Vec3::X * self.bones.upper()),
            (channels::LOWER_LENGTH, Vec3::X * self.bones.lower()),
            (channels::ROOT_OFFSET, self.root),
            (channels::SHOULDER, ball(self.fk.shoulder)),
            (channels::BEND, hinge(self.fk.bend)),
        ] {
            channel.set(document, value);
        }
        if !is_kept {
            channels::WRIST_ANGLES.set(document, ball(angles));
        }
        let target = &mut document.rig.targets[0];
        target.home = self.cursor.in_root;
        target.pin = self.cursor.in_world;
        target.is_pinned = self.cursor.is_pinned;
        target.influence = self.influence;
        let limb = target.limb_mut().expect("the target of a limb");
        limb.twist = self.twist;
        limb.reference = self.twist_reference;
        limb.pole = Some(self.pole);
        limb.soft_reach = self.soft_reach;
        limb.fk_stretch = self.fk.stretch;
        target.orientation = is_kept.then(|| ball(angles));
    }

    pub fn cursor_in_root(&self) -> Vec3 {
        let Cursor { in_root, in_world, is_pinned } = self.cursor;
        if is_pinned { in_world - self.root } else { in_root }
    }

    pub fn cursor_in_world(&self) -> Vec3 {
        let Cursor { in_root, in_world, is_pinned } = self.cursor;
        if is_pinned { in_world } else { self.root + in_root }
    }

    pub fn set_cursor(&mut self, cursor: Vec3) {
        if self.cursor.is_pinned {
            self.cursor.in_world = self.root + cursor;
        } else {
            self.cursor.in_root = cursor;
        }
    }

    pub fn is_pinned(&self) -> bool {
        self.cursor.is_pinned
    }

    pub fn uses_ik(&self) -> bool {
        self.influence > 0.0
    }

    pub fn reach_limits(&self) -> ReachLimits {
        self.frames().limits
    }

    pub fn frames(&self) -> LimbFrames {
        self.document().at(0.0).arm_frames()
    }

    pub fn pose(&self) -> TwoBonePose {
        *self.frames().pose()
    }

    pub fn solve(&self) -> IkSolution {
        self.frames().solution
    }
}

/// True if a document has the joints and the target of the arm.
pub fn has_arm(document: &Document) -> bool {
    let index = document.rig.target(LOWER);
    let limb = index.and_then(|index| document.rig.targets[index].limb());
    limb.is_some_and(|limb| limb.pole.is_some())
        && document.skeleton().joints().len() > WRIST.index()
        && document.at(0.0).limb_frames(LOWER).is_some()
        && [UPPER, LOWER].into_iter().all(|joint| document.skeleton()[joint].axis != Vec3::ZERO)
}

fn target(document: &Document) -> &Target {
    &document.rig.targets[document.rig.target(LOWER).expect("a target")]
}

pub trait ArmDocument {
    fn arm(&self) -> Arm;
    fn set_arm(&mut self, arm: Arm);
    fn edit_arm(&mut self, edit: impl FnOnce(&mut Arm));
}

impl ArmDocument for Document {
    fn arm(&self) -> Arm {
        Arm::of(self)
    }

    fn set_arm(&mut self, arm: Arm) {
        arm.write(self);
    }

    fn edit_arm(&mut self, edit: impl FnOnce(&mut Arm)) {
        let mut arm = Arm::of(self);
        edit(&mut arm);
        arm.write(self);
    }
}

pub trait ArmPosed {
    fn arm(&self) -> Arm;
    fn arm_frames(&self) -> LimbFrames;
    fn arm_pose(&self) -> TwoBonePose;
    fn arm_solution(&self) -> IkSolution;
    fn hand_rotation(&self) -> DMat3;
    fn roll(&self) -> f32;
}

impl ArmPosed for Posed {
    fn arm(&self) -> Arm {
        Arm::of(self.document())
    }

    fn arm_frames(&self) -> LimbFrames {
        self.limb_frames(LOWER).expect("a limb")
    }

    fn arm_pose(&self) -> TwoBonePose {
        *self.arm_frames().pose()
    }

    fn arm_solution(&self) -> IkSolution {
        self.arm_frames().solution
    }

    fn hand_rotation(&self) -> DMat3 {
        self.document().rig.hand_rotation(self.skeleton(), LOWER).expect("a hand")
    }

    fn roll(&self) -> f32 {
        self.document().rig.hand_roll(self.skeleton(), LOWER).expect("a hand")
    }
}

/// A change of the arm, in the words of its panel.
#[derive(Clone, Debug, PartialEq)]
pub enum ArmEdit {
    SetHand(Vec3),
    SetTwist(f32),
    SetRoot(Vec3),
    SetPin(Vec3),
    PinHand(bool),
    SetTwistReference(TwistReferenceKind),
    SetPole(Vec3),
    SetSoftReach(SoftReach),
    SetInfluence(f32),
    SwitchPoseMode(PoseMode),
    SetShoulder(Vec3),
    SetBend(f32),
    SetHandOrientation(Vec3),
    SetHandSpace(HandSpace),
    SetUpper(f32),
    SetLower(f32),
    Reset,
}

impl ArmEdit {
    pub fn action(self, session: &Session) -> Action {
        let target = *target(session.shown());
        let frames = session.posed().arm_frames();
        let with = |change: &dyn Fn(&mut Target)| -> Action {
            let mut target = target;
            change(&mut target);
            TargetEdit::SetTarget(target).into()
        };
        let limb = |change: &dyn Fn(&mut ik_arm::rig::LimbSettings)| {
            with(&|target| change(target.limb_mut().expect("a limb")))
        };
        match self {
            Self::SetHand(hand) if target.is_pinned => {
                let place = frames.root.transform_point3(hand);
                with(&|target| target.pin = place)
            }
            Self::SetHand(hand) => with(&|target| target.home = hand),
            Self::SetPin(pin) => with(&|target| (target.pin, target.is_pinned) = (pin, true)),
            Self::SetTwist(twist) => limb(&|limb| limb.twist = twist),
            Self::SetPole(pole) => limb(&|limb| limb.pole = Some(pole)),
            Self::SetSoftReach(soft_reach) => limb(&|limb| limb.soft_reach = soft_reach),
            Self::SetInfluence(influence) => with(&|target| target.influence = influence),
            Self::PinHand(is_pinned) => TargetEdit::Pin { joint: LOWER, is_pinned }.into(),
            Self::SetTwistReference(reference) => {
                TargetEdit::SetReference { joint: LOWER, reference }.into()
            }
            Self::SwitchPoseMode(mode) => TargetEdit::SwitchPoseMode { joint: LOWER, mode }.into(),
            Self::SetRoot(offset) => JointEdit::SetOffset { joint: ROOT, offset }.into(),
            Self::SetShoulder(angles) => rotate(UPPER, ball(angles)),
            Self::SetBend(bend) => rotate(LOWER, hinge(bend)),
            Self::SetHandOrientation(angles) => {
                if target.orientation.is_some() {
                    let orientation = Some(ball(angles));
                    TargetEdit::SetTarget(Target { orientation, ..target }).into()
                } else {
                    rotate(WRIST, ball(angles))
                }
            }
            Self::SetHandSpace(space) => {
                TargetEdit::KeepHand { joint: LOWER, is_kept: space == HandSpace::World }.into()
            }
            Self::SetUpper(length) => JointEdit::SetLength { joint: UPPER, length }.into(),
            Self::SetLower(length) => JointEdit::SetLength { joint: LOWER, length }.into(),
            Self::Reset => DisplayEdit::ResetPose.into(),
        }
    }
}

fn rotate(joint: JointId, rotation: Vec3) -> Action {
    JointEdit::SetRotation { joint, rotation }.into()
}

pub trait ArmSession {
    fn arm(&self) -> Arm;
    fn pose(&self) -> TwoBonePose;
    fn arm_unit(&self) -> f32;
    fn edit_arm(&mut self, edit: ArmEdit);
    fn edit_arm_in_one(&mut self, edits: impl IntoIterator<Item = ArmEdit>);
}

impl ArmSession for Session {
    fn arm(&self) -> Arm {
        Arm::of(self.shown())
    }

    fn pose(&self) -> TwoBonePose {
        self.posed().arm_pose()
    }

    fn arm_unit(&self) -> f32 {
        self.history().unit()
    }

    fn edit_arm(&mut self, edit: ArmEdit) {
        let action = edit.action(self);
        self.apply(action);
    }

    fn edit_arm_in_one(&mut self, edits: impl IntoIterator<Item = ArmEdit>) {
        self.apply(TransactionAction::Begin);
        edits.into_iter().for_each(|edit| self.edit_arm(edit));
        self.apply(TransactionAction::Commit);
    }
}

/// The roll of a rotation nearest to another one, as the forearm's.
pub fn roll_of(rotation: DMat3, near: f32) -> f32 {
    angle::roll(rotation, near)
}

/// Something that a test does to a session: an action, or an edit in the words of the arm.
#[derive(Clone, Debug, PartialEq)]
pub enum Step {
    Arm(ArmEdit),
    Action(Box<Action>),
}

impl Step {
    /// The action on a session that has the arm.
    pub fn action(self, session: &Session) -> Action {
        match self {
            Self::Arm(edit) => edit.action(session),
            Self::Action(action) => *action,
        }
    }

    pub fn opens_example(&self) -> bool {
        let Self::Action(action) = self else { return false };
        matches!(**action, Action::File(FileAction::OpenExample(_)))
    }

    pub fn apply(self, session: &mut Session) -> Option<Effect> {
        match self {
            Self::Arm(edit) if has_arm(session.shown()) => {
                let action = edit.action(session);
                session.apply(action)
            }
            Self::Arm(_) => None,
            Self::Action(action) => session.apply(*action),
        }
    }
}

impl From<ArmEdit> for Step {
    fn from(edit: ArmEdit) -> Self {
        Self::Arm(edit)
    }
}

macro_rules! from_actions {
    ($($action:ty),* $(,)?) => {
        $(impl From<$action> for Step {
            fn from(action: $action) -> Self {
                Self::Action(Box::new(action.into()))
            }
        })*
    };
}

from_actions!(
    Action,
    BakeAction,
    DisplayEdit,
    Edit,
    FileAction,
    InspectAction,
    JointEdit,
    KeysEdit,
    PathEdit,
    PlaybackAction,
    ReachAction,
    SelectAction,
    ShellAction,
    SkinEdit,
    SolverAction,
    SolverEdit,
    TargetEdit,
    TourAction,
    TransactionAction,
    ViewAction,
);
