/// A way through a text, word by word.
#[derive(Clone, Copy)]
pub struct Text<'a> {
    text: &'a str,
    at: usize,
}

/// Some of a text, and the byte at which it begins.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Word<'a> {
    pub text: &'a str,
    pub at: usize,
}

/// What is wrong at a byte of a text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fault {
    pub at: usize,
    /// The joint that it is about; empty where it is about none.
    pub joint: String,
    pub reason: String,
}

impl<'a> Text<'a> {
    pub fn new(text: &'a str) -> Self {
        Self { text, at: 0 }
    }

    /// What stands between spaces and braces, or a brace; empty at the end.
    pub fn word(&mut self) -> Word<'a> {
        let rest = self.skip_space();
        let end = match rest.starts_with(is_brace) {
            true => 1,
            false => rest.find(|c: char| c.is_whitespace() || is_brace(c)).unwrap_or(rest.len()),
        };
        self.take(end)
    }

    /// What stands before the end of the line or a brace, on this line or the next that has
    /// something; without the spaces around it.
    pub fn name(&mut self) -> Word<'a> {
        let rest = self.skip_space();
        let is_end = |c: char| c == '\n' || c == '\r' || is_brace(c);
        let word = self.take(rest.find(is_end).unwrap_or(rest.len()));
        Word { text: word.text.trim_end(), ..word }
    }

    /// Passes over these words and a colon, if they are next.
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

    /// What is left of this line, or else the next that has something; nothing at the end.
    pub fn line(&mut self) -> Option<Word<'a>> {
        let rest = self.skip_space();
        let word = self.take(rest.find(['\n', '\r']).unwrap_or(rest.len()));
        (!word.text.is_empty()).then(|| Word { text: word.text.trim_end(), ..word })
    }

    /// How many bytes are left.
    pub fn left(&self) -> usize {
        self.text.len() - self.at
    }

    fn skip_space(&mut self) -> &'a str {
        let rest = self.text.get(self.at..).unwrap_or_default();
        let trimmed = rest.trim_start();
        self.at += rest.len() - trimmed.len();
        trimmed
    }

    fn take(&mut self, length: usize) -> Word<'a> {
        let at = self.at;
        self.at += length;
        Word { text: self.text.get(at..self.at).unwrap_or_default(), at }
    }
}

impl<'a> Word<'a> {
    /// The words of it, which is a line.
    pub fn words(self) -> impl Iterator<Item = Self> {
        let mut left = self;
        std::iter::from_fn(move || {
            let trimmed = left.text.trim_start();
            let at = left.at + left.text.len() - trimmed.len();
            let end = trimmed.find(char::is_whitespace).unwrap_or(trimmed.len());
            let (text, rest) = trimmed.split_at_checked(end)?;
            left = Self { text: rest, at: at + end };
            (!text.is_empty()).then_some(Self { text, at })
        })
    }

    pub fn is(self, keyword: &str) -> bool {
        self.text.eq_ignore_ascii_case(keyword)
    }

    /// The byte after it.
    pub fn end(self) -> usize {
        self.at + self.text.len()
    }

    pub fn number(self, joint: &str) -> Result<f32, Fault> {
        let wrong = |reason| Fault::new(self.at, joint, reason);
        let number: f64 = match self.text.parse() {
            Ok(number) => number,
            Err(_) => return Err(wrong(format!("{}, expected a number", self.found()))),
        };
        if (number as f32).is_finite() {
            return Ok(number as f32);
        }
        Err(wrong(format!("{} is out of range; it must be between ±3.4028235e38", self.text)))
    }

    pub fn whole(self, joint: &str) -> Result<usize, Fault> {
        self.text.parse().map_err(|_| {
            let reason = format!("{}, expected a whole number, 0 or more", self.found());
            Fault::new(self.at, joint, reason)
        })
    }

    pub fn found(self) -> String {
        match self.text {
            "" => "found the end of the file".to_owned(),
            text => format!("found {text:?}"),
        }
    }
}

impl Fault {
    pub fn new(at: usize, joint: &str, reason: impl Into<String>) -> Self {
        Self { at, joint: joint.to_owned(), reason: reason.into() }
    }
}

fn is_brace(c: char) -> bool {
    c == '{' || c == '}'
}
