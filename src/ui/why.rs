//! Why a target is not reached, with a button for each remedy.

use egui::{Label, RichText, Ui};

use crate::kinematics::diagnosis::{Cause, Diagnosis, TriedRemedy};
use crate::rig::SkeletonRig;
use crate::session::{Actions, Session, TargetEdit};
use crate::ui::widgets::{self, format};
use crate::words;

/// Why the target is not reached that the session examines. While a mouse button is down nothing is
/// found out that is not known, so that scrubbing does not wait.
pub(in crate::ui) fn found<'a>(ui: &Ui, session: &'a Session) -> &'a [Diagnosis] {
    if is_held(ui) { session.known_why() } else { session.why() }
}

pub(in crate::ui) fn is_held(ui: &Ui) -> bool {
    ui.input(|input| input.pointer.any_down())
}

/// Shows the cause of a diagnosis as a sentence.
pub(in crate::ui) fn cause(ui: &mut Ui, session: &Session, found: &Diagnosis) {
    let sentence = words::cause(session.skeleton_rig(), found);
    ui.add(Label::new(RichText::new(sentence)).wrap());
}

/// Shows the first `most` remedies of a diagnosis as buttons that apply them.
pub(in crate::ui) fn remedies(
    ui: &mut Ui,
    session: &Session,
    found: &Diagnosis,
    most: usize,
    actions: &mut Actions,
) {
    for tried in found.remedies.iter().take(most) {
        let remedy = &tried.remedy;
        let name = words::remedy(session.skeleton_rig(), remedy);
        let tooltip = format!("Apply this; {}", left(session, found, tried));
        if widgets::button(ui, &name, &tooltip, None) {
            let (target, remedy) = (found.target, remedy.clone());
            actions.push(TargetEdit::ApplyRemedy { target, remedy });
        }
    }
}

/// The error that a remedy of a diagnosis leaves between the tip or the hand and its target.
fn left(session: &Session, found: &Diagnosis, tried: &TriedRemedy) -> String {
    let TriedRemedy { residual, rotation_residual, .. } = *tried;
    if let Cause::RotationLimits { .. } = found.cause {
        return if rotation_residual <= SkeletonRig::ROTATION_TOLERANCE {
            "it is then turned as its target asks".to_owned()
        } else {
            format!("{} are then missing", format::degrees(rotation_residual))
        };
    }
    if residual <= session.skeleton_rig().tolerance() {
        "the tip is then at its target".to_owned()
    } else {
        format!("the tip is then {} away", format::short(residual))
    }
}
