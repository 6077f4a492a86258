use glam::{DAffine3, DMat3, DQuat, DVec3, Vec3};

use super::GlbError;
use super::quaternion_spline::NodeRotation;
use super::stretch::StretchKind;
use crate::document::{Channel, Document, Overlay, Track};
use crate::io::formats::gltf::frame;
use crate::kinematics::Shared;
use crate::kinematics::skeleton::{Joint, JointId, Skeleton, SkinStretch};
use crate::rig::{LimbSettings, TaperedCylinder};

/// The rig as bones in the world, in metres.
///
/// Computed in f64, so that a skeleton far from the origin is exact.
pub struct GltfRig {
    track: Track,
    pub metres_per_unit: f64,
    /// The vectors from base to tip of a skeleton's bones in the bind pose, in the spaces of their
    /// joints. Nodes keep these directions where bones follow connected joints: the skin follows
    /// the nodes.
    axes: Vec<DVec3>,
    /// For each bone, true if its length changes over time.
    are_changing: Vec<bool>,
    /// The bones, parents before their children.
    pub bones: Vec<RigBone>,
    /// Placements of the bones in the bind pose.
    pub bind_pose: Vec<BonePlacement>,
}

/// The properties of a bone that do not change over time.
pub struct RigBone {
    pub name: String,
    pub parent: Option<usize>,
    /// True if the file has a node at the bone's tip, because the bone has no children or its
    /// length changes over time.
    pub has_tip: bool,
    pub is_leaf: bool,
    /// The bone that starts at this one's tip and can move against it.
    pub connected: Option<usize>,
    /// Radii at base and tip, in metres.
    pub radii: [f64; 2],
    /// Index of the bone's colour, 0 or 1.
    pub shade: usize,
    /// How the bone's joint ever stretches the skin; `None` if it does not, or there is no skin.
    pub stretches: Option<StretchKind>,
    /// The frame of the joint's angles relative to the bone's node.
    pub frame: DQuat,
}

/// The placement of a bone in the world, in metres.
#[derive(Clone, Copy)]
pub struct BonePlacement {
    pub base: DVec3,
    /// The vector from base to tip.
    pub along: DVec3,
    /// An axis of the joint that is not along the bone, of any length: its x axis, or for a bone
    /// along that its z axis.
    pub across: DVec3,
    /// The joint's y axis, of any length.
    pub y: DVec3,
    /// How the bone's joint stretches the skin.
    pub stretch: SkinStretch,
}

impl BonePlacement {
    /// Rotation of the bone's node in the world, with y along the bone, and x as near to
    /// [`BonePlacement::across`] as possible. For a bone without length, y is along the joint's y
    /// axis.
    pub fn frame(&self) -> DMat3 {
        let has_direction = self.along.try_normalize().is_some();
        frame(if has_direction { self.along } else { self.y }, self.across)
    }
}

impl GltfRig {
    pub fn new(document: &Document) -> Result<Self, GlbError> {
        let metres_per_unit = f64::from(document.metres_per_unit());
        let mut rig = Self {
            track: Track::new(document),
            metres_per_unit,
            axes: document.skeleton().joints().iter().map(|joint| joint.axis.as_dvec3()).collect(),
            are_changing: changing_lengths(document),
            bones: Vec::new(),
            bind_pose: Vec::new(),
        };
        rig.bind_pose = rig.metric(rig.placements(document.skeleton(), |_| DMat3::IDENTITY));
        rig.bind_pose.iter_mut().for_each(|bone| bone.stretch = SkinStretch::NONE);
        rig.bones = rig.joints(document.skeleton().joints());
        if rig.bones.is_empty() { Err(GlbError::NoJoints) } else { Ok(rig) }
    }

    /// Placements of all bones at `time`, in seconds.
    pub fn at(&self, time: f64) -> Vec<BonePlacement> {
        let posed = self.track.at(time);
        self.metric(self.placements(posed.skeleton(), local_rotation))
    }

    /// Returns whether the pose changes over time.
    pub fn is_moving(&self) -> bool {
        self.track.document().is_animated()
    }

    /// Converts placements from the document's units to metres.
    fn metric(&self, mut placements: Vec<BonePlacement>) -> Vec<BonePlacement> {
        for bone in &mut placements {
            bone.base *= self.metres_per_unit;
            bone.along *= self.metres_per_unit;
        }
        placements
    }

    /// Placements of the bones of a skeleton, along their axes in the bind pose, or along their own
    /// where lengths change.
    fn placements(
        &self,
        skeleton: &Skeleton,
        rotation: impl Fn(&Joint) -> DMat3,
    ) -> Vec<BonePlacement> {
        let spaces = joint_spaces(skeleton, rotation);
        let bones = skeleton.joints().iter().zip(&self.axes).zip(&self.are_changing).zip(spaces);
        let placement = |(((joint, axis), is_changing), full): (_, DAffine3)| {
            let (joint, axis, is_changing): (&Shared<Joint>, &DVec3, &bool) =
                (joint, axis, is_changing);
            let axis = if *is_changing { joint.axis.as_dvec3() } else { *axis };
            BonePlacement {
                base: full.translation,
                along: full.matrix3 * axis,
                across: full.matrix3 * across(axis),
                y: full.matrix3.y_axis,
                stretch: joint.skin,
            }
        };
        bones.map(placement).collect()
    }

    /// The rotation of a node by its joint's angles.
    pub fn node_rotation(&self, joint: JointId, own: &Joint) -> NodeRotation {
        let transform = self.track.document().skeleton().transform().matrix3.as_dmat3();
        let world = |index: usize| DQuat::from_mat3(&self.bind_pose[index].frame()).normalize();
        let turned = transform * transform.determinant().cbrt().recip();
        let frame = DQuat::from_mat3(&(turned * own.frame.as_dmat3())).normalize();
        let parent = own.parent.map_or(DQuat::IDENTITY, |parent| world(parent.index()));
        NodeRotation {
            before: parent.conjugate() * frame,
            after: frame.conjugate() * world(joint.index()),
        }
    }

    /// By joint, the radii of the bones that are drawn as cylinders, in metres.
    fn cylinders(&self) -> Vec<Option<[f64; 2]>> {
        let document = self.track.document();
        let mut cylinders = vec![None; document.skeleton().joints().len()];
        if !document.display.shows(Overlay::Cylinders) {
            return cylinders;
        }
        let posed = self.track.pose(document.clone(), document.timeline.start);
        let radii = |limb: TaperedCylinder| {
            [limb.base_radius, limb.tip_radius].map(|r| f64::from(r) * self.metres_per_unit)
        };
        for target in &document.rig.targets {
            let joints = document.rig.limb_joints(target.joint);
            if let Some(limb) = posed.limb_frames(target.joint) {
                for (joint, shape) in joints.zip([limb.upper(), limb.lower()]) {
                    cylinders[joint.index()] = Some(radii(shape));
                }
            }
        }
        cylinders
    }

    fn joints(&self, joints: &[Shared<Joint>]) -> Vec<RigBone> {
        let scale = self.track.document().skeleton().transform().as_daffine3().matrix3;
        let metres = scale.determinant().abs().cbrt() * self.metres_per_unit;
        let reach = f64::from(self.track.document().rig.reach()) * self.metres_per_unit;
        let mut depths = vec![0_usize; joints.len()];
        let mut are_leaves = vec![true; joints.len()];
        let mut connected = vec![None; joints.len()];
        for (index, joint) in joints.iter().enumerate() {
            if let Some(parent) = joint.parent {
                depths[index] =
                    depths[parent.index()] + usize::from(joints[parent.index()].axis != Vec3::ZERO);
                are_leaves[parent.index()] = false;
                connected[parent.index()] =
                    joint.connected.then_some(index).or(connected[parent.index()]);
            }
        }
        let cylinders = self.cylinders();
        let bone = |(index, joint): (usize, &Shared<Joint>)| RigBone {
            name: joint.name.clone(),
            parent: joint.parent.map(JointId::index),
            has_tip: (are_leaves[index] || self.are_changing[index]) && joint.axis != Vec3::ZERO,
            is_leaf: are_leaves[index],
            connected: connected[index],
            radii: cylinders[index].unwrap_or_else(|| {
                let length = self.bind_pose[index].along.length();
                radii(f64::from(joint.radius) * metres, length, reach)
            }),
            shade: depths[index] % 2,
            stretches: StretchKind::of(self.track.document(), JointId::new(index)),
            frame: self.node_rotation(JointId::new(index), joint).after.conjugate(),
        };
        joints.iter().enumerate().map(bone).collect()
    }
}

/// Radii of a bone at its base and its tip, in metres. The radius at the base is the joint's
/// radius, clamped relative to the bone's length and the skeleton's reach. A slender bone tapers to
/// the tip.
fn radii(radius: f64, length: f64, reach: f64) -> [f64; 2] {
    const THICKEST: (f64, f64) = (0.45, 0.028);
    const POINT: f64 = 0.02;
    const TAPER: f64 = 0.6;
    const SLENDER: f64 = 4.0;
    let thickest = match length {
        0.0 => POINT * reach,
        length => (THICKEST.0 * length).min(THICKEST.1 * reach),
    };
    let radius = radius.min(thickest).max(0.25 * thickest);
    [radius, if length > SLENDER * radius { radius * TAPER } else { radius }]
}

/// A joint's local rotation, made orthogonal in f64. Otherwise the errors of f32 rounding would add
/// up along a long chain.
fn local_rotation(joint: &Joint) -> DMat3 {
    let rotation = joint.local_rotation().as_dmat3();
    DMat3::from_quat(DQuat::from_mat3(&rotation).normalize())
}

/// For each joint of a document, true if the length of its bone has keys, or a limb can stretch it.
fn changing_lengths(document: &Document) -> Vec<bool> {
    let mut are_changing: Vec<bool> =
        document.skeleton().ids().map(|it| document.keys.has(Channel::Length(it))).collect();
    for target in &document.rig.targets {
        let stretches = target.limb().is_some_and(LimbSettings::is_stretching);
        if stretches || document.keys.has(Channel::Stretch(target.joint)) {
            for joint in document.rig.limb_joints(target.joint) {
                are_changing[joint.index()] = true;
            }
        }
    }
    are_changing
}

/// The axis of a joint that is not along its bone, in its own space: x, or z for a bone along x,
/// whose node would not turn with the joint otherwise.
fn across(axis: DVec3) -> DVec3 {
    const ALONG: f64 = 0.99;
    if axis.x.abs() > ALONG * axis.length() { DVec3::Z } else { DVec3::X }
}

/// Transforms of all joints to the world, in units of the scene, with local rotations by
/// `rotation`.
pub fn joint_spaces(skeleton: &Skeleton, rotation: impl Fn(&Joint) -> DMat3) -> Vec<DAffine3> {
    let mut full: Vec<DAffine3> = Vec::with_capacity(skeleton.joints().len());
    for joint in skeleton.joints() {
        let parent =
            joint.parent.map_or(skeleton.transform().as_daffine3(), |parent| full[parent.index()]);
        full.push(
            parent * DAffine3::from_mat3_translation(rotation(joint), joint.offset.as_dvec3()),
        );
    }
    full
}
