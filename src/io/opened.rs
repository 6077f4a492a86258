//! The choice of what to read of a file, and the result.

use glam::Vec3;

use super::error::Remark;
use crate::document::{Document, Overlay, Skin};
use crate::kinematics::skeleton::{JointId, Skeleton};
use crate::rig::{FileMesh, MeshSkin, SkinFile, SkinPart, SkinSource};

/// The choice of one of several skeletons and animations, and of the axis that points up.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct OpenOptions {
    /// Name of the skeleton; `None` for the first.
    pub skeleton: Option<String>,
    /// Name of the animation, or its number in the file, from 0; `None` for the first that moves
    /// the skeleton.
    pub animation: Option<String>,
    /// The axis that points up; `None` for y, with a remark if it seems to be z.
    pub up: Option<Upwards>,
    /// True if a document that has no camera gets the default one, instead of one that frames the
    /// skeleton: to frame it, its targets are solved for.
    pub without_camera: bool,
}

impl OpenOptions {
    /// Options that choose the skeleton with this name.
    pub fn of_skeleton(name: &str) -> Self {
        Self { skeleton: Some(name.to_owned()), ..Self::default() }
    }

    /// Options that choose the animation with this name or number.
    pub fn of_animation(name: &str) -> Self {
        Self { animation: Some(name.to_owned()), ..Self::default() }
    }

    /// Options that tell which axis points up.
    pub fn of_up(up: Upwards) -> Self {
        Self { up: Some(up), ..Self::default() }
    }
}

/// The axis that points up in a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Upwards {
    /// The y axis: nothing is turned.
    Y,
    /// The z axis: the skeleton is turned.
    Z,
    /// The one along which the figure stands: the skeleton is turned if that is z.
    Auto,
}

/// A document read from a file.
#[derive(Clone, Debug, PartialEq)]
pub struct Opened {
    /// The document.
    pub document: Document,
    /// Warnings about a file that could be opened all the same.
    pub warnings: Vec<Remark>,
    /// For each joint in the file's order, its index in the document's skeleton.
    pub order: Vec<JointId>,
    /// The names of the file's skeletons, one of which was opened; empty for this program's own
    /// format, in which the one skeleton has no name.
    pub skeletons: Vec<String>,
    /// Index of the skeleton that was read; `None` for this program's own format.
    pub skeleton: Option<usize>,
    /// The animations of a glTF file; empty for other formats.
    pub animations: Vec<FileAnimation>,
    /// Index of the animation that was read; `None` if there is none.
    pub animation: Option<usize>,
}

/// An animation of a file.
#[derive(Clone, Debug, PartialEq)]
pub struct FileAnimation {
    /// Name, unique in the file.
    pub name: String,
    /// Time of the first key, in seconds.
    pub start: f64,
    /// Time of the last key, in seconds.
    pub end: f64,
    /// Number of joints of the skeleton that the animation moves against their parents.
    pub moving_joints: usize,
    /// True if the animation changes weights of morph targets of the file's meshes.
    pub has_morphs: bool,
}

impl FileAnimation {
    /// Returns whether the animation moves the skeleton or changes its mesh.
    pub fn moves(&self) -> bool {
        (self.moving_joints > 0 || self.has_morphs) && self.start < self.end
    }
}

/// Gives the skeleton of a document the mesh of a file, and shows it instead of the bones, or, if it
/// is next to nothing, with them.
/// `joints` has for each joint of the mesh the joint of the skeleton. Without `file`, the document
/// contains the mesh when it is saved. A mesh without colours gets the colour of skins from bones.
pub fn attach_skin(
    document: &mut Document,
    mesh: FileMesh,
    file: Option<SkinFile>,
    joints: Vec<Option<JointId>>,
) {
    let skin = MeshSkin::new(mesh.into(), file, joints, document.skeleton());
    let is_plain = |part: &SkinPart| part.colour == [1.0; 3] && part.texture.is_none();
    let is_colourless =
        |mesh: &FileMesh| mesh.parts.iter().all(is_plain) && mesh.mesh.mesh().colours.is_empty();
    let has_colours = !skin.in_file().is_some_and(|mesh| is_colourless(mesh));
    let skin = Skin::new(SkinSource::Mesh(skin));
    let colour = if has_colours { skin.colour } else { Skin::DEFAULT_COLOUR };
    let covers = covers_the_bones(document.skeleton(), &skin);
    document.rig.skin = Some(Skin { colour, ..skin });
    document.display = document.display.with(Overlay::Skin, true).with(Overlay::Bones, !covers);
}

/// True if a skin is large enough to show the pose without the bones: its box is at least a fifth as
/// large as that of the joints.
fn covers_the_bones(skeleton: &Skeleton, skin: &Skin) -> bool {
    const LEAST: f32 = 0.2;
    let size = |points: &mut dyn Iterator<Item = Vec3>| {
        let ends = points.map(|at| (at, at)).reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)));
        ends.map_or(0.0, |(low, high)| low.distance(high))
    };
    let pose = skeleton.bind_pose();
    let Ok(mesh) = skin.mesh() else { return true };
    size(&mut mesh.corners(&pose)) >= LEAST * size(&mut pose.points())
}
