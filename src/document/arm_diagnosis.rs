use super::Arm;
use crate::kinematics::diagnosis::{Boundary, Cause, Diagnosis};
use crate::kinematics::skeleton::JointId;
use crate::kinematics::soft_reach::ReachLimits;
use crate::kinematics::two_bone::{Reach, TwoBonePose};
use crate::words::{self, Names};

impl Arm {
    /// Why the hand is not at the Cursor in a pose of the arm; `None` if it is, or if FK alone
    /// poses the arm. The joints are those of an arm without names: see [`Arm::why`].
    pub fn diagnose(&self, pose: &TwoBonePose) -> Option<Diagnosis> {
        let influence = self.influence;
        if !self.uses_ik() {
            return None;
        }
        let cause = match pose.reach {
            _ if influence < 1.0 => Cause::Influence { influence },
            Some(Reach::Reached) | None => return None,
            Some(reach) => {
                let smallest_angle = self.soft_reach.min_elbow_angle();
                let boundary = match reach {
                    _ if self.is_softened() => Boundary::SoftLimit,
                    Reach::TooClose if smallest_angle > 0.0 => Boundary::ElbowAngle,
                    _ => Boundary::Bones,
                };
                Cause::OutOfReach {
                    base: SHOULDER,
                    distance: self.cursor_in_root().length(),
                    shortest: self.bones.inner_limit(),
                    longest: self.bones.outer_limit() * pose.stretch,
                    boundary,
                }
            }
        };
        let residual = pose.hand.distance(self.cursor_in_root());
        Some(Diagnosis { target: HAND, residual, cause, joints: vec![HAND], remedies: Vec::new() })
    }

    /// True if softness alone keeps the hand from the Cursor: hard limits would let it go there.
    pub fn is_softened(&self) -> bool {
        let ReachLimits { inner, outer } = self.reach_limits();
        let distance = self.cursor_in_root().length();
        self.soft_reach.softness() > 0.0 && (inner..=outer).contains(&distance)
    }

    /// [`Arm::diagnose`] as a sentence with a full stop.
    pub fn why(&self, pose: &TwoBonePose) -> Option<String> {
        let joint = |joint: JointId| match joint {
            SHOULDER => "the shoulder".to_owned(),
            _ => "the hand".to_owned(),
        };
        let names = Names { joint: &joint, tip: &joint };
        let sentence = words::cause_with(&self.diagnose(pose)?, names);
        let (first, rest) = sentence.split_at_checked(1)?;
        Some(format!("{}{rest}.", first.to_uppercase()))
    }
}

/// Stand-ins for the joints of an arm.
const SHOULDER: JointId = JointId::new(0);
const HAND: JointId = JointId::new(1);
