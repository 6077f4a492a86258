use glam::Vec3;

use crate::skeleton::{JointId, Skeleton, SkeletonPose};

/// The axis of the world that points up for a figure.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum UpAxis {
    /// The y axis, as in this program.
    Y,
    /// The z axis, as in many programs for films and for building.
    Z,
}

impl UpAxis {
    /// The axis that points from the feet of a figure to its body in a pose; `None` if the figure
    /// has no legs, or lies.
    ///
    /// Feet are joints whose names say so. Without any, they are at least two leaves that are the
    /// lowest points along an axis and stand apart along x, of a figure that is twice as high as it
    /// is deep; and the highest points are leaves above the middle between them.
    pub fn of(skeleton: &Skeleton, pose: &SkeletonPose) -> Option<Self> {
        let feet: Vec<JointId> =
            skeleton.iter().filter(|(_, joint)| is_foot(&joint.name)).map(|(id, _)| id).collect();
        if feet.is_empty() {
            return Self::of_height(skeleton, pose);
        }
        let leg = |foot: &JointId| {
            let leg = pose.base(hip(skeleton, *foot)) - pose.base(*foot);
            leg.normalize_or_zero()
        };
        let up: Vec3 = feet.iter().map(leg).sum();
        Self::along(up.y, up.z)
    }

    /// The axis along which the figure is high and stands on leaves that are apart.
    fn of_height(skeleton: &Skeleton, pose: &SkeletonPose) -> Option<Self> {
        let points = || pose.points().filter(|point| point.is_finite());
        let (low, high) =
            points().map(|at| (at, at)).reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))?;
        let size = high - low;
        let axis = Self::along(size.y, size.z)?;
        let component = if axis == Self::Y { 1 } else { 2 };
        let mut is_leaf = vec![true; pose.len()];
        for (_, joint) in skeleton.iter() {
            if let Some(parent) = joint.parent {
                is_leaf[parent.index()] = false;
            }
        }
        /// Fraction of the height within which points are at the same height, or at the same place.
        const NEAR: f32 = 0.05;
        let near = NEAR * size[component];
        let tips = pose.ids().filter(|joint| is_leaf[joint.index()]).map(|joint| pose.tip(joint));
        let (mut feet, mut heads) = (Vec::new(), Vec::new());
        for tip in tips {
            if tip[component] < low[component] + near {
                feet.push(tip);
            } else if tip[component] > high[component] - near {
                heads.push(tip);
            }
        }
        // Feet are beside each other, and the head is above the middle between them.
        let range = |points: &[Vec3]| {
            let x = points.iter().map(|point| point.x);
            Some((x.clone().reduce(f32::min)?, x.reduce(f32::max)?))
        };
        let ((left, right), (from, to)) = (range(&feet)?, range(&heads)?);
        let middle = 0.5 * left + 0.5 * right;
        let is_above = (from - middle).abs().max((to - middle).abs()) < near;
        (right - left > near && is_above).then_some(axis)
    }

    /// The axis along which a length is more than twice that along the other.
    fn along(y: f32, z: f32) -> Option<Self> {
        const CLEAR: f32 = 2.0;
        if y > CLEAR * z.abs() { Some(Self::Y) } else { (z > CLEAR * y.abs()).then_some(Self::Z) }
    }
}

/// True if a joint is called a foot, or a part of one.
fn is_foot(name: &str) -> bool {
    const WORDS: [&str; 6] = ["foot", "toe", "ankle", "heel", "paw", "hoof"];
    let name = name.to_lowercase();
    WORDS.iter().any(|word| name.contains(word))
}

/// The joint from which the leg of a foot starts: the nearest ancestor with other children, or the
/// root.
fn hip(skeleton: &Skeleton, foot: JointId) -> JointId {
    let mut above = skeleton.ancestors(foot).skip_while(|joint| is_foot(&skeleton[*joint].name));
    let branches = |joint: &JointId| skeleton.children(*joint).nth(1).is_some();
    let root = skeleton.ancestors(foot).last().unwrap_or(foot);
    above.find(branches).unwrap_or(root)
}
