use std::path::Path;

use super::edit_action::EditAction;
use super::path_dialog::PathDialog;
use super::session::Session;
use super::skin_areas::SkinAreas;
use crate::document::{Document, Overlay, Ray, Skin};
use crate::kinematics::skeleton::JointId;
use crate::kinematics::skin::SkinShapeError;
use crate::rig::{MeshSkin, SkinFile, SkinFileError, SkinMeshError, SkinSource};

/// Weight of a root without a bone, as a fraction of the greatest one, from which the skin is its
/// own.
const SHARED: f32 = 0.5;

/// Edits of the skin, and what the mouse points at on it.
impl Session {
    /// The joint with the greatest weight at the point of the shown skin that a ray meets first;
    /// `None` if the skin is hidden or the ray meets none. A root without a bone, such as a pelvis,
    /// shares its skin with the bones on it, and wins where it has at least half of their weight.
    pub fn joint_on_skin(&self, ray: Ray) -> Option<JointId> {
        let skin = self.skeleton_rig().skin.as_ref();
        let skin = skin.filter(|_| self.shown().display.shows(Overlay::Skin))?;
        let mesh = &skin.mesh().ok()?.mesh;
        let posed = self.evaluated.posed_skin(|| {
            mesh.posed(&mesh.pose(&self.evaluated_skeleton().solved), skin.skinning)
        });
        let hit = posed.hit(ray.origin, ray.direction)?;
        let weights = mesh.weights_at(&hit);
        let least = SHARED * weights.of(weights.first());
        let root = weights.iter().find(|(joint, _)| self.is_root_point(*joint));
        Some(root.filter(|(_, weight)| *weight >= least).map_or(weights.first(), |it| it.0))
    }

    /// Whether the shown skin hides the bones.
    pub fn hides_bones(&self) -> bool {
        let display = self.shown().display;
        let skin = self.skeleton_rig().skin.as_ref().filter(|_| display.shows(Overlay::Skin));
        !display.shows(Overlay::Bones) && skin.is_some_and(|skin| skin.mesh().is_ok())
    }

    /// Areas of the cross-section of the compared skins at the active joint over the timeline; `None` if
    /// skins are not compared or have no section there.
    pub fn skin_areas(&self) -> Option<&SkinAreas> {
        self.evaluated.skin_areas(|| SkinAreas::new(self.editing.track(), self.selected()))
    }

    /// Gives the skeleton a skin from its bones, and shows it.
    pub(super) fn add_skin(&mut self) {
        let skin = Skin::from_bones(&self.skeleton_rig().skeleton);
        self.edit_document(|document| {
            skin.mesh()?;
            document.skeleton_rig.skin = Some(skin);
            document.display = document.display.with(Overlay::Skin, true);
            Ok::<(), SkinMeshError>(())
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
            let rig = &mut document.skeleton_rig;
            rig.skin = skin;
            if !is_dragging {
                rig.refresh_skin();
            }
            if let Some(Skin { source: SkinSource::Bones(bones), .. }) = &rig.skin {
                bones.shape().check(&rig.skeleton)?;
                if !is_dragging {
                    bones.mesh()?;
                }
            }
            Ok::<(), SkinShapeError>(())
        });
    }

    /// Makes the mesh of a file, which the skin has, a part of the document.
    pub(super) fn pack_skin(&mut self) {
        let packed = self.skeleton_rig().skin.as_ref().and_then(|skin| match &skin.source {
            SkinSource::Mesh(mesh) => {
                Some(Skin { source: SkinSource::Mesh(mesh.packed()?), ..skin.clone() })
            }
            SkinSource::Bones(_) => None,
        });
        if packed.is_some() {
            self.set_skin(packed);
        }
    }

    /// Replaces the mesh of the skin by that of a file, unless the skin is no longer that of the file `before`.
    /// If the file cannot be read, asks for another one.
    pub(super) fn take_located_skin(
        &mut self,
        path: &Path,
        before: Option<&SkinFile>,
        read: Result<MeshSkin, SkinFileError>,
    ) {
        match (read, self.skeleton_rig().skin.clone()) {
            (Ok(mesh), Some(skin)) if skin.can_become(&mesh, before) => {
                self.commit_edit();
                let mesh = mesh.attached_to(self.skeleton());
                let skin = Skin { source: SkinSource::Mesh(mesh), ..skin };
                self.apply_edit(EditAction::SetSkin(Some(skin)));
                self.say(format!("The skin comes from {}", path.display()));
            }
            (Ok(_), _) => self.fail("the skin has changed since its file was chosen"),
            (Err(error), _) => {
                self.fail(error.to_string());
                let (path, problem) = (path.display().to_string(), Some(error.to_string()));
                self.open_dialog(PathDialog::LocateSkin { path, problem }.into());
            }
        }
    }

    /// Shows the skin, the bones or both.
    pub(super) fn show_skin(&mut self, skin: bool, bones: bool) {
        let display = self.shown().display.with(Overlay::Skin, skin).with(Overlay::Bones, bones);
        self.commit(Document { display, ..self.shown().clone() });
    }
}
