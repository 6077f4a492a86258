use super::wavy_ring::WavyRing;

/// The path that the first chain of a skeleton follows, as a snake follows its head. The chain is the
/// first root, called the head, that root's first child, and so on.
///
/// If limits keep a joint's tip off the path, the next joint starts at that tip and turns back towards the
/// path. Locked joints follow, too.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FollowPath {
    /// The head moves around a ring.
    Ring(WavyRing),
    /// The keys of the head move it, and the chain follows the path that the head has travelled since its
    /// first key. Until then, or without keys, the joints keep their own angles.
    ///
    /// The joints' own angles also give the line of the body at the first key. A joint keeps its roll as far
    /// as the least rotation from its own direction to the path does; where the path turns back in space,
    /// the roll can turn quickly.
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
