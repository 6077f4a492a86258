//! Biovision's hierarchies, `.bvh`: a skeleton and its motion as text.
//!
//! ```text
//! HIERARCHY
//! ROOT NAME                       or several
//! {
//!     OFFSET x y z                from the parent's base, when nothing is turned
//!     CHANNELS n …                of Xposition Yposition Zposition Xrotation Yrotation Zrotation
//!     JOINT NAME { … }            any number, as a root
//!     End Site { OFFSET x y z }   where the bone of a joint without children ends
//! }
//! MOTION
//! Frames: N
//! Frame Time: seconds
//! …                               a line for each frame: what the channels are, in their order
//! ```
//!
//! Angles are degrees. A joint's rotation is the product of its rotation channels in their order, the
//! first one outermost; its position channels stand in the place of its offset.
//!
//! # Out
//!
//! One root, whose position is in its channels; Z, Y, X rotations, which is what a joint's angles are
//! here, unwrapped from frame to frame. The skeleton's transform is in the offsets, the root's
//! position and the rotations: see [`place`]. Several roots hang from one that is made for them and
//! stands at the skeleton's origin.
//!
//! # In
//!
//! Channels in any order and number. The bone of a joint goes to its End Site, or to its only child,
//! or to the middle of its children: what they are at the first frame. What changes is keyed; what
//! does not is the skeleton's own.

mod angles;
mod figure;
mod hierarchy;
mod motion;
mod names;
mod note;
mod place;
mod read;
mod text;
mod write;

use crate::document::Document;
use note::Note;

pub use read::{is_bvh, read};
pub use write::to_bvh;

/// What the lengths in a file are measured in; nothing in it says.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum BvhUnit {
    /// Usual in BVH.
    #[default]
    Centimetres,
    Metres,
    /// As they are in the document.
    Scene,
}

/// What is read as a unit.
const METRES: f32 = 0.01;

impl BvhUnit {
    /// How many of it a unit of the document's rig is.
    fn per_unit(self, document: &Document) -> f64 {
        let per_metre = match self {
            Self::Centimetres => METRES.recip(),
            Self::Metres => 1.0,
            Self::Scene => return 1.0,
        };
        f64::from(document.metres_per_unit() * per_metre)
    }
}
