//! glTF 2.0: export of the shown rig as a `.glb` file, import of skeletons from `.glb` and `.gltf`
//! files.
//!
//! # Export
//!
//! Lengths are in metres, times in seconds from the first frame. No node has a scale.
//!
//! ```text
//! Armature             identity transform; the skin's `skeleton`
//!  └ joints…           as in the document: at the bone's base, +y along the bone, x as near to the joint's own x as possible, or
//!                      for a bone along that to its z
//!     └ NAME_tip       at the tip of a bone that has no children or whose length changes
//! Limbs                the mesh: the skin, or without one a cone for each bone and balls at joints
//! ```
//!
//! Nodes are in the bind pose: the skeleton before any rotation. The document's pose is in the animation, with a key in every frame. Mirroring, stretching
//! and shear of a skeleton's transform become rotations and translations in the animation.
//!
//! # Import
//!
//! The joints of the skins that make a figure become a skeleton in the world, in metres, parents
//! before their children, and so do other nodes of their hierarchy that an animation moves, or that
//! VRM names as bones of a humanoid. Without a skin, the joints are such nodes alone, or those with
//! meshes, with their ancestors up to a common one. The nodes are the bind pose, with the scales with
//! which the animation begins, and what it gives to nodes that are no
//! joints and does not change: a joint's frame is its node's rotation. A joint that moves has the keys of its node in the
//! chosen animation, with their interpolation: rotations turn by slerp, step, or follow a spline of
//! angles that is as exact as single precision. Below scales that change, offsets have keys at every
//! frame, and below uneven ones rotations, too. A node `NAME_tip` without children is not a joint but the tip of NAME's
//! bone. The other bones follow from the joints, see [`bones`](crate::io::bones).
//!
//! The meshes of the skins, and those of nodes below their joints, become the skin of the skeleton:
//! triangles, normals, weights, and base colours with their textures. Other meshes and channels of
//! materials and morph targets are not read, with one warning. If a mesh is damaged or compressed,
//! the whole skin is left out, with a warning.
//!
//! # Source
//!
//! *glTF 2.0 Specification*, The Khronos Group, 2021.

mod export;
mod extras;
mod file;
mod import;
mod material;

use std::collections::HashMap;

use glam::{DMat3, DVec3};

pub use export::{GlbError, glb};
pub use import::{former, read};

/// The key by which a file is recognized.
pub const KEY: &str = "asset";

/// Returns a right-handed orthonormal frame: its y axis is along the vector `y`, its x axis as near
/// to the vector `x` as possible, and z = x × y. Where zero or parallel vectors leave an axis
/// undetermined, the axis is arbitrary.
pub fn frame(y: DVec3, x: DVec3) -> DMat3 {
    let y = y.try_normalize().unwrap_or(DVec3::Y);
    let x = perpendicular(x, y).unwrap_or_else(|| y.any_orthonormal_vector());
    DMat3::from_cols(x, y, x.cross(y))
}

/// Of all unit vectors perpendicular to the unit vector `y`, returns the one nearest to `x`; `None`
/// if `x` is zero or parallel to `y`.
fn perpendicular(x: DVec3, y: DVec3) -> Option<DVec3> {
    const PARALLEL: f64 = 1e-6;
    let x = x.try_normalize()?;
    let perpendicular = x - y * x.dot(y);
    (perpendicular.length() > PARALLEL).then(|| perpendicular.normalize())
}

/// Names in use, each with the number to try as the suffix of the next equal name.
#[derive(Default)]
pub struct UniqueNames(HashMap<String, usize>);

impl<const N: usize> From<[&str; N]> for UniqueNames {
    fn from(taken: [&str; N]) -> Self {
        Self(taken.map(|name| (name.to_owned(), FIRST)).into())
    }
}

const FIRST: usize = 2;

impl UniqueNames {
    /// Returns `name`, with a number as suffix if it is in use already. The result is then in use.
    pub fn free(&mut self, name: &str) -> String {
        let mut free = name.to_owned();
        let mut number = self.0.get(name).copied();
        while let Some(next) = number.filter(|_| self.0.contains_key(&free)) {
            free = format!("{name}_{next}");
            number = Some(next + 1);
        }
        if let Some(number) = number {
            self.0.insert(name.to_owned(), number);
        }
        self.0.insert(free.clone(), FIRST);
        free
    }
}

#[cfg(test)]
mod tests {
    use crate::io::formats::gltf::*;

    #[test]
    fn every_name_is_free() {
        let mut names = UniqueNames::from(["a", "a_3"]);
        let all = ["a", "b", "a", "a_2", "b", "a"].map(|name| names.free(name));
        assert_eq!(all, ["a_2", "b", "a_4", "a_2_2", "b_2", "a_5"]);
    }
}
