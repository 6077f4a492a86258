use std::sync::LazyLock;

use serde::Deserialize;

use super::goal::Goal;
use crate::document::Document;
use crate::io::{Example, OpenError, OpenOptions, parse};
use crate::session::panel_tab::PanelTab;

/// A step of the tour.
///
/// Texts may name live numbers of the scene in braces, such as `{hand}`. Parts of the window and new
/// terms are between asterisks.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TourStep {
    /// The step's title.
    pub title: String,
    /// Name of the scene: of a file in `assets/tour`, or of an example.
    scene: String,
    /// Page of the panel on the right that the step shows.
    #[serde(default)]
    pub tab: Option<PanelTab>,
    /// Section of the left panel that the step opens.
    #[serde(default)]
    pub section: Option<String>,
    /// Name of the joint that is selected at first.
    #[serde(default)]
    pub(super) select: Option<String>,
    /// What there is to see.
    pub text: String,
    /// The question to think about before the task.
    pub guess: Guess,
    /// What to do, with the mouse.
    pub task: String,
    /// How to do the same without a mouse.
    pub keyboard: String,
    /// The task, for the program.
    pub goal: Goal,
    /// What happens, and why.
    pub result: String,
}

/// A question with its possible answers.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Guess {
    /// The question.
    pub question: String,
    /// Two to four answers.
    pub answers: Vec<String>,
    /// Index of the right answer.
    right: usize,
}

impl Guess {
    /// The right answer.
    pub fn right_answer(&self) -> &str {
        self.answers.get(self.right).map_or("", String::as_str)
    }

    /// Whether an answer, counted from 0, is the right one.
    pub fn is_right(&self, answer: usize) -> bool {
        answer == self.right
    }
}

/// The card after the last step: what the user can say now.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TourEnd {
    /// The card's title.
    pub title: String,
    /// What the user can say now.
    pub sentences: Vec<String>,
    /// Where to go next, with parts of the window between asterisks.
    pub next: String,
}

/// The scenes that are no examples, by their names.
const SCENES: [(&str, &str); 6] = [
    ("over-the-shoulder", include_str!("../../../assets/tour/over-the-shoulder.json")),
    ("elbow-circle", include_str!("../../../assets/tour/elbow-circle.json")),
    ("limits", include_str!("../../../assets/tour/limits.json")),
    ("nearly-straight", include_str!("../../../assets/tour/nearly-straight.json")),
    ("globe", include_str!("../../../assets/tour/globe.json")),
    ("two-keys", include_str!("../../../assets/tour/two-keys.json")),
];

static STEPS: LazyLock<Vec<TourStep>> = LazyLock::new(|| {
    serde_json::from_str(include_str!("../../../assets/tour/steps.json"))
        .unwrap_or_else(|error| unreachable!("a test reads the steps of the tour: {error}"))
});

static END: LazyLock<TourEnd> = LazyLock::new(|| {
    serde_json::from_str(include_str!("../../../assets/tour/end.json"))
        .unwrap_or_else(|error| unreachable!("a test reads the end of the tour: {error}"))
});

impl TourEnd {
    /// The card after the last step.
    pub fn get() -> &'static Self {
        &END
    }
}

impl TourStep {
    /// All steps, in order.
    pub fn all() -> &'static [Self] {
        &STEPS
    }

    /// The document of the step's scene.
    ///
    /// # Errors
    ///
    /// Never fails: a test opens every scene.
    pub fn document(&self) -> Result<Document, OpenError> {
        let of_tour = SCENES.into_iter().find(|(name, _)| *name == self.scene);
        let example = || Example::find(&self.scene).map(|example| example.text);
        let text = of_tour.map(|(_, text)| text).or_else(example).unwrap_or_default();
        Ok(parse(&self.scene, text, &OpenOptions::default())?.document)
    }
}
