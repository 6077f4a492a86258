use glam::{DMat3, Vec3};
use serde::{Deserialize, Serialize};

use super::Wrist;
use crate::kinematics::fk::{Fk, blended};
use crate::kinematics::ik::{Ik, Solved};
use crate::kinematics::soft_reach::SoftReach;
use crate::kinematics::twist::{Stereographic, TransportedFrame, TwistReference, respun, wrapped};
use crate::kinematics::two_bone::{Facing, LengthError, TwoBone, TwoBonePose};
use crate::rig::ArmRig;

/// The arm as the user set it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Arm {
    /// Where the hand is asked to be.
    pub goal: Cursor,
    /// ψ, radians, from where the swivel says.
    pub twist: f32,
    /// The shoulder, in the world.
    pub root: Vec3,
    pub bones: TwoBone,
    /// Where the arm last faced: decides for a cursor that does not say.
    pub facing: Facing,
    pub twist_reference: TwistReferenceKind,
    /// What the elbow points at with [`TwistReferenceKind::Pole`], in Root space.
    pub pole: Vec3,
    /// What the spin was last measured from: decides where the pole or the map does not, and goes on
    /// with [`TwistReferenceKind::Transport`]. Nothing where transport is as if it began here, on the map.
    pub transported: Option<TransportedFrame>,
    pub soft_reach: SoftReach,
    /// How far the hand leads (1) or the joints' own angles do (0).
    pub influence: f32,
    /// The joints' own angles.
    pub fk: Fk,
    pub wrist: Wrist,
}

/// Where the hand is asked to be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Cursor {
    /// In Root space: it goes with the shoulder.
    Root(Vec3),
    /// Pinned to the world: it stays when the shoulder moves.
    World(Vec3),
}

/// What the elbow's spin is measured from: see [`TwistReference`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum TwistReferenceKind {
    #[default]
    Limb,
    Pole,
    Stereographic,
    Transport,
}

impl TwistReferenceKind {
    pub const ALL: [Self; 4] = [Self::Limb, Self::Pole, Self::Stereographic, Self::Transport];

    /// As pictures and panels call it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Limb => "Limb",
            Self::Pole => "Pole",
            Self::Stereographic => "Stereographic",
            Self::Transport => "Transport",
        }
    }
}

impl Arm {
    /// An arm in the seed's first pose.
    ///
    /// # Errors
    ///
    /// Refuses a length that no bone can have.
    pub fn new(upper: f32, lower: f32) -> Result<Self, LengthError> {
        let cursor = Vec3::new(250.0, 120.0, 60.0);
        Ok(Self {
            goal: Cursor::Root(cursor),
            twist: 0.0,
            root: Vec3::ZERO,
            bones: TwoBone::new(upper, lower)?,
            facing: Facing::towards(cursor, Facing::default()),
            twist_reference: TwistReferenceKind::default(),
            pole: Vec3::new(100.0, 300.0, -100.0),
            transported: None,
            soft_reach: SoftReach::default(),
            influence: 1.0,
            fk: Fk::default(),
            wrist: Wrist::default(),
        })
    }

    /// How wide the grid's cells around it are: the power of ten nearest to what the seed's are for
    /// its length, which go 1.6 to 16 times into it.
    pub fn cell(&self) -> f32 {
        /// Cells of 100 around an arm of 500.
        const SEED: f32 = 100.0 / 500.0;
        let cell = 10_f32.powf((self.bones.outer_limit() * SEED).log10().round());
        if cell.is_normal() { cell } else { 1.0 }
    }

    /// A length of the arm in letters: to a thousandth of its cell.
    pub fn length_in_words(&self, length: f32) -> String {
        format!("{length:.*}", self.length_digits())
    }

    /// How many digits behind the point a length in letters has.
    pub(crate) fn length_digits(&self) -> usize {
        (3.0 - self.cell().log10().round()).clamp(0.0, 8.0) as usize
    }

    /// Where the hand is asked to be, in Root space.
    pub fn cursor(&self) -> Vec3 {
        match self.goal {
            Cursor::Root(cursor) => cursor,
            Cursor::World(cursor) => (cursor - self.root).clamp(Vec3::MIN, Vec3::MAX),
        }
    }

    /// Where the hand is asked to be, in the world.
    pub fn cursor_world(&self) -> Vec3 {
        match self.goal {
            Cursor::Root(cursor) => (self.root + cursor).clamp(Vec3::MIN, Vec3::MAX),
            Cursor::World(cursor) => cursor,
        }
    }

    /// Asks the hand to be elsewhere, in Root space; pinned it stays pinned.
    pub fn set_cursor(&mut self, cursor: Vec3) {
        self.goal = match self.goal {
            Cursor::Root(_) => Cursor::Root(cursor),
            Cursor::World(_) => Cursor::World((self.root + cursor).clamp(Vec3::MIN, Vec3::MAX)),
        };
    }

    pub fn is_pinned(&self) -> bool {
        matches!(self.goal, Cursor::World(_))
    }

    /// Pinned to the world or not, with the cursor where it is.
    #[must_use]
    pub fn pinned(self, pinned: bool) -> Self {
        let goal = match pinned {
            true => Cursor::World(self.cursor_world()),
            false => Cursor::Root(self.cursor()),
        };
        if pinned == self.is_pinned() { self } else { Self { goal, ..self } }
    }

    /// The least and the most that the hand can be from the shoulder, as it leads.
    pub fn reach(&self) -> (f32, f32) {
        let most = self.bones.outer_limit() * self.soft_reach.max_stretch();
        (self.soft_reach.least_distance(self.bones), most.min(f32::MAX))
    }

    /// Whether the limbs are, or can become, longer or shorter than at rest.
    pub fn is_stretching(&self) -> bool {
        self.soft_reach.max_stretch() > 1.0 || self.fk.stretch != 1.0
    }

    /// Whether the hand leads, alone or with others.
    pub fn is_led_by_hand(&self) -> bool {
        self.influence > 0.0
    }

    /// What the elbow's spin is measured from.
    pub fn reference(&self) -> TwistReference {
        self.reference_of(self.twist_reference)
    }

    /// What it would be measured from with another choice.
    pub fn reference_of(&self, twist_reference: TwistReferenceKind) -> TwistReference {
        match twist_reference {
            TwistReferenceKind::Limb => TwistReference::Limb,
            TwistReferenceKind::Pole => TwistReference::Pole(self.pole),
            TwistReferenceKind::Stereographic => {
                TwistReference::Stereographic(Stereographic::default())
            }
            TwistReferenceKind::Transport => TwistReference::Transport,
        }
    }

    pub fn ik(&self) -> Ik {
        Ik { bones: self.bones, reference: self.reference(), soft_reach: self.soft_reach }
    }

    /// The arm as its hand alone would have it.
    pub fn solve(&self) -> Solved {
        self.ik().solve(self.cursor(), self.twist, self.facing, self.transported)
    }

    /// As its hand alone would have it with the same spin measured from elsewhere. `transported` is what
    /// another reference than its own goes on from.
    pub fn pose_measured_from(
        &self,
        twist_reference: TwistReferenceKind,
        transported: Option<TransportedFrame>,
    ) -> TwoBonePose {
        let transported =
            if twist_reference == self.twist_reference { self.transported } else { transported };
        let ik = Ik { reference: self.reference_of(twist_reference), ..self.ik() };
        ik.solve(self.cursor(), self.twist, self.facing, transported).pose
    }

    pub fn pose(&self) -> TwoBonePose {
        self.blended_with(&self.solve().pose)
    }

    /// Between its angles and a solved pose.
    fn blended_with(&self, solved: &TwoBonePose) -> TwoBonePose {
        blended(self.fk, solved, self.influence, self.bones, self.cursor())
    }

    pub fn rig(&self, pose: &TwoBonePose) -> ArmRig {
        ArmRig::new(self.bones, self.root, self.cursor(), pose)
    }

    /// The same arm, to be carried along from where another was.
    #[must_use]
    pub fn going_on_from(self, other: &Self) -> Self {
        let begins =
            self.twist_reference == TwistReferenceKind::Transport && self.transported.is_none();
        if begins
            && other.twist_reference == self.twist_reference
            && other.cursor() != self.cursor()
        {
            return Self { transported: Some(other.solve().transported), ..self };
        }
        self
    }

    /// The same arm with what its next pose goes on from: where it faces, what its spin is measured
    /// from, how its forearm is rolled.
    #[must_use]
    pub fn settled(self) -> Self {
        let solved = self.solve();
        let pose = self.blended_with(&solved.pose);
        let transported = match (self.twist_reference, self.transported) {
            (TwistReferenceKind::Limb, _) | (TwistReferenceKind::Transport, None) => None,
            _ => Some(solved.transported),
        };
        let wrist = self.wrist.settled(&pose);
        Self { facing: solved.pose.facing, transported, wrist, ..self }
    }

    /// The hand's rotation in the world, which is Root's too.
    pub fn hand_rotation(&self, pose: &TwoBonePose) -> DMat3 {
        self.wrist.rotation(pose)
    }

    /// How far the forearm is rolled at the hand, radians.
    pub fn roll(&self, pose: &TwoBonePose) -> f32 {
        self.wrist.settled(pose).roll
    }

    /// Measures the elbow's spin from elsewhere and leaves the elbow where it is.
    #[must_use]
    pub fn measured_from(self, twist_reference: TwistReferenceKind) -> Self {
        if twist_reference == self.twist_reference {
            return self;
        }
        let pose = self.solve().pose;
        let to = Self { twist_reference, transported: None, facing: pose.facing, ..self };
        let twist = respun(pose.spin, 0.0, to.reference().angle(pose.facing, None));
        Self { twist, ..to }.settled()
    }

    /// ψ as keys have it: that of the transported reference is measured from the map, so that playing
    /// needs no past.
    pub(super) fn keyed_spin(&self) -> f32 {
        match self.transported {
            Some(transported) if self.twist_reference == TwistReferenceKind::Transport => {
                let facing = Facing::towards(self.cursor(), self.facing);
                self.spin_on_map(transported.to(facing.direction))
            }
            _ => self.twist,
        }
    }

    /// A transported spin is measured from the map where it was last.
    pub(super) fn forget_way(&mut self) {
        if let Some(transported) = self.transported
            && self.twist_reference == TwistReferenceKind::Transport
        {
            self.set_keyed_spin(self.spin_on_map(transported));
        }
    }

    fn spin_on_map(&self, transported: TransportedFrame) -> f32 {
        let map = TransportedFrame::new(Facing::towards(transported.direction, self.facing));
        respun(self.twist, map.turn_to(transported), 0.0)
    }

    /// Sets ψ as keys have it.
    pub(super) fn set_keyed_spin(&mut self, spin: f32) {
        self.twist = wrapped(spin);
        if self.twist_reference == TwistReferenceKind::Transport {
            self.transported = None;
        }
    }

    /// The joints' own angles lead from here, and have the present pose.
    #[must_use]
    pub fn led_by_angles(self) -> Self {
        Self { fk: Fk::matching(&self.pose(), self.fk), influence: 0.0, ..self }.settled()
    }

    /// The hand leads from here, and has the present pose.
    #[must_use]
    pub fn led_by_hand(self) -> Self {
        let pose = self.pose();
        let past = match self.twist_reference {
            TwistReferenceKind::Transport => Some(self.solve().transported),
            _ => self.transported,
        };
        let transported = past.map(|transported| transported.to(pose.facing.direction));
        let (cursor, twist) = self.ik().matching(&pose, transported);
        let mut arm = Self { twist, influence: 1.0, facing: pose.facing, transported, ..self };
        arm.set_cursor(cursor);
        arm.settled()
    }

    /// Lengths that no bones can have change nothing.
    pub(super) fn set_lengths(&mut self, upper: f32, lower: f32) {
        self.bones = TwoBone::new(upper, lower).unwrap_or(self.bones);
    }

    /// A sphere around the arm as it stands, in the world: centre and radius.
    pub fn bounds(&self, pose: &TwoBonePose) -> (Vec3, f32) {
        let points = [Vec3::ZERO, pose.elbow, pose.hand];
        let low = points.into_iter().fold(Vec3::MAX, Vec3::min);
        let high = points.into_iter().fold(Vec3::MIN, Vec3::max);
        let centre = low * 0.5 + high * 0.5;
        let reach = points.into_iter().map(|point| point.distance(centre)).fold(0.0, f32::max);
        let radius = reach.max(self.bones.outer_limit() * 0.5).min(f32::MAX);
        ((self.root + centre).clamp(Vec3::MIN, Vec3::MAX), radius)
    }
}

impl Default for Arm {
    /// The seed's arm: 200 and 300 long.
    fn default() -> Self {
        const SEED: (f32, f32) = (200.0, 300.0);
        Self::new(SEED.0, SEED.1).unwrap_or_else(|_| unreachable!("200 and 300 are lengths"))
    }
}
