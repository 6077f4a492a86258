//! The pose of a limb as a line for `ik-arm solve`.

use glam::{Mat3A, Vec3};
use serde_json::{Map, Value, json};

use crate::kinematics::angle::wrapped;
use crate::kinematics::ik::{Ik, IkState};
use crate::kinematics::soft_reach::SoftReach;
use crate::kinematics::twist::{Stereographic, TwistReference, angle_from_limb, remeasured};
use crate::kinematics::two_bone::{Pointer, TwoBonePose};
use crate::rig::LimbFrames;

/// The shown pose of a limb as a JSON line. In the line, the base is where it is in the world if
/// the axes of Root space are the world's, else at the origin. For a target at the base, the line
/// does not give the direction of the Pointer.
pub(super) fn of(limb: &LimbFrames) -> String {
    let posed = &limb.posed;
    // A single line has no previous pose to transport the twist from, no joint angles and no map.
    let reference = match posed.ik.reference {
        reference @ (TwistReference::Up | TwistReference::Pole(_)) => reference,
        TwistReference::Stereographic(_) | TwistReference::Transport => {
            TwistReference::Stereographic(Stereographic::default())
        }
    };
    let ik = Ik { reference, ..posed.ik };
    let (hand, twist) = if posed.influence < 1.0 || limb.is_limited() {
        ik.matching(&posed.pose, None)
    } else {
        (posed.cursor, twist_of(&ik, posed.cursor, posed.twist, &limb.solution.pose))
    };
    let has_axes_of_world = limb.root.matrix3 == Mat3A::IDENTITY;
    let root = Vec3::from(limb.root.translation);
    let mut line = Map::new();
    let mut set = |field: &str, value: Value| line.insert(field.to_owned(), value);
    set("hand", json!(hand.to_array()));
    set("upper", json!(ik.bones.upper()));
    set("lower", json!(ik.bones.lower()));
    set("root", json!(if has_axes_of_world { root } else { Vec3::ZERO }.to_array()));
    set("twist_deg", json!(twist.to_degrees()));
    match reference {
        TwistReference::Up => None,
        TwistReference::Pole(pole) => set("reference", json!({ "pole": pole.to_array() })),
        TwistReference::Stereographic(_) | TwistReference::Transport => {
            set("reference", json!("stereographic"))
        }
    };
    let (soft_reach, default) = (ik.soft_reach, SoftReach::default());
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

/// The twist in radians that gives the elbow of a pose when the limb is solved without a previous
/// pose: `twist` if that does.
fn twist_of(ik: &Ik, cursor: Vec3, twist: f32, pose: &TwoBonePose) -> f32 {
    const SAME: f32 = 1e-6;
    let (twist, outward) = (wrapped(twist), pose.outward());
    let alone = ik.solve(cursor, twist, IkState::default()).pose;
    if alone.outward().distance(outward) < SAME {
        return twist;
    }
    let pointer = Pointer::towards(cursor, Pointer::default());
    remeasured(angle_from_limb(pointer, outward), 0.0, ik.reference.angle(pointer, None))
}
