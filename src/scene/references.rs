use core::fmt::{self, Display, Formatter};

use super::{Ball, Label, Scene, Side, Words, arm};
use crate::document::{Arm, TwistReferenceKind};
use crate::kinematics::twist::TransportedFrame;
use crate::kinematics::two_bone::TwoBonePose;
use crate::rig::ArmRig;

/// On an arm as thick as the seed's.
const LIMB: f32 = 7.0;
const ELBOW: f32 = 13.0;

/// Elbows that are nearer to each other than this share a label: two would cover each other.
const APART: f32 = 20.0 * core::f32::consts::PI / 180.0;

/// Adds the arm as every other swivel reference would have it with the same spin, thin, and how far
/// each elbow is from the arm's. `transported` is what transport would measure from.
pub(super) fn add(scene: &mut Scene, arm: &Arm, transported: Option<TransportedFrame>) {
    if !arm.is_led_by_hand() {
        return;
    }
    let own = arm.solve().pose;
    let mut ghosts = TwistReferenceKind::ALL.map(|twist_reference| {
        let pose = arm.pose_measured_from(twist_reference, transported);
        Ghost {
            twist_reference,
            pose,
            turn: own.elbow_turn_to(&pose),
            is_own: twist_reference == arm.twist_reference,
        }
    });
    ghosts.sort_by(|a, b| a.turn.total_cmp(&b.turn));
    for ghost in ghosts.iter().filter(|ghost| !ghost.is_own) {
        ghost.add_limbs(scene, arm);
    }
    for group in ghosts.chunk_by(|a, b| b.turn - a.turn < APART) {
        add_label(scene, arm, group);
    }
}

struct Ghost {
    twist_reference: TwistReferenceKind,
    pose: TwoBonePose,
    /// How far its elbow is turned from the arm's.
    turn: f32,
    is_own: bool,
}

impl Ghost {
    fn add_limbs(&self, scene: &mut Scene, arm: &Arm) {
        let thickness = ArmRig::thickness(arm.bones);
        let colour = scene.palette.twist_reference(self.twist_reference);
        let [elbow, hand] = [self.pose.elbow, self.pose.hand].map(|point| arm.root + point);
        let radius = LIMB * thickness;
        scene.add_solid(arm.root, elbow, radius, radius, colour);
        scene.add_solid(elbow, hand, radius, radius, colour);
        scene.balls.push(Ball { centre: elbow, radius: ELBOW * thickness, colour });
    }
}

/// As in "Stereographic · Limb −17°", where the arm's own has no angle.
fn add_label(scene: &mut Scene, arm: &Arm, group: &[Ghost]) {
    let shown = group.iter().find(|ghost| ghost.is_own).or(group.last());
    let Some(ghost) = shown else { return };
    let (ball, colour) = match ghost.is_own {
        true => (arm::ELBOW_BALL, scene.palette.text),
        false => (ELBOW, scene.palette.twist_reference(ghost.twist_reference)),
    };
    let label = Label {
        at: arm.root + ghost.pose.elbow,
        clearance: ball * ArmRig::thickness(arm.bones),
        side: Side::Above,
        words: Words::default(),
        colour,
    };
    scene.add_label(label, format_args!("{}", Names(group)));
}

/// The names of elbows that share a label, the arm's own first.
struct Names<'a>(&'a [Ghost]);

impl Display for Names<'_> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let own = self.0.iter().filter(|ghost| ghost.is_own);
        let others = self.0.iter().filter(|ghost| !ghost.is_own);
        for (index, ghost) in own.chain(others).enumerate() {
            let between = if index > 0 { " · " } else { "" };
            write!(f, "{between}{}", ghost.twist_reference.name())?;
            if !ghost.is_own {
                let turn = ghost.turn.to_degrees().round();
                write!(f, " {}{:.0}°", if turn < 0.0 { '−' } else { '+' }, turn.abs())?;
            }
        }
        Ok(())
    }
}
