//! Time of evaluating the Human with limb targets and with whole-body targets, of frames in which
//! a hand is dragged and the body follows or is balanced, of tracks, of a reach region, and of a
//! trail over 240 frames.

use core::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use glam::Vec3;
use ik_arm::document::{BalanceTarget, Document, SkeletonRig, Target, Track};
use ik_arm::io::Example;
use ik_arm::rig::{Aim, Carried, ReachRegion, TargetKind};

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

/// The Human with six targets: hands, feet with their rotations, a place of the pelvis, and an aim
/// of the head, for which the whole body turns.
fn six_targets() -> SkeletonRig {
    let mut rig = example("human").rig;
    let pose = rig.skeleton_at(0.0);
    let [pelvis, head] = ["pelvis", "head"].map(|name| rig.skeleton.find(name).expect("a joint"));
    let place = rig.new_target(pelvis, &pose).expect("no target yet");
    let home = place.home - 0.03 * Vec3::Y;
    rig.targets.push(Target { home, influence: 1.0, ..place });
    let look = rig.target(head).expect("a look");
    let aim = Some(Aim { axis: Vec3::Z, point: Vec3::new(0.2, 1.2, 1.0) });
    rig.targets[look] = Target { aim, kind: TargetKind::WholeBody, ..rig.targets[look] };
    rig
}

/// Steps of a drag of the left hand to `way` from its place, and back.
fn drag(rig: &mut SkeletonRig, way: Vec3) -> Carried {
    const STEPS: u8 = 60;
    let home = rig.targets[0].home;
    let mut carried = Carried::default();
    for step in (0..STEPS).chain((0..STEPS).rev()) {
        rig.targets[0].home = home + way * (f32::from(step) / f32::from(STEPS));
        carried = black_box(&*rig).step(0.0, &carried).1;
    }
    rig.targets[0].home = home;
    carried
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

    let mut six = six_targets();
    let (near, far) = (Vec3::new(0.1, 0.1, 0.1), Vec3::new(0.4, 0.2, 0.3));
    group.bench_function("human, six targets, 120 frames of a drag within reach", |it| {
        it.iter(|| drag(&mut six, near));
    });
    group.bench_function("human, six targets, 120 frames of a drag beyond reach", |it| {
        it.iter(|| drag(&mut six, far));
    });

    let mut own = example("human").rig;
    group.bench_function("human, its own targets, 120 frames of a drag within reach", |it| {
        it.iter(|| drag(&mut own, near));
    });
    group.bench_function("human, its own targets, 120 frames of a drag beyond reach", |it| {
        it.iter(|| drag(&mut own, far));
    });

    let mut balanced = example("human").rig;
    balanced.balance = Some(BalanceTarget::default());
    group.bench_function("human, balanced, 120 frames of a drag", |it| {
        it.iter(|| drag(&mut balanced, far));
    });
    let reaching = example("reaching-down");
    let hand_of_reaching = reaching.skeleton().find("left_hand").expect("a hand");
    group.bench_function("track of 165 frames of Reaching down", |it| {
        it.iter(|| Track::new(black_box(&reaching)).at(5.5).skeleton().tip(hand_of_reaching));
    });
    let human = example("human").rig;
    group.sample_size(10);
    group.bench_function("reach region of the hand of the human", |it| {
        it.iter(|| ReachRegion::of(black_box(&human), 0, 0.0));
    });
    group.sample_size(100);

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
