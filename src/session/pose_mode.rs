/// The way in which the arm is posed: by FK or by IK.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PoseMode {
    /// IK (hand → joint angles): the Cursor poses the arm.
    Hand,
    /// FK (joint angles → hand): the joint angles pose the arm.
    Angles,
}
