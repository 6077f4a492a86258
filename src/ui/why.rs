//! Why a target is not reached, with a button for each remedy.

use egui::{Label, RichText, Ui};

use crate::kinematics::diagnosis::{Diagnosis, TriedRemedy};
use crate::session::{Actions, EditAction, Session};
use crate::ui::widgets::{self, format};

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
    let sentence = session.skeleton_rig().sentence(found);
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
    for TriedRemedy { remedy, residual } in found.remedies.iter().take(most) {
        let rig = session.skeleton_rig();
        let name = rig.remedy_sentence(remedy);
        let tooltip = match *residual <= rig.tolerance() {
            true => "Apply this; the tip is then at its target".to_owned(),
            false => format!("Apply this; the tip is then {} away", format::short(*residual)),
        };
        if widgets::button(ui, &name, &tooltip, None) {
            let (target, remedy) = (found.target, remedy.clone());
            actions.push(EditAction::ApplyRemedy { target, remedy });
        }
    }
}
