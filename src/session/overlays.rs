use glam::Vec3;

use super::arm_figure::ArmFigure;
use super::body_part::BodyPart;
use super::inside_layer::InsideLayers;
use super::onion_skins::{OnionSkin, write_onion_skins};
use super::trail::{has_trail, sample_trail};
use super::wiggle::WiggleView;
use crate::document::Document;
use crate::kinematics::Shared;
use crate::kinematics::chain_ik::{Method, SubStep, TipTarget};
use crate::kinematics::skeleton::{JointId, SkeletonPose};
use crate::kinematics::twist::TransportedFrame;
use crate::rig::{Crowd, EvaluatedSkeleton};

/// State that a picture shows in addition to the document.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Overlays {
    /// Time of the playhead, in seconds.
    pub time: f64,
    /// The skeleton evaluated at that time; `None` to evaluate it for the picture.
    pub evaluated: Option<Shared<EvaluatedSkeleton>>,
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
    /// The frame transported along the Pointer's path; `None` if the Pointer has no path yet.
    pub transported: Option<TransportedFrame>,
    /// World positions of the hand, or of the active joint's tip, in all frames; empty if the trail
    /// is hidden.
    pub trail: Vec<Vec3>,
    /// The rig in frames before and after the playhead.
    pub onion_skins: Vec<OnionSkin>,
    /// Whether handles are drawn over the picture. Names that they would cover are left out.
    pub has_handles: bool,
    /// The crowd that is shown instead of the rig; `None` to show the rig.
    pub crowd: Option<Crowd>,
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
    /// What is shown of it.
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
    /// Overlays for a document at a time in seconds: its motion trail and onion skins, if its
    /// display shows them.
    pub fn new(document: &Document, time: f64) -> Self {
        let shown = document.evaluate(time);
        let has_trail = has_trail(document, &shown);
        let mut overlays = Self {
            trail: if has_trail { sample_trail(document, None) } else { Vec::new() },
            ..Self::default()
        };
        overlays.evaluate(&shown, time);
        overlays
    }

    /// The overlays at another time in seconds, at which `document` is evaluated already.
    #[must_use]
    pub fn at(mut self, document: &Document, time: f64) -> Self {
        self.evaluate(document, time);
        self
    }

    /// Sets the time, the skeleton and the onion skins; `document` is evaluated at that time.
    fn evaluate(&mut self, document: &Document, time: f64) {
        self.time = time;
        self.evaluated = Some(Shared::from(document.skeleton_rig.evaluate(time)));
        write_onion_skins(document, document, time, &mut self.onion_skins);
    }
}
