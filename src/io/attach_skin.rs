use crate::document::{Document, Overlay, Skin};
use crate::kinematics::skeleton::JointId;
use crate::rig::{FileMesh, MeshSkin, SkinFile, SkinPart, SkinSource};

/// Gives the skeleton of a document the mesh of a file, and shows all of it instead of the bones. `joints` has for
/// each joint of the mesh the joint of the skeleton. Without `file`, the document contains the mesh when it is
/// saved. A mesh without colours gets the colour of skins from bones.
pub fn attach_skin(
    document: &mut Document,
    mesh: FileMesh,
    file: Option<SkinFile>,
    joints: Vec<Option<JointId>>,
) {
    let skin = MeshSkin::new(mesh.into(), file, joints, document.skeleton());
    let is_plain = |part: &SkinPart| part.colour == [1.0; 3] && part.texture.is_none();
    let has_colours = !skin.in_file().is_some_and(|mesh| mesh.parts.iter().all(is_plain));
    let skin = Skin::new(SkinSource::Mesh(skin));
    let colour = if has_colours { skin.colour } else { Skin::DEFAULT_COLOUR };
    document.skeleton_rig.skin = Some(Skin { colour, ..skin });
    document.display = document.display.with(Overlay::Skin, true).with(Overlay::Bones, false);
}
