//! Bakes: keys instead of targets and paths.

use glam::Vec3;
use ik_arm::document::{
    Bake, BakeError, Baked, Channel, Document, FollowPath, PathKind, SkeletonRig, Target,
    TargetMotion, TargetPath, Timeline, WavyRing,
};
use ik_arm::io::Example;
use ik_arm::kinematics::chain_ik::{Method, Root, SolverOptions};
use ik_arm::kinematics::skeleton::{Joint, JointId, Skeleton, SkeletonPose};
use ik_arm::kinematics::soft_reach::SoftReach;
use ik_arm::kinematics::spline::Spline;
use ik_arm::kinematics::twist::TwistReferenceKind;
use ik_arm::rig::{LimbSettings, TargetKind};
use pollster::block_on;

use crate::common::skeletons::{forest, transform};
use crate::common::{Random, documents};

const WHOLE: Timeline = Timeline { start: 0.0, end: 2.0, frame_rate: 24.0 };
const PART: Timeline = Timeline { start: 0.5, end: 1.25, frame_rate: 24.0 };

/// A random skeleton with moving targets of both kinds, or on a path, and with keys.
fn random_document(random: &mut Random) -> Document {
    let mut skeleton = forest(random, 10);
    skeleton.set_transform(transform(random)).expect("finite");
    let mut rig = SkeletonRig::new(skeleton);
    let methods = [Method::Fabrik, Method::Relaxation, Method::Ccd, Method::DampedLeastSquares];
    let solver = rig.solver.with_method(random.one_of(&methods)).with_iterations(30);
    rig.solver = solver.with_root(random.one_of(&Root::ALL));
    for joint in rig.skeleton.ids() {
        if random.chance(0.4) {
            let target = random_target(random, joint, rig.skeleton.tip(joint));
            rig.targets.push(target);
        }
    }
    let ring = WavyRing { radius: 1.0, amplitude: 0.2, waves: 5, period: 1.5 };
    if random.chance(0.3) {
        let kind = random.one_of(&[PathKind::Ring(ring), PathKind::Head, PathKind::Target]);
        rig.follow_paths = vec![FollowPath { root: JointId::new(0), kind }];
    }
    let mut document = shown(rig);
    for joint in document.skeleton().ids() {
        for channel in [
            Channel::Rotation(joint),
            Channel::Offset(joint),
            Channel::Target(joint),
            Channel::TargetInfluence(joint),
        ] {
            for _ in 0..if random.chance(0.2) { 1 + random.below(3) } else { 0 } {
                let time = random.within(-1.0..3.0).into();
                let value = match channel {
                    Channel::TargetInfluence(_) => Vec3::X * random.within(0.0..1.0),
                    _ => random.vector(1.0),
                };
                document.keys.insert(channel, time, value);
            }
        }
    }
    document
}

fn random_target(random: &mut Random, joint: JointId, tip: Vec3) -> Target {
    let motion = TargetMotion {
        path: random.one_of(&[TargetPath::Still, TargetPath::Circle, TargetPath::FigureEight]),
        radius: random.within(0.0..1.0),
        period: random.within(0.5..4.0),
    };
    let settings = LimbSettings {
        reference: random.one_of(&[TwistReferenceKind::Fk, TwistReferenceKind::Up]),
        twist: random.within(-3.0..3.0),
        soft_reach: SoftReach::new(random.within(0.0..0.5), random.one_of(&[1.0, 1.3]), 0.1)
            .expect("in range"),
        ..LimbSettings::default()
    };
    let orientation = random.coin().then(|| random.angles());
    let kind = if random.coin() { TargetKind::Limb(settings) } else { TargetKind::WholeBody };
    let influence = random.one_of(&[0.0, 0.3, 1.0]);
    let orientation = orientation.filter(|_| kind != TargetKind::WholeBody);
    Target {
        kind,
        orientation,
        influence,
        motion,
        ..Target::new(joint, tip + random.vector(0.5), 0.1)
    }
}

/// A chain of three bones along y from the origin whose tip goes around a circle.
fn waving() -> Document {
    let mut skeleton = Skeleton::with_root("root");
    for (index, offset) in [Vec3::ZERO, Vec3::Y, Vec3::Y].into_iter().enumerate() {
        let joint = Joint::new(&format!("j{index}"), Some(JointId::new(index)), Vec3::Y);
        let rotation = Vec3::new(0.3, 0.0, 0.2);
        skeleton.add(Joint { offset, rotation, ..joint }).expect("a joint");
    }
    let mut rig = SkeletonRig::new(skeleton);
    let motion = TargetMotion { path: TargetPath::Circle, radius: 0.8, period: 2.0 };
    let target = Target::new(JointId::new(3), Vec3::new(1.0, 1.8, 0.3), 0.1);
    rig.targets.push(Target { motion, influence: 1.0, ..target });
    // A looser tolerance leaves differences between frames that only keys can follow.
    rig.solver = SolverOptions::new(Method::DampedLeastSquares).with_tolerance(1e-6);
    shown(rig)
}

fn shown(rig: SkeletonRig) -> Document {
    Document { timeline: WHOLE, ..Document::new(rig) }
}

fn bake(document: &Document, settings: &Bake) -> Baked {
    block_on(settings.run(document, async |_, _| true)).expect("it can be baked")
}

fn pose_at(document: &Document, time: f64) -> SkeletonPose {
    document.at(time).skeleton().pose()
}

/// The document without its targets.
fn untargeted(document: &Document) -> Document {
    let mut document = document.clone();
    document.rig.targets.clear();
    document
}

/// Largest distance of a base or tip between two documents at the frames of a range; the tips of
/// some joints are left out.
fn largest_distance(
    one: &Document,
    other: &Document,
    range: &Timeline,
    without: &[JointId],
) -> f32 {
    let mut most = 0.0_f32;
    for time in (0..range.frames()).map(|frame| range.time(frame)) {
        let (one, other) = (pose_at(one, time), pose_at(other, time));
        for joint in one.ids() {
            most = most.max(one.base(joint).distance(other.base(joint)));
            if !without.contains(&joint) {
                most = most.max(one.tip(joint).distance(other.tip(joint)));
            }
        }
    }
    most
}

/// Asserts that a document's bake moves as the document does, with its targets and without them.
fn assert_moves_as_before(name: &str, document: &Document, settings: &Bake, baked: &Baked) {
    let reach = document.at(settings.frames.start).into_document().rig.reach();
    let tolerance = settings.tolerance * reach;
    let shortened: Vec<JointId> = baked.shortened.iter().map(|bone| bone.joint).collect();
    for after in [&baked.document, &untargeted(&baked.document)] {
        let most = largest_distance(document, after, &settings.frames, &shortened);
        assert!(most <= tolerance, "{name}: {most} > {tolerance}");
        if shortened.is_empty() {
            let difference = (most - baked.error).abs();
            assert!(difference <= 0.01 * tolerance, "{name}: {most}, not {}", baked.error);
        }
    }
}

/// Keys of rotations and offsets in a range.
fn keys_of_joints(document: &Document, range: &Timeline) -> usize {
    let is_of_joint =
        |channel: &Channel| matches!(channel, Channel::Rotation(_) | Channel::Offset(_));
    let tracks = document.keys.tracks().filter(|(channel, _)| is_of_joint(channel));
    let knots = tracks.flat_map(|(_, track)| track.knots());
    knots.filter(|knot| (range.start..=range.end).contains(&knot.time)).count()
}

#[test]
fn baked_examples_move_as_before() {
    let mut tried = 0;
    for example in Example::ALL {
        let mut document = example.open().expect("it opens").document;
        document.rig.targets.iter_mut().for_each(|target| target.influence = 1.0);
        let frames = Timeline { frame_rate: 12.0, ..document.timeline };
        let settings = Bake { frames, ..Bake::of_timeline(&document) };
        if settings.check(&document).is_ok() {
            let baked = bake(&document, &settings);
            assert_moves_as_before(example.name, &document, &settings, &baked);
            tried += 1;
        }
    }
    assert!(tried > 3);
}

#[test]
fn baked_documents_move_as_before() {
    let mut random = Random(160);
    let mut tried = 0;
    for case in 0..60 {
        let document = random_document(&mut random);
        let tolerance = random.one_of(&[1e-4, 1e-3, 1e-2]);
        let settings = Bake { frames: random.one_of(&[WHOLE, PART]), tolerance };
        match block_on(settings.run(&document, async |_, _| true)) {
            Ok(baked) => {
                assert_moves_as_before(&case.to_string(), &document, &settings, &baked);
                tried += 1;
            }
            Err(error) => assert_eq!(error, BakeError::Nothing, "{case}"),
        }
    }
    assert!(tried > 40, "{tried}");
}

#[test]
fn documents_with_any_numbers_are_baked_or_refused() {
    let mut random = Random(161);
    for _ in 0..40 {
        let mut document = documents::document(&mut random);
        let start = document.timeline.start;
        document.timeline = Timeline { start, end: start + 0.5, frame_rate: 20.0 };
        document.rig.solver.iterations = Some(20);
        let _ = block_on(Bake::of_timeline(&document).run(&document, async |_, _| true));
    }
}

#[test]
fn a_coarser_tolerance_leaves_fewer_keys_and_the_keys_are_counted() {
    let document = waving();
    let mut before = usize::MAX;
    for tolerance in [1e-4, 1e-3, 1e-2, 1e-1] {
        let baked = bake(&document, &Bake { frames: WHOLE, tolerance });
        assert_eq!(baked.keys_at_frames, 3 * WHOLE.frames());
        assert_eq!(baked.keys, keys_of_joints(&baked.document, &WHOLE));
        assert!(baked.keys < before, "{tolerance}: {} keys", baked.keys);
        before = baked.keys;
    }
}

#[test]
fn a_still_pose_takes_one_key_a_channel() {
    let mut document = waving();
    document.rig.targets[0].motion.path = TargetPath::Still;
    let baked = bake(&document, &Bake::of_timeline(&document));
    assert_eq!(baked.keys, 3);
}

#[test]
fn angles_go_on_over_full_turns_instead_of_jumping_back() {
    let mut skeleton = Skeleton::with_root("root");
    let arm = skeleton.add(Joint::new("arm", Some(JointId::new(0)), Vec3::Y)).expect("a joint");
    let mut rig = SkeletonRig::new(skeleton);
    // The circle is nearly around the base. Exactly opposite to the bind pose, the least rotation
    // has no axis.
    let motion = TargetMotion { path: TargetPath::Circle, radius: 1.0, period: 0.5 };
    let home = Vec3::new(0.02, 1.0, 0.0);
    rig.targets.push(Target { motion, influence: 1.0, ..Target::new(arm, home, 0.1) });
    let document = shown(rig);
    let settings = Bake { tolerance: 1e-5, ..Bake::of_timeline(&document) };
    let baked = bake(&document, &settings);
    let track = baked.document.keys.track(Channel::Rotation(arm)).expect("keys");
    for pair in track.knots().windows(2) {
        let turned = (pair[1].value - pair[0].value).length();
        let most = (pair[1].time - pair[0].time) as f32 / 0.5 * std::f32::consts::TAU;
        assert!(turned <= 1.1 * most, "{turned} > {most}");
    }
    assert_moves_as_before("turns", &document, &settings, &baked);
}

#[test]
fn a_bake_of_a_part_leaves_the_rest_to_the_targets() {
    let mut document = waving();
    // Along a track, poses after the range depend on those in it.
    document.rig.is_tracked = false;
    let settings = Bake { frames: PART, ..Bake::of_timeline(&document) };
    let baked = bake(&document, &settings).document;
    for frame in 0..WHOLE.frames() {
        let time = WHOLE.time(frame);
        let influence = baked.at(time).into_document().rig.targets[0].influence;
        let is_baked = (PART.start..=PART.end).contains(&time);
        assert_eq!(influence, if is_baked { 0.0 } else { 1.0 }, "at {time}");
        if !is_baked {
            let (before, after) = (pose_at(&document, time), pose_at(&baked, time));
            for (before, after) in before.points().zip(after.points()) {
                assert!(before.distance(after) <= 1e-5, "at {time}: {before} {after}");
            }
        }
    }
}

#[test]
fn keys_of_joints_that_no_target_moves_are_left_as_they_are() {
    let mut document = waving();
    let apart = document.skeleton_mut().add(Joint::new("apart", None, Vec3::X)).expect("a joint");
    for channel in [Channel::Rotation(apart), Channel::Offset(apart)] {
        document.keys.insert(channel, 0.1, Vec3::X);
        document.keys.insert(channel, 1.1, Vec3::Y);
    }
    let baked = bake(&document, &Bake::of_timeline(&document)).document;
    for channel in [Channel::Rotation(apart), Channel::Offset(apart)] {
        assert_eq!(baked.keys.track(channel), document.keys.track(channel));
    }
    let all = |document: &Document| document.keys.tracks().count();
    assert_eq!(all(&baked), all(&document) + 3 + 1, "three rotations and one influence");
}

#[test]
fn a_stretched_bone_is_reported_and_what_hangs_on_it_is_kept() {
    let mut skeleton = Skeleton::default();
    let mut add = |name, parent, offset, axis| {
        let joint = Joint::new(name, parent, axis);
        skeleton.add(Joint { offset, ..joint }).expect("a joint")
    };
    let upper = add("upper", None, Vec3::ZERO, Vec3::Y);
    let lower = add("lower", Some(upper), Vec3::Y, Vec3::Y);
    let hand = add("hand", Some(lower), Vec3::Y, Vec3::X * 0.2);
    let mut rig = SkeletonRig::new(skeleton);
    let soft_reach = SoftReach::new(0.0, 1.5, 0.0).expect("in range");
    let kind = TargetKind::Limb(LimbSettings { soft_reach, ..LimbSettings::default() });
    let home = Vec3::new(2.0, 1.5, 0.0);
    rig.targets.push(Target { kind, influence: 1.0, ..Target::new(lower, home, 0.1) });
    let document = shown(rig);
    let baked = bake(&document, &Bake::of_timeline(&document));
    let shortened: Vec<JointId> = baked.shortened.iter().map(|bone| bone.joint).collect();
    assert_eq!(shortened, [upper, lower]);
    for bone in &baked.shortened {
        assert!((bone.error - 0.25).abs() < 1e-5, "{bone:?}");
    }
    let pose = pose_at(&untargeted(&baked.document), 0.0);
    assert!(pose.base(hand).distance(home) < 1e-5, "{}", pose.base(hand));
    assert_moves_as_before("stretched", &document, &Bake::of_timeline(&document), &baked);
}

#[test]
fn a_path_is_replaced_by_keys() {
    let document = crate::common::documents::keyed_snake();
    let frames = Timeline { frame_rate: 10.0, ..document.timeline };
    let baked = bake(&document, &Bake { frames, tolerance: 1e-2 });
    assert_eq!(baked.document.rig.follow_paths, []);
    let root = Channel::Offset(JointId::new(0));
    assert!(baked.document.keys.track(root).is_some_and(|track| !Spline::is_empty(track)));
}

#[test]
fn a_cancelled_bake_ends_at_its_next_step() {
    let document = waving();
    let mut steps = Vec::new();
    let result = block_on(Bake::of_timeline(&document).run(&document, async |done, total| {
        steps.push((done, total));
        steps.len() < 200
    }));
    assert_eq!(result, Err(BakeError::Cancelled));
    assert_eq!(steps.len(), 200);
    assert!(steps.is_sorted(), "{steps:?}");
    assert!(steps.iter().all(|(done, total)| done <= total));
}

#[test]
fn what_cannot_be_baked_is_refused_with_a_reason() {
    let document = waving();
    let settings = Bake::of_timeline(&document);
    let refused = |document: &Document, settings: Bake, why: &str| {
        let error = block_on(settings.run(document, async |_, _| true)).expect_err("it is refused");
        assert_eq!(error.to_string(), why);
    };
    let nothing = "nothing to bake: no target and no path poses the skeleton in this range";
    let mut idle = document.clone();
    idle.rig.targets[0].influence = 0.0;
    refused(&idle, settings, nothing);
    refused(&untargeted(&document), settings, nothing);
    refused(
        &document,
        Bake { frames: Timeline { end: -1.0, ..WHOLE }, ..settings },
        "a bake must start before it ends, within 86400 s of time 0, at 0.01 to 1000 frames per \
         second, got 0 s to -1 s at 24",
    );
    refused(
        &document,
        Bake { tolerance: 2.0, ..settings },
        "the tolerance must be from 0.00001 to 1 of the reach, got 2",
    );
    refused(
        &document,
        Bake { frames: Timeline { end: 80_000.0, ..WHOLE }, ..settings },
        "frames times joints must be at most 2000000, got 1920001 frames of 4 joints; bake a \
         shorter time or fewer frames per second",
    );
}
