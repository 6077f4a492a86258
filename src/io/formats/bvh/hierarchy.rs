use glam::Vec3;

use crate::kinematics::skeleton::Skeleton;

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

/// A joint of the file.
pub struct BvhNode {
    pub name: String,
    /// The byte of the text at which the name begins.
    pub at: usize,
    pub parent: Option<usize>,
    pub offset: Vec3,
    pub channels: Vec<BvhChannel>,
    /// True if position channels do not replace `offset`.
    pub keeps_offset: bool,
    /// The tip of the joint's bone relative to its base; `None` without an End Site.
    pub end: Option<Vec3>,
}

/// A channel of a joint. The number is the axis: 0 for x, 1 for y, 2 for z.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BvhChannel {
    Position(usize),
    Rotation(usize),
}

impl BvhChannel {
    pub const ALL: [(&'static str, Self); 6] = [
        ("Xposition", Self::Position(0)),
        ("Yposition", Self::Position(1)),
        ("Zposition", Self::Position(2)),
        ("Xrotation", Self::Rotation(0)),
        ("Yrotation", Self::Rotation(1)),
        ("Zrotation", Self::Rotation(2)),
    ];

    pub fn name(self) -> &'static str {
        Self::ALL.iter().find(|(_, channel)| *channel == self).map_or("", |(name, _)| name)
    }
}

/// Reads the text up to and including the word MOTION. Returns all joints, parents before their
/// children.
pub fn read(text: &mut Scanner<'_>) -> Result<Vec<BvhNode>, TextError> {
    let first = text.word();
    if !first.is("HIERARCHY") {
        return Err(TextError::new(first.at, "", format!("{}, expected HIERARCHY", first.found())));
    }
    let mut hierarchy = Hierarchy::default();
    loop {
        let word = text.word();
        let is_done = match hierarchy.open.last().copied() {
            None => hierarchy.outside(word, text)?,
            Some(OpenBlock::Joint { node, seen }) => hierarchy.in_joint(word, text, node, seen)?,
            Some(OpenBlock::End { node, end }) => hierarchy.in_end(word, text, node, end)?,
        };
        if is_done {
            return Ok(hierarchy.nodes);
        }
    }
}

#[derive(Default)]
struct Hierarchy {
    nodes: Vec<BvhNode>,
    /// The blocks that are not closed yet, from the root inwards.
    open: Vec<OpenBlock>,
}

#[derive(Clone, Copy)]
enum OpenBlock {
    Joint { node: usize, seen: JointKeywords },
    End { node: usize, end: Option<Vec3> },
}

/// The keywords that were already read in the block of a joint.
#[derive(Clone, Copy, Default)]
struct JointKeywords {
    offset: bool,
    channels: bool,
    children: bool,
}

impl Hierarchy {
    /// Reads a word outside all blocks. Returns whether the hierarchy is complete.
    fn outside(&mut self, word: Token<'_>, text: &mut Scanner<'_>) -> Result<bool, TextError> {
        if word.is("ROOT") {
            self.add(text, word, None)?;
            return Ok(false);
        }
        if word.is("MOTION") && !self.nodes.is_empty() {
            return Ok(true);
        }
        let expected = if self.nodes.is_empty() { "ROOT" } else { "ROOT or MOTION" };
        Err(TextError::new(word.at, "", format!("{}, expected {expected}", word.found())))
    }

    fn in_joint(
        &mut self,
        word: Token<'_>,
        text: &mut Scanner<'_>,
        index: usize,
        seen: JointKeywords,
    ) -> Result<bool, TextError> {
        let node = &mut self.nodes[index];
        let error = |reason: &str| Err(TextError::new(word.at, &node.name, reason));
        let mut updated = seen;
        if word.is("OFFSET") {
            if seen.offset {
                return error("must have one OFFSET, got a second");
            }
            node.offset = point(text, &node.name)?;
            updated.offset = true;
        } else if word.is("CHANNELS") {
            if seen.channels {
                return error("must have one CHANNELS, got a second");
            }
            if seen.children {
                return error("CHANNELS must be before the joint's children");
            }
            node.channels = channels(text, &node.name)?;
            updated.channels = true;
        } else if word.is("JOINT") {
            updated.children = true;
            self.set(OpenBlock::Joint { node: index, seen: updated });
            self.add(text, word, Some(index))?;
            return Ok(false);
        } else if word.is("End") {
            let site = text.name();
            if !site.text.get(..4).is_some_and(|start| start.eq_ignore_ascii_case("Site")) {
                return Err(TextError::new(site.at, &node.name, "End must be followed by Site"));
            }
            brace(text, &node.name)?;
            self.open.push(OpenBlock::End { node: index, end: None });
            return Ok(false);
        } else if word.text == "}" {
            if !seen.offset {
                return error("must have an OFFSET");
            }
            self.open.pop();
            return Ok(false);
        } else {
            let expected = "expected OFFSET, CHANNELS, JOINT, End Site or }";
            return error(&format!("{}, {expected}", word.found()));
        }
        self.set(OpenBlock::Joint { node: index, seen: updated });
        Ok(false)
    }

    fn in_end(
        &mut self,
        word: Token<'_>,
        text: &mut Scanner<'_>,
        index: usize,
        end: Option<Vec3>,
    ) -> Result<bool, TextError> {
        let node = &mut self.nodes[index];
        if word.is("OFFSET") && end.is_none() {
            let end = point(text, &node.name)?;
            self.set(OpenBlock::End { node: index, end: Some(end) });
        } else if let Some(end) = end.filter(|_| word.text == "}") {
            // Of several End Sites, the first is used.
            node.end.get_or_insert(end);
            self.open.pop();
        } else {
            let expected = if end.is_some() { "}" } else { "OFFSET" };
            let reason = format!("{}, expected {expected} in the End Site", word.found());
            return Err(TextError::new(word.at, &node.name, reason));
        }
        Ok(false)
    }

    fn set(&mut self, block: OpenBlock) {
        if let Some(last) = self.open.last_mut() {
            *last = block;
        }
    }

    fn add(
        &mut self,
        text: &mut Scanner<'_>,
        keyword: Token<'_>,
        parent: Option<usize>,
    ) -> Result<(), TextError> {
        let name = text.name();
        if name.text.is_empty() {
            let reason = format!("{} must be followed by a name", keyword.text);
            return Err(TextError::new(name.at, "", reason));
        }
        if self.nodes.len() >= Skeleton::MOST_JOINTS {
            let reason = format!("the skeleton must have at most {} joints", Skeleton::MOST_JOINTS);
            return Err(TextError::new(name.at, name.text, reason));
        }
        brace(text, name.text)?;
        self.open.push(OpenBlock::Joint { node: self.nodes.len(), seen: JointKeywords::default() });
        self.nodes.push(BvhNode {
            name: name.text.to_owned(),
            at: name.at,
            parent,
            offset: Vec3::ZERO,
            channels: Vec::new(),
            keeps_offset: false,
            end: None,
        });
        Ok(())
    }
}

fn brace(text: &mut Scanner<'_>, joint: &str) -> Result<(), TextError> {
    let word = text.word();
    match word.text {
        "{" => Ok(()),
        _ => Err(TextError::new(word.at, joint, format!("{}, expected {{", word.found()))),
    }
}

fn point(text: &mut Scanner<'_>, joint: &str) -> Result<Vec3, TextError> {
    let mut number = || text.word().number(joint);
    Ok(Vec3::new(number()?, number()?, number()?))
}

fn channels(text: &mut Scanner<'_>, joint: &str) -> Result<Vec<BvhChannel>, TextError> {
    let count = text.word();
    let number = count.whole(joint)?;
    if number > BvhChannel::ALL.len() {
        let reason = format!("must have 0 to 6 channels, got {number}");
        return Err(TextError::new(count.at, joint, reason));
    }
    let mut channels = Vec::with_capacity(number);
    for _ in 0..number {
        let word = text.word();
        let named = BvhChannel::ALL.into_iter().find(|(name, _)| word.is(name));
        let Some((name, channel)) = named else {
            let names = BvhChannel::ALL.map(|(name, _)| name).join(", ");
            let reason = format!("{}, expected a channel: {names}", word.found());
            return Err(TextError::new(word.at, joint, reason));
        };
        if channels.contains(&channel) {
            return Err(TextError::new(
                word.at,
                joint,
                format!("CHANNELS must have {name} once, got a second"),
            ));
        }
        channels.push(channel);
    }
    Ok(channels)
}
