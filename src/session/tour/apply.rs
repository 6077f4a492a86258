use super::state::{TourAction, TourState};
use super::steps::TourStep;
use crate::session::action::Action;
use crate::session::files::action::FileAction;
use crate::session::outcome::{Consequence, Outcome};
use crate::session::preferences::Preferences;
use crate::session::session::Session;

/// The tour.
impl Session {
    pub(in crate::session) fn apply_tour(&mut self, action: TourAction) {
        match action {
            TourAction::Enter(number) => self.enter_tour(number),
            TourAction::Guess(answer) => self.change_tour(|tour| tour.choose(answer)),
            TourAction::Demonstrate => self.demonstrate(),
            TourAction::Leave => self.leave_tour(),
            TourAction::Decline => {
                let declined = Preferences { offers_tour: false, ..*self.preferences() };
                self.act(Consequence::Prefer(declined));
            }
        }
    }

    fn demonstrate(&mut self) {
        let Some(step) = self.tour().and_then(TourState::step) else { return };
        self.change_tour(TourState::show_result);
        let actions = step.goal.demonstration(self);
        let (edits, others): (Vec<_>, Vec<_>) =
            actions.into_iter().partition(|action| matches!(action, Action::Edit(_)));
        // One undo step, and for the page Pops one drag.
        self.act(Consequence::Begin(None));
        edits.into_iter().for_each(|edit| drop(self.apply(edit)));
        self.act(Consequence::Commit);
        others.into_iter().for_each(|action| drop(self.apply(action)));
    }

    fn enter_tour(&mut self, number: usize) {
        let steps = TourStep::all();
        let number = number.min(steps.len());
        let step = &steps[number.min(steps.len() - 1)];
        let document = match step.document() {
            Ok(document) => document,
            Err(error) => return drop(self.act(Outcome::fail(error.to_string()))),
        };
        self.enter_scene(document, |start, done| TourState::new(number, start, done));
        let preferences = Preferences {
            explain: step.tab.is_some(),
            timeline_open: Some(false),
            ..*self.preferences()
        };
        let joints = self.skeleton().iter();
        let selected = joints.filter(|(_, joint)| Some(joint.name.as_str()) == step.select);
        let selected = Consequence::Select(selected.map(|(id, _)| id).collect());
        self.act(
            Outcome::from(Consequence::Prefer(preferences))
                .and(step.tab.map(Consequence::ShowTab))
                .and(selected),
        );
    }

    /// Shows the result of the step once its task is done.
    pub(in crate::session) fn watch_tour(&mut self) {
        let is_met = self.tour().is_some_and(|tour| {
            !tour.shows_result()
                && tour.step().is_some_and(|step| step.goal.is_met(self, tour.start()))
        });
        if is_met {
            self.change_tour(TourState::finish);
        }
    }

    /// Prepares the tour for an action on files, and returns whether the action can be applied. An
    /// action on the user's document ends the tour; the scenes of the tour cannot be saved.
    pub(in crate::session) fn prepare_tour(&mut self, action: &FileAction) -> bool {
        if self.tour().is_none() {
            return true;
        }
        if action.saves_document() {
            self.act(Outcome::fail("leave the tour first: its scenes are not saved"));
            return false;
        }
        if action.concerns_document() {
            self.leave_tour();
        }
        true
    }
}
