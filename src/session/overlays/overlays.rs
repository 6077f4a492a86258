use glam::Vec3;

use super::onion_skins::{OnionSkin, write_onion_skins};
use super::trail::{has_trail, sample_trail};
use crate::document::{Overlay, Posed, Track, TwistReferenceKind};
use crate::kinematics::Shared;
use crate::kinematics::chain_ik::{Method, SubStep, TipTarget};
use crate::kinematics::skeleton::{JointId, SkeletonPose};
use crate::kinematics::twist::TransportedFrame;
use crate::kinematics::two_bone::TwoBonePose;
use crate::rig::Crowd;
use crate::session::parts::{ArmFigure, BodyPart};
use crate::session::solver::inside::InsideLayers;
use crate::session::solver::wiggle::WiggleView;

/// State that a picture shows in addition to the document.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Overlays {
    /// Selected joints; the last of them is the active joint.
    pub selection: Vec<JointId>,
    /// The part of a body under the mouse, which lights up.
    pub hovered: Option<BodyPart>,
    /// The line of the arm's figures that lights up.
    pub figure: Option<ArmFigure>,
    /// The joints that keep a tip from its target.
    pub concerned: Vec<JointId>,
    /// Shown iterates of the solver run or of the comparison.
    pub ghosts: Vec<SolverGhost>,
    /// The part of an iteration that is looked at.
    pub inside: Option<InsideView>,
    /// An angle that swings.
    pub wiggle: Option<WiggleView>,
    /// Poses of the arm with the same twist, measured from references of each kind; `None` if twist
    /// references are hidden or FK alone poses the arm.
    pub twist_references: Option<[TwistReferencePose; TwistReferenceKind::ALL.len()]>,
    /// World positions of the hand, or of the active joint's tip, in all frames; empty if the trail
    /// is hidden.
    pub trail: Vec<Vec3>,
    /// The rig in frames before and after the playhead.
    pub onion_skins: Vec<OnionSkin>,
    /// True if handles are drawn over the picture. Names that they would cover are left out.
    pub has_handles: bool,
    /// The crowd that is shown instead of the rig; `None` to show the rig.
    pub crowd: Option<Crowd>,
}

/// The arm's pose by IK with its twist measured from a reference of one kind.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TwistReferencePose {
    /// Kind of the twist reference.
    pub kind: TwistReferenceKind,
    /// The pose.
    pub pose: TwoBonePose,
}

/// A part of an iteration, as the view shows it.
#[derive(Clone, Debug, PartialEq)]
pub struct InsideView {
    /// The part.
    pub part: Shared<SubStep>,
    /// The part before it; `None` for the first one of an iteration.
    pub previous: Option<Shared<SubStep>>,
    /// The pose before the part, in world space.
    pub before: Shared<SkeletonPose>,
    /// Layers of it that are shown.
    pub layers: InsideLayers,
}

/// The shown iterate of a solver.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SolverGhost {
    /// The solver.
    pub method: Method,
    /// Number of iterations made to the iterate.
    pub iteration: u32,
    /// The part of the iteration that is looked at, counted from 1, and the number of its parts.
    pub part: Option<[usize; 2]>,
    /// The targets that are solved for.
    pub targets: Vec<TipTarget>,
    /// The pose, in world space.
    pub pose: SkeletonPose,
}

impl Overlays {
    /// Overlays for a pose of a track: its motion trail, onion skins and twist references, if its
    /// display shows them.
    pub fn new(track: &Track, posed: &Posed) -> Self {
        let has_trail = has_trail(track.document(), posed.document());
        let mut overlays = Self {
            trail: if has_trail { sample_trail(track, None) } else { Vec::new() },
            ..Self::default()
        };
        overlays.follow(track, posed);
        overlays
    }

    /// Updates onion skins and twist references to another pose of the track.
    pub fn follow(&mut self, track: &Track, posed: &Posed) {
        write_onion_skins(track, posed, &mut self.onion_skins);
        self.twist_references = twist_reference_poses(posed, None);
    }
}

/// Poses of the arm for [`Overlays::twist_references`]. A pose with transport that is not the arm's
/// own continues from the frame `transported`.
pub(in crate::session) fn twist_reference_poses(
    posed: &Posed,
    transported: Option<TransportedFrame>,
) -> Option<[TwistReferencePose; TwistReferenceKind::ALL.len()]> {
    let arm = posed.arm();
    let is_shown = posed.document().display.shows(Overlay::TwistReferences) && arm.uses_ik();
    let pose = |kind| {
        if kind == arm.twist_reference {
            posed.arm_solution().pose
        } else {
            arm.pose_with_reference(kind, transported)
        }
    };
    is_shown
        .then(|| TwistReferenceKind::ALL.map(|kind| TwistReferencePose { kind, pose: pose(kind) }))
}
