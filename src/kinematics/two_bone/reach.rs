/// Position of the hand relative to the cursor, by the limit that prevents reaching it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(rename_all = "snake_case")
)]
pub enum Reach {
    /// The hand is the cursor, bit for bit; with soft limits, within 1e-6·L.
    Reached,
    /// The cursor is beyond the outer limit L: the arm is straight and points at it.
    TooFar,
    /// The cursor is inside the inner limit |δ|: the arm is folded and points at it.
    TooClose,
}
