/// Moves through the tour.
#[derive(Clone, Debug, PartialEq)]
pub enum TourAction {
    /// Begins a step, counted from 0; the user's document is kept for the end of the tour. A number
    /// beyond the last step shows the card after it, with the scene of the last step.
    Enter(usize),
    /// Chooses an answer to the step's question, counted from 0.
    Guess(usize),
    /// Does the step's task for the user and shows the result.
    Demonstrate,
    /// Ends the tour and puts the user's document back.
    Leave,
    /// Declines the tour; it is not offered again.
    Decline,
}
