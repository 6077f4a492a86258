use super::drag::Grip;
use super::edit_action::EditAction;
use super::pose_mode::PoseMode;
use crate::document::{Channel, Overlay, RigKind};
use crate::kinematics::diagnosis::Remedy;

/// Label of a transaction without edits.
pub(super) const CHANGE: &str = "Change";
/// Label of the undo step by which a move of the playhead discards unkeyed edits.
pub(super) const DISCARD: &str = "Discard unkeyed change";

impl EditAction {
    /// Label of the edit's undo step, as in "Undo Move hand".
    pub fn label(&self) -> &'static str {
        match self {
            Self::SetHand(_) | Self::SetPin(_) => "Move hand",
            Self::SetTwist(_) => "Set Socket twist",
            Self::SetRoot(_) => "Move shoulder",
            Self::PinHand(true) => "Pin hand",
            Self::PinHand(false) => "Unpin hand",
            Self::SetTwistReference(_) => "Change twist reference",
            Self::SetPole(_) => "Move pole",
            Self::SetSoftReach(_) => "Change soft reach",
            Self::SetInfluence(_) => "Blend FK and IK",
            Self::SwitchPoseMode(PoseMode::Hand) => "Switch to IK",
            Self::SwitchPoseMode(PoseMode::Angles) => "Switch to FK",
            Self::SetShoulder(_) => "Turn shoulder",
            Self::SetBend(_) => "Bend elbow",
            Self::SetHandOrientation(_) | Self::SetHandSpace(_) => "Turn hand",
            Self::SetUpper(_) | Self::SetLower(_) => "Change length",
            Self::ResetPose => "Reset pose",
            Self::ResetAll => "Reset all",
            Self::ShowOverlay(overlay, _) => toggle_label(*overlay),
            Self::ShowRig(RigKind::Arm) => "Show arm",
            Self::ShowRig(RigKind::Skeleton) => "Show skeleton",
            Self::AddChild { .. } | Self::AddJoint { .. } => "Add joint",
            Self::AddRoot => "Add root",
            Self::DeleteJoints(joints) | Self::DissolveJoints(joints) if joints.len() == 1 => {
                "Delete joint"
            }
            Self::DeleteJoints(_) | Self::DissolveJoints(_) => "Delete joints",
            Self::RenameJoint { .. } => "Rename joint",
            Self::ReparentJoint { .. } => "Re-parent joint",
            Self::SetRotation { .. } => "Turn joint",
            Self::SetAxis { .. } => "Change bone",
            Self::SetLimit { .. } => "Change limit",
            Self::SetLocked { locked: true, .. } => "Lock joint",
            Self::SetLocked { locked: false, .. } => "Unlock joint",
            Self::AddSkin => "Add skin",
            Self::ShowSkin { skin: true, bones: true } => "Show skin and bones",
            Self::ShowSkin { skin: true, bones: false } => "Show skin",
            Self::ShowSkin { skin: false, .. } => "Show bones",
            Self::PackSkin => "Pack skin into file",
            Self::SetSkin(None) => "Remove skin",
            Self::SetSkin(Some(_)) => "Change skin",
            Self::SetFollowPath { .. } => "Change path",
            Self::SetHead { .. } => "Move head",
            Self::SetTranslation(_) => "Move skeleton",
            Self::TurnYUp => "Turn to y up",
            Self::AddTarget(_) => "Add target",
            Self::RemoveTarget(_) => "Remove target",
            Self::SetTarget(_) => "Change target",
            Self::MatchTargetToFk(_) => "Move target to FK",
            Self::MatchFkToPose(_) => "Write pose to FK",
            Self::SetTargetSpace { .. } => "Change target space",
            Self::SetPoleSpace { .. } => "Change pole space",
            Self::ApplyRemedy { remedy, .. } => remedy_label(remedy),
            Self::SetSolver(_) | Self::SetIterationsPerFrame(_) => "Change solver",
            Self::ApplyPose => "Apply pose",
            Self::Key(channels) => match channels[..] {
                [Channel::Hand] => "Key hand",
                [Channel::Twist] => "Key Socket twist",
                [..] => "Set keys",
            },
            Self::DeleteKeys(_) | Self::ClearChannels(_) => "Delete keys",
            Self::MoveKeys { .. } => "Move keys",
            Self::SetInterpolation(..) => "Set interpolation",
            Self::SetSlopes(..) => "Set tangents",
            Self::PasteKeys => "Paste keys",
            Self::Bake(_) => "Bake to keys",
            Self::SetTimeline(_) => "Change timeline",
            Self::SetMetres(_) => "Change unit",
        }
    }
}

impl Grip {
    /// Label of the undo step of a drag of this part.
    pub(super) fn label(self) -> &'static str {
        match self {
            Self::Hand(_) => "Move hand",
            Self::Pole(_) => "Move pole",
            Self::Root(_) => "Move shoulder",
            Self::Twist | Self::Limb => "Set Socket twist",
            Self::Shoulder(_) | Self::UpperLimb => "Turn shoulder",
            Self::Bend => "Bend elbow",
            Self::HandRing(_) => "Turn hand",
            Self::Target(..) => "Move target",
            Self::LimbPole(..) => "Move pole",
            Self::Head(..) => "Move head",
            Self::Tip(..) => "Pose joints",
            Self::Ring(..) => "Turn joint",
            Self::Orientation(..) => "Turn target",
        }
    }
}

fn remedy_label(remedy: &Remedy) -> &'static str {
    match remedy {
        Remedy::MoveTarget { .. } => "Move target",
        Remedy::Lengthen { .. } => "Lengthen bones",
        Remedy::SetRoot(_) => "Change root",
        Remedy::WidenLimits(_) => "Widen limits",
        Remedy::Unlock(_) => "Unlock joints",
        Remedy::SwitchOff(_) => "Switch off target",
        Remedy::SetWeight { .. } => "Change weight",
        Remedy::UseMethod(_) => "Change solver",
        Remedy::StartFrom(_) => "Change start",
        Remedy::AllowIterations(_) => "Allow iterations",
        Remedy::FullInfluence(_) => "Change influence",
        Remedy::Stretch { .. } | Remedy::HardLimits(_) => "Change soft reach",
    }
}

fn toggle_label(overlay: Overlay) -> &'static str {
    match overlay {
        Overlay::Cursor => "Toggle Cursor",
        Overlay::Pointer => "Toggle Pointer",
        Overlay::InnerLimit => "Toggle Inner Limit",
        Overlay::OuterLimit => "Toggle Outer Limit",
        Overlay::ElbowCircle => "Toggle elbow circle",
        Overlay::GridXy => "Toggle XY grid",
        Overlay::GridXz => "Toggle XZ grid",
        Overlay::GridYz => "Toggle YZ grid",
        Overlay::Ground => "Toggle ground",
        Overlay::Axes => "Toggle axes",
        Overlay::Labels => "Toggle labels",
        Overlay::Shadow => "Toggle shadow",
        Overlay::Trail => "Toggle motion trail",
        Overlay::OnionSkins => "Toggle onion skins",
        Overlay::FkPose => "Toggle FK pose",
        Overlay::Skin => "Toggle skin",
        Overlay::Bones => "Toggle bones",
        Overlay::Wireframe => "Toggle wireframe",
        Overlay::SkinWeights => "Toggle skin weights",
        Overlay::CompareSkinning => "Toggle comparison of skinning",
        Overlay::Frames => "Toggle frames",
        Overlay::SingularityGlobe => "Toggle singularity globe",
        Overlay::TwistReferences => "Toggle references",
        Overlay::Hand => "Toggle hand",
    }
}
