use super::history::steps::TreeChange;
use super::outcome::{Consequence, Outcome};
use super::session::Session;
use super::skeleton::joints;
use crate::document::{Display, Document, Overlay};

/// A change of the display, or a reset.
#[derive(Clone, Debug, PartialEq)]
pub enum DisplayEdit {
    /// Shows or hides an overlay.
    ShowOverlay(Overlay, bool),
    /// Resets the rig: one with the joints of the arm to the arm's defaults, any other to its bind
    /// pose. The display does not change.
    ResetPose,
    /// Resets the pose, the display, the camera and the crowd.
    ResetAll,
    /// Sets the length of a document unit in exports, in metres; `None` for the default.
    SetMetres(Option<f32>),
}

impl DisplayEdit {
    /// Label of the edit's undo step.
    pub fn label(&self) -> &'static str {
        match self {
            Self::ShowOverlay(overlay, _) => toggle_label(*overlay),
            Self::ResetPose => "Reset pose",
            Self::ResetAll => "Reset all",
            Self::SetMetres(_) => "Change unit",
        }
    }

    pub(super) fn apply(self, session: &mut Session) -> Outcome {
        match self {
            Self::ShowOverlay(overlay, is_shown) => {
                let display = session.shown().display.with(overlay, is_shown);
                show(session, display)
            }
            Self::ResetPose => reset_pose(session),
            Self::ResetAll => reset_all(session),
            Self::SetMetres(Some(metres)) if !(metres.is_finite() && metres > 0.0) => {
                Outcome::fail("The length of a unit must be finite and above 0 m")
            }
            Self::SetMetres(metres) => {
                Outcome::change(session.shown(), |document| document.metres_per_unit = metres)
            }
        }
    }
}

fn show(session: &Session, display: Display) -> Outcome {
    Consequence::Write(Box::new(Document { display, ..session.shown().clone() })).into()
}

/// True if a document has the joints of the arm, in any pose.
fn is_arm_tree(document: &Document) -> bool {
    let arm = Document::default();
    let change = TreeChange::between(document.skeleton(), arm.skeleton());
    change == TreeChange::Kept && document.rig.sole_limb().is_some()
}

fn reset_pose(session: &Session) -> Outcome {
    if is_arm_tree(session.shown()) {
        let rig = Document::default().rig;
        return Outcome::from(Consequence::ResetPosture).and(Outcome::change(
            session.shown(),
            |document| {
                document.rig = rig;
                document.track_start = None;
            },
        ));
    }
    joints::bind_pose(session)
}

fn reset_all(session: &mut Session) -> Outcome {
    let is_arm = is_arm_tree(session.shown());
    let display = if is_arm { Display::of_arm() } else { Display::default() };
    let shown = show(session, display);
    session.act(Outcome::from(Consequence::ResetCrowd).and(shown));
    let reset = reset_pose(session);
    session.act(reset);
    if is_arm {
        Consequence::GlideTo(session.shown().framing_camera()).into()
    } else {
        Consequence::FrameAll.into()
    }
}

fn toggle_label(overlay: Overlay) -> &'static str {
    match overlay {
        Overlay::Cursor => "Toggle Cursor",
        Overlay::Pointer => "Toggle Pointer",
        Overlay::InnerLimit => "Toggle Inner Limit",
        Overlay::OuterLimit => "Toggle Outer Limit",
        Overlay::ElbowCircle => "Toggle elbow circle",
        Overlay::GridXy => "Toggle XY grid",
        Overlay::GridXz => "Toggle XZ grid",
        Overlay::GridYz => "Toggle YZ grid",
        Overlay::Ground => "Toggle ground",
        Overlay::Axes => "Toggle axes",
        Overlay::Labels => "Toggle labels",
        Overlay::Shadow => "Toggle shadow",
        Overlay::Trail => "Toggle motion trail",
        Overlay::OnionSkins => "Toggle onion skins",
        Overlay::FkPose => "Toggle FK pose",
        Overlay::ByItself => "Toggle frame by itself",
        Overlay::Skin => "Toggle skin",
        Overlay::Bones => "Toggle bones",
        Overlay::Wireframe => "Toggle wireframe",
        Overlay::SkinWeights => "Toggle skin weights",
        Overlay::Stiffness => "Toggle stiffness",
        Overlay::Balance => "Toggle balance",
        Overlay::ReachRegion => "Toggle reach region",
        Overlay::JointLimits => "Toggle joint limits",
        Overlay::CompareSkinning => "Toggle comparison of skinning",
        Overlay::Frames => "Toggle frames",
        Overlay::SingularityGlobe => "Toggle singularity globe",
        Overlay::TwistReferences => "Toggle references",
        Overlay::Cylinders => "Toggle cylinders",
        Overlay::Paths => "Toggle paths",
        Overlay::Hand => "Toggle hand",
    }
}
