use super::error::OpenError;
use super::open::parse;
use super::opened::{OpenOptions, Opened};
use crate::document::Document;

/// An example document that is built into the program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Example {
    /// The list in which the example is shown.
    pub group: ExampleGroup,
    /// Name of the example's file, without extension.
    pub name: &'static str,
    /// Name of the example on screen.
    pub title: &'static str,
    /// One sentence that describes the example.
    pub sentence: &'static str,
    /// Content of the example's file.
    pub text: &'static str,
}

/// A list of examples.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ExampleGroup {
    /// Introduction to what the program can do.
    Basics,
    /// Targets that are not reached, one example for each cause.
    WhyNot,
    /// Iterations that are looked at part by part.
    InsideSolver,
    /// One example for each case that is hard for IK.
    HardCases,
}

/// Returns the document of a new window, which shows the arm. Its skeleton, to which the user can
/// switch, is the one of the Human example.
pub fn new_document() -> Document {
    let human = Example::find("human").and_then(|human| human.open().ok());
    let skeleton_rig = human.map(|opened| opened.document.skeleton_rig).unwrap_or_default();
    Document { skeleton_rig, ..Document::default() }
}

impl Example {
    /// All examples, in the order in which they are listed.
    pub const ALL: [Self; 32] = [
        Self {
            group: ExampleGroup::Basics,
            name: "arm",
            title: "Arm",
            sentence: "The arm of the paper, two limbs in closed form.",
            text: include_str!("../../assets/arm.json"),
        },
        Self {
            group: ExampleGroup::Basics,
            name: "two-targets",
            title: "Two targets on a Y",
            sentence: "A tree with two branches, each with a target of its own.",
            text: include_str!("../../assets/two-targets.json"),
        },
        Self {
            group: ExampleGroup::Basics,
            name: "human",
            title: "Human",
            sentence: "A figure whose hands and feet stay at their targets while its pelvis is dragged.",
            text: include_str!("../../assets/human.json"),
        },
        Self {
            group: ExampleGroup::Basics,
            name: "walk",
            title: "Walk",
            sentence: "A figure that walks: its feet stand at their targets while the pelvis moves \
                       on, and its arms swing by FK; press Space to play.",
            text: include_str!("../../assets/walk.json"),
        },
        Self {
            group: ExampleGroup::Basics,
            name: "wheel",
            title: "Two hands on a wheel",
            sentence: "A figure whose hands hold a wheel that turns: their targets are on the wheel.",
            text: include_str!("../../assets/wheel.json"),
        },
        Self {
            group: ExampleGroup::Basics,
            name: "candy-wrapper",
            title: "Candy wrapper",
            sentence: "A forearm that is twisted by 180°, with its skin blended in three ways; press \
                       Space to play, and watch the area of its middle.",
            text: include_str!("../../assets/candy-wrapper.json"),
        },
        Self {
            group: ExampleGroup::Basics,
            name: "table",
            title: "Table",
            sentence: "An arm whose hand rests on a table while its shoulder moves.",
            text: include_str!("../../assets/table.json"),
        },
        Self {
            group: ExampleGroup::Basics,
            name: "snake",
            title: "Snake",
            sentence: "Drag the circle at the head across the floor: 24 joints follow its path.",
            text: include_str!("../../assets/snake.json"),
        },
        Self {
            group: ExampleGroup::Basics,
            name: "tadpoles",
            title: "Tadpoles",
            sentence: "Five heads swim after moving targets, and their tails follow their paths; \
                       switch on Follow the mouse.",
            text: include_str!("../../assets/tadpoles.json"),
        },
        Self {
            group: ExampleGroup::Basics,
            name: "ten-joints",
            title: "Ten-joint chain",
            sentence: "A chain with one target, to watch the solvers at work.",
            text: include_str!("../../assets/ten-joints.json"),
        },
        Self {
            group: ExampleGroup::Basics,
            name: "keyframes",
            title: "Keyframes",
            sentence: "An arm whose hand goes along a spline through six keys; press Space to \
                       play.",
            text: include_str!("../../assets/keyframes.json"),
        },
        Self {
            group: ExampleGroup::Basics,
            name: "degenerate",
            title: "Degenerate cases",
            sentence: "Cases that break careless solvers: a bone without length, a target at the \
                       root, a straight chain, targets out of reach, all of it in a mirror.",
            text: include_str!("../../assets/degenerate.json"),
        },
        Self {
            group: ExampleGroup::WhyNot,
            name: "out-of-reach",
            title: "Out of reach",
            sentence: "The target is farther away than the bones are long; the note beside it offers what would help.",
            text: include_str!("../../assets/why/out-of-reach.json"),
        },
        Self {
            group: ExampleGroup::WhyNot,
            name: "at-a-limit",
            title: "At a limit",
            sentence: "The shin cannot bend far enough for the target; the note says by how much its limit must be widened.",
            text: include_str!("../../assets/why/at-a-limit.json"),
        },
        Self {
            group: ExampleGroup::WhyNot,
            name: "locked",
            title: "Locked",
            sentence: "A locked joint keeps the chain from its target, which it would reach if that joint could turn.",
            text: include_str!("../../assets/why/locked.json"),
        },
        Self {
            group: ExampleGroup::WhyNot,
            name: "pulled-apart",
            title: "Pulled apart",
            sentence: "Two targets are too far apart for the two arms of a Y: each can be reached alone, not both.",
            text: include_str!("../../assets/why/pulled-apart.json"),
        },
        Self {
            group: ExampleGroup::WhyNot,
            name: "gimbal-lock",
            title: "Gimbal lock",
            sentence: "At y = 90° two of a joint's angles turn about one axis, and none turns towards the target.",
            text: include_str!("../../assets/why/gimbal-lock.json"),
        },
        Self {
            group: ExampleGroup::WhyNot,
            name: "too-few-iterations",
            title: "Too few iterations",
            sentence: "The solver stops after 20 iterations, while the tip is still coming nearer.",
            text: include_str!("../../assets/why/too-few-iterations.json"),
        },
        Self {
            group: ExampleGroup::InsideSolver,
            name: "inside-dls",
            title: "Inside damped least squares",
            sentence: "One iteration, part by part: the columns of the Jacobian, its ellipsoid and what the damping leaves of it, and the step; Shift . shows the next part.",
            text: include_str!("../../assets/inside/inside-dls.json"),
        },
        Self {
            group: ExampleGroup::InsideSolver,
            name: "inside-ccd",
            title: "Inside CCD",
            sentence: "One iteration, part by part: each joint in turn swings the tip towards the target; Shift . shows the next part.",
            text: include_str!("../../assets/inside/inside-ccd.json"),
        },
        Self {
            group: ExampleGroup::InsideSolver,
            name: "inside-fabrik",
            title: "Inside FABRIK",
            sentence: "One iteration, part by part: the points go to the target and then back to the root; Shift . shows the next part.",
            text: include_str!("../../assets/inside/inside-fabrik.json"),
        },
        Self {
            group: ExampleGroup::HardCases,
            name: "through-the-root",
            title: "Target through the root",
            sentence: "The target goes straight through the shoulder: the hand comes no nearer \
                       than 100 and jumps to the other side; limbs of equal length take the jump \
                       away.",
            text: include_str!("../../assets/hard/through-the-root.json"),
        },
        Self {
            group: ExampleGroup::HardCases,
            name: "straight-up-and-down",
            title: "Straight up and down",
            sentence: "The hand goes around through straight up and straight down, where the \
                       Limb's elbow does not know its side and jumps; the Stereographic \
                       reference takes the jumps away.",
            text: include_str!("../../assets/hard/straight-up-and-down.json"),
        },
        Self {
            group: ExampleGroup::HardCases,
            name: "along-the-pole",
            title: "Along the pole",
            sentence: "The hand crosses the line to the pole, and the elbow that points at it \
                       flips over; the Stereographic reference takes the flip away.",
            text: include_str!("../../assets/hard/along-the-pole.json"),
        },
        Self {
            group: ExampleGroup::HardCases,
            name: "exactly-straight",
            title: "Exactly straight",
            sentence: "The target is exactly as far away as the arm is long: it is reached, and \
                       turning the Socket twist leaves the elbow where it is.",
            text: include_str!("../../assets/hard/exactly-straight.json"),
        },
        Self {
            group: ExampleGroup::HardCases,
            name: "just-past-straight",
            title: "Just past straight",
            sentence: "The target leaves the arm's reach and comes back, and the elbow snaps where \
                       the arm is straight; a softness of 0.1 takes the snap away.",
            text: include_str!("../../assets/hard/just-past-straight.json"),
        },
        Self {
            group: ExampleGroup::HardCases,
            name: "equal-bones-folded",
            title: "Equal bones folded",
            sentence: "The target goes through the shoulder of two equal limbs: they fold up \
                       completely, it is reached all the way, and nothing jumps.",
            text: include_str!("../../assets/hard/equal-bones-folded.json"),
        },
        Self {
            group: ExampleGroup::HardCases,
            name: "thousand-to-one",
            title: "One bone a thousand times the other",
            sentence: "A forearm of 0.3 on an upper arm of 300, small as its joints: the hand goes \
                       once around the elbow and stays at its target.",
            text: include_str!("../../assets/hard/thousand-to-one.json"),
        },
        Self {
            group: ExampleGroup::HardCases,
            name: "far-root",
            title: "Root a million units away",
            sentence: "The shoulder is a million units away, where f32 positions are 1/16 \
                       apart: the limbs keep their lengths within that rounding.",
            text: include_str!("../../assets/hard/far-root.json"),
        },
        Self {
            group: ExampleGroup::HardCases,
            name: "tiny",
            title: "Tiny arm",
            sentence: "An arm a thousandth of a unit long, which moves as the large ones do.",
            text: include_str!("../../assets/hard/tiny.json"),
        },
        Self {
            group: ExampleGroup::HardCases,
            name: "huge",
            title: "Huge arm",
            sentence: "An arm a million units long, which moves as the small ones do.",
            text: include_str!("../../assets/hard/huge.json"),
        },
        Self {
            group: ExampleGroup::HardCases,
            name: "mirrored",
            title: "Mirrored",
            sentence: "Two bones in a mirror, where turning left is turning right: the hand is at \
                       its target all the same; press R and Space, and it follows.",
            text: include_str!("../../assets/hard/mirrored.json"),
        },
    ];

    /// All examples of a group.
    pub fn of(group: ExampleGroup) -> impl Iterator<Item = Self> {
        Self::ALL.into_iter().filter(move |example| example.group == group)
    }

    /// The example called `name`; `None` if there is no such example.
    pub fn find(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|example| example.name == name)
    }

    /// Opens the example.
    ///
    /// # Errors
    ///
    /// Never fails: a test opens every example.
    pub fn open(self) -> Result<Opened, OpenError> {
        parse(self.name, self.text, &OpenOptions::default())
    }
}
