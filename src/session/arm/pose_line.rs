use serde_json::{Map, Value, json};

use crate::document::{Arm, TwistReferenceKind};
use crate::kinematics::angle::wrapped;
use crate::kinematics::ik::IkState;
use crate::kinematics::soft_reach::SoftReach;
use crate::kinematics::twist::{angle_from_limb, remeasured};
use crate::kinematics::two_bone::Pointer;

/// The pose of the arm as a JSON line for `ik-arm solve`. For a Cursor at the shoulder, the line
/// does not give the direction of the Pointer.
pub(in crate::session) fn of(arm: &Arm) -> String {
    let arm = if arm.influence < 1.0 { arm.switched_to_ik() } else { *arm };
    // A single line has no previous pose to transport the twist from, and no joint angles.
    let arm = match arm.twist_reference {
        TwistReferenceKind::Transport | TwistReferenceKind::Fk => {
            arm.with_twist_reference(TwistReferenceKind::Stereographic)
        }
        _ => arm,
    };
    let mut line = Map::new();
    let mut set = |field: &str, value: Value| line.insert(field.to_owned(), value);
    set("hand", json!(arm.cursor_in_root().to_array()));
    set("upper", json!(arm.bones.upper()));
    set("lower", json!(arm.bones.lower()));
    set("root", json!(arm.root.to_array()));
    set("twist_deg", json!(twist_without_history(&arm).to_degrees()));
    match arm.twist_reference {
        TwistReferenceKind::Up => None,
        TwistReferenceKind::Pole => set("reference", json!({ "pole": arm.pole.to_array() })),
        TwistReferenceKind::Stereographic
        | TwistReferenceKind::Transport
        | TwistReferenceKind::Fk => set("reference", json!("stereographic")),
    };
    let (soft_reach, default) = (arm.soft_reach, SoftReach::default());
    // An angle just below π may round to 180°, which is out of range.
    let min_elbow_angle_deg = soft_reach.min_elbow_angle().to_degrees().min(180.0_f32.next_down());
    for (field, value, default) in [
        ("softness", soft_reach.softness(), default.softness()),
        ("max_stretch", soft_reach.max_stretch(), default.max_stretch()),
        ("min_elbow_angle_deg", min_elbow_angle_deg, default.min_elbow_angle().to_degrees()),
    ] {
        if value != default {
            set(field, json!(value));
        }
    }
    Value::Object(line).to_string()
}

/// The twist in radians that gives the same elbow when the arm is solved without a previous pose.
fn twist_without_history(arm: &Arm) -> f32 {
    const SAME: f32 = 1e-6;
    let (cursor, outward) = (arm.cursor_in_root(), arm.solve().pose.outward());
    let twist = wrapped(arm.twist);
    let alone = arm.ik().solve(cursor, twist, IkState::default()).pose;
    if alone.outward().distance(outward) < SAME {
        return twist;
    }
    let pointer = Pointer::towards(cursor, Pointer::default());
    remeasured(angle_from_limb(pointer, outward), 0.0, arm.reference().angle(pointer, None))
}
