//! Bakes of 240 frames: the figure of the Human example with four moving limb targets, and the
//! Snake.

use core::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use ik_arm::document::{Bake, Document, TargetMotion, TargetPath, Timeline};
use ik_arm::io::Example;
use ik_arm::kinematics::limb_ik::Limb;
use ik_arm::rig::{LimbSettings, TargetKind};
use pollster::block_on;

const FRAMES: Timeline = Timeline { start: 0.0, end: 239.0 / 30.0, frame_rate: 30.0 };

fn example(name: &str) -> Document {
    let opened = Example::find(name).and_then(|example| example.open().ok());
    opened.map(|opened| opened.document).unwrap_or_default()
}

/// The Human, its hands and feet on circles.
fn human() -> Document {
    let mut document = example("human");
    let rig = &mut document.rig;
    for target in &mut rig.targets {
        if Limb::ending_at(&rig.skeleton, target.joint).is_ok() {
            target.kind = TargetKind::Limb(LimbSettings::default());
        }
        target.influence = 1.0;
        target.motion = TargetMotion { path: TargetPath::Circle, radius: 0.1, period: 2.0 };
    }
    document
}

fn bakes(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("bake_240_frames");
    group.sample_size(10);
    for (name, document) in [("human", human()), ("snake", example("snake"))] {
        let settings = Bake { frames: FRAMES, ..Bake::of_timeline(&document) };
        group.bench_function(name, |bencher| {
            bencher
                .iter(|| block_on(settings.run(black_box(&document), async |_, _| true)).is_ok());
        });
    }
    group.finish();
}

criterion_group!(benches, bakes);
criterion_main!(benches);
