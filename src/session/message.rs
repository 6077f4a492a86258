use super::Session;

/// The line at the bottom of the window.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Message {
    text: String,
    /// Whether it says why something was not done.
    is_error: bool,
}

impl Session {
    /// What just happened or failed; `None` once the next edit follows.
    pub fn message(&self) -> Option<&str> {
        self.message.as_ref().map(|message| message.text.as_str())
    }

    /// Whether [`Session::message`] says why something was not done.
    pub fn has_failed(&self) -> bool {
        self.message.as_ref().is_some_and(|message| message.is_error)
    }

    pub(super) fn say(&mut self, text: impl Into<String>) {
        self.message = Some(Message { text: text.into(), is_error: false });
    }

    /// Says why something was not done, as a sentence.
    pub(super) fn fail(&mut self, why: impl Into<String>) {
        let why = why.into();
        let mut letters = why.chars();
        let first = letters.next().map(|letter| letter.to_uppercase().to_string());
        let text = format!("{}{}", first.unwrap_or_default(), letters.as_str());
        self.message = Some(Message { text, is_error: true });
    }
}
