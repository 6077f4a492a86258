use std::collections::HashSet;

use glam::{DAffine3, DMat3, DVec3, Vec3};

use super::file::{self, JointKind, Robot, Visual};
use super::shapes;
use super::xml::UrdfError;
use crate::document::{Document, SkeletonRig};
use crate::io::bones::{self, JointTree};
use crate::io::error::{MOST_NAMES, OpenError, Remark};
use crate::io::formats::gltf::UniqueNames;
use crate::io::opened::{OpenOptions, Opened, attach_skin};
use crate::io::source::Source;
use crate::kinematics::chain_ik::{Method, Root};
use crate::kinematics::skeleton::{Joint, JointId, JointLimits, Limit, Skeleton};
use crate::rig::SkinFile;

/// Reads the robot of a file. The skeleton has the robot's name. Fails if the options choose
/// another name.
pub fn read(source: &Source, options: &OpenOptions) -> Result<Opened, OpenError> {
    let open_error = |error: UrdfError| error.of_file(source);
    let robot = file::parse(source.text()).map_err(open_error)?;
    let skeletons = vec![robot.name.clone()];
    if let Some(name) = options.skeleton.as_ref().filter(|name| **name != robot.name) {
        let (file, name) = (source.name().to_owned(), name.clone());
        return Err(OpenError::NoSkeleton { file, name, names: skeletons });
    }
    let tree = LinkTree::new(&robot).map_err(open_error)?;
    let mut document = tree.document().map_err(open_error)?;
    let mut warnings: Vec<Remark> = remarks(&robot).map(Remark::new).collect();
    let file = source.path().map(|path| SkinFile {
        path: path.into(),
        checksum: source.checksum().finalize(),
        skeleton: robot.name.clone(),
        animation: None,
    });
    match shapes::mesh(&tree.bodies(), &tree.frames, tree.parents()) {
        Ok(Some(mesh)) => {
            let joints = document.skeleton().ids().map(Some).collect();
            attach_skin(&mut document, mesh, file, joints);
        }
        Ok(None) => {}
        Err(error) => warnings.push(Remark::new(format!("{error}; the skin is left out"))),
    }
    document.camera = document.framing_camera();
    let mut order = vec![JointId::default(); robot.links.len()];
    for (joint, link) in tree.links.iter().enumerate() {
        order[*link] = JointId::new(joint);
    }
    Ok(Opened {
        document,
        warnings,
        order,
        skeletons,
        skeleton: Some(0),
        animations: Vec::new(),
        animation: None,
    })
}

/// Warnings about joints and bodies that are not supported.
fn remarks(robot: &Robot) -> impl Iterator<Item = String> {
    let fixed = robot.joints.iter().filter_map(|joint| match &joint.kind {
        JointKind::Unsupported(kind) => Some(format!("{} ({kind})", joint.name)),
        JointKind::Turning { .. } | JointKind::Fixed => None,
    });
    let all_swapped = robot.joints.iter().filter_map(|joint| match joint.kind {
        JointKind::Turning { limits: Some([lower, upper]), .. } if lower > upper => {
            Some(format!("{} ({lower} to {upper})", joint.name))
        }
        _ => None,
    });
    let unread = robot.unread.iter().map(|file| format!("{file:?}"));
    let of = |names: Vec<String>, what: &str| {
        let (count, more) = (names.len(), if names.len() > MOST_NAMES { " …" } else { "" });
        let listed = names[..count.min(MOST_NAMES)].join(", ");
        (count > 0).then(|| format!("{what}: {listed}{more}"))
    };
    let fixed = of(fixed.collect(), "prismatic, planar, floating and mimic joints are locked");
    let swapped = "joints whose lower limit is above the upper one turn without limits";
    let swapped = of(all_swapped.collect(), swapped);
    let meshes = "meshes and textures are not read, only boxes, cylinders and spheres are shown";
    fixed.into_iter().chain(swapped).chain(of(unread.collect(), meshes))
}

/// The links of a robot from its roots on, each before those below it.
struct LinkTree<'a> {
    robot: &'a Robot,
    /// For each joint of the skeleton the index of its link.
    links: Vec<usize>,
    /// For each joint of the skeleton its parent and the index of the robot's joint; `None` for
    /// roots.
    joins: Vec<Option<(usize, usize)>>,
    /// For each joint of the skeleton the frame of its link in the root's, at the angles 0.
    frames: Vec<DAffine3>,
}

impl<'a> LinkTree<'a> {
    fn new(robot: &'a Robot) -> Result<Self, UrdfError> {
        let mut above: Vec<Option<usize>> = vec![None; robot.links.len()];
        let mut below: Vec<Vec<usize>> = vec![Vec::new(); robot.links.len()];
        for (index, joint) in robot.joints.iter().enumerate() {
            if let Some(other) = above[joint.child].replace(index) {
                let (link, other) = (&robot.links[joint.child].name, &robot.joints[other].name);
                let reason = format!("its child {link:?} must not be the child of {other:?}, too");
                return Err(UrdfError::new(joint.at, &joint.name, reason));
            }
            below[joint.parent].push(index);
        }
        if robot.links.len() > Skeleton::MOST_JOINTS {
            let (most, got) = (Skeleton::MOST_JOINTS, robot.links.len());
            let reason = format!("must have at most {most} links, got {got}");
            return Err(UrdfError::new(0, &robot.name, reason));
        }
        let turns = |joint: &file::RobotJoint| matches!(joint.kind, JointKind::Turning { .. });
        if !robot.joints.iter().any(turns) {
            let reason = "a robot must have a joint that turns: revolute or continuous";
            return Err(UrdfError::new(0, &robot.name, reason));
        }
        let mut tree = Self { robot, links: Vec::new(), joins: Vec::new(), frames: Vec::new() };
        let roots = (0..robot.links.len()).rev().filter(|link| above[*link].is_none());
        let mut next: Vec<(usize, Option<(usize, usize)>)> =
            roots.map(|root| (root, None)).collect();
        while let Some((link, join)) = next.pop() {
            let frame = join.map_or(DAffine3::IDENTITY, |(parent, joint)| {
                tree.frames[parent] * robot.joints[joint].origin
            });
            let index = tree.links.len();
            tree.links.push(link);
            tree.joins.push(join);
            tree.frames.push(frame);
            let children = below[link].iter().rev();
            next.extend(children.map(|joint| (robot.joints[*joint].child, Some((index, *joint)))));
        }
        if tree.links.len() < robot.links.len() {
            return Err(tree.cycle_error(&above));
        }
        Ok(tree)
    }

    /// The error for links that no root leads to: upwards from these, joints go round in a circle.
    fn cycle_error(&self, above: &[Option<usize>]) -> UrdfError {
        let joints = &self.robot.joints;
        let reached: HashSet<usize> = self.links.iter().copied().collect();
        let mut link = (0..above.len()).find(|link| !reached.contains(link)).unwrap_or_default();
        for _ in 0..above.len() {
            link = above[link].map_or(link, |joint| joints[joint].parent);
        }
        let joint = above[link].map(|joint| &joints[joint]);
        let (at, name) = joint.map_or((0, ""), |joint| (joint.at, joint.name.as_str()));
        UrdfError::new(at, name, "its child link must not be an ancestor of its parent link")
    }

    /// The parents of the skeleton's joints.
    fn parents(&self) -> Vec<Option<JointId>> {
        self.joins.iter().map(|join| join.map(|(parent, _)| JointId::new(parent))).collect()
    }

    /// The bodies of all links with their joints.
    fn bodies(&self) -> Vec<(JointId, &'a Visual)> {
        let of = |(joint, link): (usize, &usize)| {
            let visuals = self.robot.links[*link].visuals.iter();
            visuals.map(move |visual| (JointId::new(joint), visual))
        };
        self.links.iter().enumerate().flat_map(of).collect()
    }

    fn kind(&self, joint: usize) -> Option<&'a JointKind> {
        self.joins[joint].map(|(_, joint)| &self.robot.joints[joint].kind)
    }

    fn document(&self) -> Result<Document, UrdfError> {
        let mut names = UniqueNames::default();
        let mut joints: Vec<Joint> =
            (0..self.links.len()).map(|joint| self.joint(joint, &mut names)).collect();
        self.give_bones(&mut joints);
        let skeleton = Skeleton::from_joints(joints)
            .map_err(|error| UrdfError::new(0, &self.robot.name, error.to_string()))?;
        let mut rig = SkeletonRig::new(skeleton);
        // Robots have a fixed base, and hinges, for which FABRIK is not made.
        rig.solver.root = Root::Locked;
        rig.solver.method = Method::DampedLeastSquares;
        Ok(Document { metres_per_unit: Some(1.0), ..Document::new(rig) })
    }

    /// The joint of a link, without its bone.
    fn joint(&self, joint: usize, names: &mut UniqueNames) -> Joint {
        let link = &self.robot.links[self.links[joint]];
        let (parent, frame) = (self.joins[joint].map(|(parent, _)| parent), self.frames[joint]);
        let above = parent.map_or(DVec3::ZERO, |parent| self.frames[parent].translation);
        let (name, axis) = match (self.joins[joint], self.kind(joint)) {
            (Some((_, of_robot)), Some(JointKind::Turning { axis, .. })) => {
                (&self.robot.joints[of_robot].name, *axis)
            }
            _ => (&link.name, DVec3::Z),
        };
        const FIXED: Option<Limit> = Some(Limit { min: 0.0, max: 0.0 });
        let (about_z, locked) = match self.kind(joint) {
            Some(JointKind::Turning { limits, .. }) => (limits.and_then(limit), false),
            Some(JointKind::Fixed | JointKind::Unsupported(_)) | None => (FIXED, true),
        };
        Joint {
            offset: (frame.translation - above).as_vec3(),
            frame: (frame.matrix3 * frame_about(axis)).as_mat3(),
            limits: JointLimits::new([FIXED, FIXED, about_z]),
            locked,
            ..Joint::new(&names.free(name), parent.map(JointId::new), Vec3::ZERO)
        }
    }

    /// Gives each joint a bone: to the child below which most joints turn, or, for a last link, to the
    /// far end of its bodies; without bodies it has none, so that its target is at its frame.
    fn give_bones(&self, joints: &mut [Joint]) {
        let mut turning = vec![0_usize; joints.len()];
        for joint in (0..joints.len()).rev() {
            turning[joint] += usize::from(!joints[joint].locked);
            if let Some((parent, _)) = self.joins[joint] {
                turning[parent] += turning[joint];
            }
        }
        let tree = JointTree::new(joints);
        let end = |joint: usize| {
            let link = &self.robot.links[self.links[joint]];
            let end = shapes::far_end(&link.visuals).filter(|_| tree.children(joint).is_empty())?;
            let end = self.frames[joint].matrix3 * end;
            (end.length() > 1e-6).then(|| end.as_vec3())
        };
        let next = |joint: usize| {
            let children = || tree.children(joint).iter().copied();
            let most = children().map(|child| turning[child]).max().filter(|most| *most > 0)?;
            let mut best = children().filter(|child| turning[*child] == most);
            best.next().filter(|_| best.next().is_none())
        };
        let bones = tree.bones(end, next);
        bones::give_bones(joints, &bones);
    }
}

/// Limits in single precision; `None` for those in the wrong order.
fn limit([lower, upper]: [f64; 2]) -> Option<Limit> {
    (lower <= upper).then_some(Limit { min: lower as f32, max: upper as f32 })
}

/// A rotation that turns z to a unit axis.
fn frame_about(axis: DVec3) -> DMat3 {
    match axis.to_array() {
        [_, _, 1.0] => DMat3::IDENTITY,
        _ => {
            let (x, y) = axis.any_orthonormal_pair();
            DMat3::from_cols(x, y, axis)
        }
    }
}
