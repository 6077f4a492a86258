use glam::Vec3;

use super::text::{Fault, Text, Word};
use crate::kinematics::skeleton::Skeleton;

/// A joint as the file has it.
pub struct Node {
    pub name: String,
    /// Where in the text the name is.
    pub at: usize,
    pub parent: Option<usize>,
    pub offset: Vec3,
    pub channels: Vec<Channel>,
    /// Where its bone ends, if an End Site says.
    pub end: Option<Vec3>,
}

/// What a number of a frame moves: x, y or z (0, 1, 2).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Channel {
    Position(usize),
    Rotation(usize),
}

impl Channel {
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

/// All joints, parents before their children, up to the word MOTION and with it.
pub fn read(text: &mut Text<'_>) -> Result<Vec<Node>, Fault> {
    let first = text.word();
    if !first.is("HIERARCHY") {
        return Err(Fault::new(first.at, "", format!("{}, expected HIERARCHY", first.found())));
    }
    let mut hierarchy = Hierarchy::default();
    loop {
        let word = text.word();
        let is_done = match hierarchy.open.last().copied() {
            None => hierarchy.outside(word, text)?,
            Some(Block::Joint { node, has }) => hierarchy.in_joint(word, text, node, has)?,
            Some(Block::End { node, end }) => hierarchy.in_end(word, text, node, end)?,
        };
        if is_done {
            return Ok(hierarchy.nodes);
        }
    }
}

#[derive(Default)]
struct Hierarchy {
    nodes: Vec<Node>,
    /// The blocks that are open, from the root inwards.
    open: Vec<Block>,
}

#[derive(Clone, Copy)]
enum Block {
    Joint { node: usize, has: Has },
    End { node: usize, end: Option<Vec3> },
}

/// What has been said of a joint.
#[derive(Clone, Copy, Default)]
struct Has {
    offset: bool,
    channels: bool,
    children: bool,
}

impl Hierarchy {
    /// Whether it is done.
    fn outside(&mut self, word: Word<'_>, text: &mut Text<'_>) -> Result<bool, Fault> {
        if word.is("ROOT") {
            self.add(text, word, None)?;
            return Ok(false);
        }
        if word.is("MOTION") && !self.nodes.is_empty() {
            return Ok(true);
        }
        let expected = if self.nodes.is_empty() { "ROOT" } else { "ROOT or MOTION" };
        Err(Fault::new(word.at, "", format!("{}, expected {expected}", word.found())))
    }

    fn in_joint(
        &mut self,
        word: Word<'_>,
        text: &mut Text<'_>,
        index: usize,
        has: Has,
    ) -> Result<bool, Fault> {
        let node = &mut self.nodes[index];
        let wrong = |reason: &str| Err(Fault::new(word.at, &node.name, reason));
        let mut now = has;
        if word.is("OFFSET") {
            if has.offset {
                return wrong("OFFSET stands twice in this joint");
            }
            node.offset = point(text, &node.name)?;
            now.offset = true;
        } else if word.is("CHANNELS") {
            if has.channels {
                return wrong("CHANNELS stands twice in this joint");
            }
            if has.children {
                return wrong("CHANNELS must stand before what hangs from the joint");
            }
            node.channels = channels(text, &node.name)?;
            now.channels = true;
        } else if word.is("JOINT") {
            now.children = true;
            self.set(Block::Joint { node: index, has: now });
            self.add(text, word, Some(index))?;
            return Ok(false);
        } else if word.is("End") {
            let site = text.name();
            if !site.text.get(..4).is_some_and(|start| start.eq_ignore_ascii_case("Site")) {
                return Err(Fault::new(site.at, &node.name, "Site must stand after End"));
            }
            brace(text, &node.name)?;
            self.open.push(Block::End { node: index, end: None });
            return Ok(false);
        } else if word.text == "}" {
            if !has.offset {
                return wrong("OFFSET is missing: it says where the joint is from its parent");
            }
            self.open.pop();
            return Ok(false);
        } else {
            let expected = "expected OFFSET, CHANNELS, JOINT, End Site or }";
            return wrong(&format!("{}, {expected}", word.found()));
        }
        self.set(Block::Joint { node: index, has: now });
        Ok(false)
    }

    fn in_end(
        &mut self,
        word: Word<'_>,
        text: &mut Text<'_>,
        index: usize,
        end: Option<Vec3>,
    ) -> Result<bool, Fault> {
        let node = &mut self.nodes[index];
        if word.is("OFFSET") && end.is_none() {
            let end = point(text, &node.name)?;
            self.set(Block::End { node: index, end: Some(end) });
        } else if let Some(end) = end.filter(|_| word.text == "}") {
            // Of several the first counts.
            node.end.get_or_insert(end);
            self.open.pop();
        } else {
            let expected = if end.is_some() { "}" } else { "OFFSET" };
            let reason = format!("{}, expected {expected} in the End Site", word.found());
            return Err(Fault::new(word.at, &node.name, reason));
        }
        Ok(false)
    }

    fn set(&mut self, block: Block) {
        if let Some(last) = self.open.last_mut() {
            *last = block;
        }
    }

    fn add(
        &mut self,
        text: &mut Text<'_>,
        keyword: Word<'_>,
        parent: Option<usize>,
    ) -> Result<(), Fault> {
        let name = text.name();
        if name.text.is_empty() {
            let reason = format!("a name is missing after {}", keyword.text);
            return Err(Fault::new(name.at, "", reason));
        }
        if self.nodes.len() >= Skeleton::MOST_JOINTS {
            let reason = format!("a skeleton has at most {} joints", Skeleton::MOST_JOINTS);
            return Err(Fault::new(name.at, name.text, reason));
        }
        brace(text, name.text)?;
        self.open.push(Block::Joint { node: self.nodes.len(), has: Has::default() });
        self.nodes.push(Node {
            name: name.text.to_owned(),
            at: name.at,
            parent,
            offset: Vec3::ZERO,
            channels: Vec::new(),
            end: None,
        });
        Ok(())
    }
}

fn brace(text: &mut Text<'_>, joint: &str) -> Result<(), Fault> {
    let word = text.word();
    match word.text {
        "{" => Ok(()),
        _ => Err(Fault::new(word.at, joint, format!("{}, expected {{", word.found()))),
    }
}

fn point(text: &mut Text<'_>, joint: &str) -> Result<Vec3, Fault> {
    let mut number = || text.word().number(joint);
    Ok(Vec3::new(number()?, number()?, number()?))
}

fn channels(text: &mut Text<'_>, joint: &str) -> Result<Vec<Channel>, Fault> {
    let count = text.word();
    let number = count.whole(joint)?;
    if number > Channel::ALL.len() {
        let reason = format!("{number} channels are more than there are: 0 to 6");
        return Err(Fault::new(count.at, joint, reason));
    }
    let mut channels = Vec::with_capacity(number);
    for _ in 0..number {
        let word = text.word();
        let named = Channel::ALL.into_iter().find(|(name, _)| word.is(name));
        let Some((name, channel)) = named else {
            let names = Channel::ALL.map(|(name, _)| name).join(", ");
            let reason = format!("{}, expected a channel: {names}", word.found());
            return Err(Fault::new(word.at, joint, reason));
        };
        if channels.contains(&channel) {
            return Err(Fault::new(word.at, joint, format!("{name} stands twice in CHANNELS")));
        }
        channels.push(channel);
    }
    Ok(channels)
}
