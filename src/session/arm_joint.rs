/// A joint of the arm that can be selected in the viewport, which shows its handles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ArmJoint {
    /// The shoulder, with handles that move the Root.
    Root,
    /// The elbow, with the ring of the Socket twist.
    Elbow,
    /// The hand, with the rings of its orientation.
    Hand,
}
