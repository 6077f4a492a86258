/// Whether the hand reaches the cursor, and which limit prevents it if not.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(rename_all = "snake_case")
)]
pub enum Reach {
    /// The hand is at the cursor: bit for bit with hard limits, within 1e-6·L with soft limits.
    Reached,
    /// The hand is nearer to the shoulder than the cursor. With hard limits, the cursor is beyond
    /// the outer limit L: the arm is straight and points at the cursor.
    TooFar,
    /// The hand is farther from the shoulder than the cursor. With hard limits, the cursor is
    /// inside the inner limit |δ|: the arm is folded and points at the cursor.
    TooClose,
}
