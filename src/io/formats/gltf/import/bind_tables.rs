//! The transforms by which the joints of a figure place its meshes, see
//! [`skin_mesh`](super::skin_mesh): one table for all skins that agree about them.

use glam::{DAffine3, DMat4};

use super::buffers::GltfBuffers;
use super::figures::Figure;
use super::nodes::{SkinJoints, at_skin};
use super::rows::{AccessorRows, at_accessor};
use crate::io::formats::gltf::file::GltfFile;
use crate::io::json::FieldError;
use crate::kinematics::skin::SkinnedMesh;

/// The tables of a figure.
pub struct BindTables {
    /// At least one.
    pub tables: Vec<BindTable>,
    /// For each skin of the figure, its table.
    pub of_skins: Vec<usize>,
}

/// Transforms A of all joints of the figure, for skins that agree about the joints that they share.
pub struct BindTable {
    pub attached: Vec<DAffine3>,
    /// True for joints that a skin lists.
    is_listed: Vec<bool>,
}

impl BindTables {
    /// The tables of a figure, whose nodes have the transforms `worlds`.
    pub fn new(
        file: &GltfFile<'_>,
        buffers: &GltfBuffers<'_>,
        figure: &Figure,
        joints: &SkinJoints,
        worlds: &[DAffine3],
    ) -> Result<Self, FieldError> {
        let nodes: Vec<DAffine3> = joints.skin_nodes.iter().map(|node| worlds[*node]).collect();
        let count = nodes.len();
        let new = || BindTable { attached: nodes.clone(), is_listed: vec![false; count] };
        let (mut tables, mut of_skins): (Vec<BindTable>, Vec<usize>) = (Vec::new(), Vec::new());
        for (skin, joints) in figure.skins.iter().zip(&joints.of_skins) {
            let binds = attached(file, buffers, *skin, joints, &nodes)?;
            let listed = || joints.iter().copied().zip(binds.iter().copied());
            let fitting = tables.iter().position(|table| table.fits(listed()));
            let place = fitting.unwrap_or_else(|| {
                tables.push(new());
                tables.len() - 1
            });
            for (joint, bind) in listed() {
                tables[place].attached[joint] = bind;
                tables[place].is_listed[joint] = true;
            }
            of_skins.push(place);
            if tables.len().saturating_mul(count) > SkinnedMesh::MOST_BINDS {
                let most = SkinnedMesh::MOST_BINDS / count;
                let reason = format!("must differ in at most {most} skins of {count} joints");
                return Err(FieldError::new(at_skin(*skin).key("inverseBindMatrices"), reason));
            }
        }
        if tables.is_empty() {
            tables.push(new());
        }
        Ok(Self { tables, of_skins })
    }
}

/// The transforms A of a skin's joints, in the order of the skin; `nodes` are those of all joints'
/// nodes.
fn attached(
    file: &GltfFile<'_>,
    buffers: &GltfBuffers<'_>,
    skin: usize,
    joints: &[usize],
    nodes: &[DAffine3],
) -> Result<Vec<DAffine3>, FieldError> {
    let nodes = joints.iter().map(|joint| nodes[*joint]);
    let Some(accessor) = file.skins.0[skin].inverse_binds.map(|it| it.0 as usize) else {
        return Ok(nodes.collect());
    };
    let rows = AccessorRows::new(file, buffers, accessor, "MAT4")?;
    if rows.len() < joints.len() {
        let (joints, got) = (joints.len(), rows.len());
        let reason = format!("must be at least {joints}, the number of joints, got {got}");
        return Err(FieldError::new(at_accessor(accessor).key("count"), reason));
    }
    let bind = |row| DAffine3::from_mat4(DMat4::from_cols_array(&rows.row(row)));
    Ok(nodes.enumerate().map(|(row, world)| world * bind(row)).collect())
}

impl BindTable {
    /// Returns whether the table has the same transforms for all of these joints that it lists.
    fn fits(&self, mut joints: impl Iterator<Item = (usize, DAffine3)>) -> bool {
        /// Part of the largest number by which transforms may differ: files have single precision.
        const ALIKE: f64 = 1e-6;
        joints.all(|(joint, bind)| {
            let numbers = bind.to_cols_array();
            let largest = numbers.iter().fold(0.0, |most: f64, it| most.max(it.abs()));
            !self.is_listed[joint] || self.attached[joint].abs_diff_eq(bind, ALIKE * largest)
        })
    }
}
