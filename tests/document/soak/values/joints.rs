//! Joints, targets, solver options and path following.

use core::num::NonZeroU32;

use glam::{Affine3A, Vec2, Vec3};
use ik_arm::document::{
    BalanceOver, BalanceTarget, PathKind, Target, TargetMotion, TargetPath, WavyRing,
};
use ik_arm::kinematics::chain_ik::{Method, Root, SolverOptions};
use ik_arm::kinematics::diagnosis::{Remedy, Start, WidenedLimit, WiderLimit};
use ik_arm::kinematics::skeleton::{Cone, JointId, JointLimits, Limit, RotationAxis};
use ik_arm::kinematics::skin::{
    Blob, BlobSphere, SkinShape, SkinnedMesh, Skinning, TriangleMesh, VertexWeights,
};
use ik_arm::kinematics::twist::TwistReferenceKind;
use ik_arm::rig::{
    Aim, BoneSkin, FileMesh, LimbSettings, MeshSkin, PartLook, Skin, SkinFile, SkinFileError,
    SkinPart, SkinSource, TargetKind, TargetSpace,
};

use super::Values;

impl Values<'_> {
    fn joints(&self) -> usize {
        self.session.skeleton().joints().len()
    }

    /// Mostly an existing joint.
    pub fn joint(&mut self) -> JointId {
        let joints = self.joints();
        if joints == 0 || self.chance(0.03) {
            return self.one_of(&[joints, joints + 1, 99, u32::MAX as usize, usize::MAX]).into();
        }
        match self.session.selection().active() {
            Some(joint) if self.chance(0.3) => joint,
            _ => self.random.below(joints).into(),
        }
    }

    /// Mostly a joint with a target, if there is one.
    pub fn aimed(&mut self) -> JointId {
        let targets = &self.session.rig().targets;
        if targets.is_empty() || self.chance(0.1) {
            return self.joint();
        }
        targets[self.random.below(targets.len())].joint
    }

    /// Sometimes none; coarse or invalid shapes of few blobs.
    pub fn skin(&mut self) -> Option<Skin> {
        if self.chance(0.2) {
            return None;
        }
        let rig = self.session.rig();
        let mut skin = rig.skin.clone().unwrap_or_else(|| Skin::from_bones(&rig.skeleton));
        skin.skinning = self.one_of(&Skinning::ALL);
        skin.colour = [(); 3].map(|()| self.part());
        if self.chance(0.3) {
            skin.source = SkinSource::Mesh(self.mesh_skin());
            return Some(skin);
        }
        let bones = match skin.source {
            SkinSource::Bones(bones) => bones,
            SkinSource::Mesh(_) => BoneSkin::new(rig.skeleton.clone(), SkinShape::default()),
        };
        let detail = self.one_of(&[1.2, 1.2, 1.5, 0.0, f32::NAN]);
        let thickness = self.one_of(&[0.5, 1.0, 2.0, -1.0, f32::INFINITY]);
        let joint = self.joint();
        let mut sphere = |radius| BlobSphere { centre: self.small_point(), radius };
        let spheres = [1.0, 2.0, 0.7].map(&mut sphere).to_vec();
        let angles = self.small_point();
        let blobs = if self.chance(0.2) { vec![Blob { joint, spheres }] } else { Vec::new() };
        let pose = if self.chance(0.2) { vec![(joint, angles)] } else { Vec::new() };
        let is_jointed = self.chance(0.3);
        let shape = SkinShape { detail, thickness, blobs, is_jointed, pose };
        skin.source = SkinSource::Bones(bones.with_shape(shape));
        Some(skin)
    }

    /// A few triangles on the joints of the skeleton, in the document or from a file that is
    /// missing.
    pub fn mesh_skin(&mut self) -> MeshSkin {
        let skeleton = self.session.rig().skeleton.clone();
        let count = skeleton.joints().len();
        let joints: Vec<_> =
            skeleton.ids().map(|it| Some(it).filter(|_| self.chance(0.9))).collect();
        let file = SkinFile {
            path: "/nowhere/figure.glb".into(),
            checksum: 7,
            skeleton: self.name(),
            animation: None,
        };
        if self.chance(0.3) || count == 0 {
            let missing = SkinFileError::Missing(file.path.clone());
            return MeshSkin::without_mesh(file, joints, missing);
        }
        let corner = |values: &mut Self| {
            let weights: Vec<_> = (0..5).map(|_| (values.joint(), values.part())).collect();
            (values.small_point(), VertexWeights::heaviest(weights).0)
        };
        let (positions, weights): (Vec<Vec3>, Vec<_>) = (0..9).map(|_| corner(self)).unzip();
        let mesh = TriangleMesh {
            normals: vec![Vec3::Y; positions.len()],
            positions,
            triangles: vec![[0, 1, 2], [3, 4, 5], [6, 7, 8]],
            ..TriangleMesh::default()
        };
        let binds = vec![Affine3A::from_scale(Vec3::splat(0.5)); count];
        let Ok(mesh) = SkinnedMesh::new(mesh, weights, binds) else {
            let missing = SkinFileError::Missing(file.path.clone());
            return MeshSkin::without_mesh(file, joints, missing);
        };
        let part = SkinPart {
            colour: [1.0, 0.5, 0.0],
            look: PartLook { is_double_sided: true, ..PartLook::default() },
            ..SkinPart::white(2)
        };
        let parents = skeleton.joints().iter().map(|joint| joint.parent).collect();
        let mesh = FileMesh { mesh, parents, parts: vec![part] };
        MeshSkin::new(mesh.into(), None, joints, &skeleton)
    }

    /// The file of the skin, if it has one.
    pub fn skin_file(&mut self) -> Option<SkinFile> {
        match &self.session.rig().skin.as_ref()?.source {
            SkinSource::Mesh(mesh) => mesh.file().cloned(),
            SkinSource::Bones(_) => None,
        }
    }

    pub fn located_skin(&mut self) -> Result<MeshSkin, SkinFileError> {
        let skin = self.mesh_skin();
        skin.mesh().map(|_| skin.clone())
    }

    /// None, one or several, with repetitions.
    pub fn some_joints(&mut self) -> Vec<JointId> {
        (0..self.random.below(4)).map(|_| self.joint()).collect()
    }

    /// Index of an Euler angle, sometimes out of range.
    pub fn axis(&mut self) -> usize {
        if self.is_wild() { self.one_of(&[3, 99, usize::MAX]) } else { self.random.below(3) }
    }

    pub fn rotation_axis(&mut self) -> RotationAxis {
        self.one_of(&RotationAxis::ALL)
    }

    pub fn limit(&mut self) -> Option<Limit> {
        let (a, b) = (self.angle(), self.angle());
        match self.random.below(5) {
            0 => None,
            1 => Some(Limit { min: a, max: a }),
            2 => Some(Limit { min: a, max: b }),
            _ => Some(Limit { min: a.min(b), max: a.max(b) }),
        }
    }

    /// Stiffness of a joint's angles; sometimes out of range.
    pub fn stiffness(&mut self) -> Vec3 {
        Vec3::from_array([(); 3].map(|()| 0.9 * self.part()))
    }

    pub fn limits(&mut self) -> JointLimits {
        if self.chance(0.3) {
            return JointLimits::cone(self.cone());
        }
        JointLimits::new([self.limit(), self.limit(), self.limit()])
    }

    pub fn name(&mut self) -> String {
        const NAMES: [&str; 12] = [
            "",
            " ",
            "a",
            "b",
            "root",
            "joint",
            "joint_2",
            " hand ",
            "é\u{301}\u{202e}😀",
            "\"\\\n\t\0",
            "{}[],:",
            "ROOT",
        ];
        match self.random.below(8) {
            0 => "ab c".repeat(self.random.below(600)),
            1 => self.joint_name().unwrap_or_default(),
            2..5 => format!("j{}", self.random.below(50)),
            _ => self.one_of(&NAMES).to_owned(),
        }
    }

    fn joint_name(&mut self) -> Option<String> {
        let joint = self.joint();
        Some(self.session.skeleton().joint(joint)?.name.clone())
    }

    pub fn target(&mut self) -> Target {
        let joint = self.aimed();
        let size = self.session.rig().reach();
        let path = self.one_of(&[
            TargetPath::Still,
            TargetPath::Still,
            TargetPath::Circle,
            TargetPath::FigureEight,
        ]);
        let motion =
            TargetMotion { path, radius: self.number(0.3 * size), period: self.above_0(6.0) };
        let home = self.small_point();
        let (weight, enabled) = (self.above_0(2.0), self.chance(0.9));
        let influence = self.one_of(&[0.0, 0.4, 1.0, 1.5]);
        let kind = match self.random.below(6) {
            0..3 => TargetKind::WholeBody,
            3 => TargetKind::Chain(self.chain_length()),
            _ => self.limb(),
        };
        let space = self.space();
        let orientation = self.chance(0.4).then(|| self.small_point());
        let aims =
            !matches!(kind, TargetKind::Limb(_)) && orientation.is_none() && self.chance(0.5);
        let aim = aims.then(|| Aim { axis: Vec3::Z, point: self.small_point() });
        let target = Target::new(joint, home, 1.0);
        Target { weight, enabled, motion, influence, kind, space, orientation, aim, ..target }
    }

    fn chain_length(&mut self) -> NonZeroU32 {
        self.one_of(&[1, 2, 3, 1000]).try_into().expect("above 0")
    }

    fn limb(&mut self) -> TargetKind {
        let reference = self.elbow_reference();
        let (twist, pole_space) = (self.number(4.0), self.space());
        let pole = self.chance(0.7).then(|| self.small_point());
        let soft_reach = self.soft_reach();
        TargetKind::Limb(LimbSettings {
            reference,
            pole,
            twist,
            pole_space,
            soft_reach,
            ..Default::default()
        })
    }

    pub fn elbow_reference(&mut self) -> TwistReferenceKind {
        self.one_of(&TwistReferenceKind::ALL)
    }

    /// The world, or the space of any joint; often one in which the target cannot be.
    pub fn space(&mut self) -> TargetSpace {
        if self.chance(0.6) { TargetSpace::World } else { TargetSpace::Joint(self.joint()) }
    }

    pub fn path_kind(&mut self) -> Option<PathKind> {
        if self.chance(0.5) {
            return Some(self.one_of(&[PathKind::Head, PathKind::Target]));
        }
        self.chance(0.6).then(|| {
            PathKind::Ring(WavyRing {
                radius: self.number(3.0),
                amplitude: self.number(0.5),
                waves: self.one_of(&[0, 1, 3, 6, 40]),
                period: self.above_0(6.0),
            })
        })
    }

    pub fn cone(&mut self) -> Cone {
        let twist = self.limit().unwrap_or(Limit { min: -0.5, max: 0.5 });
        let middle = Vec2::new(self.small_point().x, self.small_point().z);
        Cone { x: self.above_0(3.0), z: self.above_0(3.0), twist, middle }
    }

    pub fn balance(&mut self) -> Option<BalanceTarget> {
        let (influence, weight) = (self.number(1.0), self.above_0(3.0));
        let Vec3 { x, z, .. } = self.small_point();
        let over = self.one_of(&[BalanceOver::Feet, BalanceOver::Point(Vec2::new(x, z))]);
        self.chance(0.7).then_some(BalanceTarget { influence, weight, over })
    }

    pub fn options(&mut self) -> SolverOptions {
        let iterations = self.one_of(&[0, 1, 3, 20, 100, 1000]);
        let tolerance = self.above_0(0.1);
        let mut options = SolverOptions::new(self.one_of(&Method::ALL));
        options.iterations = self.chance(0.3).then_some(iterations);
        options.tolerance = self.chance(0.3).then_some(tolerance);
        options.damping = self.above_0(0.2);
        options.step = self.above_0(2.0);
        options.posture_rate = self.one_of(&[10.0, 10.0, 0.0, 1.0, 50.0, 1e6, -1.0]);
        options.root_stiffness = self.one_of(&[0.0, 0.0, 0.5, 0.99, 1.0]);
        options.root = if self.chance(0.4) { self.one_of(&Root::ALL) } else { Root::Turns };
        options
    }

    pub fn remedy(&mut self) -> Remedy {
        let joint = self.aimed();
        match self.random.below(17) {
            0 => Remedy::MoveTarget { joint, point: self.small_point() },
            1 => Remedy::Lengthen { joint, factor: self.above_0(2.0) },
            2 => Remedy::SetRoot(self.one_of(&Root::ALL)),
            3 => {
                let limit = self.limit().unwrap_or(Limit { min: 0.0, max: 0.0 });
                let axis = self.rotation_axis();
                let to = match self.coin() {
                    true => WiderLimit::Range { axis, limit },
                    false => WiderLimit::Cone(self.cone()),
                };
                Remedy::WidenLimits(vec![WidenedLimit { joint: self.joint(), to, by: 0.1 }])
            }
            4 => Remedy::Unlock(self.some_joints()),
            5 => Remedy::SwitchOff(joint),
            6 => Remedy::SetWeight { joint, weight: self.above_0(10.0) },
            7 => Remedy::UseMethod(self.one_of(&Method::ALL)),
            8 => {
                let angles = vec![(self.joint(), self.angles())];
                Remedy::StartFrom(Start { is_bend: self.coin(), angles })
            }
            9 => Remedy::AllowIterations(self.one_of(&[0, 1, 20, 500])),
            10 => Remedy::FullInfluence(joint),
            11 => Remedy::FollowBody,
            15 => Remedy::FreeBalance,
            16 => Remedy::LengthenChain { joint, length: self.chain_length() },
            12 => Remedy::FreeTurn(joint),
            13 => Remedy::FreePlace(joint),
            _ => Remedy::Stretch { joint, max_stretch: self.above_0(3.0) },
        }
    }

    pub fn iterations_per_frame(&mut self) -> u32 {
        match self.random.below(40) {
            0 => self.one_of(&[0, 1000, 100_000, u32::MAX]),
            _ => 1 + self.random.below(16) as u32,
        }
    }
}
