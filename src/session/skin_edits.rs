use super::session::Session;
use super::skin_areas::SkinAreas;
use crate::document::{Document, Overlay, Ray, Skin};
use crate::kinematics::skeleton::JointId;
use crate::kinematics::skin::SkinShapeError;
use crate::rig::SkinSource;

/// Edits of the skin, and what the mouse points at on it.
impl Session {
    /// The joint with the greatest weight at the point of the shown skin that a ray meets first; `None` if
    /// the skin is hidden or the ray meets none.
    pub fn joint_on_skin(&self, ray: Ray) -> Option<JointId> {
        let skin = self.skeleton_rig().skin.as_ref();
        let skin = skin.filter(|_| self.shown().display.shows(Overlay::Skin))?;
        let mesh = &skin.mesh().ok()?.mesh;
        let posed = self.evaluated.posed_skin(|| {
            mesh.posed(&mesh.pose(&self.evaluated_skeleton().solved), skin.skinning)
        });
        let hit = posed.hit(ray.origin, ray.direction)?;
        Some(mesh.heaviest_joint(&hit))
    }

    /// Areas of the cross-section of the compared skins at the active joint over the timeline; `None` if
    /// skins are not compared or have no section there.
    pub fn skin_areas(&self) -> Option<&SkinAreas> {
        self.evaluated.skin_areas(|| SkinAreas::new(self.document(), self.selected()))
    }

    /// Gives the skeleton a skin from its bones, and shows it.
    pub(super) fn add_skin(&mut self) {
        let skin = Skin::from_bones(&self.skeleton_rig().skeleton);
        self.edit_document(|document| {
            skin.mesh()?;
            document.skeleton_rig.skin = Some(skin);
            document.display = document.display.with(Overlay::Skin, true);
            Ok::<(), SkinShapeError>(())
        });
    }

    /// Replaces the skin, with its colour clamped to valid channels. During a drag its mesh stays; otherwise
    /// it is made at once.
    pub(super) fn set_skin(&mut self, skin: Option<Skin>) {
        let skin = skin.map(|skin| Skin {
            colour: skin.colour.map(|channel| if channel > 0.0 { channel.min(1.0) } else { 0.0 }),
            ..skin
        });
        let is_dragging = self.is_editing();
        self.edit_document(|document| {
            if let Some(SkinSource::Bones(bones)) = skin.as_ref().map(|skin| &skin.source) {
                bones.shape().check(document.skeleton())?;
            }
            document.skeleton_rig.skin = skin;
            if !is_dragging {
                document.skeleton_rig.refresh_skin();
                document.skeleton_rig.skin.as_ref().map(Skin::mesh).transpose()?;
            }
            Ok::<(), SkinShapeError>(())
        });
    }

    /// Shows the skin, the bones or both.
    pub(super) fn show_skin(&mut self, skin: bool, bones: bool) {
        let display = self.shown().display.with(Overlay::Skin, skin).with(Overlay::Bones, bones);
        self.commit(Document { display, ..self.shown().clone() });
    }
}
