use super::arm;
use super::outcome::{Consequence, Outcome};
use super::session::Session;
use super::skeleton::joints;
use crate::document::{Arm, Camera, Display, Document, Overlay, RigKind};

/// A change of the display, or of both rigs alike.
#[derive(Clone, Debug, PartialEq)]
pub enum DisplayEdit {
    /// Shows or hides an overlay.
    ShowOverlay(Overlay, bool),
    /// Shows the arm or the skeleton.
    ShowRig(RigKind),
    /// Resets the shown rig: the arm to its defaults, or the skeleton to its bind pose. The display
    /// does not change.
    ResetPose,
    /// Resets the pose, the display, the camera and the crowd.
    ResetAll,
    /// Sets the length of a document unit in exports, in metres; `None` for the shown rig's
    /// default.
    SetMetres(Option<f32>),
}

impl DisplayEdit {
    /// Label of the edit's undo step.
    pub fn label(&self) -> &'static str {
        match self {
            Self::ShowOverlay(overlay, _) => toggle_label(*overlay),
            Self::ShowRig(RigKind::Arm) => "Show arm",
            Self::ShowRig(RigKind::Skeleton) => "Show skeleton",
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
            Self::ShowRig(rig) => show_rig(session, rig),
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

/// Shows the arm or the skeleton.
fn show_rig(session: &mut Session, rig: RigKind) -> Outcome {
    session.act(Consequence::SettleCamera);
    let mut after = session.shown().clone();
    after.show(rig);
    Outcome::from(Consequence::Write(Box::new(after))).and(Consequence::Message(None))
}

fn reset_pose(session: &Session) -> Outcome {
    match session.rig() {
        RigKind::Arm => arm::edits::replace(session, Arm::default()),
        RigKind::Skeleton => joints::bind_pose(session),
    }
}

fn reset_all(session: &mut Session) -> Outcome {
    let framed = match session.rig() {
        RigKind::Arm => Consequence::GlideTo(Camera::default()),
        RigKind::Skeleton => Consequence::FrameAll,
    };
    let shown = show(session, Display::default());
    session.act(Outcome::from(Consequence::ResetCrowd).and(shown).and(framed));
    reset_pose(session)
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
        Overlay::CompareSkinning => "Toggle comparison of skinning",
        Overlay::Frames => "Toggle frames",
        Overlay::SingularityGlobe => "Toggle singularity globe",
        Overlay::TwistReferences => "Toggle references",
        Overlay::Hand => "Toggle hand",
    }
}
