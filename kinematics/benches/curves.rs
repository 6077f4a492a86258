//! Time to evaluate each twist reference, and a value between keys.

use core::hint::black_box;

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use glam::Vec3;
use ik_arm_kinematics::spline::Spline;
use ik_arm_kinematics::twist::{Stereographic, TransportedFrame, TwistReference};
use ik_arm_kinematics::two_bone::Pointer;

fn facings() -> Vec<Pointer> {
    let pointer = |i: usize| {
        let turn = i as f32 * 2.399_963;
        let height = 1.0 - (i as f32 + 0.5) / 512.0;
        let around = (1.0 - height * height).sqrt();
        let towards = Vec3::new(around * turn.cos(), height, around * turn.sin());
        Pointer::towards(towards, Pointer::default())
    };
    (0..1024).map(pointer).collect()
}

fn twist_reference(criterion: &mut Criterion) {
    let facings = facings();
    let mut group = criterion.benchmark_group("twist");
    group.throughput(Throughput::Elements(facings.len() as u64));
    let references = [
        ("up", TwistReference::Up),
        ("pole", TwistReference::Pole(Vec3::new(0.0, 400.0, -100.0))),
        ("stereographic", TwistReference::Stereographic(Stereographic::default())),
        ("transport", TwistReference::Transport),
    ];
    for (name, reference) in references {
        let last = Some(TransportedFrame::new(Pointer::default()));
        group.bench_function(name, |bencher| {
            bencher.iter(|| {
                for pointer in &facings {
                    black_box(reference.outward(black_box(*pointer), black_box(last)));
                }
            });
        });
    }
    group.finish();
}

/// Values at times all along a curve of so many keys.
fn spline(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("spline");
    for keys in [4, 32, 1024] {
        let mut spline = Spline::default();
        for key in 0..keys {
            let time = f64::from(key) * 0.5 + f64::from(key % 3) * 0.1;
            spline.insert(time, Vec3::splat((key * 37 % 101) as f32));
        }
        let end = f64::from(keys) * 0.5;
        let times = (0..1024).map(|i| f64::from(i) / 1024.0 * end).collect::<Vec<_>>();
        group.throughput(Throughput::Elements(times.len() as u64));
        group.bench_function(BenchmarkId::new("keys", keys), |bencher| {
            bencher.iter(|| {
                for time in &times {
                    black_box(spline.at(black_box(*time)));
                }
            });
        });
    }
    group.finish();
}

criterion_group!(benches, twist_reference, spline);
criterion_main!(benches);
