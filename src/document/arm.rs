use glam::Vec3;

use super::cursor::Cursor;
use super::hand_orientation::HandOrientation;
use crate::kinematics::fk::Fk;
use crate::kinematics::ik::IkState;
use crate::kinematics::soft_reach::SoftReach;
use crate::kinematics::twist::TwistReferenceKind;
use crate::kinematics::two_bone::{LengthError, Pointer, TwoBone, TwoBonePose};
use crate::rig::ArmRig;

/// The arm: what poses it, and the state that its next solve starts from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Arm {
    /// The Cursor, the hand's target.
    pub cursor: Cursor,
    /// Socket twist ψ in radians, measured from the twist reference.
    pub twist: f32,
    /// Position of the shoulder in the world.
    pub root: Vec3,
    /// Lengths of the limbs.
    pub bones: TwoBone,
    /// Kind of the twist reference.
    pub twist_reference: TwistReferenceKind,
    /// Point in Root space that the elbow turns to with [`TwistReferenceKind::Pole`].
    pub pole: Vec3,
    /// State that the next solve starts from. Without a transported frame,
    /// [`TwistReferenceKind::Transport`] starts from the stereographic direction.
    pub ik_state: IkState,
    /// Soft limits and stretch.
    pub soft_reach: SoftReach,
    /// Influence of IK (hand → joint angles) over FK (joint angles → hand): 0 is FK alone, 1 is IK alone.
    pub influence: f32,
    /// Joint angles of FK.
    pub fk: Fk,
    /// Orientation of the hand.
    pub hand_orientation: HandOrientation,
}

impl Arm {
    /// An arm in the default pose.
    ///
    /// # Errors
    ///
    /// If a length is not finite or not above 0.
    pub fn new(upper: f32, lower: f32) -> Result<Self, LengthError> {
        let cursor = Vec3::new(250.0, 120.0, 60.0);
        Ok(Self {
            cursor: Cursor::Root(cursor),
            twist: 0.0,
            root: Vec3::ZERO,
            bones: TwoBone::new(upper, lower)?,
            twist_reference: TwistReferenceKind::default(),
            pole: Vec3::new(100.0, 300.0, -100.0),
            ik_state: IkState {
                pointer: Pointer::towards(cursor, Pointer::default()),
                transported: None,
            },
            soft_reach: SoftReach::default(),
            influence: 1.0,
            fk: Fk::default(),
            hand_orientation: HandOrientation::default(),
        })
    }

    /// The Cursor in Root space.
    pub fn cursor_in_root(&self) -> Vec3 {
        self.cursor.in_root(self.root)
    }

    /// The Cursor in the world.
    pub fn cursor_in_world(&self) -> Vec3 {
        self.cursor.in_world(self.root)
    }

    /// Moves the Cursor to a point in Root space; a pinned one stays pinned.
    pub fn set_cursor(&mut self, cursor: Vec3) {
        let cursor = Cursor::Root(cursor);
        self.cursor = match self.is_pinned() {
            true => Cursor::World(cursor.in_world(self.root)),
            false => cursor,
        };
    }

    /// Whether the Cursor is pinned to the world.
    pub fn is_pinned(&self) -> bool {
        matches!(self.cursor, Cursor::World(_))
    }

    /// Pins the Cursor to the world, or unpins it, and leaves it where it is.
    #[must_use]
    pub fn with_pinned(self, pinned: bool) -> Self {
        let cursor = match pinned {
            true => Cursor::World(self.cursor_in_world()),
            false => Cursor::Root(self.cursor_in_root()),
        };
        if pinned == self.is_pinned() { self } else { Self { cursor, ..self } }
    }

    /// Minimum and maximum distance of the hand from the shoulder with IK.
    pub fn reach(&self) -> (f32, f32) {
        let most = self.bones.outer_limit() * self.soft_reach.max_stretch();
        (self.soft_reach.least_distance(self.bones), most.min(f32::MAX))
    }

    /// Whether the limbs are stretched by FK, or can be by IK.
    pub fn is_stretching(&self) -> bool {
        self.soft_reach.max_stretch() > 1.0 || self.fk.stretch != 1.0
    }

    /// Whether IK poses the arm, alone or blended with FK.
    pub fn uses_ik(&self) -> bool {
        self.influence > 0.0
    }

    /// Sets the lengths of the limbs; invalid ones change nothing.
    pub(super) fn set_lengths(&mut self, upper: f32, lower: f32) {
        self.bones = TwoBone::new(upper, lower).unwrap_or(self.bones);
    }

    /// The hierarchy Root → Limb → Socket of a pose.
    pub fn rig(&self, pose: &TwoBonePose) -> ArmRig {
        ArmRig::new(self.bones, self.root, self.cursor_in_root(), pose)
    }

    /// Width of a cell of the grid: the power of ten nearest to a fifth of the arm's length.
    pub fn grid_cell(&self) -> f32 {
        const FRACTION: f32 = 0.2;
        let cell = 10_f32.powf((self.bones.outer_limit() * FRACTION).log10().round());
        if cell.is_normal() { cell } else { 1.0 }
    }

    /// A length of the arm as text, to a thousandth of a cell of the grid.
    pub fn format_length(&self, length: f32) -> String {
        format!("{length:.*}", self.length_decimals())
    }

    /// Decimals of a length of the arm as text.
    pub(crate) fn length_decimals(&self) -> usize {
        (3.0 - self.grid_cell().log10().round()).clamp(0.0, 8.0) as usize
    }

    /// Bounding sphere of a pose in the world: centre and radius, at least half the arm's length.
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
    /// The arm of the paper: 200 and 300 long.
    fn default() -> Self {
        const LENGTHS: (f32, f32) = (200.0, 300.0);
        Self::new(LENGTHS.0, LENGTHS.1).unwrap_or_else(|_| unreachable!("200 and 300 are lengths"))
    }
}
