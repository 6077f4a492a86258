//! `ik-arm tour`: the text of the tour, with the numbers of its scenes.

use std::io::{self, Write};

use super::report::CommandError;
use crate::session::{
    Comparison, PlaybackAction, Preferences, Session, TourAction, TourEnd, TourStep, filled,
};

const WIDTH: usize = 88;
const INDENT: &str = "   ";

pub fn run() -> Result<(), CommandError> {
    Ok(print(&mut io::stdout().lock())?)
}

fn print(out: &mut impl Write) -> io::Result<()> {
    let steps = TourStep::all();
    writeln!(out, "The tour, in {} steps. In the program: ik-arm gui --tour [STEP]", steps.len())?;
    let mut session = Session::new(Preferences::default());
    for (number, step) in steps.iter().enumerate() {
        writeln!(out, "\n{}. {}\n", number + 1, step.title)?;
        session.apply(TourAction::Enter(number));
        print_step(out, step, &mut session)?;
    }
    print_end(out, TourEnd::get())
}

fn print_step(out: &mut impl Write, step: &TourStep, session: &mut Session) -> io::Result<()> {
    paragraph(out, &filled(step.text, session))?;
    paragraph(out, &format!("Guess first: {}", step.guess.question))?;
    for answer in step.guess.answers {
        writeln!(out, "{INDENT}- {answer}")?;
    }
    paragraph(out, &format!("Now try it: {}", filled(step.task, session)))?;
    paragraph(out, &format!("Without a mouse: {}", step.keyboard))?;
    demonstrate(session);
    paragraph(out, &format!("Answer: {}", step.guess.right_answer()))?;
    paragraph(out, &format!("What happens: {}", filled(step.result, session)))
}

fn print_end(out: &mut impl Write, end: &TourEnd) -> io::Result<()> {
    writeln!(out, "\n{}\n", end.title)?;
    for sentence in end.sentences {
        paragraph(out, &format!("- {sentence}"))?;
    }
    paragraph(out, end.next)
}

/// Does the task of the step, and waits for the end of what it starts.
fn demonstrate(session: &mut Session) {
    const MOST_FRAMES: u16 = 1000;
    session.apply(TourAction::Demonstrate);
    let is_racing =
        |session: &Session| session.solvers().comparison().is_some_and(Comparison::is_running);
    for frame in 0..MOST_FRAMES {
        if !is_racing(session) {
            return;
        }
        session.apply(PlaybackAction::Advance(f64::from(frame)));
    }
}

/// Prints words in lines of at most [`WIDTH`] letters.
fn paragraph(out: &mut impl Write, text: &str) -> io::Result<()> {
    let mut line = INDENT.to_owned();
    for word in text.split_whitespace() {
        if line.chars().count() + word.chars().count() > WIDTH {
            writeln!(out, "{}", line.trim_end())?;
            line = INDENT.to_owned();
        }
        line += word;
        line.push(' ');
    }
    writeln!(out, "{}", line.trim_end())
}
