use super::{Ball, Label, Scene, Side, arm};
use crate::document::{Arm, Swivel};
use crate::kinematics::swivel::Carried;
use crate::kinematics::two_bone::Pose;
use crate::rig::ArmRig;

/// On an arm as thick as the seed's.
const LIMB: f32 = 7.0;
const ELBOW: f32 = 13.0;

/// Elbows that are nearer to each other than this share a label, which would cover each other.
const APART: f32 = 12.0 * core::f32::consts::PI / 180.0;

/// Adds the arm as every swivel reference would have it with the same spin, but for its own, thin, and
/// how far each elbow is from the arm's. `carried` is what transport would measure from.
pub(super) fn add(scene: &mut Scene, arm: &Arm, carried: Option<Carried>) {
    if !arm.is_led_by_hand() {
        return;
    }
    let own = arm.solve().pose;
    let ghosts = Swivel::ALL.into_iter().filter(|swivel| *swivel != arm.swivel).map(|swivel| {
        let pose = arm.pose_measured_from(swivel, carried);
        Ghost { swivel, pose, turn: own.elbow_turn_to(&pose) }
    });
    let mut ghosts: Vec<Ghost> = ghosts.collect();
    ghosts.sort_by(|a, b| a.turn.total_cmp(&b.turn));
    for ghost in &ghosts {
        ghost.add_limbs(scene, arm);
    }
    for group in ghosts.chunk_by(|a, b| b.turn - a.turn < APART) {
        add_label(scene, arm, group);
    }
}

struct Ghost {
    swivel: Swivel,
    pose: Pose,
    /// How far its elbow is turned from the arm's.
    turn: f32,
}

impl Ghost {
    fn add_limbs(&self, scene: &mut Scene, arm: &Arm) {
        let thickness = ArmRig::thickness(arm.bones);
        let colour = scene.palette.swivel(self.swivel);
        let [elbow, hand] = [self.pose.elbow, self.pose.hand].map(|point| arm.root + point);
        let radius = LIMB * thickness;
        scene.add_solid(arm.root, elbow, radius, radius, colour);
        scene.add_solid(elbow, hand, radius, radius, colour);
        scene.balls.push(Ball { centre: elbow, radius: ELBOW * thickness, colour });
    }
}

/// As in "Limb, Stereographic +19°". Beside the arm's own elbow it stands below that one's name.
fn add_label(scene: &mut Scene, arm: &Arm, group: &[Ghost]) {
    let Some(ghost) = group.get(group.len() / 2) else { return };
    let names: Vec<_> = group.iter().map(|ghost| ghost.swivel.name()).collect();
    let degrees = (ghost.turn.to_degrees().round()) + 0.0;
    let is_beside = ghost.turn.abs() < APART;
    scene.labels.push(Label {
        at: arm.root + ghost.pose.elbow,
        clearance: if is_beside { arm::ELBOW_BALL } else { ELBOW } * ArmRig::thickness(arm.bones),
        side: if is_beside { Side::Below } else { Side::Above },
        text: format!("{} {degrees:+.0}°", names.join(", ")),
        colour: scene.palette.swivel(ghost.swivel),
    });
}
