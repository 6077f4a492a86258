//! Random documents, built-in examples, and a snake with keys.

use super::arm::{Arm, Cursor, HandOrientation, HandSpace};
use glam::{Affine3A, Mat3, Quat, Vec2, Vec3};
use ik_arm::document::{
    BalanceOver, BalanceTarget, Camera, Channel, Display, Document, Keys, Overlay, PathKind,
    Quantity, SkeletonRig, Target, TargetMotion, TargetPath, Timeline, TwistReferenceKind,
    WavyRing,
};
use ik_arm::io::{Example, OpenOptions, parse};
use ik_arm::kinematics::Shared;
use ik_arm::kinematics::chain_ik::{Method, Root, SolverOptions};
use ik_arm::kinematics::fk::Fk;
use ik_arm::kinematics::limb_ik::LimbPosture;
use ik_arm::kinematics::skeleton::{
    Cone, Joint, JointId, JointLimits, Limit, Skeleton, SkinStretch,
};
use ik_arm::kinematics::soft_reach::SoftReach;
use ik_arm::kinematics::twist::Stereographic;
use ik_arm::kinematics::two_bone::TwoBone;
use ik_arm::rig::{Aim, LimbSettings, Posture, PosturedJoint, TargetKind, TargetSpace};
use ik_arm::session::FileAction;

use super::Random;

/// A document with any finite numbers.
pub fn document(random: &mut Random) -> Document {
    let mut rig =
        if random.coin() { arm(random).document().rig } else { SkeletonRig::new(skeleton(random)) };
    let is_arm = !rig.targets.is_empty();
    for joint in rig.skeleton.ids().filter(|_| !is_arm) {
        if random.below(3) == 0 {
            let paths = [TargetPath::Still, TargetPath::Circle, TargetPath::FigureEight];
            let motion = TargetMotion {
                path: random.one_of(&paths),
                radius: random.finite(),
                period: random.positive(),
            };
            let (home, weight) = (random.finite_vector(), random.positive());
            let enabled = random.coin();
            let (kind, influence) = (target_kind(random), random.within(0.0..1.0));
            let turns = random.below(3);
            let orientation = (turns == 1).then(|| random.finite_vector());
            let aims = turns == 2 && !matches!(kind, TargetKind::Limb(_));
            let aim = aims.then(|| Aim { axis: random.direction(), point: random.finite_vector() });
            let (space, softness) = (TargetSpace::World, random.within(0.0..0.99));
            rig.targets.push(Target {
                joint,
                home,
                space,
                pin: if random.coin() { random.finite_vector() } else { home },
                is_pinned: random.coin(),
                kind,
                orientation,
                aim,
                orientation_weight: if random.coin() { 1.0 } else { random.positive() },
                influence,
                weight,
                softness,
                enabled,
                motion,
            });
        }
    }
    if !is_arm {
        put_on_joints(random, &mut rig);
    }
    rig.solver.method = random.one_of(&Method::ALL);
    rig.solver.iterations = random.coin().then(|| 1 + random.below(1 << 31) as u32);
    rig.solver.tolerance = random.coin().then(|| random.positive());
    rig.solver.damping = random.positive();
    rig.solver.step = random.positive();
    rig.solver.posture_rate = random.positive();
    rig.solver.root = random.one_of(&Root::ALL);
    rig.solver.root_stiffness = random.within(0.0..1.0);
    rig.iterations_per_frame = 1 + random.below(1000) as u32;
    let ring = PathKind::Ring(WavyRing {
        radius: random.finite(),
        amplitude: random.finite(),
        waves: random.below(1 << 32) as u32,
        period: random.positive(),
    });
    let roots = rig.skeleton.ids().filter(|joint| rig.skeleton[*joint].parent.is_none());
    for root in roots.collect::<Vec<_>>() {
        let kinds = [ring, PathKind::Head, PathKind::Target].map(Some);
        rig.follow_paths =
            rig.with_path(root, random.one_of(&[None, kinds[0], kinds[1], kinds[2]]));
    }
    rig.is_tracked = random.coin();
    rig.body_follows = random.coin();
    rig.balance = random.coin().then(|| balance(random));
    rig.posture =
        random.coin().then(|| posture(random, &rig)).filter(|it| !it.is_empty()).map(Shared::from);
    let keys = keys(random, &rig);
    let start = f64::from(random.within(-100.0..100.0));
    let timeline = Timeline {
        start,
        end: start + f64::from(random.within(0.1..100.0)) / 3.0,
        frame_rate: (1 + random.below(100_000)) as f64 / 100.0,
    };
    Document {
        rig,
        keys,
        timeline,
        track_start: random.coin().then(|| start - f64::from(random.within(0.0..3.0))),
        metres_per_unit: random.coin().then(|| random.positive()),
        animation_name: random.coin().then(|| random.one_of(&["Run", "", "läuft"]).to_owned()),
        camera: Camera {
            target: random.finite_vector(),
            yaw: random.finite(),
            pitch: random.within(-1.5..1.5),
            distance: random.positive(),
            orthographic: random.coin(),
        },
        display: Overlay::all().filter(|_| random.coin()).collect::<Display>(),
    }
}

fn posture(random: &mut Random, rig: &SkeletonRig) -> Posture {
    let mut posture = Posture::default();
    for joint in rig.skeleton.ids() {
        let rotation = random.coin().then(|| random.finite_vector());
        let offset = random.coin().then(|| random.finite_vector());
        posture.joints.insert(joint, PosturedJoint { rotation, offset });
        if random.coin() {
            posture.limbs.insert(joint, limb_posture(random));
        }
    }
    posture
}

fn limb_posture(random: &mut Random) -> LimbPosture {
    LimbPosture {
        pointer: random.finite_vector(),
        elbow: random.finite_vector(),
        bend_axis: random.finite_vector(),
        bend: random.finite_vector(),
        hand: random.coin().then(|| random.finite_vector()),
    }
}

fn target_kind(random: &mut Random) -> TargetKind {
    match random.below(4) {
        0 | 1 => return TargetKind::WholeBody,
        2 => {
            let length = 1 + random.below(5) as u32;
            return TargetKind::Chain(length.try_into().expect("above 0"));
        }
        _ => {}
    }
    let reference = random.one_of(&TwistReferenceKind::ALL);
    let needs_pole = reference == TwistReferenceKind::Pole;
    let pole = (needs_pole || random.coin()).then(|| random.finite_vector());
    let map = Stereographic::new(random.direction(), random.direction());
    let soft_reach = SoftReach::new(random.within(0.0..0.9), 1.0 + random.within(0.0..2.0), 0.5);
    TargetKind::Limb(LimbSettings {
        reference,
        pole,
        map: map.filter(|_| random.coin()).unwrap_or_default(),
        fk_stretch: if random.coin() { random.positive() } else { 1.0 },
        bends_about: random.coin().then(|| random.direction()),
        twist: random.finite(),
        soft_reach: soft_reach.expect("in range"),
        pole_space: TargetSpace::World,
    })
}

fn arm(random: &mut Random) -> Arm {
    let soft_reach = SoftReach::new(
        random.within(0.0..0.99),
        1.0 + random.finite().abs().min(9.0),
        random.within(0.0..3.1),
    );
    Arm {
        cursor: cursor(random),
        twist: random.finite(),
        root: random.finite_vector(),
        bones: TwoBone::new(random.positive(), random.positive()).expect("lengths"),
        twist_reference: random.one_of(&TwistReferenceKind::ALL),
        pole: random.finite_vector(),
        soft_reach: soft_reach.expect("a softening"),
        influence: random.within(0.0..1.0),
        fk: Fk {
            shoulder: random.finite_vector(),
            bend: random.finite(),
            stretch: random.positive(),
        },
        hand_orientation: HandOrientation {
            space: random.one_of(&[HandSpace::LowerLimb, HandSpace::World]),
            angles: random.finite_vector(),
        },
    }
}

/// A Cursor of which a file has both points or only the one in use.
fn cursor(random: &mut Random) -> Cursor {
    let (default, point) = (Arm::default().cursor, random.finite_vector());
    let (in_root, in_world) = match random.below(3) {
        0 => (point, default.in_world),
        1 => (default.in_root, point),
        _ => (point, random.finite_vector()),
    };
    Cursor { in_root, in_world, is_pinned: random.coin() }
}

/// Puts some targets and poles on joints, where they can be evaluated.
fn balance(random: &mut Random) -> BalanceTarget {
    let (influence, weight) = (random.within(0.0..1.0), random.positive());
    let point = BalanceOver::Point(Vec2::new(random.finite(), random.finite()));
    let over = random.one_of(&[BalanceOver::Feet, point]);
    BalanceTarget { influence, weight, over }
}

fn put_on_joints(random: &mut Random, rig: &mut SkeletonRig) {
    let joints: Vec<JointId> = rig.skeleton.ids().collect();
    for index in 0..rig.targets.len() {
        let before = rig.targets[index];
        let space = TargetSpace::Joint(random.one_of(&joints));
        match rig.targets[index].limb_mut().filter(|_| random.coin()) {
            Some(limb) if limb.pole().is_some() => limb.pole_space = space,
            _ => rig.targets[index].space = space,
        }
        if rig.check_target_spaces().is_err() {
            rig.targets[index] = before;
        }
    }
}

fn keys(random: &mut Random, rig: &SkeletonRig) -> Keys {
    let overlays = Overlay::all().map(Channel::Overlay);
    let joints = (0..rig.skeleton.joints().len()).flat_map(|joint| {
        let joint = JointId::new(joint);
        [
            Channel::Rotation(joint),
            Channel::Offset(joint),
            Channel::SkinScale(joint),
            Channel::SkinShear(joint),
        ]
    });
    let targets = rig.targets.iter();
    let targets = targets.flat_map(|it| Channel::of_target(it.joint));
    let all = overlays.chain([Channel::Translation]);
    let all = all.chain(rig.balance.map(|_| Channel::BalanceInfluence));
    let mut keys = Keys::default();
    for channel in all.chain(joints).chain(targets) {
        if random.below(3) > 0 {
            continue;
        }
        for _ in 0..1 + random.below(5) {
            let value = match channel.quantity() {
                Quantity::Point | Quantity::Numbers | Quantity::Rotation => random.finite_vector(),
                Quantity::Fraction => Vec3::new(random.within(0.0..1.0), 0.0, 0.0),
                Quantity::Angle | Quantity::Number => Vec3::new(random.finite(), 0.0, 0.0),
                Quantity::Length => Vec3::new(random.positive(), 0.0, 0.0),
                Quantity::Switch => Vec3::new(f32::from(u8::from(random.coin())), 0.0, 0.0),
            };
            keys.insert(channel, f64::from(random.finite()) / 3.0, value);
        }
    }
    keys
}

fn skeleton(random: &mut Random) -> Skeleton {
    let count = random.below(12);
    let joints = (0..count).map(|index| {
        let parent = (index > 0 && random.below(4) > 0).then(|| random.below(index).into());
        let turn = [(); 4].map(|()| random.within(-1.0..1.0));
        Joint {
            name: format!("{} \"é\\\n{index}", random.below(100)),
            parent,
            offset: random.finite_vector(),
            axis: random.finite_vector(),
            rotation: random.finite_vector(),
            frame: match random.below(3) {
                0 => Mat3::from_quat(Quat::from_array(turn).normalize()),
                1 => Mat3::from_cols(Vec3::new(1.0, -0.0, 0.0), Vec3::Y, Vec3::Z),
                _ => Mat3::IDENTITY,
            },
            limits: limits(random),
            stiffness: Vec3::from_array([(); 3].map(|()| random.within(0.0..1.0))),
            locked: random.coin(),
            connected: random.coin(),
            radius: random.finite().abs(),
            human_bone: random.chance(0.2).then(|| "leftHand".to_owned()),
            skin: match random.coin() {
                true => SkinStretch::NONE,
                false => {
                    SkinStretch { scale: random.finite_vector(), shear: random.finite_vector() }
                }
            },
        }
    });
    let mut skeleton = Skeleton::from_joints(joints.collect()).expect("a skeleton");
    let transform = Affine3A::from_cols_array(&[(); 12].map(|()| random.finite()));
    skeleton.set_transform(transform).expect("finite");
    skeleton
}

fn limits(random: &mut Random) -> JointLimits {
    if random.below(4) == 0 {
        let min = random.within(-4.0..4.0);
        let twist = Limit { min, max: min + random.within(0.0..6.0) };
        let [x, z] = [(); 2].map(|()| random.within(0.01..2.9));
        let middle = Vec2::from([(); 2].map(|()| random.within(-2.0..2.0)));
        return JointLimits::cone(Cone { x, z, twist, middle });
    }
    JointLimits::new([(); 3].map(|()| {
        let (a, b) = (random.finite(), random.finite());
        random.coin().then_some(Limit { min: a.min(b), max: a.max(b) })
    }))
}

/// The document of a built-in example.
pub fn example(name: &str) -> Document {
    Example::find(name).expect("an example").open().expect("it opens").document
}

/// The action that opens a built-in example.
pub fn open_example(name: &str) -> FileAction {
    FileAction::OpenExample(Example::find(name).expect("an example"))
}

/// A file of a snake whose head has keys.
pub const KEYED_SNAKE: &str = include_str!("../data/keyed-snake.json");

/// The document of [`KEYED_SNAKE`].
pub fn keyed_snake() -> Document {
    parse("snake.json", KEYED_SNAKE, &OpenOptions::default()).expect("it opens").document
}
