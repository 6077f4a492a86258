use super::wavy_ring::WavyRing;
use crate::skeleton::JointId;

/// A path that a chain of joints follows, as a snake follows its head. The chain is a root, called the
/// head, that root's first child, and so on.
///
/// If limits keep a joint's tip off the path, the next joint starts at that tip and turns back towards the
/// path. Locked joints follow, too.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FollowPath {
    /// The head: a joint without a parent.
    pub root: JointId,
    /// What moves the head.
    pub kind: PathKind,
}

/// What moves the head of a chain that follows a path.
///
/// Behind the path that a key or a target gives, the joints' own angles give the line of the body. A
/// joint keeps its roll as far as the least rotation from its own direction to the path does; where the
/// path turns back in space, the roll can turn quickly.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PathKind {
    /// The head moves around a ring.
    Ring(WavyRing),
    /// The keys of the head move it, and the chain follows the path that the head has travelled since its
    /// first key. Until then, or without keys, the joints keep their own angles.
    Head,
    /// The enabled target of the head moves it, and the chain follows the path that the target has
    /// travelled. That target moves nothing else, whatever its influence. Without such a target the
    /// joints keep their own angles.
    Target,
}

impl PathKind {
    /// Whether the path has finite lengths and a period above 0.
    pub fn is_valid(&self) -> bool {
        match self {
            Self::Ring(WavyRing { radius, amplitude, waves: _, period }) => {
                let are_finite = [radius, amplitude, period].into_iter().all(|it| it.is_finite());
                are_finite && *period > 0.0
            }
            Self::Head | Self::Target => true,
        }
    }
}
