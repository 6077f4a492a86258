use super::steps::{TourEnd, TourStep};
use crate::document::Document;

/// Moves through the tour.
#[derive(Clone, Debug, PartialEq)]
pub enum TourAction {
    /// Begins a step, counted from 0; the user's document is kept for the end of the tour. A number
    /// beyond the last step shows the card after it, with the scene of the last step.
    Enter(usize),
    /// Chooses an answer to the step's question, counted from 0.
    Guess(usize),
    /// Does the step's task for the user and shows the result.
    Demonstrate,
    /// Ends the tour and puts the user's document back.
    Leave,
    /// Declines the tour; it is not offered again.
    Decline,
}

/// Where the user is in the tour: in a step, or at the card after the last one.
#[derive(Clone, Debug, PartialEq)]
pub struct TourState {
    number: usize,
    /// The document with which the step began.
    start: Document,
    guess: Option<usize>,
    shows_result: bool,
    /// For each step, whether the user has done its task.
    done: Vec<bool>,
}

impl TourState {
    /// A step of a tour in which the tasks of some steps were `done`.
    pub(in crate::session) fn new(number: usize, start: Document, mut done: Vec<bool>) -> Self {
        done.resize(TourStep::all().len(), false);
        Self { number, start, guess: None, shows_result: false, done }
    }

    /// Number of the step, counted from 0; at the card after the last step, the number of all
    /// steps.
    pub fn number(&self) -> usize {
        self.number
    }

    /// The step; `None` at the card after the last one.
    pub fn step(&self) -> Option<&'static TourStep> {
        TourStep::all().get(self.number)
    }

    /// Title of the card.
    pub fn title(&self) -> &'static str {
        self.step().map_or(TourEnd::get().title, |step| step.title)
    }

    /// The document with which the step began.
    pub(in crate::session) fn start(&self) -> &Document {
        &self.start
    }

    /// The chosen answer to the step's question; `None` before it was chosen.
    pub fn guess(&self) -> Option<usize> {
        self.guess
    }

    /// True while the result of the step is shown: its task was done, by the user or in a
    /// demonstration.
    pub fn shows_result(&self) -> bool {
        self.shows_result
    }

    /// True if the user has done the task of a step, counted from 0.
    pub fn is_done(&self, number: usize) -> bool {
        self.done.get(number).copied().unwrap_or(false)
    }

    /// For each step, whether the user has done its task.
    pub(in crate::session) fn done(self) -> Vec<bool> {
        self.done
    }

    pub(in crate::session) fn choose(&mut self, answer: usize) {
        if self.step().is_some_and(|step| answer < step.guess.answers.len()) {
            self.guess = Some(answer);
        }
    }

    pub(in crate::session) fn show_result(&mut self) {
        self.shows_result = true;
    }

    pub(in crate::session) fn finish(&mut self) {
        self.shows_result = true;
        if let Some(done) = self.done.get_mut(self.number) {
            *done = true;
        }
    }
}
