//! The examples that are built into the program.

use super::error::OpenError;
use super::open::parse;
use super::opened::{OpenOptions, Opened};
use crate::document::Theme;

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
    /// Its pictures in the dark and in the light theme.
    pictures: [&'static [u8]; 2],
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

/// Lists the examples by groups: the folder of a group's files in `assets/`, then the name, title
/// and sentence of each example.
macro_rules! examples {
    ($($group:ident in $folder:literal {
        $($name:literal, $title:literal => $sentence:literal;)*
    })*) => {
        [$($(Self {
            group: ExampleGroup::$group,
            name: $name,
            title: $title,
            sentence: $sentence,
            text: include_str!(concat!("../../assets/", $folder, $name, ".json")),
            pictures: [
                include_bytes!(concat!("../../assets/pictures/dark/", $name, ".jpg")),
                include_bytes!(concat!("../../assets/pictures/light/", $name, ".jpg")),
            ],
        },)*)*]
    };
}

impl ExampleGroup {
    /// All groups, in the order in which they are listed.
    pub const ALL: [Self; 4] = [Self::Basics, Self::WhyNot, Self::InsideSolver, Self::HardCases];

    /// Name on screen.
    pub fn title(self) -> &'static str {
        match self {
            Self::Basics => "Scenes",
            Self::WhyNot => "Why not reached",
            Self::InsideSolver => "Inside a solver",
            Self::HardCases => "Hard cases",
        }
    }
}

impl Example {
    /// Width and height in pixels of a frame of an example's picture.
    pub const FRAME_SIZE: [usize; 2] = [288, 180];
    /// Frames per second at which an example's picture is played.
    pub const FRAME_RATE: f64 = 10.0;

    /// A JPEG picture of frames of the size [`Example::FRAME_SIZE`] in rows, read like text: one
    /// frame of an example that stands still, several of one that moves.
    pub fn picture(&self, theme: Theme) -> &'static [u8] {
        let [dark, light] = self.pictures;
        match theme {
            Theme::Dark => dark,
            Theme::Light => light,
        }
    }

    /// All examples, in the order in which they are listed.
    pub const ALL: [Self; 35] = examples! {
        Basics in "" {
            "arm", "Arm" => "Two limbs and a hand: drag the hand, and a formula finds the elbow.";
            "two-targets", "Two targets on a Y" =>
                "A tree with two branches, each with a target of its own.";
            "human", "Human" =>
                "Hands and feet stay at their targets while the pelvis is dragged, and the head looks at \
                 a point.";
            "walk", "Walk" =>
                "Feet stand at their targets while the pelvis moves on, and the arms swing by FK.";
            "reaching-down", "Reaching down" =>
                "A squat to the floor: only the hands with their rotations, the gaze and the balance are \
                 given.";
            "looking-at-the-hand", "Looking at the hand" =>
                "Neck and head turn to the hand, wherever it goes; press Space to stop, and drag it.";
            "wheel", "Two hands on a wheel" =>
                "A figure whose hands hold a wheel that turns: their targets are on the wheel.";
            "candy-wrapper", "Candy wrapper" =>
                "A forearm that is twisted by 180°, its skin blended in three ways: watch the area of \
                 the middle.";
            "table", "Table" => "An arm whose hand rests on a table while its shoulder moves.";
            "snake", "Snake" =>
                "Drag the circle at the head across the floor: 24 joints follow its path.";
            "tadpoles", "Tadpoles" =>
                "Five heads swim after moving targets, and their tails follow their paths; switch \
                 on Follow the mouse.";
            "ten-joints", "Ten-joint chain" =>
                "A chain with one target, to watch the solvers at work.";
            "jumping-chain", "Jumping chain" =>
                "A chain follows its target smoothly; the thin figure shows what each frame would do by \
                 itself: it jumps.";
            "keyframes", "Keyframes" =>
                "An arm whose hand goes along a spline through six keys.";
            "degenerate", "Degenerate cases" =>
                "What breaks careless solvers: a bone without length, a target at the root, a straight \
                 chain, a mirror.";
        }
        WhyNot in "why/" {
            "out-of-reach", "Out of reach" =>
                "The target is farther away than the bones are long; the note beside it offers \
                 what would help.";
            "at-a-limit", "At a limit" =>
                "The shin cannot bend far enough for the target; the note says by how much its \
                 limit must be widened.";
            "locked", "Locked" =>
                "A locked joint keeps the chain from its target, which it would reach if that \
                 joint could turn.";
            "pulled-apart", "Pulled apart" =>
                "Two targets are too far apart for the two arms of a Y: each can be reached alone, \
                 not both.";
            "gimbal-lock", "Gimbal lock" =>
                "At y = 90° two of a joint's angles turn about one axis, and none turns towards \
                 the target.";
            "too-few-iterations", "Too few iterations" =>
                "The solver stops after 20 iterations, while the tip is still coming nearer.";
        }
        InsideSolver in "inside/" {
            "inside-dls", "Inside damped least squares" =>
                "One iteration, part by part: the columns of the Jacobian, its ellipsoid and what \
                 the damping leaves of it, and the step; Shift . shows the next part.";
            "inside-ccd", "Inside CCD" =>
                "One iteration, part by part: each joint in turn swings the tip towards the \
                 target; Shift . shows the next part.";
            "inside-fabrik", "Inside FABRIK" =>
                "One iteration, part by part: the points go to the target and then back to the \
                 root; Shift . shows the next part.";
        }
        HardCases in "hard/" {
            "through-the-root", "Target through the root" =>
                "The target goes straight through the shoulder: the hand comes no nearer than 100 \
                 and jumps to the other side; limbs of equal length take the jump away.";
            "straight-up-and-down", "Straight up and down" =>
                "The hand goes around through straight up and straight down, where the Limb's \
                 elbow does not know its side and jumps; the Stereographic reference takes the \
                 jumps away.";
            "along-the-pole", "Along the pole" =>
                "The hand crosses the line to the pole, and the elbow that points at it flips \
                 over; the Stereographic reference takes the flip away.";
            "exactly-straight", "Exactly straight" =>
                "The target is exactly as far away as the arm is long: it is reached, and turning \
                 the Socket twist leaves the elbow where it is.";
            "just-past-straight", "Just past straight" =>
                "The target leaves the arm's reach and comes back, and the elbow snaps where the \
                 arm is straight; a softness of 0.1 takes the snap away.";
            "equal-bones-folded", "Equal bones folded" =>
                "The target goes through the shoulder of two equal limbs: they fold up completely, \
                 it is reached all the way, and nothing jumps.";
            "thousand-to-one", "One bone a thousand times the other" =>
                "A forearm of 0.3 on an upper arm of 300, small as its joints: the hand goes once \
                 around the elbow and stays at its target.";
            "far-root", "Root a million units away" =>
                "The shoulder is a million units away, where f32 positions are 1/16 apart: the \
                 limbs keep their lengths within that rounding.";
            "tiny", "Tiny arm" =>
                "An arm a thousandth of a unit long, which moves as the large ones do.";
            "huge", "Huge arm" => "An arm a million units long, which moves as the small ones do.";
            "mirrored", "Mirrored" =>
                "Two bones in a mirror, where turning left is turning right: the hand is at its \
                 target all the same; press R and Space, and it follows.";
        }
    };

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
