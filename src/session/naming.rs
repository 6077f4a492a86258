use super::{Action, Grip, Lead};
use crate::document::{Channel, Layer, RigKind};

/// What an action does to the document, as in "Undo move hand"; nothing if it leaves it alone.
pub(super) fn of(action: &Action) -> Option<&'static str> {
    Some(match action {
        Action::SetHand(_) | Action::SetPin(_) => "move hand",
        Action::SetElbowSpin(_) => "spin elbow",
        Action::SetRoot(_) => "move shoulder",
        Action::PinHand(true) => "pin hand",
        Action::PinHand(false) => "unpin hand",
        Action::SetSwivel(_) => "change swivel",
        Action::SetPole(_) => "move pole",
        Action::SetSoftening(_) => "change softness",
        Action::SetWeight(_) => "blend FK and IK",
        Action::SwitchTo(Lead::Hand) => "switch to IK",
        Action::SwitchTo(Lead::Angles) => "switch to FK",
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
        Action::SetSlither(_) => "change slither",
        Action::SetTranslation(_) => "move skeleton",
        Action::AddTarget(_) => "add target",
        Action::RemoveTarget(_) => "remove target",
        Action::SetTarget(_) => "change target",
        Action::SetSolver(_) | Action::SetIterationsPerFrame(_) => "change solver",
        Action::Step => "solver step",
        Action::ResetSolver => "reset solver",
        Action::Key(channels) => match channels[..] {
            [Channel::Hand] => "key hand",
            [Channel::ElbowSpin] => "key elbow spin",
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

fn of_layer(layer: Layer) -> &'static str {
    match layer {
        Layer::Cursor => "toggle Cursor",
        Layer::Pointer => "toggle Pointer",
        Layer::InnerLimit => "toggle Inner Limit",
        Layer::OuterLimit => "toggle Outer Limit",
        Layer::GridXy => "toggle XY grid",
        Layer::GridXz => "toggle XZ grid",
        Layer::GridYz => "toggle YZ grid",
        Layer::Ground => "toggle ground",
        Layer::Axes => "toggle axes",
        Layer::Labels => "toggle labels",
        Layer::Shadow => "toggle shadow",
        Layer::Trail => "toggle motion trail",
        Layer::OnionSkins => "toggle onion skins",
        Layer::Globe => "toggle singularity globe",
        Layer::References => "toggle references",
        Layer::Hand => "toggle hand",
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
