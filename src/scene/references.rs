use super::{Ball, Label, Scene, Side};
use crate::document::{Arm, Swivel};
use crate::kinematics::swivel::Carried;
use crate::rig::ArmRig;

/// On an arm as thick as the seed's.
const LIMB: f32 = 7.0;
const ELBOW: f32 = 13.0;

/// Adds the arm as every swivel reference would have it with the same spin, but for its own, thin, and
/// how far each elbow is from the arm's. `carried` is what transport would measure from.
pub(super) fn add(scene: &mut Scene, arm: &Arm, carried: Option<Carried>) {
    if !arm.is_led_by_hand() {
        return;
    }
    let thickness = ArmRig::thickness(arm.bones);
    let own = arm.solve().pose;
    for swivel in Swivel::ALL.into_iter().filter(|swivel| *swivel != arm.swivel) {
        let pose = arm.pose_measured_from(swivel, carried);
        let colour = scene.palette.swivel(swivel);
        let [elbow, hand] = [pose.elbow, pose.hand].map(|point| arm.root + point);
        let radius = LIMB * thickness;
        scene.add_solid(arm.root, elbow, radius, radius, colour);
        scene.add_solid(elbow, hand, radius, radius, colour);
        let ball = ELBOW * thickness;
        scene.balls.push(Ball { centre: elbow, radius: ball, colour });
        scene.labels.push(Label {
            at: elbow,
            clearance: ball,
            side: if pose.outward().y < 0.0 { Side::Below } else { Side::Above },
            text: format!("{} {:+.0}°", title(swivel), own.elbow_turn_to(&pose).to_degrees()),
            colour,
        });
    }
}

/// As pictures and panels call it.
fn title(swivel: Swivel) -> &'static str {
    match swivel {
        Swivel::Limb => "Limb",
        Swivel::Pole => "Pole",
        Swivel::Stereographic => "Stereographic",
        Swivel::Transport => "Transport",
    }
}
