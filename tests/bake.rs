//! Bakes: keys instead of targets and paths.
#![cfg(feature = "document")]

mod common;

use common::Random;
use common::skeletons::{forest, transform};
use glam::Vec3;
use ik_arm::document::{
    Bake, BakeError, Baked, Channel, Document, FollowPath, RigKind, SkeletonRig, Target,
    TargetMotion, TargetPath, Timeline,
};
use ik_arm::io::Example;
use ik_arm::kinematics::chain_ik::{Method, Root};
use ik_arm::kinematics::limb_ik::ElbowReference;
use ik_arm::kinematics::skeleton::{JointId, SkeletonPose};
use ik_arm::kinematics::soft_reach::SoftReach;
use ik_arm::rig::{LimbSettings, TargetKind};

const WHOLE: Timeline = Timeline { start: 0.0, end: 2.0, frame_rate: 24 };

/// A random skeleton with moving targets of both kinds, or on a path, and with keys.
fn random_document(random: &mut Random) -> Document {
    let mut skeleton = forest(random, 10);
    skeleton.set_transform(transform(random)).expect("finite");
    let mut rig = SkeletonRig::new(skeleton);
    let methods = [Method::Fabrik, Method::Ccd, Method::DampedLeastSquares];
    let solver = rig.solver.with_method(random.one_of(&methods)).with_iterations(30);
    rig.solver = solver.with_root(random.one_of(&Root::ALL));
    for joint in rig.skeleton.ids() {
        if random.chance(0.4) {
            let target = random_target(random, joint, rig.skeleton.tip(joint));
            rig.targets.push(target);
        }
    }
    if random.chance(0.2) {
        rig.follow_path = Some(FollowPath { radius: 1.0, amplitude: 0.2, waves: 5, period: 1.5 });
    }
    let rig_kind = RigKind::Skeleton;
    let mut document =
        Document { rig: rig_kind, skeleton_rig: rig, timeline: WHOLE, ..Document::default() };
    let joints = document.skeleton().ids();
    for channel in joints.flat_map(|joint| {
        [Channel::Rotation(joint), Channel::Offset(joint), Channel::Target(joint)]
    }) {
        if random.chance(0.2) {
            for _ in 0..1 + random.below(3) {
                let time = random.within(-1.0..3.0).into();
                document.keys.insert(channel, time, random.vector(1.0));
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
        reference: random.one_of(&[ElbowReference::Fk, ElbowReference::Limb]),
        twist: random.within(-3.0..3.0),
        soft_reach: SoftReach::new(random.within(0.0..0.5), random.one_of(&[1.0, 1.3]), 0.1)
            .expect("in range"),
        orientation: random.coin().then(|| random.angles()),
    };
    let kind = if random.coin() { TargetKind::Limb(settings) } else { TargetKind::WholeBody };
    let influence = random.one_of(&[0.0, 0.3, 1.0]);
    Target { kind, influence, motion, ..Target::new(joint, tip + random.vector(0.5), 0.1) }
}

fn bake(document: &Document, settings: &Bake) -> Baked {
    settings.run(document, |_, _| true).expect("it can be baked")
}

fn pose_at(document: &Document, time: f64) -> SkeletonPose {
    document.evaluate(time).skeleton_rig.skeleton_at(time).pose()
}

/// The document without its targets.
fn untargeted(document: &Document) -> Document {
    let mut document = document.clone();
    document.skeleton_rig.targets.clear();
    document
}

/// Largest distance of a base or tip between two documents at the frames of a range; without the tips
/// of shortened bones.
fn largest_distance(one: &Document, baked: &Baked, range: &Timeline) -> f32 {
    let other = untargeted(&baked.document);
    let is_shortened = |joint: JointId| baked.shortened.iter().any(|bone| bone.joint == joint);
    let mut most = 0.0_f32;
    for frame in 0..range.frames() {
        let time = range.time(frame);
        let (one, other) = (pose_at(one, time), pose_at(&other, time));
        for joint in one.ids() {
            let base = one.base(joint).distance(other.base(joint));
            let tip = one.tip(joint).distance(other.tip(joint));
            most = most.max(base).max(if is_shortened(joint) { 0.0 } else { tip });
        }
    }
    most
}

/// The examples with a skeleton, their targets at full influence.
fn examples() -> Vec<(&'static str, Document)> {
    let opened = Example::ALL
        .into_iter()
        .map(|example| (example.name, example.open().expect("opens").document));
    let skeletons = opened.filter(|(_, document)| document.rig == RigKind::Skeleton);
    let posed = skeletons.map(|(name, mut document)| {
        document.skeleton_rig.targets.iter_mut().for_each(|target| target.influence = 1.0);
        (name, document)
    });
    posed.collect()
}

#[test]
fn baked_examples_move_as_before_without_their_targets() {
    let mut tried = 0;
    for (name, document) in examples() {
        let settings = Bake::of_timeline(&document);
        if settings.check(&document).is_err() {
            continue;
        }
        tried += 1;
        let start = std::time::Instant::now();
        let baked = bake(&document, &settings);
        eprintln!(
            "{name}: {} -> {} keys, error {} of {}, {:?} {:?}",
            baked.keys_at_frames,
            baked.keys,
            baked.error,
            settings.tolerance * document.skeleton_rig.reach(),
            baked.shortened,
            start.elapsed()
        );
        let tolerance =
            settings.tolerance * document.evaluate(settings.frames.start).skeleton_rig.reach();
        let most = largest_distance(&document, &baked, &settings.frames);
        assert!(most <= tolerance, "{name}: {most} > {tolerance}");
    }
    assert!(tried > 0);
}

#[test]
fn baked_documents_move_as_before_without_their_targets() {
    let mut random = Random(160);
    let mut sum = (0, 0);
    let mut tried = 0;
    for case in 0..60 {
        let document = random_document(&mut random);
        let tolerance = random.one_of(&[1e-4, 1e-3, 1e-2]);
        let settings = Bake { frames: WHOLE, tolerance };
        let baked = match settings.run(&document, |_, _| true) {
            Ok(baked) => baked,
            Err(BakeError::Nothing) => continue,
            Err(error) => panic!("{case}: {error}"),
        };
        tried += 1;
        sum.0 += baked.keys_at_frames;
        sum.1 += baked.keys;
        let tolerance = tolerance * document.evaluate(0.0).skeleton_rig.reach();
        let most = largest_distance(&document, &baked, &settings.frames);
        assert!(most <= tolerance, "{case}: {most} > {tolerance}");
    }
    eprintln!("sum {sum:?}");
    assert!(tried > 0);
}
