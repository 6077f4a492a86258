use crate::document::{Document, Overlay, Posed, Skin, Track, TwistReferenceKind};
use crate::kinematics::Shared;
use crate::kinematics::chain_ik::{ChainSolver, ChainTarget, Method, SubStep};
use crate::kinematics::limb_ik::Limb;
use crate::kinematics::skeleton::{JointId, SkeletonPose};
use crate::kinematics::skin::SkinPose;
use crate::kinematics::twist::TransportedFrame;
use crate::kinematics::two_bone::TwoBonePose;
use crate::rig::{Crowd, LimbFrames};
use crate::session::limb::ShownLimb;
use crate::session::parts::LimbFigure;
use crate::session::pops::TransportPath;
use crate::session::reach_regions::ShownRegion;
use crate::session::session::Session;
use crate::session::solver::iterates::InsideLayers;
use crate::session::solver::run::SolverRun;
use crate::session::solver::wiggle::WiggleView;
use crate::session::trail::Trail;

/// State that a picture shows in addition to the document.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Overlays {
    /// Selected joints; the last of them is the active joint.
    pub selection: Vec<JointId>,
    /// The joint whose bone or skin is under the mouse, which lights up.
    pub hovered: Option<JointId>,
    /// The line of the limb's figures that lights up.
    pub figure: Option<LimbFigure>,
    /// The limb that the open page is about, whose bones alone are coloured; `None` to colour all.
    pub limb: Option<Limb>,
    /// The joints that keep a tip from its target.
    pub concerned: Vec<JointId>,
    /// Shown iterates of the solver run or of the comparison.
    pub ghosts: Vec<SolverGhost>,
    /// The part of an iteration that is looked at.
    pub inside: Option<InsideView>,
    /// An angle that swings.
    pub wiggle: Option<WiggleView>,
    /// Poses of the limb with the same twist, measured from references of each kind; `None` if
    /// twist references are hidden or FK alone poses the limb.
    pub twist_references: Option<TwistReferencePoses>,
    /// The motion of the hand, or of the active joint's tip; empty if it is hidden.
    pub trail: Trail,
    /// The rig in frames before and after the playhead.
    pub onion_skins: Vec<OnionSkin>,
    /// The reach region of the selected target; `None` if it is hidden or not known.
    pub reach_region: Option<ShownRegion>,
    /// True if handles are drawn over the picture. Names that they would cover are left out.
    pub has_handles: bool,
    /// The crowd that is shown instead of the rig; `None` to show the rig.
    pub crowd: Option<Crowd>,
}

/// A limb's poses by IK with its twist measured from a reference of each kind.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TwistReferencePoses {
    /// By [`TwistReferenceKind::ALL`]; `None` for a pole without a place.
    poses: [Option<TwoBonePose>; TwistReferenceKind::ALL.len()],
}

impl TwistReferencePoses {
    /// The poses of a limb. One with transport that is not the limb's own continues from the frame
    /// `transported`.
    pub fn new(limb: &LimbFrames, transported: Option<TransportedFrame>) -> Self {
        let pose = |kind| limb.pose_with_reference(kind, transported);
        Self { poses: TwistReferenceKind::ALL.map(pose) }
    }

    /// The poses with the kinds of their references.
    pub fn iter(&self) -> impl Iterator<Item = (TwistReferenceKind, &TwoBonePose)> {
        let poses = TwistReferenceKind::ALL.into_iter().zip(&self.poses);
        poses.filter_map(|(kind, pose)| Some((kind, pose.as_ref()?)))
    }
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
    pub targets: Vec<ChainTarget>,
    /// The pose, in world space.
    pub pose: SkeletonPose,
}

impl Overlays {
    /// Overlays for a pose of a track: its motion trail, onion skins and twist references, if its
    /// display shows them.
    pub fn new(track: &Track, posed: &Posed) -> Self {
        let mut overlays = Self::default();
        if Trail::is_shown(track.document(), posed.document()) {
            overlays.trail = Trail::new(track, None);
        }
        overlays.follow(track, posed);
        overlays
    }

    /// Updates onion skins and twist references of the first limb to another pose of the track.
    pub fn follow(&mut self, track: &Track, posed: &Posed) {
        write_onion_skins(track, posed, &mut self.onion_skins);
        let limb = ShownLimb::frames(posed, None);
        self.twist_references = twist_reference_poses(posed, limb.as_ref(), None);
    }
}

/// The poses of [`Overlays::twist_references`].
fn twist_reference_poses(
    posed: &Posed,
    limb: Option<&LimbFrames>,
    transported: Option<TransportedFrame>,
) -> Option<TwistReferencePoses> {
    let is_shown = posed.document().display.shows(Overlay::TwistReferences);
    let limb = limb.filter(|limb| is_shown && limb.uses_ik())?;
    Some(TwistReferencePoses::new(limb, transported))
}

/// The rig in a frame before or after the playhead.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct OnionSkin {
    /// The pose, in world space.
    pub pose: SkeletonPose,
    /// The pose of the rig's mesh; `None` if none is shown.
    pub skin: Option<Shared<SkinPose>>,
    /// True if the frame is before the playhead.
    pub past: bool,
    /// Number of frames from the playhead.
    pub frames: u32,
    /// Opacity: 1 nearest to the playhead, less farther away.
    pub opacity: f32,
}

impl OnionSkin {
    fn write_skin(&mut self, posed: &Posed) {
        let Document { rig, display, .. } = posed.document();
        let skin = rig.skin.as_ref().filter(|_| display.shows(Overlay::Skin));
        let Some(Ok(mesh)) = skin.map(Skin::mesh) else { return self.skin = None };
        let pose = self.skin.get_or_insert_default();
        mesh.mesh.write_pose(posed.skeleton(), pose.make_mut());
    }
}

/// Writes into `skins` the rig in frames before and after those of `posed` that are on the
/// timeline, or nothing if onion skins are hidden. Reuses the memory of `skins`.
pub(in crate::session) fn write_onion_skins(
    track: &Track,
    posed: &Posed,
    skins: &mut Vec<OnionSkin>,
) {
    /// Number of onion skins on each side of the playhead.
    const MOST: isize = 2;
    /// Number of frames from one skin to the next, so that those of a walk overlap a little.
    const FRAMES: f64 = 10.0;
    /// Opacity of a skin as a fraction of that of the one before it.
    const FAINTER: f32 = 0.6;
    /// Work of a pose above which only the nearest skins are shown: they are posed in every frame.
    const MOST_WORK: u64 = ChainSolver::POSE_WORK / 16;
    let document = track.document();
    if !posed.document().display.shows(Overlay::OnionSkins) || !document.is_animated() {
        return skins.clear();
    }
    let count = if posed.evaluated_skeleton().work() > MOST_WORK { 1 } else { MOST };
    let timeline = document.timeline;
    let step = FRAMES / timeline.frame_rate;
    let is_played = |time: f64| time >= timeline.start - 1e-9 && time <= timeline.end + 1e-9;
    let all = (-count..=count).filter(|place| *place != 0);
    let times = all.map(|place| (place, posed.time() + place as f64 * step));
    let mut made = 0;
    for (place, time) in times.filter(|(_, time)| is_played(*time)) {
        let posed = track.at(time);
        if made == skins.len() {
            skins.push(OnionSkin::default());
        }
        let skin = &mut skins[made];
        posed.skeleton().write_pose(&mut skin.pose);
        skin.write_skin(&posed);
        let nth = place.unsigned_abs();
        (skin.past, skin.opacity) = (place < 0, FAINTER.powi(nth as i32 - 1));
        skin.frames = FRAMES as u32 * nth as u32;
        made += 1;
    }
    skins.truncate(made);
}

/// Overlays of the viewport.
impl Session {
    /// State that the viewport shows beside the document: selection, drags, trails, solver ghosts.
    pub fn overlays(&self) -> Overlays {
        let mut overlays = Overlays::default();
        self.write_overlays(&mut overlays);
        overlays
    }

    /// Writes [`Session::overlays`] into `overlays` and reuses its memory. Allocates nothing,
    /// except for onion skins, which copy a document with keys.
    pub fn write_overlays(&self, overlays: &mut Overlays) {
        overlays.crowd = self.crowd();
        overlays.selection.clear();
        overlays.selection.extend_from_slice(self.selection().joints());
        overlays.hovered = self.selection().hovered();
        overlays.figure = self.selection().figure();
        overlays.limb = self.limb_of_page().map(|limb| limb.joints);
        overlays.concerned.clear();
        let is_figure = self.rig().sole_limb().is_none();
        if let (Some(found), true) =
            (self.why(false).first(), is_figure && self.solvers().is_idle())
        {
            // The sentence calls a limb's target by its hand.
            overlays.concerned.extend(self.rig().end_of_target(found.target));
            overlays.concerned.extend_from_slice(&found.joints);
        }
        overlays.reach_region = self.reach_region().cloned();
        overlays.inside = inside_view(self);
        overlays.wiggle = self.view().wiggle_view(self.posed());
        let limb = self.limb().map(|limb| &limb.frames);
        let transported = self.evaluated().transport_path().map(TransportPath::transported);
        overlays.twist_references = twist_reference_poses(self.posed(), limb, transported);
        overlays.trail.clone_from(trail(self));
        write_ghosts(self.solvers().runs(), &mut overlays.ghosts);
        write_onion_skins(self.history().track(), self.posed(), &mut overlays.onion_skins);
    }
}

/// The part of the shown iteration that is looked at.
fn inside_view(session: &Session) -> Option<InsideView> {
    let run = session.solvers().run()?;
    let shown = run.shown_part()?;
    let part = run.parts().get(shown)?.clone();
    let previous = shown.checked_sub(1).and_then(|before| run.parts().get(before)).cloned();
    let (before, layers) = (run.before_part().clone(), session.view().inside_layers());
    Some(InsideView { part, previous, before, layers })
}

/// The motion of the hand or the active joint's tip; empty if the motion trail is hidden.
fn trail(session: &Session) -> &Trail {
    static NONE: Trail = Trail { points: Vec::new(), keys: Vec::new() };
    if Trail::is_shown(session.document(), session.shown()) {
        let joint = session.selection().active();
        session.evaluated().trail(|| Trail::new(session.history().track(), joint))
    } else {
        &NONE
    }
}

fn write_ghosts<'a>(runs: impl Iterator<Item = &'a SolverRun>, ghosts: &mut Vec<SolverGhost>) {
    let mut count = 0;
    for run in runs {
        if count == ghosts.len() {
            ghosts.push(SolverGhost::default());
        }
        let ghost = &mut ghosts[count];
        (ghost.method, ghost.iteration) = (run.method(), run.shown().iteration);
        ghost.part = run.shown_part().map(|part| [part + 1, run.parts().len()]);
        ghost.targets.clear();
        ghost.targets.extend_from_slice(run.targets());
        run.skeleton().write_pose(&mut ghost.pose);
        count += 1;
    }
    ghosts.truncate(count);
}
