/// The text in the status bar.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Message {
    text: String,
    is_error: bool,
}

impl Message {
    pub fn new(text: impl Into<String>) -> Self {
        Self { text: text.into(), is_error: false }
    }

    /// An error message; the first letter of `why` becomes a capital.
    pub fn error(why: &str) -> Self {
        let mut letters = why.chars();
        let first = letters.next().map(|letter| letter.to_uppercase().to_string());
        let text = format!("{}{}", first.unwrap_or_default(), letters.as_str());
        Self { text, is_error: true }
    }

    pub fn text(&self) -> &str {
        &self.text
    }

    pub fn is_error(&self) -> bool {
        self.is_error
    }
}
