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

    /// One sentence on what its examples have in common.
    pub fn about(self) -> &'static str {
        match self {
            Self::Basics => "Rigs to pose and motions to play, the simplest first.",
            Self::WhyNot => "Targets that are not reached, and what stops each of them.",
            Self::InsideSolver => "One step of a solver, taken apart.",
            Self::HardCases => "Poses and sizes at which IK jumps or loses precision.",
        }
    }

    /// Name on screen.
    pub fn title(self) -> &'static str {
        match self {
            Self::Basics => "Scenes",
            Self::WhyNot => "Unreached targets",
            Self::InsideSolver => "Solver steps",
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
            "arm", "Arm" => "Drag the hand: a formula finds the elbow.";
            "keyframes", "Keyframes" => "The hand of an arm moves along a curve through six keys.";
            "table", "Table" => "A hand rests on a table while its shoulder moves.";
            "human", "Human" => "Drag hands, feet or pelvis, and the rest of the body follows.";
            "walk", "Walk" => "Each foot stays where it steps while the body moves on.";
            "reaching-down", "Reaching down" =>
                "A squat: hands, gaze and balance are given, the body follows.";
            "looking-at-the-hand", "Looking at the hand" =>
                "Neck and head turn to the hand; press Space to stop, then drag it.";
            "wheel", "Two hands on a wheel" =>
                "The hands hold a wheel that turns: their targets are on the wheel.";
            "snake", "Snake" => "Drag the circle at the head: 24 joints follow its path.";
            "tadpoles", "Tadpoles" =>
                "Heads swim after targets or the mouse, and their tails follow.";
            "two-targets", "Two targets on a Y" =>
                "A tree with two branches, each with a target of its own.";
            "ten-joints", "Ten-joint chain" => "A chain with one target, to watch solvers at work.";
            "jumping-chain", "Jumping chain" =>
                "A smooth chain, beside one that jumps from frame to frame.";
            "candy-wrapper", "Twisted forearm" =>
                "Three ways to twist a skin by 180°: one narrows like a candy wrapper.";
        }
        WhyNot in "why/" {
            "out-of-reach", "Out of reach" =>
                "The bones are too short for the target; a note offers remedies.";
            "at-a-limit", "At a limit" =>
                "The shin would have to bend past its limit; a note says how far.";
            "locked", "Locked" => "A locked joint keeps the chain from its target.";
            "pulled-apart", "Pulled apart" =>
                "Two targets too far apart: each can be reached alone, not both.";
            "gimbal-lock", "Gimbal lock" =>
                "At y = 90° two angles turn about one axis, none to the target.";
            "too-few-iterations", "Too few iterations" =>
                "The solver stops after 20 iterations, before the tip is there.";
        }
        InsideSolver in "inside/" {
            "inside-dls", "Inside damped least squares" =>
                "Jacobian, ellipsoid, damping, step: part by part (next: Shift .).";
            "inside-ccd", "Inside CCD" =>
                "Joint by joint, the tip swings to the target (next: Shift .).";
            "inside-fabrik", "Inside FABRIK" =>
                "The points go to the target and back to the root (next: Shift .).";
        }
        HardCases in "hard/" {
            "through-the-root", "Target through the root" =>
                "The target goes through the shoulder: the hand jumps across.";
            "straight-up-and-down", "Straight up and down" =>
                "The elbow jumps straight up and down; not with Stereographic.";
            "along-the-pole", "Along the pole" =>
                "The hand crosses the line to the pole, and the elbow flips over.";
            "exactly-straight", "Exactly straight" =>
                "The target is exactly as far away as the arm is long.";
            "just-past-straight", "Just past straight" =>
                "The elbow snaps where the arm is straight; softness takes it away.";
            "equal-bones-folded", "Equal bones folded" =>
                "Two equal limbs fold up completely, and nothing jumps.";
            "thousand-to-one", "One bone a thousand times the other" =>
                "A forearm of 0.3 on an upper arm of 300 stays at its target.";
            "far-root", "Root a million units away" =>
                "The limbs keep their lengths where f32 positions are 1/16 apart.";
            "tiny", "Tiny arm" =>
                "An arm a thousandth of a unit long, which moves as large ones do.";
            "huge", "Huge arm" => "An arm a million units long, which moves as small ones do.";
            "degenerate", "Degenerate chains" =>
                "A bone without length, a target at the root, a mirror.";
            "mirrored", "Mirrored" =>
                "Two bones in a mirror, where left is right: the target is reached.";
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
