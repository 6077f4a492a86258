//! What is saved: the arm, the skeleton, their keys in time, where they are looked at from, and what
//! is shown.
//!
//! The pose is a function of the document and the time alone, so whatever a stateful choice needs
//! (the last direction and yaw of the Pointer, the joints' angles) is in it too.

mod arm;
mod camera;
mod channel;
mod display;
mod dissolve;
mod follow_path;
mod keys;
mod shared;
mod skeleton;
mod timeline;
mod wrist;

pub use arm::{Arm, Cursor, TwistReferenceKind};
pub use camera::{AxisView, Camera, Projection, Ray};
pub use channel::{Channel, Quantity};
pub use display::{Display, Overlay, Theme};
pub use follow_path::FollowPath;
pub use keys::Keys;
pub use shared::Shared;
pub use skeleton::{SkeletonRig, Target, TargetMotion, TargetPath};
pub use timeline::Timeline;
pub use wrist::{HandSpace, Wrist};

use serde::{Deserialize, Serialize};

use crate::kinematics::skeleton::{JointId, JointRemap, Skeleton, SkeletonError};

/// Everything that a file holds.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Document {
    /// Which rig is shown and edited; the other is kept as it is.
    pub rig: RigKind,
    pub arm: Arm,
    pub skeleton_rig: SkeletonRig,
    pub keys: Keys,
    pub timeline: Timeline,
    /// Where the shown rig is looked at from.
    pub camera: Camera,
    /// The camera of the other rig; `None` frames that rig when it is shown.
    pub other_camera: Option<Camera>,
    pub display: Display,
    /// How long a unit of the shown rig is for other programs; nothing says what is usual: see
    /// [`Document::metres_per_unit`].
    pub metres: Option<f32>,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum RigKind {
    #[default]
    Arm,
    Skeleton,
}

impl Document {
    /// How long a unit of the shown rig is for other programs, in metres: a millimetre for the arm,
    /// which is as long as the seed's, a metre for a skeleton, unless the document says.
    pub fn metres_per_unit(&self) -> f32 {
        self.metres.unwrap_or(match self.rig {
            RigKind::Arm => 0.001,
            RigKind::Skeleton => 1.0,
        })
    }

    /// The joints of the skeleton rig.
    pub fn skeleton(&self) -> &Skeleton {
        &self.skeleton_rig.skeleton
    }

    /// The joints of the skeleton rig, to change; copied first if other documents share them.
    pub fn skeleton_mut(&mut self) -> &mut Skeleton {
        self.skeleton_rig.skeleton_mut()
    }

    /// Shows a rig, from where it was looked at last.
    pub fn show(&mut self, rig: RigKind) {
        if rig == self.rig {
            return;
        }
        let camera = self.other_camera.unwrap_or_else(|| self.first_view(rig));
        self.other_camera = Some(self.camera);
        (self.rig, self.camera) = (rig, camera);
    }

    /// A view of a whole rig.
    fn first_view(&self, rig: RigKind) -> Camera {
        match rig {
            RigKind::Arm if self.arm.bones == Arm::default().bones => Camera::default(),
            RigKind::Arm => {
                let (centre, radius) = self.arm.bounds(&self.arm.pose());
                Camera::default().framing(centre, radius, 1.0)
            }
            RigKind::Skeleton => self.skeleton_rig.first_view(),
        }
    }

    /// Deletes joints with all their descendants.
    ///
    /// # Errors
    ///
    /// None; [`Document::dissolve`] has some.
    pub fn delete(&mut self, joints: &[JointId]) -> Result<JointRemap, SkeletonError> {
        let moved = self.skeleton_mut().remove(joints)?;
        self.follow(&moved);
        Ok(moved)
    }

    /// Lets targets and keys follow their joints to new places.
    pub fn follow(&mut self, moved: &JointRemap) {
        self.skeleton_rig.follow(moved);
        self.keys.follow(moved);
    }

    /// How wide the grid's cells are, a power of ten: around the arm [its own](Arm::cell); around a
    /// skeleton the one that goes 2 to 20 times into its reach.
    pub fn cell(&self) -> f32 {
        match self.rig {
            RigKind::Arm => self.arm.cell(),
            RigKind::Skeleton => SkeletonRig::cell(self.skeleton_rig.reach()),
        }
    }
}
