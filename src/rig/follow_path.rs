use super::wavy_ring::WavyRing;

/// The path that the first chain of a skeleton follows, as a snake follows its head. The chain is the
/// first root, called the head, that root's first child, and so on.
///
/// A joint whose limits keep it off the path is followed by the next one from where it ends, back
/// towards the path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FollowPath {
    /// The head moves around a ring.
    Ring(WavyRing),
    /// The head is where its keys put it, and the chain follows the path that the head has left. Up to
    /// the head's first key the chain is posed by its own angles.
    Head,
}

impl FollowPath {
    /// Whether the path has finite lengths and a period above 0.
    pub fn is_valid(&self) -> bool {
        match self {
            Self::Ring(WavyRing { radius, amplitude, waves: _, period }) => {
                let are_finite = [radius, amplitude, period].into_iter().all(|it| it.is_finite());
                are_finite && *period > 0.0
            }
            Self::Head => true,
        }
    }
}
