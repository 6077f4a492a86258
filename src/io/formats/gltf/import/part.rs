/// The part of a node's transform that an animation channel changes.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
pub enum AnimatedPart {
    Translation,
    Rotation,
    Scale,
}
