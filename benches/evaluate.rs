//! Time of evaluating the Human with limb targets and with whole-body targets, of a trail over 240
//! frames, and of baking the Walk.

use core::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use glam::Vec3;
use ik_arm::document::{Document, SkeletonRig, Target};
use ik_arm::io::Example;
use ik_arm::rig::TargetKind;

fn example(name: &str) -> Document {
    Example::find(name).expect("an example").open().expect("valid").document
}

/// The Human with a target 5 cm away from each hand and foot; the pelvis is 5 cm lower than the
/// targets were added for.
fn human(kind: impl Fn(Target) -> Target) -> SkeletonRig {
    let mut rig = example("human").rig;
    rig.targets.clear();
    let pose = rig.skeleton_at(0.0);
    for name in ["left_hand", "right_hand", "left_foot", "right_foot"] {
        let joint = rig.skeleton.find(name).expect("a joint");
        let target = kind(rig.new_target(joint, &pose).expect("no target yet"));
        rig.targets.push(target);
    }
    let pelvis = rig.skeleton.find("pelvis").expect("a pelvis");
    rig.skeleton_mut().change(pelvis, |pelvis| pelvis.offset.y -= 0.05).expect("a joint");
    rig
}

fn evaluate(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("evaluate");
    let limbs = human(|target| target);
    assert!(limbs.targets.iter().all(|target| target.limb().is_some()));
    group.bench_function("human, four limbs", |it| it.iter(|| black_box(&limbs).evaluate(0.0)));
    let bodies = human(|target| Target { kind: TargetKind::WholeBody, ..target });
    let name = "human, four whole-body targets";
    group.bench_function(name, |it| it.iter(|| black_box(&bodies).evaluate(0.0)));
    let fk = human(|target| Target { influence: 0.0, ..target });
    group.bench_function("human, FK alone", |it| it.iter(|| black_box(&fk).evaluate(0.0)));

    let walk = example("walk");
    let hand = walk.skeleton().find("left_hand").expect("a hand");
    group.bench_function("trail of 240 frames of the walk", |it| {
        it.iter(|| -> Vec<Vec3> {
            let mut posed = walk.clone();
            let point = |frame: u32| {
                let time = f64::from(frame) / 30.0;
                posed.clone_from(&walk.at(time).into_document());
                posed.rig.skeleton_at(time).tip(hand)
            };
            (0..240).map(point).collect()
        });
    });
    group.finish();
}

criterion_group!(benches, evaluate);
criterion_main!(benches);
