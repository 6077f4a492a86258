use core::fmt::{self, Display, Formatter};

use crate::document::{Arm, Posed, TwistReferenceKind};
use crate::kinematics::two_bone::TwoBonePose;
use crate::rig::ArmRig;
use crate::scene::{Ball, Label, LabelSide, Scene};
use crate::session::{BodyPart, TwistReferencePose};

/// Radii of a ghost's limbs and of its elbow, on an arm of thickness 1.
const LIMB_RADIUS: f32 = 7.0;
const ELBOW_RADIUS: f32 = 13.0;

/// Angle in radians between two elbows below which they share a label, since two labels would
/// overlap.
const SHARED_LABEL_ANGLE: f32 = 20.0 * core::f32::consts::PI / 180.0;

/// Adds ghosts of the arm: thin arms with the same twist, each measured from another kind of twist
/// reference. Labels show the angles from the arm's elbow to those of the ghosts.
pub(super) fn add<const N: usize>(
    scene: &mut Scene,
    posed: &Posed,
    poses: [TwistReferencePose; N],
) {
    let (arm, own) = (posed.arm(), posed.arm_solution().pose);
    let mut ghosts = poses.map(|TwistReferencePose { kind, pose }| ReferenceGhost {
        twist_reference: kind,
        pose,
        turn: own.elbow_turn_to(&pose),
        is_own: kind == arm.twist_reference,
    });
    ghosts.sort_by(|a, b| a.turn.total_cmp(&b.turn));
    for ghost in ghosts.iter().filter(|ghost| !ghost.is_own) {
        ghost.add_limbs(scene, arm);
    }
    for group in ghosts.chunk_by(|a, b| b.turn - a.turn < SHARED_LABEL_ANGLE) {
        add_label(scene, arm, group);
    }
}

/// The arm posed with one of the kinds of twist reference.
struct ReferenceGhost {
    twist_reference: TwistReferenceKind,
    pose: TwoBonePose,
    /// Angle in radians about the Pointer from the arm's elbow to the ghost's elbow.
    turn: f32,
    is_own: bool,
}

impl ReferenceGhost {
    fn add_limbs(&self, scene: &mut Scene, arm: &Arm) {
        let thickness = ArmRig::thickness(arm.bones);
        let colour = scene.palette.twist_reference(self.twist_reference);
        let [elbow, hand] = [self.pose.elbow, self.pose.hand].map(|point| arm.root + point);
        let radius = LIMB_RADIUS * thickness;
        scene.add_solid(arm.root, elbow, radius, radius, colour);
        scene.add_solid(elbow, hand, radius, radius, colour);
        scene.balls.push(Ball { centre: elbow, radius: ELBOW_RADIUS * thickness, colour });
    }
}

/// Adds one label for ghosts with nearly the same elbow, like "Stereographic · Limb −17°". The
/// arm's own reference has no angle.
fn add_label(scene: &mut Scene, arm: &Arm, group: &[ReferenceGhost]) {
    let shown = group.iter().find(|ghost| ghost.is_own).or(group.last());
    let Some(ghost) = shown else { return };
    let (ball, colour) = match ghost.is_own {
        true => (BodyPart::JOINT_BALL, scene.palette.text),
        false => (ELBOW_RADIUS, scene.palette.twist_reference(ghost.twist_reference)),
    };
    let at = arm.root + ghost.pose.elbow;
    let clearance = ball * ArmRig::thickness(arm.bones);
    let label = Label::new(at, clearance, LabelSide::Above, colour);
    scene.add_label(label, format_args!("{}", GhostNames(group)));
}

/// Text of a shared label: the names of its references, the arm's own first.
struct GhostNames<'a>(&'a [ReferenceGhost]);

impl Display for GhostNames<'_> {
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
