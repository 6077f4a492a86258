//! Time of whole tracks: of the Human with four whole-body targets over 240 frames, reached and
//! partly out of reach, by each method, and of a chain of 100 joints over 1,000 frames; then of one
//! time of a known track, of a frame while a key is dragged, and of a motion without targets.

use core::hint::black_box;

use criterion::{BatchSize, Criterion, criterion_group, criterion_main};
use glam::Vec3;
use ik_arm::document::{
    Channel, Document, SkeletonRig, Target, TargetMotion, TargetPath, Timeline, Track,
};
use ik_arm::io::Example;
use ik_arm::kinematics::chain_ik::Method;
use ik_arm::kinematics::skeleton::{Joint, JointId, Skeleton};
use ik_arm::rig::TargetKind;

/// The Human whose hands and feet have whole-body targets on circles of this radius, over 240
/// frames.
fn human(method: Method, radius: f32) -> Document {
    let example = Example::find("human").expect("an example").open().expect("valid").document;
    let mut rig = example.rig;
    rig.targets.clear();
    let pose = rig.skeleton_at(0.0);
    for name in ["left_hand", "right_hand", "left_foot", "right_foot"] {
        let joint = rig.skeleton.find(name).expect("a joint");
        let target = rig.new_target(joint, &pose).expect("no target yet");
        let radius = if name.ends_with("hand") { radius } else { 0.05 };
        let motion = TargetMotion { path: TargetPath::Circle, radius, period: 4.0 };
        rig.targets.push(Target { kind: TargetKind::WholeBody, motion, ..target });
    }
    rig.solver = rig.solver.with_method(method);
    document(rig, 8.0)
}

fn document(rig: SkeletonRig, end: f64) -> Document {
    let timeline = Timeline { start: 0.0, end, frame_rate: 30.0 };
    Document { timeline, ..Document::new(rig) }
}

/// A chain of 100 joints whose tip goes around a circle, over 1,000 frames.
fn chain() -> Document {
    let mut skeleton = Skeleton::with_root("root");
    let mut last = JointId::new(0);
    for bone in 0..100 {
        let joint = Joint::new(&format!("bone {bone}"), Some(last), Vec3::Y * 0.01);
        let rotation = Vec3::new(0.02, 0.0, 0.03);
        last = skeleton
            .add(Joint { offset: skeleton[last].axis, rotation, ..joint })
            .expect("a joint");
    }
    let mut rig = SkeletonRig::new(skeleton);
    let motion = TargetMotion { path: TargetPath::Circle, radius: 0.2, period: 4.0 };
    let home = rig.skeleton.tip(last) * 0.8;
    rig.targets.push(Target { influence: 1.0, motion, ..Target::new(last, home, 0.2) });
    document(rig, 1000.0 / 30.0)
}

fn track(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("track");
    group.sample_size(10);
    let whole =
        |document: &Document| Track::new(document).at(document.timeline.end).skeleton().clone();
    for method in Method::ALL.into_iter().filter(|method| !method.is_closed_form()) {
        for (radius, name) in [(0.1, "reached"), (0.6, "partly out of reach")] {
            let document = human(method, radius);
            let name = format!("human, 240 frames, {method}, {name}");
            group.bench_function(name, |it| it.iter(|| whole(black_box(&document))));
        }
    }
    let long = chain();
    group.bench_function("chain of 100, 1,000 frames", |it| it.iter(|| whole(black_box(&long))));

    let document = human(Method::Fabrik, 0.1);
    let known = Track::new(&document);
    known.at(document.timeline.end).skeleton();
    let time = document.timeline.time(200);
    group.bench_function("one time of a known track", |it| {
        it.iter(|| known.at(black_box(time)).skeleton().clone());
    });
    known.at(time).skeleton();
    for (at, name) in [(0.5, "near the start"), (9.5, "near the end")] {
        let mut keyed = human(Method::Fabrik, 0.1);
        keyed.timeline.end = 10.0;
        let joint = keyed.rig.targets[0].joint;
        let home = keyed.rig.targets[0].home;
        for second in 0_u8..=20 {
            let value = home + Vec3::Y * 0.05 * f32::from(second % 3);
            keyed.keys.insert_auto(Channel::Target(joint), f64::from(second) / 2.0, value);
        }
        let known = Track::new(&keyed);
        known.at(10.0).skeleton();
        let mut moved = keyed.clone();
        moved.keys.insert_auto(Channel::Target(joint), at, home + Vec3::X * 0.05);
        group.bench_function(format!("frame at a dragged key {name}"), |it| {
            it.iter_batched(
                || known.clone(),
                |known| known.updated(black_box(&moved)).at(at).skeleton().clone(),
                BatchSize::SmallInput,
            );
        });
    }
    let mut plain = human(Method::Fabrik, 0.1);
    plain.rig.targets.clear();
    for frame in 0..10_000 {
        let turned = Vec3::X * (frame as f32 * 0.1).sin();
        let channel = Channel::Rotation(JointId::new(2));
        plain.keys.insert(channel, f64::from(frame) / 30.0, turned);
    }
    let plain = Track::new(&plain);
    group.bench_function("one of 10,000 frames without targets", |it| {
        it.iter(|| plain.at(black_box(200.0)).skeleton().clone());
    });
    group.finish();
}

criterion_group!(benches, track);
criterion_main!(benches);
