//! The document, everything that a document file stores: the rig (joints with their targets), its
//! keys, the timeline, the camera and the set of visible overlays.
//!
//! A pose is a function of the document and the time alone, and a [`Track`] is the only way to it.
//! The posture from which a motion begins is therefore part of the document too.
//!
//! Large parts are [`Shared`](crate::kinematics::Shared): clones of a document share them, and an
//! edit copies only the parts that it changes.

mod animation;
mod bake;
mod camera;
mod channel;
mod channel_table;
mod conversion;
mod display;
mod dissolve;
mod inspection;
mod keys;
mod length_format;
mod projection;
mod timeline;
mod track;

use crate::kinematics::skeleton::{JointId, JointRemap, Skeleton, SkeletonError};
use crate::kinematics::two_bone::TwoBone;

pub use crate::kinematics::twist::TwistReferenceKind;
pub use crate::rig::{
    BalanceOver, BalanceTarget, FollowPath, PathKind, SkeletonRig, Skin, Target, TargetMotion,
    TargetPath, WavyRing,
};
pub use bake::{Bake, BakeError, Baked, ShortenedBone};
pub use camera::{AxisView, Camera};
pub use channel::{Channel, Quantity, UnknownChannel};
pub use display::{Display, Overlay, Theme};
pub use inspection::{FramePop, Inspection, LimitSpan, LostSpan, Slide, WorstMiss};
pub use keys::Keys;
pub use length_format::LengthFormat;
pub(crate) use length_format::ShownLength;
pub use projection::{Projection, Ray};
pub use timeline::Timeline;
pub use track::{Posed, Track};

/// Everything that a document file stores.
#[derive(Clone, Debug, PartialEq)]
pub struct Document {
    /// The joints with their targets.
    pub rig: SkeletonRig,
    /// Keys of the rig and of the overlays.
    pub keys: Keys,
    /// The time range that is played, and its frame rate.
    pub timeline: Timeline,
    /// The time in seconds of the first step of the rig's motion, which is set when a target first
    /// poses it; see [`Document::motion_start`].
    pub track_start: Option<f64>,
    /// The camera.
    pub camera: Camera,
    /// The overlays that are shown.
    pub display: Display,
    /// Length in metres of one unit, for exports; `None` for a metre.
    pub metres_per_unit: Option<f32>,
    /// Name of the animation that the keys come from, for exports.
    pub animation_name: Option<String>,
}

impl Default for Document {
    /// The arm of E. Palmieri's report (2014), whose unit is a millimetre.
    fn default() -> Self {
        Self::arm(TwoBone::default())
    }
}

impl Document {
    /// A document that shows a rig in metres, without keys.
    pub fn new(rig: SkeletonRig) -> Self {
        Self {
            rig,
            keys: Keys::default(),
            timeline: Timeline::default(),
            track_start: None,
            camera: Camera::default(),
            display: Display::default(),
            metres_per_unit: None,
            animation_name: None,
        }
    }

    /// An arm of two bones in millimetres, drawn as tapered cylinders with a hand.
    pub fn arm(bones: TwoBone) -> Self {
        let display = Display::of_arm();
        Self { display, metres_per_unit: Some(1e-3), ..Self::new(SkeletonRig::arm(bones)) }
    }

    /// Length in metres of one unit.
    pub fn metres_per_unit(&self) -> f32 {
        self.metres_per_unit.unwrap_or(1.0)
    }

    /// The target of a rig that is a single limb and drawn as cylinders. The ground, the grid and
    /// the camera are then measured by the limb.
    pub fn measured_limb(&self) -> Option<&Target> {
        self.rig.sole_limb().filter(|_| self.display.shows(Overlay::Cylinders))
    }

    /// The joints of the skeleton rig.
    pub fn skeleton(&self) -> &Skeleton {
        &self.rig.skeleton
    }

    /// The joints of the skeleton rig, for editing. They are copied first if other documents share
    /// them.
    pub fn skeleton_mut(&mut self) -> &mut Skeleton {
        self.rig.skeleton_mut()
    }

    /// Deletes joints with all their descendants, their targets and their keys. Targets on them
    /// move to the world.
    ///
    /// # Errors
    ///
    /// [`SkeletonError::NoJoint`]; the document is then unchanged.
    pub fn delete(&mut self, joints: &[JointId]) -> Result<JointRemap, SkeletonError> {
        let mut skeleton = self.rig.skeleton.clone();
        let remap = skeleton.make_mut().remove(joints)?;
        self.release_targets(&remap);
        self.rig.skeleton = skeleton;
        self.remap_joints(&remap);
        Ok(remap)
    }

    /// Renumbers the joints of targets and keys; drops the targets and keys of removed joints.
    pub fn remap_joints(&mut self, remap: &JointRemap) {
        self.rig.remap(remap);
        self.keys.remap(remap);
    }

    /// Width of a cell of the grid around the rig, a power of ten.
    pub fn grid_cell(&self) -> f32 {
        match self.measured_limb() {
            Some(target) => LengthFormat::of_length(self.rig.length_to(target.joint)).cell(),
            None => SkeletonRig::grid_cell_for(self.rig.reach()),
        }
    }

    /// True if the shown skin hides the bones.
    pub fn hides_bones(&self) -> bool {
        let display = self.display;
        let is_shown = display.shows(Overlay::Skin) && !display.shows_bones_in_skin();
        is_shown && self.rig.skin.as_ref().is_some_and(|skin| skin.mesh().is_ok())
    }

    /// True if the skin is shown for each way of blending joints.
    pub fn compares_skinning(&self) -> bool {
        let overlays = [Overlay::Skin, Overlay::CompareSkinning];
        overlays.into_iter().all(|it| self.display.shows(it))
    }
}
