use glam::Vec3;

use super::key::Key;
use super::pose_mode::PoseMode;
use crate::document::{
    Channel, FollowPath, HandSpace, Overlay, RigKind, Target, Timeline, TwistReferenceKind,
};
use crate::kinematics::chain_ik::SolverOptions;
use crate::kinematics::skeleton::{JointId, Limit};
use crate::kinematics::soft_reach::SoftReach;

/// A change of the document. Each is one undo step and has a label.
#[derive(Clone, Debug, PartialEq)]
pub enum EditAction {
    /// Moves the Cursor, in Root space.
    SetHand(Vec3),
    /// Sets the Socket twist in radians; wraps around.
    SetTwist(f32),
    /// Moves the shoulder, in world space.
    SetRoot(Vec3),
    /// Moves the point in world space to which the hand is pinned.
    SetPin(Vec3),
    /// Pins the hand to the world, or unpins it; the hand does not move.
    PinHand(bool),
    /// Changes the twist reference; the elbow does not move.
    SetTwistReference(TwistReferenceKind),
    /// Moves the pole at which the elbow points, in Root space.
    SetPole(Vec3),
    /// Sets softness, stretch and the smallest elbow angle.
    SetSoftReach(SoftReach),
    /// Sets the blend from FK (0) to IK (1).
    SetInfluence(f32),
    /// Switches to FK or IK; the pose does not change.
    SwitchPoseMode(PoseMode),
    /// Sets the FK angles of the shoulder about x, y and z in radians.
    SetShoulder(Vec3),
    /// Sets the FK bend of the elbow in radians.
    SetBend(f32),
    /// Sets the angles of the hand about x, y and z in radians.
    SetHandOrientation(Vec3),
    /// Changes the space of the hand's angles; the hand does not turn.
    SetHandSpace(HandSpace),
    /// Sets the length of the upper limb.
    SetUpper(f32),
    /// Sets the length of the lower limb.
    SetLower(f32),
    /// Resets the arm, or the skeleton to its bind pose; the display stays.
    ResetPose,
    /// Resets the pose, the display and the camera.
    ResetAll,
    /// Shows or hides an overlay.
    ShowOverlay(Overlay, bool),
    /// Shows the arm or the skeleton.
    ShowRig(RigKind),

    /// Adds a child at the tip of a joint. Its bone ends at `tip` in world space, else it continues
    /// the bone of its parent.
    AddChild {
        /// The joint that gets a child.
        parent: JointId,
        /// End of the new bone, in world space.
        tip: Option<Vec3>,
    },
    /// Adds a child to the selected joint, else to the last one, else to a new root.
    AddJoint {
        /// End of the new bone, in world space.
        tip: Option<Vec3>,
    },
    /// Adds a joint without a parent.
    AddRoot,
    /// Deletes joints and all their descendants.
    DeleteJoints(Vec<JointId>),
    /// Deletes joints; their children are attached to the next remaining ancestor and do not move.
    DissolveJoints(Vec<JointId>),
    /// Renames a joint; names are unique.
    RenameJoint {
        /// The joint.
        joint: JointId,
        /// Its new name.
        name: String,
    },
    /// Attaches a joint to another parent; the joint does not move.
    ReparentJoint {
        /// The joint.
        joint: JointId,
        /// Its new parent; `None` for a root.
        parent: Option<JointId>,
    },
    /// Sets the Euler angles of a joint about x, y and z in radians.
    SetRotation {
        /// The joint.
        joint: JointId,
        /// Its angles.
        rotation: Vec3,
    },
    /// Sets the bone of a joint, from base to tip.
    SetAxis {
        /// The joint.
        joint: JointId,
        /// Its bone.
        axis: Vec3,
    },
    /// Sets or removes the limit of an angle.
    SetLimit {
        /// The joint.
        joint: JointId,
        /// 0, 1 or 2 for x, y or z.
        axis: usize,
        /// Its limit; `None` for unlimited.
        limit: Option<Limit>,
    },
    /// Locks or unlocks a joint: solvers do not turn locked joints.
    SetLocked {
        /// The joint.
        joint: JointId,
        /// Whether it is locked.
        locked: bool,
    },
    /// Sets the path that the skeleton follows, or none.
    SetFollowPath(Option<FollowPath>),
    /// Moves the origin of the skeleton, in world space.
    SetTranslation(Vec3),

    /// Adds a target at the tip of a joint.
    AddTarget(JointId),
    /// Removes the target of a joint, with its keys.
    RemoveTarget(JointId),
    /// Replaces the target of the joint that it names.
    SetTarget(Target),
    /// Sets the solver and its options.
    SetSolver(SolverOptions),
    /// Sets the iterations that a run makes per frame.
    SetIterationsPerFrame(u32),
    /// Makes one solver iteration.
    StepSolver,
    /// Resets the skeleton to the pose before the first iteration.
    ResetSolver,

    /// Keys channels at the playhead with the values that are shown.
    Key(Vec<Channel>),
    /// Deletes keys.
    DeleteKeys(Vec<Key>),
    /// Deletes all keys of channels.
    ClearChannels(Vec<Channel>),
    /// Moves keys, named by their times before the transaction.
    MoveKeys {
        /// The keys.
        keys: Vec<Key>,
        /// The distance in seconds.
        by: f64,
    },
    /// Pastes the copied keys at the playhead.
    PasteKeys,
    /// Sets start, end and frame rate.
    SetTimeline(Timeline),
    /// Sets the length of a unit in exports, in metres; `None` for the default.
    SetMetres(Option<f32>),
}
