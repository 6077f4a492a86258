//! Biovision hierarchies, `.bvh`: a skeleton and its motion as text.
//!
//! ```text
//! HIERARCHY
//! ROOT NAME                       one or several roots
//! {
//!     OFFSET x y z                from the parent's base, in the bind pose
//!     CHANNELS n …                n of Xposition Yposition Zposition Xrotation Yrotation Zrotation
//!     JOINT NAME { … }            any number of children, written like the root
//!     End Site { OFFSET x y z }   tip of a bone without children
//! }
//! MOTION
//! Frames: N
//! Frame Time: seconds
//! …                               one line per frame: the values of all channels in their order
//! ```
//!
//! Angles are in degrees. A joint's rotation is the product of its rotation channels in their
//! order, with the first channel as the leftmost factor. Position channels replace the joint's
//! offset, unless those of all joints are 0 in all frames.
//!
//! # Export
//!
//! The file has one root with position channels. Rotation channels are Z, Y, X, the order of a
//! joint's angles, and are unwrapped from frame to frame. The skeleton's transform is applied to
//! the offsets, the root's position and the rotations: see [`transform`]. Several roots become
//! children of a new root at the skeleton's origin.
//!
//! # Import
//!
//! Channels can have any order and number. The bone of a joint goes to its End Site or to the child
//! that continues the chain, see [`bones`](crate::io::bones), all at the first frame. Values that
//! change over time become keys, of rotations by slerp; constant values are set on the skeleton.

mod hierarchy;
mod read;
mod rig;
mod write;

pub use read::{is_bvh, read};
pub use write::to_bvh;
