use super::Session;
use crate::session::action::Action;
use crate::session::dialog::Dialog;
use crate::session::files::action::FileAction;
use crate::session::outcome::{Consequence, Outcome};
use crate::session::preferences::Preferences;
use crate::session::tour::state::{TourAction, TourState};
use crate::session::tour::steps::TourStep;

/// The tour.
impl Session {
    pub(super) fn apply_tour(&mut self, action: TourAction) {
        match action {
            TourAction::Enter(number) => self.enter_tour(number),
            TourAction::Guess(answer) => self.tour.iter_mut().for_each(|tour| tour.choose(answer)),
            TourAction::Demonstrate => self.demonstrate(),
            TourAction::Leave => self.leave_tour(),
            TourAction::Decline => self.preferences.offers_tour = false,
        }
    }

    fn demonstrate(&mut self) {
        let Some(step) = self.tour().and_then(TourState::step) else { return };
        self.tour.iter_mut().for_each(TourState::show_result);
        let actions = step.goal.demonstration(self);
        let (edits, others): (Vec<_>, Vec<_>) =
            actions.into_iter().partition(|action| matches!(action, Action::Edit(_)));
        // One undo step, and for the page Pops one drag.
        self.act(Consequence::Begin(None));
        edits.into_iter().for_each(|edit| drop(self.apply(edit)));
        self.act(Consequence::Commit);
        others.into_iter().for_each(|action| drop(self.apply(action)));
    }

    /// Shows the scene of a step in place of the user's document, which is kept.
    fn enter_tour(&mut self, number: usize) {
        let steps = TourStep::all();
        let number = number.min(steps.len());
        let step = &steps[number.min(steps.len() - 1)];
        let document = match step.document() {
            Ok(document) => document,
            Err(error) => return drop(self.act(Outcome::fail(error.to_string()))),
        };
        let done = self.tour.take().map(TourState::done).unwrap_or_default();
        self.cancel_bake();
        let own = self.own.take().unwrap_or_else(|| Box::new(self.paused()));
        let preferences = Preferences {
            offers_tour: false,
            explain: step.tab.is_some(),
            timeline_open: Some(false),
            ..self.preferences
        };
        let playback = self.playback.restarted(&document.timeline);
        let files = std::mem::take(&mut self.files);
        *self = Self { files, playback, ..Self::with_document(preferences, document) };
        self.refresh();
        self.evaluated.reset_transport();
        self.tour = Some(TourState::new(number, self.shown().clone(), done));
        self.own = Some(own);
        let joints = self.skeleton().iter();
        let selected = joints.filter(|(_, joint)| Some(joint.name.as_str()) == step.select);
        let selected = Consequence::Select(selected.map(|(id, _)| id).collect());
        self.act(Outcome::from(step.tab.map(Consequence::ShowTab)).and(selected));
    }

    /// Shows the result of the step once its task is done.
    pub(super) fn watch_tour(&mut self) {
        let is_met = self.tour().is_some_and(|tour| {
            !tour.shows_result()
                && tour.step().is_some_and(|step| step.goal.is_met(self, tour.start()))
        });
        if is_met {
            self.tour.iter_mut().for_each(TourState::finish);
        }
    }

    /// Prepares the tour for an action on files, and returns whether the action can be applied. An
    /// action on the user's document ends the tour; the scenes of the tour cannot be saved.
    pub(super) fn prepare_tour(&mut self, action: &FileAction) -> bool {
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

    /// Ends all changes that are under way, and returns the session as it is then.
    fn paused(&mut self) -> Self {
        self.commit();
        self.end_glide();
        let paused = self.playback.play(false, &self.document().timeline);
        self.act(paused);
        self.clone()
    }

    /// Puts the user's document back. Files and those preferences that the tour does not set are
    /// kept as they are now.
    pub(super) fn leave_tour(&mut self) {
        let Some(own) = self.own.take() else { return };
        self.cancel_bake();
        let Preferences { explain, tab, timeline_open, curves, .. } = own.preferences;
        let preferences = Preferences { explain, tab, timeline_open, curves, ..self.preferences };
        let files = std::mem::take(&mut self.files);
        *self = Self { files, preferences, ..*own };
    }

    /// Cancels a running bake and closes its dialog.
    fn cancel_bake(&mut self) {
        if matches!(self.shell.dialog(), Some(Dialog::Bake { .. })) {
            self.close_dialog();
        }
    }
}
