use glam::DMat3;

use super::arm::Arm;
use crate::kinematics::angle::wrapped;
use crate::kinematics::diagnosis::{Boundary, Cause, Diagnosis};
use crate::kinematics::fk::{Fk, blended};
use crate::kinematics::ik::{Ik, IkSolution, IkState};
use crate::kinematics::skeleton::JointId;
use crate::kinematics::soft_reach::ReachLimits;
use crate::kinematics::twist::{
    Stereographic, TransportedFrame, TwistReference, TwistReferenceKind, remeasured,
};
use crate::kinematics::two_bone::{Pointer, Reach, TwoBonePose};
use crate::words::{self, Names};

/// IK solves, and poses made from them.
impl Arm {
    /// The twist reference.
    pub fn reference(&self) -> TwistReference {
        self.reference_for(self.twist_reference)
    }

    /// The twist reference of the given kind; a [`TwistReferenceKind::Pole`] has this arm's pole.
    pub fn reference_for(&self, kind: TwistReferenceKind) -> TwistReference {
        match kind {
            TwistReferenceKind::Up => TwistReference::Up,
            TwistReferenceKind::Pole => TwistReference::Pole(self.pole),
            TwistReferenceKind::Stereographic => {
                TwistReference::Stereographic(Stereographic::default())
            }
            TwistReferenceKind::Transport => TwistReference::Transport,
            TwistReferenceKind::Fk => {
                // Least rotations from one direction are the stereographic map opposite to it.
                let fk = self.fk.pose(self.bones, Pointer::default());
                let map = Stereographic::new(-fk.pointer.direction, fk.outward());
                TwistReference::Stereographic(map.unwrap_or_default())
            }
        }
    }

    /// The IK solver with this arm's bones, twist reference and soft reach.
    pub fn ik(&self) -> Ik {
        Ik { bones: self.bones, reference: self.reference(), soft_reach: self.soft_reach }
    }

    /// Solves the arm by IK alone.
    pub fn solve(&self) -> IkSolution {
        self.ik().solve(self.cursor_in_root(), self.twist, self.ik_state)
    }

    /// Pose of the arm: FK and IK, blended by the influence.
    pub fn pose(&self) -> TwoBonePose {
        self.blended_with(&self.solve().pose)
    }

    /// Blends the FK pose with an IK pose by the influence.
    pub(super) fn blended_with(&self, solved: &TwoBonePose) -> TwoBonePose {
        blended(self.fk, solved, self.influence, self.bones, self.cursor_in_root())
    }

    /// Rotation of the hand in the world and in Root space, which have the same axes.
    pub fn hand_rotation(&self, pose: &TwoBonePose) -> DMat3 {
        self.hand_orientation.rotation(pose)
    }

    /// Roll of the hand about the forearm in a pose, in radians, whole turns included.
    pub fn roll(&self, pose: &TwoBonePose) -> f32 {
        self.hand_orientation.with_roll_in(pose).roll
    }
}

/// State that a solve passes on to the next one.
impl Arm {
    /// Continues the transport of `previous` if both arms use [`TwistReferenceKind::Transport`],
    /// this arm has no transported frame yet, and the Cursor has moved from `previous` to this arm.
    #[must_use]
    pub fn transported_from(self, previous: &Self) -> Self {
        let is_new = self.twist_reference == TwistReferenceKind::Transport
            && self.ik_state.transported.is_none();
        if is_new
            && previous.twist_reference == self.twist_reference
            && previous.cursor_in_root() != self.cursor_in_root()
        {
            let transported = Some(previous.solve().transported);
            return Self { ik_state: IkState { transported, ..self.ik_state }, ..self };
        }
        self
    }

    /// Stores the state from which the next solve continues: the Pointer, the transported frame and
    /// the forearm's roll of the present pose.
    #[must_use]
    pub fn with_solve_state(self) -> Self {
        let solved = self.solve();
        let pose = self.blended_with(&solved.pose);
        let transported = match (self.twist_reference, self.ik_state.transported) {
            (TwistReferenceKind::Up, _) | (TwistReferenceKind::Transport, None) => None,
            _ => Some(solved.transported),
        };
        let hand_orientation = self.hand_orientation.with_roll_in(&pose);
        let ik_state = IkState { transported, ..solved.state() };
        Self { ik_state, hand_orientation, ..self }
    }

    /// Changes the kind of the twist reference, and adjusts the twist so that the elbow does not
    /// move.
    #[must_use]
    pub fn with_twist_reference(self, kind: TwistReferenceKind) -> Self {
        if kind == self.twist_reference {
            return self;
        }
        let pose = self.solve().pose;
        let ik_state = IkState { pointer: pose.pointer, transported: None };
        let to = Self { twist_reference: kind, ik_state, ..self };
        let twist = remeasured(pose.twist, 0.0, to.reference().angle(pose.pointer, None));
        Self { twist, ..to }.with_solve_state()
    }

    /// Switches to FK, with joint angles that keep the present pose.
    #[must_use]
    pub fn switched_to_fk(self) -> Self {
        let fk = Fk::matching(&self.pose(), self.fk);
        Self { fk, influence: 0.0, ..self }.with_solve_state()
    }

    /// Switches to IK, with a Cursor and twist that keep the present pose as far as the soft limits
    /// allow.
    #[must_use]
    pub fn switched_to_ik(self) -> Self {
        let pose = self.pose();
        let last = match self.twist_reference {
            TwistReferenceKind::Transport => Some(self.solve().transported),
            _ => self.ik_state.transported,
        };
        let transported = last.map(|transported| transported.to(pose.pointer.direction));
        let (cursor, twist) = self.ik().matching(&pose, transported);
        let ik_state = IkState { pointer: pose.pointer, transported };
        let mut arm = Self { twist, influence: 1.0, ik_state, ..self };
        arm.set_cursor(cursor);
        arm.with_solve_state()
    }
}

/// Conversion of the twist from and to its value in keys. With [`TwistReferenceKind::Transport`]
/// keys measure the twist from the stereographic direction, so that a pose depends on its time
/// alone and not on earlier poses.
impl Arm {
    /// The twist as keys store it, in radians.
    pub(super) fn keyed_twist(&self) -> f32 {
        match self.ik_state.transported {
            Some(transported) if self.twist_reference == TwistReferenceKind::Transport => {
                let pointer = Pointer::towards(self.cursor_in_root(), self.ik_state.pointer);
                self.stereographic_twist(transported.to(pointer.direction))
            }
            _ => self.twist,
        }
    }

    /// Sets the twist to a value as keys store it, in radians.
    pub(super) fn set_keyed_twist(&mut self, twist: f32) {
        self.twist = wrapped(twist);
        if self.twist_reference == TwistReferenceKind::Transport {
            self.ik_state.transported = None;
        }
    }

    /// Ends the transport: with [`TwistReferenceKind::Transport`], replaces the twist from the
    /// transported frame by the twist from the stereographic direction, for the Pointer of that
    /// frame.
    pub(super) fn end_transport(&mut self) {
        if let Some(transported) = self.ik_state.transported
            && self.twist_reference == TwistReferenceKind::Transport
        {
            self.set_keyed_twist(self.stereographic_twist(transported));
        }
    }

    fn stereographic_twist(&self, transported: TransportedFrame) -> f32 {
        let start =
            TransportedFrame::new(Pointer::towards(transported.direction, self.ik_state.pointer));
        remeasured(self.twist, start.turn_to(transported), 0.0)
    }
}

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
