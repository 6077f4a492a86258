use super::OpenError;
use super::open::{Opened, parse};

/// A scene that comes with the program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Example {
    /// As its file is called, without its ending.
    pub name: &'static str,
    pub title: &'static str,
    /// What it shows, in one sentence.
    pub sentence: &'static str,
    /// What its file has, in the program's own format.
    pub text: &'static str,
}

impl Example {
    pub const ALL: [Self; 7] = [
        Self {
            name: "arm",
            title: "Arm",
            sentence: "The arm of the paper, two limbs in closed form.",
            text: include_str!("../../assets/arm.json"),
        },
        Self {
            name: "two-targets",
            title: "Two targets on a Y",
            sentence: "A tree with two branches, each with a target of its own.",
            text: include_str!("../../assets/two-targets.json"),
        },
        Self {
            name: "human",
            title: "Human",
            sentence: "A figure with limited elbows and knees, and targets for hands and feet.",
            text: include_str!("../../assets/human.json"),
        },
        Self {
            name: "snake",
            title: "Snake",
            sentence: "24 joints that follow their head around in waves.",
            text: include_str!("../../assets/snake.json"),
        },
        Self {
            name: "ten-joints",
            title: "Ten-joint chain",
            sentence: "A chain with one target, to watch the solvers at work.",
            text: include_str!("../../assets/ten-joints.json"),
        },
        Self {
            name: "keyframes",
            title: "Keyframes",
            sentence: "An arm whose hand goes along a spline through six keys; press Space to play.",
            text: include_str!("../../assets/keyframes.json"),
        },
        Self {
            name: "degenerate",
            title: "Degenerate cases",
            sentence: "What breaks careless solvers: a bone without length, a target at the root, a \
                       straight chain, targets out of reach, all of it in a mirror.",
            text: include_str!("../../assets/degenerate.json"),
        },
    ];

    pub fn find(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|example| example.name == name)
    }

    /// # Errors
    ///
    /// None, as the tests have it.
    pub fn open(self) -> Result<Opened, OpenError> {
        parse(self.name, self.text, None)
    }
}
