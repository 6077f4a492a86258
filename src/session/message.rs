/// The text in the status bar.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Message {
    text: String,
    is_error: bool,
    /// Whether the message is about the pose at the current time, and goes when the time changes.
    is_of_moment: bool,
}

impl Message {
    pub fn new(text: impl Into<String>) -> Self {
        Self { text: text.into(), is_error: false, is_of_moment: false }
    }

    /// A message about the pose at the current time.
    pub fn of_moment(text: impl Into<String>) -> Self {
        Self { is_of_moment: true, ..Self::new(text) }
    }

    pub fn is_of_moment(&self) -> bool {
        self.is_of_moment
    }

    /// An error message; the first letter of `why` becomes a capital.
    pub fn error(why: &str) -> Self {
        let mut letters = why.chars();
        let first = letters.next().map(|letter| letter.to_uppercase().to_string());
        let text = format!("{}{}", first.unwrap_or_default(), letters.as_str());
        Self { text, is_error: true, is_of_moment: false }
    }

    pub fn text(&self) -> &str {
        &self.text
    }

    pub fn is_error(&self) -> bool {
        self.is_error
    }
}
