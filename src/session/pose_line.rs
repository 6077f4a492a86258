use serde_json::{Map, Value, json};

use crate::document::{Arm, Swivel};
use crate::kinematics::reach::Softening;

/// A line that `ik-arm solve` reads, and that gives the arm as its hand would lead it to where it is.
pub(super) fn of(arm: &Arm) -> String {
    let arm = if arm.weight < 1.0 { arm.led_by_hand() } else { *arm };
    // A line of its own has no past to be carried along from.
    let arm = match arm.swivel {
        Swivel::Transport => arm.measured_from(Swivel::Stereographic),
        _ => arm,
    };
    let mut line = Map::new();
    let mut say = |field: &str, value: Value| line.insert(field.to_owned(), value);
    say("hand", json!(arm.cursor().to_array()));
    say("upper", json!(arm.bones.upper()));
    say("lower", json!(arm.bones.lower()));
    say("root", json!(arm.root.to_array()));
    say("elbow_spin_deg", json!(arm.elbow_spin.to_degrees()));
    match arm.swivel {
        Swivel::Limb => None,
        Swivel::Pole => say("swivel", json!({ "pole": arm.pole.to_array() })),
        Swivel::Stereographic | Swivel::Transport => say("swivel", json!("stereographic")),
    };
    let (softening, seed) = (arm.softening, Softening::default());
    for (field, value, usual) in [
        ("softness", softening.softness(), seed.softness()),
        ("max_stretch", softening.max_stretch(), seed.max_stretch()),
        ("min_elbow_deg", softening.min_elbow_angle().to_degrees(), seed.min_elbow_angle()),
    ] {
        if value != usual {
            say(field, json!(value));
        }
    }
    Value::Object(line).to_string()
}
