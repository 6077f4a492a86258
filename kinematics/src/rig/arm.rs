use glam::{Mat3, Vec3};

use super::skeleton_rig::SkeletonRig;
use super::target::{LimbSettings, Target, TargetKind, TargetSpace};
use crate::skeleton::{Joint, JointId, JointLimits, Limit, Skeleton};
use crate::twist::TwistReferenceKind;
use crate::two_bone::TwoBone;

/// The arm of E. Palmieri's report (2014) as a skeleton: the smallest figure.
///
/// ```text
/// root        a point, locked: the shoulder
///  └ upper    along +x; its angles x, y, z turn it about +x, −z and +y
///     └ lower along +x; a hinge about −z, which bends by its angle z
///        └ hand   a point; its angles turn it like those of `upper`
/// ```
///
/// A limb target of `lower`, in the space of `root`, is the Cursor.
impl SkeletonRig {
    /// Index of the joint `root` of [`SkeletonRig::arm`].
    pub const ROOT: JointId = JointId::new(0);
    /// Index of the joint `upper` of [`SkeletonRig::arm`].
    pub const UPPER: JointId = JointId::new(1);
    /// Index of the joint `lower` of [`SkeletonRig::arm`], which has the target.
    pub const LOWER: JointId = JointId::new(2);
    /// Index of the joint `hand` of [`SkeletonRig::arm`].
    pub const HAND: JointId = JointId::new(3);

    /// Frame of the ball joints of [`SkeletonRig::arm`]: with it R_z · R_y · R_x is
    /// R_y(r_z) · R_z(−r_y) · R_x(r_x), a yaw, then a pitch, then a roll.
    pub const BALL_FRAME: Mat3 = Mat3::from_cols(Vec3::X, Vec3::NEG_Z, Vec3::Y);
    /// Frame of the hinge of [`SkeletonRig::arm`]: a positive angle z bends it so that the elbow is
    /// towards +y.
    pub const HINGE_FRAME: Mat3 = Mat3::from_cols(Vec3::X, Vec3::NEG_Y, Vec3::NEG_Z);

    /// An arm of two bones in the pose of the report, with its shoulder at the origin.
    pub fn arm(bones: TwoBone) -> Self {
        let [upper, lower] = [bones.upper(), bones.lower()].map(|length| Vec3::X * length);
        let fixed = Some(Limit { min: 0.0, max: 0.0 });
        let joint = |name, parent, offset, axis, frame| Joint {
            offset,
            frame,
            ..Joint::new(name, Some(parent), axis)
        };
        let root = Joint { locked: true, ..Joint::new("root", None, Vec3::ZERO) };
        let joints = vec![
            root,
            joint("upper", Self::ROOT, Vec3::ZERO, upper, Self::BALL_FRAME),
            Joint {
                limits: JointLimits::new([fixed, fixed, None]),
                ..joint("lower", Self::UPPER, upper, lower, Self::HINGE_FRAME)
            },
            joint("hand", Self::LOWER, lower, Vec3::ZERO, Self::BALL_FRAME),
        ];
        let skeleton = Skeleton::from_joints(joints);
        let mut rig = Self::new(skeleton.unwrap_or_else(|error| unreachable!("{error}")));
        let cursor = Vec3::new(250.0, 120.0, 60.0);
        let target = Target::new(Self::LOWER, cursor, rig.default_path_radius());
        rig.targets.push(Target {
            space: TargetSpace::Joint(Self::ROOT),
            kind: TargetKind::Limb(LimbSettings {
                reference: TwistReferenceKind::Up,
                pole: Some(Vec3::new(100.0, 300.0, -100.0)),
                pole_space: TargetSpace::Joint(Self::ROOT),
                ..LimbSettings::default()
            }),
            influence: 1.0,
            ..target
        });
        rig
    }
}
