use super::state::{TourAction, TourState};
use super::steps::TourStep;
use crate::session::action::Action;
use crate::session::file_action::FileAction;
use crate::session::playback_action::PlaybackAction;
use crate::session::preferences::Preferences;
use crate::session::session::Session;

/// The tour.
impl Session {
    /// Where the user is in the tour; `None` outside of it.
    pub fn tour(&self) -> Option<&TourState> {
        self.tour.as_ref()
    }

    /// The session with the user's own document, which the tour does not change: outside the tour,
    /// this session.
    pub fn own(&self) -> &Self {
        self.own.as_deref().unwrap_or(self)
    }

    pub(in crate::session) fn apply_tour(&mut self, action: TourAction) {
        match action {
            TourAction::Enter(number) => self.enter_tour(number),
            TourAction::Guess(answer) => self.change_tour(|tour| tour.choose(answer)),
            TourAction::Demonstrate => self.demonstrate(),
            TourAction::Leave => self.leave_tour(),
            TourAction::Decline => self.preferences.offers_tour = false,
        }
    }

    fn demonstrate(&mut self) {
        if let Some(tour) = &mut self.tour
            && let Some(step) = tour.step()
        {
            tour.show_result();
            let (edits, others): (Vec<_>, Vec<_>) = step
                .goal
                .demonstration(self)
                .into_iter()
                .partition(|action| matches!(action, Action::Edit(_)));
            // One undo step, and for the page Pops one drag.
            self.begin_edit(None);
            edits.into_iter().for_each(|edit| drop(self.apply(edit)));
            self.commit_edit();
            others.into_iter().for_each(|action| drop(self.apply(action)));
        }
    }

    fn change_tour(&mut self, change: impl FnOnce(&mut TourState)) {
        if let Some(tour) = &mut self.tour {
            change(tour);
        }
    }

    fn enter_tour(&mut self, number: usize) {
        let steps = TourStep::all();
        let number = number.min(steps.len());
        let step = &steps[number.min(steps.len() - 1)];
        let document = match step.document() {
            Ok(document) => document,
            Err(error) => return self.fail(error.to_string()),
        };
        let done = self.tour.take().map(TourState::done).unwrap_or_default();
        self.cancel_bake();
        let own = self.own.take().unwrap_or_else(|| Box::new(self.paused()));
        let preferences = Preferences { offers_tour: false, ..self.preferences };
        let playback = self.playback.restarted(&document.timeline);
        let files = std::mem::take(&mut self.files);
        *self = Self { files, playback, ..Self::with_document(preferences, document) };
        self.refresh();
        self.reset_transport();
        self.preferences.explain = step.tab.is_some();
        self.preferences.timeline_open = Some(false);
        step.tab.into_iter().for_each(|tab| self.show_tab(tab));
        let joints = self.skeleton().iter();
        let selected = joints.filter(|(_, joint)| Some(joint.name.as_str()) == step.select);
        self.select(selected.map(|(id, _)| id).collect());
        self.tour = Some(TourState::new(number, self.shown().clone(), done));
        self.own = Some(own);
    }

    /// Ends all changes that are under way, and returns the session as it is then.
    fn paused(&mut self) -> Self {
        self.commit_edit();
        self.end_glide();
        self.apply_playback(PlaybackAction::Play(false));
        self.clone()
    }

    /// Puts the user's document back. Files and those preferences that the tour does not set are
    /// kept as they are now.
    pub(in crate::session) fn leave_tour(&mut self) {
        let Some(own) = self.own.take() else { return };
        self.cancel_bake();
        let Preferences { explain, arm_tab, skeleton_tab, timeline_open, curves, .. } =
            own.preferences;
        let preferences = Preferences {
            explain,
            arm_tab,
            skeleton_tab,
            timeline_open,
            curves,
            ..self.preferences
        };
        let files = std::mem::take(&mut self.files);
        *self = Self { files, preferences, ..*own };
    }

    /// Shows the result of the step once its task is done.
    pub(in crate::session) fn watch_tour(&mut self) {
        let is_met = self.tour.as_ref().is_some_and(|tour| {
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
        if self.tour.is_none() {
            return true;
        }
        if action.saves_document() {
            self.fail("leave the tour first: its scenes are not saved");
            return false;
        }
        if action.concerns_document() {
            self.leave_tour();
        }
        true
    }
}
