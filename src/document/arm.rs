use glam::{Affine3A, DMat3, Vec3};
use serde::{Deserialize, Serialize};

use super::length_format::LengthFormat;
use crate::kinematics::angle;
use crate::kinematics::fk::{Fk, blended_limits, limb_rotations};
use crate::kinematics::ik::{IkSolution, IkState};
use crate::kinematics::pop::PosedLimb;
use crate::kinematics::soft_reach::{ReachLimits, SoftReach};
use crate::kinematics::twist::TwistReferenceKind;
use crate::kinematics::two_bone::{LengthError, Pointer, TwoBone, TwoBonePose};
use crate::rig::LimbFrames;

/// The two-bone arm: the values that pose it, and the state from which its next IK solve continues.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Arm {
    /// The Cursor, the hand's target.
    pub cursor: Cursor,
    /// Socket twist ψ in radians, measured from the twist reference.
    pub twist: f32,
    /// Position of the shoulder in the world.
    pub root: Vec3,
    /// Lengths of the two limbs.
    pub bones: TwoBone,
    /// Kind of the twist reference.
    pub twist_reference: TwistReferenceKind,
    /// Point in Root space towards which [`TwistReferenceKind::Pole`] turns the elbow.
    pub pole: Vec3,
    /// State from which the next IK solve continues. If it has no transported frame,
    /// [`TwistReferenceKind::Transport`] starts from the stereographic direction.
    pub ik_state: IkState,
    /// Soft limits and stretch.
    pub soft_reach: SoftReach,
    /// Influence of IK (hand → joint angles) in its blend with FK (joint angles → hand): 0 is FK
    /// alone, 1 is IK alone.
    pub influence: f32,
    /// Joint angles and stretch of the FK pose.
    pub fk: Fk,
    /// Orientation of the hand.
    pub hand_orientation: HandOrientation,
}

impl Arm {
    /// An arm with limbs of these lengths, in the default pose.
    ///
    /// # Errors
    ///
    /// If a length is not finite or not above 0.
    pub fn new(upper: f32, lower: f32) -> Result<Self, LengthError> {
        let cursor = Vec3::new(250.0, 120.0, 60.0);
        Ok(Self {
            cursor: Cursor::unpinned(cursor),
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
        self.cursor.position_in_root(self.root)
    }

    /// The Cursor in the world.
    pub fn cursor_in_world(&self) -> Vec3 {
        self.cursor.position_in_world(self.root)
    }

    /// Moves the Cursor to a point in Root space. A pinned Cursor stays pinned.
    pub fn set_cursor(&mut self, cursor: Vec3) {
        self.cursor.move_in_root(self.root, cursor);
    }

    /// True if the Cursor is pinned to the world.
    pub fn is_pinned(&self) -> bool {
        self.cursor.is_pinned
    }

    /// Pins the Cursor to the world or unpins it. The Cursor does not move.
    #[must_use]
    pub fn with_pinned(self, pinned: bool) -> Self {
        Self { cursor: self.cursor.with_pinned(pinned, self.root), ..self }
    }

    /// Limits of the hand's distance from the shoulder, at the present influence and FK stretch.
    pub fn reach_limits(&self) -> ReachLimits {
        blended_limits(self.fk, self.soft_reach, self.influence, self.bones)
    }

    /// True if the limbs are stretched by FK, or can be by IK.
    pub fn is_stretching(&self) -> bool {
        self.soft_reach.max_stretch() > 1.0 || self.fk.stretch != 1.0
    }

    /// True if IK poses the arm, alone or blended with FK.
    pub fn uses_ik(&self) -> bool {
        self.influence > 0.0
    }

    /// Sets the lengths of the limbs. If one of them is invalid, both stay unchanged.
    pub(super) fn set_lengths(&mut self, upper: f32, lower: f32) {
        self.bones = TwoBone::new(upper, lower).unwrap_or(self.bones);
    }

    /// The point of Root space that the Pointer goes through: the Cursor, or the hand where FK has
    /// a part in the pose.
    pub fn pointed_at(&self, pose: &TwoBonePose) -> Vec3 {
        if self.influence == 1.0 { self.cursor_in_root() } else { pose.hand }
    }

    /// The hierarchy Root → Limb → Socket of a pose, and of the IK solve that is a part of it.
    pub fn frames(&self, solution: &IkSolution, pose: &TwoBonePose) -> LimbFrames {
        let inner = self.soft_reach.least_distance(self.bones);
        let range = ReachLimits { inner, outer: self.bones.outer_limit() };
        LimbFrames {
            root: Affine3A::from_translation(self.root),
            posed: PosedLimb {
                pose: *pose,
                cursor: self.cursor_in_root(),
                ik: self.ik(),
                kind: self.twist_reference,
                twist: self.twist,
                pinned_root: self.is_pinned().then_some(self.root),
                influence: self.influence,
                fk: self.fk,
            },
            solution: *solution,
            limits: self.reach_limits(),
            range,
            limited_by: None,
            references: TwistReferenceKind::ALL.map(|kind| Some(self.reference_for(kind))),
        }
    }

    /// Width of a cell of the grid around the arm.
    pub fn grid_cell(&self) -> f32 {
        LengthFormat::of_limb(self.bones).cell()
    }

    /// Centre and radius of a bounding sphere of a pose, in the world. The radius is at least half
    /// the arm's length.
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

/// The Cursor, the hand's target: a point in Root space, a point in the world, and the switch
/// between them. The point that is not in use keeps its value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cursor {
    /// The Cursor in Root space while it is not pinned: it moves with the shoulder.
    pub in_root: Vec3,
    /// The Cursor in the world while it is pinned: it stays when the shoulder moves.
    pub in_world: Vec3,
    /// True if the Cursor is pinned to the world.
    pub is_pinned: bool,
}

impl Cursor {
    /// A Cursor that is not pinned, at a point in Root space. Its point in the world is the same
    /// for a shoulder at the origin.
    pub const fn unpinned(point: Vec3) -> Self {
        Self { in_root: point, in_world: point, is_pinned: false }
    }

    /// A Cursor that is pinned to a point in the world. Its point in Root space is the same for a
    /// shoulder at the origin.
    pub const fn pinned(point: Vec3) -> Self {
        Self { is_pinned: true, ..Self::unpinned(point) }
    }

    /// Position of the Cursor in Root space, for a shoulder at `root` in the world. Overflow is
    /// clamped to ±`f32::MAX`.
    pub fn position_in_root(self, root: Vec3) -> Vec3 {
        if self.is_pinned { clamped(self.in_world - root) } else { self.in_root }
    }

    /// Position of the Cursor in the world, for a shoulder at `root` in the world. Overflow is
    /// clamped to ±`f32::MAX`.
    pub fn position_in_world(self, root: Vec3) -> Vec3 {
        if self.is_pinned { self.in_world } else { clamped(root + self.in_root) }
    }

    /// Moves the Cursor to a point in Root space, for a shoulder at `root` in the world.
    pub fn move_in_root(&mut self, root: Vec3, point: Vec3) {
        if self.is_pinned {
            self.in_world = clamped(root + point);
        } else {
            self.in_root = point;
        }
    }

    /// Pins the Cursor to the world or unpins it, for a shoulder at `root` in the world. The Cursor
    /// does not move: the point that comes into use is set to its position.
    #[must_use]
    pub fn with_pinned(self, is_pinned: bool, root: Vec3) -> Self {
        match (self.is_pinned, is_pinned) {
            (false, true) => Self { in_world: self.position_in_world(root), is_pinned, ..self },
            (true, false) => Self { in_root: self.position_in_root(root), is_pinned, ..self },
            _ => self,
        }
    }
}

fn clamped(point: Vec3) -> Vec3 {
    point.clamp(Vec3::MIN, Vec3::MAX)
}

impl Default for Arm {
    /// The arm of E. Palmieri's report (2014): limbs of length 200 and 300.
    fn default() -> Self {
        const LENGTHS: (f32, f32) = (200.0, 300.0);
        Self::new(LENGTHS.0, LENGTHS.1).unwrap_or_else(|_| unreachable!("200 and 300 are lengths"))
    }
}

/// Orientation of the hand. Its rotation about the lower limb, the roll, is spread along the
/// forearm.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct HandOrientation {
    /// Space in which the angles are measured.
    pub space: HandSpace,
    /// Angles about x, y and z in radians: see [`angle`].
    pub angles: Vec3,
    /// Roll τ of the forearm in the previous pose, in radians, whole turns included. With
    /// [`HandSpace::World`] the next roll is the equivalent angle nearest to this one.
    pub roll: f32,
}

/// The space that the hand's angles are measured in.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum HandSpace {
    /// The space of the lower limb: the hand turns with the limb.
    #[default]
    LowerLimb,
    /// The world: the hand keeps its orientation when the limb turns.
    World,
}

impl HandOrientation {
    /// Rotation of the hand in the world: +x points out of the lower limb, +y out of the back of
    /// the hand.
    pub fn rotation(&self, pose: &TwoBonePose) -> DMat3 {
        let own = angle::euler_rotation(self.angles);
        match self.space {
            HandSpace::LowerLimb => limb_rotations(pose).1 * own,
            HandSpace::World => own,
        }
    }

    /// Replaces the stored roll by the roll of the forearm in `pose`.
    #[must_use]
    pub fn with_roll_in(self, pose: &TwoBonePose) -> Self {
        let own = angle::euler_rotation(self.angles);
        let roll = match self.space {
            // The angle about x already includes the whole turns.
            HandSpace::LowerLimb => angle::roll(own, self.angles.x),
            HandSpace::World => angle::roll(limb_rotations(pose).1.transpose() * own, self.roll),
        };
        Self { roll, ..self }
    }

    /// Converts the angles to another space. The hand keeps its orientation in `pose`.
    #[must_use]
    pub fn in_space(self, space: HandSpace, pose: &TwoBonePose) -> Self {
        self.in_space_near(space, pose, self.angles)
    }

    /// [`Self::in_space`] with the equivalent angles that are nearest to `near`.
    pub(super) fn in_space_near(self, space: HandSpace, pose: &TwoBonePose, near: Vec3) -> Self {
        if space == self.space {
            return self;
        }
        let rotation = self.rotation(pose);
        let own = match space {
            HandSpace::LowerLimb => limb_rotations(pose).1.transpose() * rotation,
            HandSpace::World => rotation,
        };
        Self { space, angles: angle::euler_angles(own, near), ..self }.with_roll_in(pose)
    }
}
