//! The space in which a target or a pole is fixed.

use egui::Ui;

use super::super::choice::Choice;
use crate::document::Target;
use crate::rig::{SkeletonRig, TargetSpace};
use crate::session::{Actions, EditAction, Session};

/// Shows the choice of the target's space.
pub(super) fn of_target(ui: &mut Ui, session: &Session, target: &Target, actions: &mut Actions) {
    let choice = Choice {
        label: "Moves with",
        name: "Target space",
        tooltip: "Fix the target to the world or to a joint; it stays where it is",
        shown: name(session.skeleton_rig(), target.space),
    };
    let put = |target: &mut Target, space| target.space = space;
    spaces(ui, session, target, target.space, &choice, put, |space| {
        actions.push(EditAction::SetTargetSpace { joint: target.joint, space });
    });
}

/// Shows the choice of the space of a limb's pole.
pub(super) fn of_pole(
    ui: &mut Ui,
    session: &Session,
    target: &Target,
    now: TargetSpace,
    actions: &mut Actions,
) {
    let choice = Choice {
        label: "Pole moves with",
        name: "Pole space",
        tooltip: "Fix the pole to the world or to a joint; it stays where it is",
        shown: name(session.skeleton_rig(), now),
    };
    let put = |target: &mut Target, space| {
        if let Some(limb) = target.limb_mut() {
            limb.pole_space = space;
        }
    };
    spaces(ui, session, target, now, &choice, put, |space| {
        actions.push(EditAction::SetPoleSpace { joint: target.joint, space });
    });
}

fn name(rig: &SkeletonRig, space: TargetSpace) -> &str {
    space.joint().and_then(|joint| rig.skeleton.joint(joint)).map_or("World", |joint| &joint.name)
}

/// Shows a choice of spaces. `put` writes a space into a target, to find out whether the target could
/// be evaluated there.
fn spaces(
    ui: &mut Ui,
    session: &Session,
    target: &Target,
    now: TargetSpace,
    choice: &Choice<'_>,
    put: impl Fn(&mut Target, TargetSpace),
    mut choose: impl FnMut(TargetSpace),
) {
    choice.show(ui, |list| {
        let mut rig = session.skeleton_rig().clone();
        let Some(index) = rig.target(target.joint) else { return };
        let joints = session.skeleton().ids().map(TargetSpace::Joint);
        for space in std::iter::once(TargetSpace::World).chain(joints) {
            put(&mut rig.targets[index], space);
            let refused = rig.check_target_spaces().err().map(|error| error.reason());
            let name = name(session.skeleton_rig(), space);
            let tooltip = match space {
                TargetSpace::World => "Stay in the world",
                TargetSpace::Joint(_) => "Move and turn with this joint",
            };
            if list.item(space == now, name, tooltip, refused) {
                choose(space);
            }
        }
    });
}
