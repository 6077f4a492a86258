use super::answer::Answer;
use super::error::LineError;
use super::previous::PreviousLine;
use super::request::Request;
use crate::kinematics::twist::TwistReference;

/// Solves one line of `ik-arm solve`, given without its line ending. `previous` is the state after
/// the last valid line, and becomes the state after this one; an invalid line leaves it unchanged.
///
/// # Errors
///
/// Fails if the line is not a request, or no arm can meet it; see [`LineError`].
pub fn solve_line(line: &[u8], previous: &mut Option<PreviousLine>) -> Result<Answer, LineError> {
    if line.len() > LineError::MAX_LENGTH {
        return Err(LineError::TooLong);
    }
    let request = Request::parse(line)?;
    let ik = request.ik()?;
    // Lines with any other reference are solved on their own.
    let is_transported = ik.reference == TwistReference::Transport;
    let solved = request.solve(ik, previous.filter(|_| is_transported));
    let answer = Answer::new(request.root.0, ik.reference, &solved)?;
    *previous = is_transported.then(|| PreviousLine::new(&solved));
    Ok(answer)
}
