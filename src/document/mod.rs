//! The document, everything that a document file stores: the arm, the skeleton with its targets,
//! their keys, the timeline, the cameras and the set of visible overlays.
//!
//! A pose is a function of the document and the time alone, and a [`Track`] is the only way to it.
//! State from which a motion begins (the skeleton's posture; of the arm the previous Pointer, the
//! transported frame, the forearm's roll) is therefore part of the document too.
//!
//! Large parts are [`Shared`](crate::kinematics::Shared): clones of a document share them, and an
//! edit copies only the parts that it changes.

mod animation;
mod arm;
mod arm_solve;
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

pub use crate::kinematics::twist::TwistReferenceKind;
pub use crate::rig::{
    FollowPath, PathKind, SkeletonRig, Skin, Target, TargetMotion, TargetPath, WavyRing,
};
pub use arm::{Arm, Cursor, HandOrientation, HandSpace};
pub use bake::{Bake, BakeError, Baked, ShortenedBone};
pub use camera::{AxisView, Camera};
pub use channel::{Channel, Quantity, UnknownChannel};
pub use display::{Display, Overlay, RigKind, Theme};
pub use inspection::{FramePop, Inspection, LimitSpan, LostSpan, Slide, WorstMiss};
pub use keys::Keys;
pub use length_format::LengthFormat;
pub(crate) use length_format::ShownLength;
pub use projection::{Projection, Ray};
pub use timeline::Timeline;
pub use track::{Posed, Track};

/// Everything that a document file stores.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Document {
    /// The rig that is shown and edited; the other one is kept.
    pub rig: RigKind,
    /// The two-bone arm.
    pub arm: Arm,
    /// The skeleton with its targets.
    pub skeleton_rig: SkeletonRig,
    /// Keys of both rigs and of the overlays.
    pub keys: Keys,
    /// The time range that is played, and its frame rate.
    pub timeline: Timeline,
    /// The time in seconds of the first step of the skeleton's motion, which is set when a target
    /// first poses it; see [`Document::motion_start`].
    pub track_start: Option<f64>,
    /// The camera of the shown rig.
    pub camera: Camera,
    /// The camera of the rig that is not shown; with `None`, that rig is framed when it is shown.
    pub other_rig_camera: Option<Camera>,
    /// The overlays that are shown.
    pub display: Display,
    /// Length in metres of one unit of the shown rig, for exports; `None` for the rig's default,
    /// see [`Document::metres_per_unit`].
    pub metres_per_unit: Option<f32>,
    /// Name of the animation that the keys come from, for exports.
    pub animation_name: Option<String>,
}

impl Document {
    /// Length in metres of one unit of the shown rig; by default a millimetre for the arm and a
    /// metre for a skeleton.
    pub fn metres_per_unit(&self) -> f32 {
        self.metres_per_unit.unwrap_or(match self.rig {
            RigKind::Arm => 0.001,
            RigKind::Skeleton => 1.0,
        })
    }

    /// The joints of the skeleton rig.
    pub fn skeleton(&self) -> &Skeleton {
        &self.skeleton_rig.skeleton
    }

    /// The joints of the skeleton rig, for editing. They are copied first if other documents share
    /// them.
    pub fn skeleton_mut(&mut self) -> &mut Skeleton {
        self.skeleton_rig.skeleton_mut()
    }

    /// Shows a rig through the camera that it had when it was last shown, or else through one that
    /// frames it.
    pub fn show(&mut self, rig: RigKind) {
        if rig == self.rig {
            return;
        }
        self.rig = rig;
        let camera = self.other_rig_camera.unwrap_or_else(|| self.framing_camera());
        self.other_rig_camera = Some(self.camera);
        self.camera = camera;
    }

    /// Deletes joints with all their descendants, their targets and their keys. Targets on them
    /// move to the world.
    ///
    /// # Errors
    ///
    /// [`SkeletonError::NoJoint`]; the document is then unchanged.
    pub fn delete(&mut self, joints: &[JointId]) -> Result<JointRemap, SkeletonError> {
        let mut skeleton = self.skeleton_rig.skeleton.clone();
        let remap = skeleton.make_mut().remove(joints)?;
        self.release_targets(&remap);
        self.skeleton_rig.skeleton = skeleton;
        self.remap_joints(&remap);
        Ok(remap)
    }

    /// Renumbers the joints of targets and keys; drops the targets and keys of removed joints.
    pub fn remap_joints(&mut self, remap: &JointRemap) {
        self.skeleton_rig.remap(remap);
        self.keys.remap(remap);
    }

    /// Width of a cell of the grid around the shown rig, a power of ten.
    pub fn grid_cell(&self) -> f32 {
        match self.rig {
            RigKind::Arm => self.arm.grid_cell(),
            RigKind::Skeleton => SkeletonRig::grid_cell_for(self.skeleton_rig.reach()),
        }
    }

    /// True if the shown skin hides the bones.
    pub fn hides_bones(&self) -> bool {
        let is_shown = self.display.shows(Overlay::Skin) && !self.display.shows(Overlay::Bones);
        is_shown && self.skeleton_rig.skin.as_ref().is_some_and(|skin| skin.mesh().is_ok())
    }

    /// True if the skin is shown for each way of blending joints.
    pub fn compares_skinning(&self) -> bool {
        let overlays = [Overlay::Skin, Overlay::CompareSkinning];
        self.rig == RigKind::Skeleton && overlays.into_iter().all(|it| self.display.shows(it))
    }
}
