use glam::Vec3;

use super::key::Key;
use super::pose_mode::PoseMode;
use crate::document::{
    Baked, Channel, HandSpace, Overlay, PathKind, RigKind, Skin, Target, Timeline,
    TwistReferenceKind,
};
use crate::kinematics::chain_ik::SolverOptions;
use crate::kinematics::diagnosis::Remedy;
use crate::kinematics::skeleton::{JointId, Limit, RotationAxis};
use crate::kinematics::soft_reach::SoftReach;
use crate::kinematics::spline::{Interpolation, Slopes};
use crate::rig::TargetSpace;

/// A change of the document. Outside a transaction, each change is one undo step with its own
/// label.
#[derive(Clone, Debug, PartialEq)]
pub enum EditAction {
    /// Moves the Cursor to a point in Root space.
    SetHand(Vec3),
    /// Sets the Socket twist in radians, wrapped to [0, 2π).
    SetTwist(f32),
    /// Moves the shoulder to a point in world space.
    SetRoot(Vec3),
    /// Pins the hand to a point in world space.
    SetPin(Vec3),
    /// Pins the hand to the world, or unpins it; the hand does not move.
    PinHand(bool),
    /// Changes the twist reference; the elbow does not move.
    SetTwistReference(TwistReferenceKind),
    /// Moves the pole, towards which the elbow points, to a point in Root space.
    SetPole(Vec3),
    /// Sets softness, maximum stretch and minimum elbow angle.
    SetSoftReach(SoftReach),
    /// Sets the blend from FK (0) to IK (1).
    SetInfluence(f32),
    /// Switches to FK or IK; the pose does not change.
    SwitchPoseMode(PoseMode),
    /// Sets the FK angles of the shoulder about x, y and z in radians.
    SetShoulder(Vec3),
    /// Sets the FK bend of the elbow in radians.
    SetBend(f32),
    /// Sets the angles of the hand about x, y and z in radians, in the present [`HandSpace`].
    SetHandOrientation(Vec3),
    /// Changes the space of the hand's angles; the hand does not turn.
    SetHandSpace(HandSpace),
    /// Sets the length of the upper limb.
    SetUpper(f32),
    /// Sets the length of the lower limb.
    SetLower(f32),
    /// Resets the shown rig: the arm to its defaults, or the skeleton to its bind pose. The display
    /// does not change.
    ResetPose,
    /// Resets the pose, the display, the camera and the crowd.
    ResetAll,
    /// Shows or hides an overlay.
    ShowOverlay(Overlay, bool),
    /// Shows the arm or the skeleton.
    ShowRig(RigKind),

    /// Adds a child at the tip of a joint.
    AddChild {
        /// The joint that gets a child.
        parent: JointId,
        /// End of the new bone, in world space; `None` continues the parent's bone.
        tip: Option<Vec3>,
    },
    /// Adds a child to the selected joint; without a selection, to the joint with the highest
    /// index; without joints, to a new root.
    AddJoint {
        /// End of the new bone, in world space; `None` continues the parent's bone.
        tip: Option<Vec3>,
    },
    /// Adds a joint without a parent.
    AddRoot,
    /// Deletes joints and all their descendants.
    DeleteJoints(Vec<JointId>),
    /// Deletes joints; their children are attached to the next remaining ancestor and do not move.
    DissolveJoints(Vec<JointId>),
    /// Renames a joint. A name that another joint has is refused.
    RenameJoint {
        /// The joint.
        joint: JointId,
        /// The new name.
        name: String,
    },
    /// Attaches a joint to another parent; the joint does not move.
    ReparentJoint {
        /// The joint.
        joint: JointId,
        /// The new parent; `None` makes the joint a root.
        parent: Option<JointId>,
    },
    /// Sets the Euler angles of a joint about x, y and z in radians.
    SetRotation {
        /// The joint.
        joint: JointId,
        /// The angles.
        rotation: Vec3,
    },
    /// Sets the vector of a joint's bone, from base to tip.
    SetAxis {
        /// The joint.
        joint: JointId,
        /// The vector, in the joint's own space.
        axis: Vec3,
    },
    /// Sets or removes the limit of one of a joint's Euler angles.
    SetLimit {
        /// The joint.
        joint: JointId,
        /// Axis of the angle.
        axis: RotationAxis,
        /// The limit, in radians; `None` for an unlimited angle.
        limit: Option<Limit>,
    },
    /// Locks or unlocks a joint: solvers do not turn locked joints.
    SetLocked {
        /// The joint.
        joint: JointId,
        /// Whether the joint is to be locked.
        locked: bool,
    },
    /// Gives the skeleton a skin from its bones, and shows it.
    AddSkin,
    /// Shows the skin of the skeleton, its bones, or both.
    ShowSkin {
        /// Whether the skin is shown.
        skin: bool,
        /// Whether the bones are shown through the skin.
        bones: bool,
    },
    /// Makes the mesh of a file, which the skin has, a part of the document.
    PackSkin,
    /// Replaces the skin of the skeleton; `None` removes it.
    SetSkin(Option<Skin>),
    /// Sets the path that the chain of a root follows; `None` for no path.
    SetFollowPath {
        /// The root.
        root: JointId,
        /// What moves it.
        kind: Option<PathKind>,
    },
    /// Moves a root to a point of skeleton space. With
    /// [`PathKind::Head`](crate::document::PathKind::Head), the chain below it follows.
    SetHead {
        /// The root.
        root: JointId,
        /// Its new place.
        to: Vec3,
    },
    /// Moves the origin of the skeleton to a point in world space.
    SetTranslation(Vec3),
    /// Turns the skeleton, in which z points up, so that y does.
    TurnYUp,

    /// Adds a target at the tip of a joint.
    AddTarget(JointId),
    /// Removes the target of a joint, with its keys.
    RemoveTarget(JointId),
    /// Replaces the target of the joint [`Target::joint`].
    SetTarget(Target),
    /// Moves a joint's target to another space; it stays where it is in the world.
    SetTargetSpace {
        /// Joint of the target.
        joint: JointId,
        /// The space.
        space: TargetSpace,
    },
    /// Moves the pole of a joint's target to another space; it stays where it is in the world.
    SetPoleSpace {
        /// Joint of the target.
        joint: JointId,
        /// The space.
        space: TargetSpace,
    },
    /// Moves the target of a joint to where the FK pose has the tip, with the hand's orientation and the
    /// elbow's side.
    MatchTargetToFk(JointId),
    /// Writes the shown pose to the FK angles of the joints that the target of a joint moves.
    MatchFkToPose(JointId),
    /// Applies a remedy for a target that is not reached.
    ApplyRemedy {
        /// Joint of the target.
        target: JointId,
        /// The remedy.
        remedy: Remedy,
    },
    /// Sets the solver and its options.
    SetSolver(SolverOptions),
    /// Sets the number of iterations that a solver run makes per frame.
    SetIterationsPerFrame(u32),
    /// Writes the shown iterate of the solver run to the joints' own angles and offsets, and ends the
    /// run.
    ApplyPose,

    /// Keys channels at the playhead with their shown values.
    Key(Vec<Channel>),
    /// Deletes keys.
    DeleteKeys(Vec<Key>),
    /// Deletes all keys of channels.
    ClearChannels(Vec<Channel>),
    /// Moves keys in time and in value.
    MoveKeys {
        /// The keys to move, each with the time that it had before the transaction.
        keys: Vec<Key>,
        /// Shift in seconds; positive is later.
        by: f64,
        /// Change of the values. The result is kept within the values that a channel can have.
        raise: Vec3,
    },
    /// Sets the curve from each key to the next one of its channel.
    SetInterpolation(Vec<Key>, Interpolation),
    /// Sets the slopes of curves at keys, per second; `None` for those that the neighbours give.
    SetSlopes(Vec<Key>, Option<Slopes<Vec3>>),
    /// Pastes the copied keys at the playhead.
    PasteKeys,
    /// Replaces the motion by targets and path by the keys of a bake.
    Bake(Box<Baked>),
    /// Sets start, end and frame rate of the timeline.
    SetTimeline(Timeline),
    /// Sets the length of a document unit in exports, in metres; `None` for the shown rig's
    /// default.
    SetMetres(Option<f32>),
}
