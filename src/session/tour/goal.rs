use serde::Deserialize;

/// The task of a step of the tour, which the program notices when it is done.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Goal {
    /// Move the hand above the shoulder to the other side.
    PassOverTheShoulder,
    /// Pose the arm by FK so that the hand moves.
    MoveTheHandByFk,
    /// Bend the elbow at a right angle.
    BendTheElbowAtARightAngle,
    /// Turn the elbow by at least a quarter of its circle, without the hand.
    TurnTheElbowAlongItsCircle,
    /// Give both limbs the same length.
    CloseTheHole,
    /// Move the Cursor farther away than the arm is long.
    MoveTheCursorOutOfReach,
    /// Soften the limits of the reach.
    SoftenTheLimits,
    /// Choose the twist reference Transport.
    ChooseTransport,
    /// Move the shoulder while the hand stays in the world.
    MoveTheShoulderAndKeepTheHand,
    /// Play the timeline by IK.
    PlayByIk,
    /// Race all solvers to the end.
    RaceAllSolvers,
    /// Move the skeleton so that a target is out of reach.
    LeaveATargetOutOfReach,
}
