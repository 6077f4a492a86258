//! The protocol of `ik-arm solve`: one line, and the pose that answers it. The fuzzer uses it
//! without the program's windows and commands.

mod answer;
mod error;
mod request;

use crate::kinematics::twist::TwistReference;
pub use answer::{Answer, PreviousLine};
pub use error::LineError;
use request::Request;

/// Solves one line of `ik-arm solve`, given without its line ending. `previous` is the state after
/// the nearest valid line before this one; it becomes the state after this line. An invalid line
/// leaves `previous` unchanged.
///
/// # Errors
///
/// Fails if the line is not a request, or a number in it is out of range; see [`LineError`].
pub fn solve_line(line: &[u8], previous: &mut Option<PreviousLine>) -> Result<Answer, LineError> {
    if line.len() > LineError::MAX_LENGTH {
        return Err(LineError::TooLong);
    }
    let request = Request::parse(line)?;
    let ik = request.ik()?;
    // A line with any other reference is solved without the previous line.
    let is_transported = ik.reference == TwistReference::Transport;
    let solved = request.solve(ik, previous.filter(|_| is_transported));
    let answer = Answer::new(request.root.0, ik.reference, &solved)?;
    *previous = is_transported.then(|| PreviousLine::new(&solved));
    Ok(answer)
}
