//! `ik-arm skin`: a document whose skeleton has a skin around its bones.

use std::path::PathBuf;

use super::argument::number;
use super::open::{self, InputArgs};
use super::report::{CommandError, say};
use crate::document::{Document, Overlay, Skin};
use crate::io::save;
use crate::kinematics::skin::{BindError, SkinShape, SkinnedMesh, Skinning};
use crate::rig::{BoneSkin, SkinSource};

#[derive(clap::Args)]
#[command(
    after_help = r#"The skin is a closed mesh around the bones in the bind pose, as thick as the joints' radii. The
document holds its settings; the mesh is made again when the document is opened. It replaces the
mesh of a figure from another program. With --bind that mesh stays, and gets new weights, which the
document holds with it. Settings that are not given stay as they are in FILE, also
blobs, which only a document can have. The numbers of vertices and triangles are listed on stderr."#,
    mut_arg("file", |file| file.help(open::input_help("File with a skeleton")))
)]
pub struct SkinArgs {
    /// Document to write (.json)
    #[arg(short, long, value_name = "OUT")]
    output: PathBuf,
    #[command(flatten)]
    input: InputArgs,
    /// How finely the mesh is made: the smallest radius is N cells of the grid, 1.2 to 16; twice
    /// the detail gives four times the vertices [default: 2]
    #[arg(long, value_name = "N", allow_hyphen_values = true, value_parser = number)]
    detail: Option<f32>,
    /// Factor of all radii, above 0 [default: 1]
    #[arg(long, value_name = "X", allow_hyphen_values = true, value_parser = number)]
    thickness: Option<f32>,
    /// Give each joint a body of its own, as an artist's mannequin has;
    /// `--jointed=false` makes one surface of all [default: false]
    #[arg(long, value_name = "BOOL", num_args = 0..=1, require_equals = true, default_missing_value = "true")]
    jointed: Option<bool>,
    /// Let the mesh that FILE has follow its bones instead, by their distances inside it, in the pose
    /// at the timeline's start
    #[arg(long, conflicts_with_all = ["detail", "thickness", "jointed"])]
    bind: bool,
    /// How a vertex between joints follows them: linear, dual-quaternion or spread-twist [default:
    /// dual-quaternion]
    #[arg(long, visible_alias = "blend", value_name = "WAY")]
    skinning: Option<Skinning>,
}

pub fn run(args: &SkinArgs) -> Result<(), CommandError> {
    let SkinArgs { input, output, .. } = args;
    open::require_document("skin", output)?;
    let mut document = input.open()?.document;
    let skin = match args.bind {
        true => args.bound(&document).map_err(|why| CommandError::of_file(input.name(), why))?,
        false => args.made(&document),
    };
    let made = skin.mesh().map_err(|error| CommandError::of_file(input.name(), error))?;
    let mesh = made.mesh.mesh();
    let report = format!("{} vertices, {} triangles", mesh.positions.len(), mesh.triangles.len());
    document.rig.skin = Some(skin);
    document.display = document.display.with(Overlay::Skin, true);
    save(&document, output)?;
    say(&report);
    Ok(())
}

impl SkinArgs {
    /// The mesh of the document on its bones.
    fn bound(&self, document: &Document) -> Result<Skin, BindError> {
        let skin = document.rig.skin.as_ref().ok_or(BindError::NoMesh)?;
        let mesh = skin.mesh_skin().ok_or(BindError::NoMesh)?;
        let skinning = self.skinning.unwrap_or(skin.skinning);
        let posed = document.at(document.timeline.start);
        let bind = |mesh: &SkinnedMesh| mesh.bound(posed.skeleton(), skinning);
        let bound = mesh.reattached(document.skeleton(), bind)?.ok_or(BindError::NoMesh)?;
        Ok(Skin { source: SkinSource::Mesh(bound), skinning, ..skin.clone() })
    }

    /// The skin of the document with the settings that are given.
    fn made(&self, document: &Document) -> Skin {
        let rig = &document.rig;
        let old = rig.skin.clone().unwrap_or_else(|| Skin::from_bones(&rig.skeleton));
        let old = match old.source {
            SkinSource::Bones(_) => old,
            SkinSource::Mesh(_) => Skin::from_bones(&rig.skeleton),
        };
        let mut shape = match &old.source {
            SkinSource::Bones(bones) => bones.shape().clone(),
            SkinSource::Mesh(_) => SkinShape::default(),
        };
        shape.detail = self.detail.unwrap_or(shape.detail);
        shape.thickness = self.thickness.unwrap_or(shape.thickness);
        shape.is_jointed = self.jointed.unwrap_or(shape.is_jointed);
        let source = SkinSource::Bones(BoneSkin::new(rig.skeleton.clone(), shape));
        let skinning = self.skinning.unwrap_or(old.skinning);
        Skin { source, skinning, ..old }
    }
}
