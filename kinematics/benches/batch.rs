//! Time to solve many arms, relative to copying as many bytes as the solver reads and writes:
//! the copy is the lower bound for anything limited by memory bandwidth.

use core::hint::black_box;

use criterion::{
    BenchmarkId, Criterion, SamplingMode, Throughput, criterion_group, criterion_main,
};
use ik_arm_kinematics::batch::{
    ArmBatch, BatchBones, BatchPositions, BatchRotations, BatchTwist, Points, PointsMut,
    QuaternionsMut,
};
use ik_arm_kinematics::two_bone::TwoBone;

/// Numbers of arms: within the cache of one core, and beyond the caches of all.
const SIZES: [(usize, &str); 3] = [(4 << 10, "4 Ki"), (1 << 20, "1 Mi"), (4 << 20, "4 Mi")];

struct Data {
    cursor: [Vec<f32>; 3],
    angle: Vec<f32>,
    cos: Vec<f32>,
    sin: Vec<f32>,
    upper: Vec<f32>,
    lower: Vec<f32>,
    elbow: [Vec<f32>; 3],
    hand: [Vec<f32>; 3],
    rotations: [[Vec<f32>; 4]; 2],
}

impl Data {
    /// Cursors in a cube twice as wide as the arm is long, and twists all around.
    fn new(arms: usize) -> Self {
        let numbers = |seed: usize, least: f32, most: f32| {
            let share = |arm: usize| {
                let mixed = (arm * 8 + seed).wrapping_mul(0x9e37_79b9_7f4a_7c15);
                (mixed >> 40) as f32 / (1_u64 << 24) as f32
            };
            (0..arms).map(|arm| least + (most - least) * share(arm)).collect::<Vec<_>>()
        };
        let angle = numbers(3, -3.0, 3.0);
        let none = || vec![0.0; arms];
        Self {
            cursor: [0, 1, 2].map(|seed| numbers(seed, -500.0, 500.0)),
            cos: angle.iter().map(|angle| angle.cos()).collect(),
            sin: angle.iter().map(|angle| angle.sin()).collect(),
            angle,
            upper: numbers(4, 100.0, 300.0),
            lower: numbers(5, 100.0, 300.0),
            elbow: [none(), none(), none()],
            hand: [none(), none(), none()],
            rotations: [[none(), none(), none(), none()], [none(), none(), none(), none()]],
        }
    }

    /// Input arrays, and output arrays to be filled.
    fn split(
        &mut self,
        kind: Kind,
    ) -> (ArmBatch<'_>, BatchPositions<'_>, Option<BatchRotations<'_>>) {
        let Self { cursor: [x, y, z], angle, cos, sin, upper, lower, elbow, hand, rotations } =
            self;
        let bones = match kind {
            Kind::OwnBones => BatchBones::Each { upper, lower },
            _ => BatchBones::Same(TwoBone::new(200.0, 300.0).expect("lengths")),
        };
        let twist = match kind {
            Kind::Angles => BatchTwist::Angle(angle),
            _ => BatchTwist::CosSin { cos, sin },
        };
        let arms = ArmBatch::new(bones, Points { x, y, z }, twist).expect("a batch");
        let positions = BatchPositions { elbow: PointsMut::of(elbow), hand: PointsMut::of(hand) };
        let [of_upper, of_lower] = rotations;
        let rotations = matches!(kind, Kind::Rotations).then(|| BatchRotations {
            upper: QuaternionsMut::of(of_upper),
            lower: QuaternionsMut::of(of_lower),
        });
        (arms, positions, rotations)
    }

    /// The solver reads five arrays and writes six, or fourteen with rotations. This makes as many
    /// copies, some from the same array.
    fn copy(&mut self, kind: Kind) {
        let Self { cursor, cos, sin, elbow, hand, rotations, .. } = self;
        let from = cursor.iter().chain([&*cos, &*sin]).cycle();
        let to = elbow.iter_mut().chain(hand);
        if matches!(kind, Kind::Rotations) {
            to.chain(rotations.iter_mut().flatten())
                .zip(from)
                .for_each(|(to, from)| to.copy_from_slice(from));
        } else {
            to.zip(from).for_each(|(to, from)| to.copy_from_slice(from));
        }
    }
}

#[derive(Clone, Copy)]
enum Kind {
    Places,
    Rotations,
    OwnBones,
    Angles,
}

const KINDS: [(Kind, &str); 4] = [
    (Kind::Places, "elbow and hand"),
    (Kind::Rotations, "with rotations"),
    (Kind::OwnBones, "own bones"),
    (Kind::Angles, "angles"),
];

fn batch(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("batch");
    group.sampling_mode(SamplingMode::Flat).sample_size(40);
    for (arms, name) in SIZES {
        let mut data = Data::new(arms);
        group.throughput(Throughput::Elements(arms as u64));
        for (kind, what) in KINDS {
            group.bench_function(BenchmarkId::new(what, name), |bencher| {
                bencher.iter(|| {
                    let (arms, positions, rotations) = black_box(&mut data).split(kind);
                    arms.solve(positions, rotations)
                });
            });
        }
        for (kind, what) in [(Kind::Places, "copy"), (Kind::Rotations, "copy with rotations")] {
            group.bench_function(BenchmarkId::new(what, name), |bencher| {
                bencher.iter(|| black_box(&mut data).copy(kind));
            });
        }
        #[cfg(feature = "parallel")]
        group.bench_function(BenchmarkId::new("all cores", name), |bencher| {
            bencher.iter(|| {
                let (arms, positions, rotations) = black_box(&mut data).split(Kind::Places);
                arms.solve_on_all_cores(positions, rotations)
            });
        });
    }
    group.finish();
}

criterion_group!(benches, batch);
criterion_main!(benches);
