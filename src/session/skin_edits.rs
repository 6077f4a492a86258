use super::session::Session;
use crate::document::{Overlay, Skin};
use crate::kinematics::skin::SkinShapeError;

/// Edits of the skin.
impl Session {
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

    pub(super) fn set_skin(&mut self, skin: Option<Skin>) {
        self.edit_document(|document| {
            skin.as_ref().map(Skin::mesh).transpose()?;
            document.skeleton_rig.skin = skin;
            document.skeleton_rig.refresh_skin();
            Ok::<(), SkinShapeError>(())
        });
    }
}
