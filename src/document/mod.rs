//! The document, everything that a document file stores: the arm, the skeleton with its targets,
//! their keys, the timeline, the cameras and the set of visible overlays.
//!
//! A pose is a function of the document and the time alone, and a [`Track`] is the only way to it.
//! State from which a solve continues (the previous Pointer, the transported frame, the forearm's
//! roll) is therefore part of the document too.
//!
//! Large parts are [`Shared`](crate::kinematics::Shared): clones of a document share them, and an
//! edit copies only the parts that it changes.

mod animation;
mod arm;
mod arm_diagnosis;
mod arm_solve;
mod bake;
mod camera;
mod channel;
mod channel_name;
mod channel_value;
mod conversion;
mod display;
mod dissolve;
#[expect(clippy::module_inception, reason = "the type Document, in the file of its name")]
mod document;
mod framing;
mod hand_orientation;
mod keys;
mod plant;
mod projection;
mod rig_kind;
mod timeline;
mod track;
mod turn;

pub use crate::kinematics::twist::TwistReferenceKind;
pub use crate::rig::{
    FollowPath, PathKind, SkeletonRig, Skin, Target, TargetMotion, TargetPath, WavyRing,
};
pub(crate) use arm::ShownLength;
pub use arm::{Arm, Cursor};
pub use bake::{Bake, BakeError, Baked, ShortenedBone};
pub use camera::{AxisView, Camera};
pub use channel::{Channel, Quantity};
pub use channel_name::UnknownChannel;
pub use display::{Display, Overlay, Theme};
pub use document::Document;
pub use hand_orientation::{HandOrientation, HandSpace};
pub use keys::Keys;
pub use projection::{Projection, Ray};
pub use rig_kind::RigKind;
pub use timeline::Timeline;
pub use track::{Posed, Track};
