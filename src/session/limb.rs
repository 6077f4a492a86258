use crate::document::{Document, LengthFormat, Posed};
use crate::kinematics::limb_ik::Limb;
use crate::kinematics::skeleton::JointId;
use crate::rig::LimbFrames;
use crate::words::LimbWords;

/// The limb that pages and guides are about: that of the selected joint, else the first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShownLimb {
    /// The joint of the limb's target.
    pub target: JointId,
    /// Its joints.
    pub joints: Limb,
    /// The limb in its frames.
    pub frames: LimbFrames,
    /// Words for its joints.
    pub words: LimbWords,
}

impl ShownLimb {
    /// The limb of a posed document that is shown while `selected` is the active joint; `None`
    /// without a limb.
    pub fn new(posed: &Posed, selected: Option<JointId>) -> Option<Self> {
        let document = posed.document();
        let target = Self::target(document, selected)?;
        let joints = Limb::ending_at(posed.skeleton(), target).ok()?;
        let frames = posed.limb_frames(target)?;
        Some(Self { target, joints, frames, words: LimbWords::of_target(&document.rig, target) })
    }

    /// [`ShownLimb::new`] without its words, which take memory.
    pub fn frames(posed: &Posed, selected: Option<JointId>) -> Option<LimbFrames> {
        posed.limb_frames(Self::target(posed.document(), selected)?)
    }

    /// The joint of the target of the shown limb.
    fn target(document: &Document, selected: Option<JointId>) -> Option<JointId> {
        let rig = &document.rig;
        let of_selected = selected.and_then(|joint| rig.limb_target_of(joint));
        let shown = of_selected.map(|index| &rig.targets[index]);
        Some(shown.or_else(|| rig.limb_targets().next())?.joint)
    }

    /// The format of the limb's lengths.
    pub fn lengths(&self) -> LengthFormat {
        LengthFormat::of_limb(self.frames.bones())
    }
}
