//! The bones and blobs that a skin is made of, and which of them blend: those of a joint with those
//! of its parent, and siblings that start at one point. All others do not, so that fingers do not
//! melt together.

use glam::{DVec3, Vec3};

use super::sweep::{BlobSphere, Sweep};
use crate::skeleton::{Joint, JointId, Skeleton, SkeletonPose};
use crate::skin::SkinError;

/// Parameters of a skin from bones beside the skeleton.
#[derive(Clone, Debug, PartialEq)]
pub struct SkinShape {
    /// Cells of the grid on the smallest radius, from [`SkinShape::LEAST_DETAIL`] to
    /// [`SkinShape::MOST_DETAIL`]. Twice the detail gives four times the vertices.
    pub detail: f32,
    /// Factor of all radii, above 0.
    pub thickness: f32,
    /// Bodies beside the bones.
    pub blobs: Vec<Blob>,
    /// Each joint has a closed surface of its own, as the parts of an artist's mannequin are.
    /// Otherwise each tree of joints has one surface.
    ///
    /// A surface moves with its joint alone, except near a seam where a joint is at the tip of its
    /// parent, or at the side of a parent without a bone, and both surfaces are about as thick there
    /// (radii that differ by less than 1.4 times): within 1.4 radii to either side of such a seam,
    /// weights pass evenly from one joint to the other, so that an elbow, a knee or a hip has no
    /// crease. Elsewhere, surfaces keep their volume in any bend. At all seams normals turn to the
    /// mean of both, so that a seam is hardly seen.
    pub is_jointed: bool,
    /// Euler angles in radians of the joints in the pose in which the surface is made; 0 for joints
    /// that are not in the list, as in the bind pose.
    pub pose: Vec<(JointId, Vec3)>,
}

/// A body beside a joint's bone, for example a rib cage or a heel: what a sphere passes through that
/// goes from each of some spheres to the next one, along a smooth curve if there are more than two.
#[derive(Clone, Debug, PartialEq)]
pub struct Blob {
    /// The joint that the blob moves with.
    pub joint: JointId,
    /// The spheres, at least one.
    pub spheres: Vec<BlobSphere>,
}

impl SkinShape {
    /// The coarsest grid: no sphere falls between its points.
    pub const LEAST_DETAIL: f32 = 1.2;
    /// The finest grid.
    pub const MOST_DETAIL: f32 = 16.0;
    /// The most spheres of all blobs together.
    pub const MOST_SPHERES: usize = 8192;

    /// Checks the numbers, and that the joints of blobs and pose exist.
    ///
    /// # Errors
    ///
    /// [`SkinShapeError`] names the number and the rule.
    pub fn check(&self, skeleton: &Skeleton) -> Result<(), SkinShapeError> {
        let Self { detail, thickness, blobs, is_jointed: _, pose } = self;
        if !(Self::LEAST_DETAIL..=Self::MOST_DETAIL).contains(detail) {
            return Err(SkinShapeError::Detail(*detail));
        }
        if !(thickness.is_finite() && *thickness > 0.0) {
            return Err(SkinShapeError::Thickness(*thickness));
        }
        let spheres = blobs.iter().map(|blob| blob.spheres.len().max(1)).sum();
        if spheres > Self::MOST_SPHERES {
            return Err(SkinShapeError::TooManySpheres(spheres));
        }
        let joints = skeleton.joints().len();
        let is_sound =
            |(joint, angles): &(JointId, Vec3)| joint.index() < joints && angles.is_finite();
        if let Some(index) = pose.iter().position(|joint| !is_sound(joint)) {
            return Err(SkinShapeError::Pose { index, joints });
        }
        for (index, blob) in blobs.iter().enumerate() {
            if blob.joint.index() >= joints {
                return Err(SkinShapeError::BlobJoint { blob: index, joints, got: blob.joint });
            }
            let is_sound = |sphere: &BlobSphere| {
                sphere.centre.is_finite() && sphere.radius.is_finite() && sphere.radius > 0.0
            };
            if blob.spheres.is_empty() || !blob.spheres.iter().all(is_sound) {
                return Err(SkinShapeError::Blob { blob: index });
            }
        }
        Ok(())
    }
}

impl Default for SkinShape {
    fn default() -> Self {
        Self { detail: 2.0, thickness: 1.0, blobs: Vec::new(), is_jointed: false, pose: Vec::new() }
    }
}

/// No skin can be made from these bones.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SkinShapeError {
    /// The detail is outside its range.
    #[error("skin detail must be from 1.2 to 16, got {0}")]
    Detail(f32),
    /// The thickness is not above 0.
    #[error("skin thickness must be finite and above 0, got {0}")]
    Thickness(f32),
    /// The blobs have too many spheres.
    #[error("the blobs of a skin must have at most 8192 spheres, got {0}")]
    TooManySpheres(usize),
    /// A blob is on a joint that does not exist.
    #[error("the joint of blob {blob} must be below {joints}, got {}", got.index())]
    BlobJoint {
        /// Index of the blob.
        blob: usize,
        /// Number of joints.
        joints: usize,
        /// The joint that does not exist.
        got: JointId,
    },
    /// A blob has no sphere, or one whose centre is not finite or whose radius is not finite and
    /// above 0.
    #[error("blob {blob} must have spheres with finite centres, and finite radii above 0")]
    Blob {
        /// Index of the blob.
        blob: usize,
    },
    /// A joint of the pose does not exist, or its angles are not finite.
    #[error("entry {index} of the pose must have a joint below {joints} and finite angles")]
    Pose {
        /// Index in the list.
        index: usize,
        /// Number of joints.
        joints: usize,
    },
    /// No joint has a radius above 0, and there are no blobs.
    #[error("a skin from bones needs a joint with a radius above 0, and there is none")]
    NoRadius,
    /// Sizes differ so much that the grid would not be able to tell them apart.
    #[error("the bones must be less than {most} times as long as thick, got {got:.0}")]
    TooThin {
        /// Greatest ratio.
        most: f64,
        /// Ratio of the size of the skeleton to the smallest radius.
        got: f64,
    },
    /// The surface has numbers that are not finite, because the bones are near the limit of `f32`.
    #[error(transparent)]
    NotFinite(#[from] SkinError),
}

/// A bone or blob of a body.
#[derive(Clone, Debug)]
pub struct Part {
    /// The joint that it moves with.
    pub joint: JointId,
    pub sweep: Sweep,
    kind: PartKind,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum PartKind {
    Bone,
    /// From a bone to a child whose base is not on it.
    Link,
    Blob,
}

/// Parts that blend into one surface.
#[derive(Clone, Debug)]
pub struct Group {
    pub members: Vec<Member>,
}

/// One or two parts as a member of a group.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Member {
    Part(usize),
    /// Two bones that meet, with the width of their blend, which depends on the bend.
    Bend(usize, usize, f64),
}

/// The parts of one closed surface, and the groups that blend.
#[derive(Clone, Debug)]
pub struct Body {
    pub parts: Vec<Part>,
    pub groups: Vec<Group>,
}

impl Body {
    /// The bodies of a skeleton in its bind pose, in skeleton space: one for each root, or each
    /// joint of a jointed shape, that has any part.
    pub fn all(skeleton: &Skeleton, shape: &SkinShape) -> Result<Vec<Self>, SkinShapeError> {
        shape.check(skeleton)?;
        let pose = skeleton.bind_pose_in_skeleton();
        let mut parts = bones(skeleton, &pose, shape.thickness);
        parts.extend(links(skeleton, &pose, shape.thickness));
        parts.extend(blobs(&shape.blobs, &pose, shape.thickness));
        if parts.is_empty() {
            return Err(SkinShapeError::NoRadius);
        }
        let root = |joint: JointId| skeleton.ancestors(joint).last().unwrap_or(joint);
        let first = |part: &Part| if shape.is_jointed { part.joint } else { root(part.joint) };
        let mut of_first = vec![Vec::new(); skeleton.joints().len()];
        for part in parts {
            of_first[first(&part).index()].push(part);
        }
        let bodies = of_first.into_iter().filter(|parts| !parts.is_empty());
        Ok(bodies.map(|parts| Self::new(parts, skeleton)).collect())
    }

    fn new(parts: Vec<Part>, skeleton: &Skeleton) -> Self {
        let mut of_joint = vec![Vec::new(); skeleton.joints().len()];
        for (index, part) in parts.iter().enumerate() {
            of_joint[part.joint.index()].push(index);
        }
        let mut groups: Vec<Group> = skeleton
            .iter()
            .filter(|(joint, _)| !of_joint[joint.index()].is_empty())
            .map(|(id, joint)| {
                let above = joint.parent.map_or(&[][..], |parent| &of_joint[parent.index()]);
                group(&parts, above, &of_joint[id.index()])
            })
            .collect();
        groups.extend(forks(&parts, skeleton));
        Self { parts, groups }
    }

    /// The joint that all parts move with; `None` if they move with several.
    pub fn sole_joint(&self) -> Option<JointId> {
        let joint = self.parts.first()?.joint;
        self.parts.iter().all(|part| part.joint == joint).then_some(joint)
    }

    /// The sweeps of all parts.
    pub fn sweeps(&self) -> impl Iterator<Item = &Sweep> {
        self.parts.iter().map(|part| &part.sweep)
    }

    /// Lowest and highest corner of a box around all parts.
    pub fn bounds(&self) -> (DVec3, DVec3) {
        let boxes = self.sweeps().map(Sweep::bounds);
        boxes.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1))).unwrap_or_default()
    }

    /// Makes parts that are thinner than `radius` that thick.
    pub fn thicken(&mut self, radius: f64) {
        for part in &mut self.parts {
            part.sweep = part.sweep.thickened(radius);
        }
    }
}

/// A bone has its joint's radius at its base. At its tip it has the radius of the one joint that
/// continues it; otherwise its own.
fn bones(skeleton: &Skeleton, pose: &SkeletonPose, thickness: f32) -> Vec<Part> {
    let with_radius = skeleton.iter().filter(|(_, joint)| joint.radius > 0.0);
    let bone = |(id, joint): (JointId, &Joint)| {
        let mut at_tip = skeleton.children(id).filter(|child| is_at_tip(skeleton, *child));
        let radius = match (at_tip.next(), at_tip.next()) {
            (Some(child), None) if skeleton[child].radius > 0.0 => skeleton[child].radius,
            _ => joint.radius,
        };
        let (base, tip) = (pose.base(id).as_dvec3(), pose.tip(id).as_dvec3());
        let [base_radius, tip_radius] =
            [joint.radius, radius].map(|radius| f64::from(radius * thickness));
        let sweep = Sweep::straight(base, tip, base_radius, tip_radius);
        Part { joint: id, sweep, kind: PartKind::Bone }
    };
    with_radius.map(bone).collect()
}

/// Round cones from bones to the bases of children that are not on them, so that no part of a body
/// floats beside it.
fn links(skeleton: &Skeleton, pose: &SkeletonPose, thickness: f32) -> Vec<Part> {
    let link = |(id, joint): (JointId, &Joint)| {
        let parent = joint.parent?;
        let radius = f64::from(joint.radius.min(skeleton[parent].radius) * thickness);
        let (base, tip) = (pose.base(parent).as_dvec3(), pose.tip(parent).as_dvec3());
        let child = pose.base(id).as_dvec3();
        let near = nearest_on_segment(base, tip, child);
        let is_apart = near.distance(child) > 1e-4 * radius;
        let sweep = || Sweep::straight(near, child, radius, radius);
        let part = || Part { joint: parent, sweep: sweep(), kind: PartKind::Link };
        (radius > 0.0 && is_apart).then(part)
    };
    skeleton.iter().filter_map(link).collect()
}

fn blobs(blobs: &[Blob], pose: &SkeletonPose, thickness: f32) -> Vec<Part> {
    let part = |blob: &Blob| {
        let space = pose.full(blob.joint);
        let placed = |sphere: &BlobSphere| BlobSphere {
            centre: space.transform_point3(sphere.centre),
            radius: sphere.radius * thickness,
        };
        let spheres: Vec<BlobSphere> = blob.spheres.iter().map(placed).collect();
        Part { joint: blob.joint, sweep: Sweep::through(&spheres), kind: PartKind::Blob }
    };
    blobs.iter().map(part).collect()
}

fn nearest_on_segment(base: DVec3, tip: DVec3, point: DVec3) -> DVec3 {
    let axis = tip - base;
    let fraction = (point - base).dot(axis) / axis.length_squared();
    if fraction.is_finite() { base + axis * fraction.clamp(0.0, 1.0) } else { base }
}

/// Whether the base of a joint is at the tip of its parent.
pub fn is_at_tip(skeleton: &Skeleton, child: JointId) -> bool {
    let joint = &skeleton[child];
    let Some(parent) = joint.parent.map(|parent| &skeleton[parent]) else { return false };
    joint.offset.distance(parent.axis) <= 1e-4 * parent.axis.length()
}

/// The parts of a joint and of its parent.
fn group(parts: &[Part], of_parent: &[usize], of_joint: &[usize]) -> Group {
    let is_bone = |index: &&usize| parts[**index].kind == PartKind::Bone;
    let bones = [of_parent, of_joint].map(|of| of.iter().find(is_bone).copied());
    let mut members: Vec<Member> = match bones {
        [Some(above), Some(own)] => {
            vec![Member::Bend(
                above,
                own,
                bend_width(&parts[above].sweep, &parts[own].sweep, false),
            )]
        }
        bones => bones.into_iter().flatten().map(Member::Part).collect(),
    };
    let others = of_parent.iter().chain(of_joint).filter(|index| !is_bone(index));
    members.extend(others.map(|index| Member::Part(*index)));
    Group { members }
}

/// Siblings that start at one point and blend there.
fn forks(parts: &[Part], skeleton: &Skeleton) -> Vec<Group> {
    let parent = |part: &Part| skeleton[part.joint].parent;
    let bones = || parts.iter().enumerate().filter(|(_, part)| part.kind == PartKind::Bone);
    let mut forks = Vec::new();
    for (second, other) in bones() {
        for (first, part) in bones().take_while(|(first, _)| *first < second) {
            if parent(part).is_some() && parent(part) == parent(other) {
                let width = bend_width(&part.sweep, &other.sweep, true);
                if width > 0.0 {
                    forks.push(Group { members: vec![Member::Bend(first, second, width)] });
                }
            }
        }
    }
    forks
}

/// Width of the blend of two bones, at most half of their smaller radius: the more, the sharper the
/// bend, since bones in line would swell where they meet.
fn bend_width(one: &Sweep, other: &Sweep, are_siblings: bool) -> f64 {
    let most = 0.5 * one.least_radius().min(other.least_radius());
    most * sharpness(one, other, are_siblings)
}

/// The sharpness of the bend between two bones: 0 if they go straight on with one radius, 1 for a
/// bend by 90° or more or if one is twice as thick. 0 for bones that do not meet.
fn sharpness(one: &Sweep, other: &Sweep, are_siblings: bool) -> f64 {
    let direction = |bone: &Sweep| bone.direction().try_normalize();
    let cosine = direction(one).zip(direction(other)).map(|(one, other)| one.dot(other));
    let apart = |one: (DVec3, f64), other: (DVec3, f64)| one.0.distance_squared(other.0);
    let (ends, sign) = if are_siblings {
        ([one.start(), other.start()], -1.0)
    } else if apart(one.end(), other.start()) <= apart(one.start(), other.end()) {
        ([one.end(), other.start()], 1.0)
    } else {
        ([one.start(), other.end()], 1.0)
    };
    let [(point, radius), (other_point, other_radius)] = ends;
    let least = radius.min(other_radius);
    let bend = cosine.map_or(0.0, |cosine| 1.0 - sign * cosine);
    let step = (radius - other_radius).abs() / least;
    let apart = point.distance(other_point) / least;
    bend.max(step).clamp(0.0, 1.0) * (1.0 - apart).max(0.0)
}
