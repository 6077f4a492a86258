/// A scanner that splits a text into words.
#[derive(Clone, Copy)]
pub struct Scanner<'a> {
    text: &'a str,
    at: usize,
}

/// A part of the text, and the byte at which it begins.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Token<'a> {
    pub text: &'a str,
    pub at: usize,
}

/// An error at a byte of the text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TextError {
    pub at: usize,
    /// Name of the joint that the error is about; empty if the error is about no joint.
    pub joint: String,
    pub reason: String,
}

impl<'a> Scanner<'a> {
    pub fn new(text: &'a str) -> Self {
        Self { text, at: 0 }
    }

    /// Reads the next word or brace. The token is empty at the end of the text.
    pub fn word(&mut self) -> Token<'a> {
        let rest = self.skip_space();
        let end = if rest.starts_with(is_brace) {
            1
        } else {
            rest.find(|c: char| c.is_whitespace() || is_brace(c)).unwrap_or(rest.len())
        };
        self.take(end)
    }

    /// Skips space and line ends, then reads up to a brace or the end of the line. Space at the end
    /// of the token is removed.
    pub fn name(&mut self) -> Token<'a> {
        let rest = self.skip_space();
        let is_end = |c: char| c == '\n' || c == '\r' || is_brace(c);
        let word = self.take(rest.find(is_end).unwrap_or(rest.len()));
        Token { text: word.text.trim_end(), ..word }
    }

    /// Skips `words` and a colon if they come next in the text. Returns whether they did.
    pub fn label(&mut self, words: &[&str]) -> bool {
        let mut ahead = *self;
        for word in words {
            let rest = ahead.skip_space();
            let is_there =
                rest.get(..word.len()).is_some_and(|start| start.eq_ignore_ascii_case(word));
            if !is_there {
                return false;
            }
            ahead.take(word.len());
        }
        let is_there = ahead.skip_space().starts_with(':');
        if is_there {
            ahead.take(1);
            *self = ahead;
        }
        is_there
    }

    /// Skips space and line ends, then reads up to the end of the line. Space at the end of the
    /// token is removed. Returns `None` at the end of the text.
    pub fn line(&mut self) -> Option<Token<'a>> {
        let rest = self.skip_space();
        let word = self.take(rest.find(['\n', '\r']).unwrap_or(rest.len()));
        (!word.text.is_empty()).then(|| Token { text: word.text.trim_end(), ..word })
    }

    /// Number of bytes of the text that are not read yet.
    pub fn remaining(&self) -> usize {
        self.text.len() - self.at
    }

    fn skip_space(&mut self) -> &'a str {
        let rest = self.text.get(self.at..).unwrap_or_default();
        let trimmed = rest.trim_start();
        self.at += rest.len() - trimmed.len();
        trimmed
    }

    fn take(&mut self, length: usize) -> Token<'a> {
        let at = self.at;
        self.at += length;
        Token { text: self.text.get(at..self.at).unwrap_or_default(), at }
    }
}

impl<'a> Token<'a> {
    /// The words in the token's text.
    pub fn words(self) -> impl Iterator<Item = Self> {
        let mut remaining = self;
        std::iter::from_fn(move || {
            let trimmed = remaining.text.trim_start();
            let at = remaining.at + remaining.text.len() - trimmed.len();
            let end = trimmed.find(char::is_whitespace).unwrap_or(trimmed.len());
            let (text, rest) = trimmed.split_at_checked(end)?;
            remaining = Self { text: rest, at: at + end };
            (!text.is_empty()).then_some(Self { text, at })
        })
    }

    pub fn is(self, keyword: &str) -> bool {
        self.text.eq_ignore_ascii_case(keyword)
    }

    /// The byte of the text after the token.
    pub fn end(self) -> usize {
        self.at + self.text.len()
    }

    pub fn number(self, joint: &str) -> Result<f32, TextError> {
        let error = |reason| TextError::new(self.at, joint, reason);
        let number: f64 = match self.text.parse() {
            Ok(number) => number,
            Err(_) => return Err(error(format!("{}, expected a number", self.found()))),
        };
        if (number as f32).is_finite() {
            return Ok(number as f32);
        }
        Err(error(format!("must be within ±3.4028235e38, got {}", self.text)))
    }

    pub fn whole(self, joint: &str) -> Result<usize, TextError> {
        self.text.parse().map_err(|_| {
            let reason = format!("{}, expected a whole number, 0 or more", self.found());
            TextError::new(self.at, joint, reason)
        })
    }

    pub fn found(self) -> String {
        match self.text {
            "" => "found the end of the file".to_owned(),
            text => format!("found {text:?}"),
        }
    }
}

impl TextError {
    pub fn new(at: usize, joint: &str, reason: impl Into<String>) -> Self {
        Self { at, joint: joint.to_owned(), reason: reason.into() }
    }
}

fn is_brace(c: char) -> bool {
    c == '{' || c == '}'
}
