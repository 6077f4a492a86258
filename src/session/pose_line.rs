use serde_json::{Map, Value, json};

use crate::document::{Arm, TwistReferenceKind};
use crate::kinematics::angle::wrapped;
use crate::kinematics::ik::IkState;
use crate::kinematics::soft_reach::SoftReach;
use crate::kinematics::twist::{angle_from_limb, remeasured};
use crate::kinematics::two_bone::Pointer;

/// A line that `ik-arm solve` reads, and that gives the arm as its hand would lead it to where it is.
/// A hand at the shoulder itself has no direction in a line.
pub(super) fn of(arm: &Arm) -> String {
    let arm = if arm.influence < 1.0 { arm.switched_to_ik() } else { *arm };
    // A line of its own has no past to be carried along from.
    let arm = match arm.twist_reference {
        TwistReferenceKind::Transport => {
            arm.with_twist_reference(TwistReferenceKind::Stereographic)
        }
        _ => arm,
    };
    let mut line = Map::new();
    let mut say = |field: &str, value: Value| line.insert(field.to_owned(), value);
    say("hand", json!(arm.cursor_in_root().to_array()));
    say("upper", json!(arm.bones.upper()));
    say("lower", json!(arm.bones.lower()));
    say("root", json!(arm.root.to_array()));
    say("twist_deg", json!(spin_alone(&arm).to_degrees()));
    match arm.twist_reference {
        TwistReferenceKind::Limb => None,
        TwistReferenceKind::Pole => say("reference", json!({ "pole": arm.pole.to_array() })),
        TwistReferenceKind::Stereographic | TwistReferenceKind::Transport => {
            say("reference", json!("stereographic"))
        }
    };
    let (soft_reach, seed) = (arm.soft_reach, SoftReach::default());
    // Just below a half turn in radians may be one in degrees.
    let min_elbow_angle_deg = soft_reach.min_elbow_angle().to_degrees().min(180.0_f32.next_down());
    for (field, value, usual) in [
        ("softness", soft_reach.softness(), seed.softness()),
        ("max_stretch", soft_reach.max_stretch(), seed.max_stretch()),
        ("min_elbow_angle_deg", min_elbow_angle_deg, seed.min_elbow_angle()),
    ] {
        if value != usual {
            say(field, json!(value));
        }
    }
    Value::Object(line).to_string()
}

/// The spin that leaves the elbow where it is for who does not know where the arm last faced.
fn spin_alone(arm: &Arm) -> f32 {
    const SAME: f32 = 1e-6;
    let (cursor, outward) = (arm.cursor_in_root(), arm.solve().pose.outward());
    let spin = wrapped(arm.twist);
    let alone = arm.ik().solve(cursor, spin, IkState::default()).pose;
    if alone.outward().distance(outward) < SAME {
        return spin;
    }
    let pointer = Pointer::towards(cursor, Pointer::default());
    remeasured(angle_from_limb(pointer, outward), 0.0, arm.reference().angle(pointer, None))
}
