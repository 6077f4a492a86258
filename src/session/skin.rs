use std::path::Path;

use glam::Vec3;

use crate::document::{Channel, Document, Overlay, Ray, Skin};
use crate::kinematics::skeleton::{Joint, JointId, Skeleton};
use crate::kinematics::skin::{BindError, SkinShapeError, SkinnedMesh, Skinning, VertexWeights};
use crate::rig::{MeshSkin, SkeletonRig, SkinFile, SkinFileError, SkinMeshError, SkinSource};
use crate::session::evaluated::SkinAreas;
use crate::session::files::action::PathDialog;
use crate::session::outcome::{Consequence, Outcome};
use crate::session::session::Session;

/// A change of the skin.
#[derive(Clone, Debug, PartialEq)]
pub enum SkinEdit {
    /// Gives the skeleton a skin from its bones, and shows it.
    AddSkin,
    /// Shows the skin of the skeleton, its bones, or both.
    ShowSkin {
        /// True if the skin is shown.
        skin: bool,
        /// True if the bones are shown through the skin.
        bones: bool,
    },
    /// Makes the mesh of a file, which the skin has, a part of the document.
    PackSkin,
    /// Lets the mesh of the skin follow the bones by weights from their distances inside it.
    Bind,
    /// Lets the mesh of the skin follow its first joint alone.
    Unbind,
    /// Places the only joint of the skeleton at a point in the world, and leaves the mesh of the skin
    /// where it is.
    PlaceRoot(Vec3),
    /// Sets the weight of a morph target of the skin.
    SetMorph {
        /// Index of the morph target.
        morph: u16,
        /// The weight.
        weight: f32,
    },
    /// Replaces the skin of the skeleton; `None` removes it.
    SetSkin(Option<Skin>),
}

impl SkinEdit {
    /// Label of the edit's undo step.
    pub fn label(&self) -> &'static str {
        match self {
            Self::AddSkin => "Add skin",
            Self::ShowSkin { skin: true, bones: true } => "Show skin and bones",
            Self::ShowSkin { skin: true, bones: false } => "Show skin",
            Self::ShowSkin { skin: false, .. } => "Show bones",
            Self::PackSkin => "Pack skin into file",
            Self::Bind => "Bind mesh",
            Self::Unbind => "Unbind mesh",
            Self::PlaceRoot(_) => "Place root",
            Self::SetMorph { .. } => "Set morph target",
            Self::SetSkin(None) => "Remove skin",
            Self::SetSkin(Some(_)) => "Change skin",
        }
    }

    pub(super) fn apply(self, session: &Session) -> Outcome {
        match self {
            Self::AddSkin => add(session),
            Self::ShowSkin { skin, bones } => show(session.shown(), skin, bones),
            Self::PackSkin => pack(session),
            Self::Bind => bind(session),
            Self::Unbind => unbind(session),
            Self::PlaceRoot(at) => place_root(session, at),
            Self::SetMorph { morph, weight } => Outcome::change(session.shown(), |document| {
                document.rig.set_morph_weight(morph.into(), weight);
            }),
            Self::SetSkin(skin) => set(session, skin),
        }
    }
}

/// Gives the skeleton a skin from its bones, and shows it.
fn add(session: &Session) -> Outcome {
    let skin = Skin::from_bones(&session.rig().skeleton);
    Outcome::edit(session.shown(), |document| {
        skin.mesh()?;
        document.rig.skin = Some(skin);
        document.display = document.display.with(Overlay::Skin, true);
        Ok::<(), SkinMeshError>(())
    })
}

/// Shows the skin, the bones or both.
fn show(shown: &Document, skin: bool, bones: bool) -> Outcome {
    let display = shown.display.with(Overlay::Skin, skin).with(Overlay::Bones, bones);
    Consequence::Write(Box::new(Document { display, ..shown.clone() })).into()
}

/// Makes the mesh of a file, which the skin has, a part of the document.
fn pack(session: &Session) -> Outcome {
    let packed = session.rig().skin.as_ref().and_then(|skin| match &skin.source {
        SkinSource::Mesh(mesh) => {
            Some(Skin { source: SkinSource::Mesh(mesh.packed()?), ..skin.clone() })
        }
        SkinSource::Bones(_) => None,
    });
    packed.map(|packed| set(session, Some(packed))).into()
}

/// Lets the mesh follow the bones, and shows the weights of the selected joint.
fn bind(session: &Session) -> Outcome {
    let bound = attach(session, |document, mesh, posed, skinning| {
        document.display = document.display.with(Overlay::SkinWeights, true);
        mesh.bound(posed, skinning)
    });
    match bound {
        Ok(written) => written.and(Outcome::say(
            "Bound: the colours are the weights of the selected joint; Weights in the panel hides them",
        )),
        Err(refused) => refused,
    }
}

/// Lets the mesh follow its first joint alone.
fn unbind(session: &Session) -> Outcome {
    let loose = attach(session, |document, mesh, posed, skinning| {
        document.display = document.display.with(Overlay::SkinWeights, false);
        let weights = vec![VertexWeights::rigid(JointId::new(0)); mesh.weights().len()];
        Ok(mesh.reattached(weights, [posed; 2], skinning)?)
    });
    loose.unwrap_or_else(|refused| refused)
}

/// Attaches the mesh of the skin again, as it is on the shown pose. Fails with the report of the
/// error.
fn attach(
    session: &Session,
    attach: impl FnOnce(
        &mut Document,
        &SkinnedMesh,
        &Skeleton,
        Skinning,
    ) -> Result<SkinnedMesh, BindError>,
) -> Result<Outcome, Outcome> {
    let posed = session.posed();
    let edited = Outcome::edit_with(session.shown(), |document| {
        let skin = document.rig.skin.clone().ok_or(BindError::NoMesh)?;
        let mesh = skin.mesh_skin().ok_or(BindError::NoMesh)?;
        let skeleton = document.rig.skeleton.clone();
        let attached = mesh.reattached(&skeleton, |mesh| {
            attach(document, mesh, posed.skeleton(), skin.skinning)
        })?;
        let source = SkinSource::Mesh(attached.ok_or(BindError::NoMesh)?);
        document.rig.skin = Some(Skin { source, ..skin });
        Ok::<(), BindError>(())
    });
    edited.map(|(written, ())| written)
}

/// Places the only joint, and shows it with the mesh.
fn place_root(session: &Session, at: Vec3) -> Outcome {
    let root = JointId::new(0);
    let placed = Outcome::edit(session.shown(), |document| {
        let before = document.skeleton().clone();
        let offset = before.transform().inverse().transform_point3(at);
        let placed = document.skeleton_mut().change(root, |joint| joint.offset = offset);
        placed.map_err(|error| error.to_string())?;
        document.display = document.display.with(Overlay::Bones, true);
        let SkeletonRig { skeleton, skin, .. } = &mut document.rig;
        let Some(Skin { source: SkinSource::Mesh(mesh), skinning, .. }) = skin else {
            return Ok(());
        };
        let stays = |mesh: &SkinnedMesh| {
            mesh.reattached(mesh.weights().to_vec(), [&before, skeleton], *skinning)
        };
        if let Some(attached) = mesh.reattached(skeleton, stays).map_err(|it| it.to_string())? {
            *mesh = attached;
        }
        Ok::<(), String>(())
    });
    placed.and(Consequence::Select(vec![root]))
}

/// Replaces the skin, with its colour clamped to valid channels. During a drag its mesh stays;
/// otherwise it is made at once.
fn set(session: &Session, skin: Option<Skin>) -> Outcome {
    let skin = skin.map(|skin| Skin {
        colour: skin.colour.map(|channel| if channel > 0.0 { channel.min(1.0) } else { 0.0 }),
        ..skin
    });
    let is_dragging = session.history().is_editing();
    Outcome::edit(session.shown(), |document| {
        let rig = &mut document.rig;
        rig.skin = skin;
        if !is_dragging {
            rig.refresh_skin();
        }
        forget_lost_morphs(document);
        let rig = &mut document.rig;
        if let Some(Skin { source: SkinSource::Bones(bones), .. }) = &rig.skin {
            bones.shape().check(&rig.skeleton)?;
            if !is_dragging {
                bones.mesh()?;
            }
        }
        Ok::<(), SkinShapeError>(())
    })
}

/// Removes the keys of morph targets that the skin does not have.
fn forget_lost_morphs(document: &mut Document) {
    let channels = document.keys.tracks().map(|(channel, _)| channel);
    let is_lost = |channel: &Channel| {
        matches!(channel, Channel::Morph(_)) && channel.value(document).is_none()
    };
    let lost: Vec<Channel> = channels.filter(is_lost).collect();
    lost.into_iter().for_each(|channel| document.keys.clear(channel));
}

/// The edit that replaces the mesh of the skin by that of a file, unless the skin is no longer that
/// of the file `before`.
///
/// # Errors
///
/// The report of the error. If the file cannot be read, it asks for another one.
pub(super) fn located(
    session: &Session,
    path: &Path,
    before: Option<&SkinFile>,
    read: Result<MeshSkin, SkinFileError>,
) -> Result<SkinEdit, Outcome> {
    let mesh = read.map_err(|error| {
        let (path, problem) = (path.display().to_string(), Some(error.to_string()));
        let dialog = PathDialog::LocateSkin { path, problem }.into();
        Outcome::fail(error.to_string()).and(Consequence::OpenDialog(Box::new(dialog)))
    })?;
    let skin = session.rig().skin.clone();
    match skin.filter(|skin| skin.can_become(&mesh, before)) {
        Some(skin) => {
            let weights = skin.mesh_skin().map(|mesh| mesh.morph_weights().to_vec());
            let mesh = mesh.attached_to(session.skeleton());
            let mesh = mesh.with_morph_weights(weights.unwrap_or_default());
            let source = SkinSource::Mesh(mesh);
            Ok(SkinEdit::SetSkin(Some(Skin { source, ..skin })))
        }
        None => Err(Outcome::fail("the skin has changed since its file was chosen")),
    }
}

/// The skin under the mouse.
impl Session {
    /// True if the skin is a mesh that follows a root without a bone alone: joints can be placed in it.
    pub fn has_loose_mesh(&self) -> bool {
        let mesh = self.rig().skin.as_ref().and_then(Skin::mesh_skin);
        let followed = mesh.and_then(MeshSkin::sole_joint);
        followed.and_then(|joint| self.skeleton().joint(joint)).is_some_and(Joint::is_root_point)
    }

    /// True if the skeleton is a single joint without a bone.
    pub fn has_lone_root(&self) -> bool {
        let joints = self.skeleton().joints();
        matches!(joints, [root] if root.is_root_point())
    }

    /// The middle of the body that a ray enters, if the shown skin is an imported mesh; `None` if it
    /// meets none.
    pub fn middle_of_mesh(&self, ray: Ray) -> Option<Vec3> {
        self.rig().skin.as_ref()?.mesh_skin()?;
        self.evaluated().middle_of_skin(self.posed(), ray)
    }

    /// Areas of the cross-section of the compared skins at the active joint over the timeline;
    /// `None` if skins are not compared or have no section there.
    pub fn skin_areas(&self) -> Option<&SkinAreas> {
        self.evaluated()
            .skin_areas(|| SkinAreas::new(self.history().track(), self.selection().active()))
    }
}
