use glam::{DMat3, DQuat, DVec3};

use super::GlbError;
use super::figure::{Figure, Placed};
use crate::io::gltf::names::Names;

/// The joints that a file has: one for every bone, in the same order, then those at tips.
pub struct Bones {
    pub nodes: Vec<Node>,
    /// Where they are in the bind pose.
    pub rest: Vec<Local>,
}

pub struct Node {
    /// No two have the same.
    pub name: String,
    pub parent: Option<usize>,
    /// The bone that it is, or that it is at the tip of.
    pub bone: usize,
    pub is_tip: bool,
}

/// A rigid transform in the parent's, in metres.
#[derive(Clone, Copy)]
pub struct Local {
    pub translation: DVec3,
    pub rotation: DQuat,
}

impl Bones {
    /// What the node above all joints, and the one with the mesh, are called.
    pub const ARMATURE: &str = "Armature";
    pub const MESH: &str = "Limbs";

    pub fn new(figure: &Figure) -> Result<Self, GlbError> {
        let mut names = Names::from([Self::ARMATURE, Self::MESH]);
        let joints = figure.bones.iter().enumerate().map(|(bone, joint)| Node {
            name: names.free(&joint.name),
            parent: joint.parent,
            bone,
            is_tip: false,
        });
        let mut nodes: Vec<Node> = joints.collect();
        for bone in (0..nodes.len()).filter(|bone| figure.bones[*bone].has_tip) {
            let name = names.free(&format!("{}_tip", nodes[bone].name));
            nodes.push(Node { name, parent: Some(bone), bone, is_tip: true });
        }
        let mut bones = Self { nodes, rest: Vec::new() };
        bones.rest = bones.locals(&figure.rest, None)?;
        Ok(bones)
    }

    /// The joint at the tip of every bone that has one.
    pub fn tips(&self) -> Vec<Option<usize>> {
        let mut tips = vec![None; self.nodes.len()];
        for (node, tip) in self.nodes.iter().enumerate().filter(|(_, node)| node.is_tip) {
            tips[tip.bone] = Some(node);
        }
        tips
    }

    /// Where every joint is in its parent when the bones are placed so, at a time in seconds.
    pub fn locals(&self, placed: &[Placed], time: Option<f64>) -> Result<Vec<Local>, GlbError> {
        let frames: Vec<DMat3> = placed.iter().map(Placed::frame).collect();
        let local = |node: &Node| {
            let Placed { base, along, .. } = placed[node.bone];
            let local = match node.parent {
                _ if node.is_tip => {
                    Local { translation: DVec3::Y * along.length(), rotation: DQuat::IDENTITY }
                }
                Some(parent) => {
                    let above = frames[parent].transpose();
                    Local {
                        translation: above * (base - placed[parent].base),
                        rotation: DQuat::from_mat3(&(above * frames[node.bone])).normalize(),
                    }
                }
                None => Local {
                    translation: base,
                    rotation: DQuat::from_mat3(&frames[node.bone]).normalize(),
                },
            };
            let fits = [base, base + along, local.translation].map(|v| v.as_vec3().is_finite());
            if fits != [true; 3] {
                return Err(GlbError::TooFar { joint: node.name.clone(), time });
            }
            Ok(local)
        };
        self.nodes.iter().map(local).collect()
    }
}
