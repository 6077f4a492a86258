//! The joints that a target moves, the whole body or a limb; the space in which a target or a pole is
//! fixed.

use core::num::NonZeroU32;

use egui::Ui;

use crate::document::Target;
use crate::kinematics::limb_ik::Limb;
use crate::rig::{LimbSettings, SkeletonRig, TargetKind, TargetSpace};
use crate::session::{Actions, Session, TargetEdit};
use crate::ui::widgets::{Choice, NumberField};

pub(super) fn kind(ui: &mut Ui, session: &Session, target: Target, actions: &mut Actions) {
    let no_limb = Limb::ending_at(session.skeleton(), target.joint)
        .err()
        .map(|reason| format!("No limb: {reason}"));
    let choice = Choice {
        label: "Moves",
        name: "Target kind",
        tooltip: "Choose the joints that the target moves",
        shown: match target.kind {
            TargetKind::WholeBody => "Whole body",
            TargetKind::Chain(_) => "Chain",
            TargetKind::Limb(_) => "Limb",
        },
    };
    let mut set = |kind| actions.push(TargetEdit::SetTarget(target.with_kind(kind)));
    choice.show(ui, |list| {
        let by_body = "Solve from the root, together with the other whole-body targets";
        let is_body = target.kind == TargetKind::WholeBody;
        if list.item(is_body, "Whole body", by_body, None) {
            set(TargetKind::WholeBody);
        }
        let by_chain = "Turn a number of joints above the tip, after the body";
        if list.item(target.kind.is_chain(), "Chain", by_chain, None) {
            set(TargetKind::Chain(NEW_LENGTH));
        }
        let by_limb = "Solve the two bones above the tip in closed form";
        let is_limb = target.limb().is_some();
        if list.item(is_limb, "Limb", by_limb, no_limb.as_deref()) {
            set(TargetKind::Limb(LimbSettings::default()));
        }
    });
    if let TargetKind::Chain(length) = target.kind {
        chain_length(ui, session, target, length, actions);
    }
}

/// The length of a new chain, in joints.
const NEW_LENGTH: NonZeroU32 = NonZeroU32::new(2).expect("above 0");

fn chain_length(
    ui: &mut Ui,
    session: &Session,
    target: Target,
    length: NonZeroU32,
    actions: &mut Actions,
) {
    let most = session.skeleton().ancestors(target.joint).count();
    let field = NumberField {
        name: "Chain length",
        value: length.get() as f32,
        unit: "",
        step: 1.0,
        digits: 0,
        tooltip: "Set how many joints the target turns, from its own upwards",
    };
    field.row(ui, session, "Chain length", actions, |length: f32| {
        let length = length.round().clamp(1.0, most as f32) as u32;
        let kind = NonZeroU32::new(length).map_or(target.kind, TargetKind::Chain);
        TargetEdit::SetTarget(target.with_kind(kind))
    });
}

/// Shows the choice of the target's space.
pub(super) fn of_target(ui: &mut Ui, session: &Session, target: &Target, actions: &mut Actions) {
    let choice = Choice {
        label: "Moves with",
        name: "Target space",
        tooltip: "Fix the target to the world or to a joint; it stays where it is",
        shown: name(session.rig(), target.space),
    };
    let put = |target: &mut Target, space| target.space = space;
    spaces(ui, session, target, target.space, &choice, put, |space| {
        actions.push(TargetEdit::SetTargetSpace { joint: target.joint, space });
    });
}

/// Shows the choice of the space of a limb's pole.
pub(in crate::ui) fn of_pole(
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
        shown: name(session.rig(), now),
    };
    let put = |target: &mut Target, space| {
        if let Some(limb) = target.limb_mut() {
            limb.pole_space = space;
        }
    };
    spaces(ui, session, target, now, &choice, put, |space| {
        actions.push(TargetEdit::SetPoleSpace { joint: target.joint, space });
    });
}

fn name(rig: &SkeletonRig, space: TargetSpace) -> &str {
    space.joint().and_then(|joint| rig.skeleton.joint(joint)).map_or("World", |joint| &joint.name)
}

/// Shows a choice of spaces. `put` writes a space into a target, to find out whether the target
/// could be evaluated there.
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
        let mut rig = session.rig().clone();
        let Some(index) = rig.target(target.joint) else { return };
        let joints = session.skeleton().ids().map(TargetSpace::Joint);
        for space in std::iter::once(TargetSpace::World).chain(joints) {
            put(&mut rig.targets[index], space);
            let refused = rig.check_target_spaces().err().map(|error| error.reason());
            let name = name(session.rig(), space);
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
