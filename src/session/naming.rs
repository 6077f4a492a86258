use super::{Action, Grip, PoseMode};
use crate::document::{Channel, Overlay, RigKind};

/// What an action does to the document, as in "Undo move hand"; nothing if it leaves it alone.
pub(super) fn of(action: &Action) -> Option<&'static str> {
    Some(match action {
        Action::SetHand(_) | Action::SetPin(_) => "move hand",
        Action::SetTwist(_) => "spin elbow",
        Action::SetRoot(_) => "move shoulder",
        Action::PinHand(true) => "pin hand",
        Action::PinHand(false) => "unpin hand",
        Action::SetTwistReference(_) => "change swivel",
        Action::SetPole(_) => "move pole",
        Action::SetSoftReach(_) => "change softness",
        Action::SetInfluence(_) => "blend FK and IK",
        Action::SwitchTo(PoseMode::Hand) => "switch to IK",
        Action::SwitchTo(PoseMode::Angles) => "switch to FK",
        Action::SetShoulder(_) => "turn shoulder",
        Action::SetBend(_) => "bend elbow",
        Action::SetWrist(_) | Action::SetWristSpace(_) => "turn hand",
        Action::SetUpper(_) | Action::SetLower(_) => "change length",
        Action::ResetPose => "reset pose",
        Action::ResetAll => "reset all",
        Action::Show(layer, _) => of_layer(*layer),
        Action::ShowRig(RigKind::Arm) => "show arm",
        Action::ShowRig(RigKind::Skeleton) => "show skeleton",
        Action::AddChild { .. } | Action::AddJoint { .. } => "add joint",
        Action::AddRoot => "add root",
        Action::Delete(joints) | Action::Dissolve(joints) if joints.len() == 1 => "delete joint",
        Action::Delete(_) | Action::Dissolve(_) => "delete joints",
        Action::Rename { .. } => "rename joint",
        Action::Reparent { .. } => "re-parent joint",
        Action::SetRotation { .. } => "turn joint",
        Action::SetAxis { .. } => "change bone",
        Action::SetLimit { .. } => "change limit",
        Action::SetLocked { locked: true, .. } => "lock joint",
        Action::SetLocked { locked: false, .. } => "unlock joint",
        Action::SetFollowPath(_) => "change slither",
        Action::SetTranslation(_) => "move skeleton",
        Action::AddTarget(_) => "add target",
        Action::RemoveTarget(_) => "remove target",
        Action::SetTarget(_) => "change target",
        Action::SetSolver(_) | Action::SetIterationsPerFrame(_) => "change solver",
        Action::Step => "solver step",
        Action::ResetSolver => "reset solver",
        Action::Key(channels) => match channels[..] {
            [Channel::Hand] => "key hand",
            [Channel::Twist] => "key elbow spin",
            _ => "set keys",
        },
        Action::DeleteKeys(_) | Action::ClearChannels(_) => "delete keys",
        Action::MoveKeys { .. } => "move keys",
        Action::PasteKeys => "paste keys",
        Action::SetTimeline(_) => "change timeline",
        Action::SetMetres(_) => "change unit",
        _ => return None,
    })
}

fn of_layer(layer: Overlay) -> &'static str {
    match layer {
        Overlay::Cursor => "toggle Cursor",
        Overlay::Pointer => "toggle Pointer",
        Overlay::InnerLimit => "toggle Inner Limit",
        Overlay::OuterLimit => "toggle Outer Limit",
        Overlay::GridXy => "toggle XY grid",
        Overlay::GridXz => "toggle XZ grid",
        Overlay::GridYz => "toggle YZ grid",
        Overlay::Ground => "toggle ground",
        Overlay::Axes => "toggle axes",
        Overlay::Labels => "toggle labels",
        Overlay::Shadow => "toggle shadow",
        Overlay::Trail => "toggle motion trail",
        Overlay::OnionSkins => "toggle onion skins",
        Overlay::Globe => "toggle singularity globe",
        Overlay::References => "toggle references",
        Overlay::Hand => "toggle hand",
    }
}

/// What a drag does.
pub(super) fn of_drag(grip: Grip) -> &'static str {
    match grip {
        Grip::Hand(_) => "move hand",
        Grip::Pole(_) => "move pole",
        Grip::Shoulder(_) => "turn shoulder",
        Grip::Bend => "bend elbow",
        Grip::Target(..) => "move target",
        Grip::Tip(..) => "pose joints",
        Grip::Ring(..) => "turn joint",
    }
}
