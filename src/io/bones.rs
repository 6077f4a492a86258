//! Bones for the joints of files, which have positions but no bones.

use glam::{DVec3, Vec3};

use crate::kinematics::skeleton::Joint;

/// The bone that the joint of a file gets.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct JointBone {
    /// Vector from the joint to the bone's tip.
    pub axis: Vec3,
    /// The child at the tip, which continues the chain; `None` for a leaf, and where no child
    /// continues it.
    pub child: Option<usize>,
}

/// The joints of a file, parents before their children.
pub struct JointTree<'a> {
    joints: &'a [Joint],
    children: Vec<Vec<usize>>,
    /// Number of joints below each joint.
    descendants: Vec<usize>,
}

/// Bones that follow another chain bend by less than this angle, 60°; its cosine.
const STRAIGHT: f64 = 0.5;

impl<'a> JointTree<'a> {
    pub fn new(joints: &'a [Joint]) -> Self {
        let mut children = vec![Vec::new(); joints.len()];
        let mut descendants = vec![0; joints.len()];
        for (index, joint) in joints.iter().enumerate().rev() {
            if let Some(parent) = joint.parent {
                children[parent.index()].push(index);
                descendants[parent.index()] += 1 + descendants[index];
            }
        }
        children.iter_mut().for_each(|children| children.reverse());
        Self { joints, children, descendants }
    }

    pub fn children(&self, joint: usize) -> &[usize] {
        &self.children[joint]
    }

    /// The bone of each joint. It ends at the `ends` that the file has, otherwise at the child that
    /// continues the chain. `next` can choose this child.
    pub fn bones(
        &self,
        ends: impl Fn(usize) -> Option<Vec3>,
        next: impl Fn(usize) -> Option<usize>,
    ) -> Vec<JointBone> {
        let bone = |joint| {
            if let Some(axis) = ends(joint) {
                return JointBone { axis, child: None };
            }
            let child = next(joint).or_else(|| self.next(joint));
            JointBone { axis: child.map_or(Vec3::ZERO, |child| self.joints[child].offset), child }
        };
        (0..self.joints.len()).map(bone).collect()
    }

    /// Takes the bones from roots that are no part of the body but the origin that it stands on:
    /// their one child moves, or is where the body branches.
    pub fn free_origins(&self, bones: &mut [JointBone], moves: impl Fn(usize) -> bool) {
        for (index, joint) in self.joints.iter().enumerate() {
            if let ([child], None) = (&self.children[index][..], joint.parent)
                && (moves(*child) || self.children[*child].len() > 1)
            {
                bones[index] = JointBone::default();
            }
        }
    }

    /// Gives bones to those leaves of which the file tells no end: straight on from their parents,
    /// as long as the mean of their siblings' bones, otherwise half as long as the way from their
    /// parents.
    pub fn guess_leaves(&self, bones: &mut [JointBone], has_end: impl Fn(usize) -> bool) {
        let known = bones.to_vec();
        for (index, joint) in self.joints.iter().enumerate() {
            let Some(parent) = joint.parent else { continue };
            let is_bare = self.children[index].is_empty() && !has_end(index);
            let Some(direction) = self.direction(index).filter(|_| is_bare) else { continue };
            let siblings = self.children[parent.index()].iter();
            let lengths: Vec<f64> = siblings
                .map(|sibling| known[*sibling].axis.as_dvec3().length())
                .filter(|length| *length > 0.0)
                .collect();
            let length = match lengths.len() {
                0 => 0.5 * joint.offset.as_dvec3().length(),
                count => lengths.iter().sum::<f64>() / count as f64,
            };
            bones[index].axis = (direction * length).as_vec3();
        }
    }

    /// The child that continues the chain: the one that bends least from the direction in which the
    /// chain arrives, otherwise the one with the most joints below it. `None` without children away
    /// from the joint, and where several have as many below them.
    fn next(&self, joint: usize) -> Option<usize> {
        let away = |child: &usize| self.joints[*child].offset != Vec3::ZERO;
        let children: Vec<usize> = self.children[joint].iter().copied().filter(away).collect();
        if let [] | [_] = children[..] {
            return children.first().copied();
        }
        let arriving = self.direction(joint);
        let straightness = |child: usize| match (arriving, self.direction(child)) {
            (Some(arriving), Some(leaving)) => arriving.dot(leaving),
            _ => -1.0,
        };
        let first_best = |a: &usize, b: &usize| straightness(*a) >= straightness(*b);
        let straightest =
            children.iter().copied().reduce(|a, b| if first_best(&a, &b) { a } else { b });
        straightest.filter(|child| straightness(*child) > STRAIGHT).or_else(|| {
            let most = children.iter().map(|child| self.descendants[*child]).max();
            let mut with_most =
                children.iter().filter(|child| Some(self.descendants[**child]) == most);
            let first = with_most.next().copied();
            first.filter(|_| with_most.next().is_none())
        })
    }

    /// Unit vector from a joint's parent to the joint, without rotations; `None` for roots, and for
    /// joints at their parents.
    fn direction(&self, joint: usize) -> Option<DVec3> {
        let joint = &self.joints[joint];
        joint.parent.and_then(|_| joint.offset.as_dvec3().try_normalize())
    }
}

/// Sets the axes of the joints, and radii that suit them.
pub fn give_bones(joints: &mut [Joint], bones: &[JointBone]) {
    for (joint, bone) in joints.iter_mut().zip(bones) {
        joint.axis = bone.axis;
        joint.radius = Joint::new("", None, bone.axis).radius.min(f32::MAX);
    }
}

/// Connects those children at the tips of bones that move, so that the bones follow them.
pub fn connect(joints: &mut [Joint], bones: &[JointBone], moves: impl Fn(usize) -> bool) {
    for child in bones.iter().filter_map(|bone| bone.child).filter(|child| moves(*child)) {
        joints[child].connected = true;
    }
}
