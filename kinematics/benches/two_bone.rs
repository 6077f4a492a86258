//! Times of `TwoBone::solve` (with the sine and cosine of the twist), of the textbook solution by
//! angles, and of `TwoBoneJob::run` and `job::batch`, on one thread and on all cores. Ends with a
//! table of the fastest passes, relative to `TwoBone::solve`.

use core::hint::black_box;
use std::time::Instant;

use criterion::{Criterion, criterion_group};
use glam::{Affine3A, EulerRot, Mat3, Quat, Vec3};
use ik_arm_kinematics::batch::{Points, QuaternionsMut};
use ik_arm_kinematics::job::TwoBoneJob;
use ik_arm_kinematics::job::batch::{JobInputs, JobOutputs, Joints, LenError, solve};
use ik_arm_kinematics::two_bone::{Reach, TwoBone};

/// 1,024 different targets with twists, so that the branch predictor cannot learn them.
fn cursors() -> Vec<(Vec3, f32)> {
    (0..1024)
        .map(|i| {
            let turn = i as f32 * 2.399_963;
            let height = 1.0 - (i as f32 + 0.5) / 512.0;
            let around = (1.0 - height * height).sqrt();
            let radius = 60.0 + 500.0 * ((i * 37) % 1024) as f32 / 1024.0;
            let direction = Vec3::new(around * turn.cos(), height, around * turn.sin());
            (direction * radius, turn % core::f32::consts::TAU)
        })
        .collect()
}

/// The method of Palmieri's report: arc tangents and an arc cosine, then rotation matrices.
fn by_angles(upper: f32, lower: f32, cursor: Vec3, twist: f32) -> Vec3 {
    let yaw = cursor.z.atan2(cursor.x);
    let flat = cursor.x.hypot(cursor.z);
    let pitch = cursor.y.atan2(flat);
    let distance = cursor.length().clamp((upper - lower).abs(), upper + lower);
    let cos = (upper * upper + distance * distance - lower * lower) / (2.0 * upper * distance);
    let shoulder = cos.clamp(-1.0, 1.0).acos();
    Mat3::from_rotation_y(-yaw)
        * Mat3::from_rotation_z(pitch)
        * Mat3::from_rotation_x(twist)
        * Vec3::new(upper * shoulder.cos(), upper * shoulder.sin(), 0.0)
}

/// A function under test, called for all limbs in a pass.
struct Case<'a> {
    name: &'static str,
    limbs: usize,
    pass: Box<dyn FnMut() + 'a>,
}

impl<'a> Case<'a> {
    fn of_each<T>(name: &'static str, items: &'a [T], mut run: impl FnMut(&T) + 'a) -> Self {
        let pass = Box::new(move || items.iter().for_each(|item| run(black_box(item))));
        Self { name, limbs: items.len(), pass }
    }
}

/// Inputs of all cases.
struct Inputs {
    arm: TwoBone,
    cursors: Vec<(Vec3, f32)>,
    jobs: Vec<TwoBoneJob>,
    jobs_without_twist: Vec<TwoBoneJob>,
    /// With and without twists.
    limbs: [Limbs; 2],
    /// Enough limbs for all cores.
    #[cfg(feature = "parallel")]
    many_limbs: [Limbs; 2],
}

impl Inputs {
    fn new() -> Self {
        let arm = TwoBone::new(200.0, 300.0).expect("lengths");
        let cursors = cursors();
        let jobs = jobs(arm, &cursors);
        let without_twist = |job: &TwoBoneJob| TwoBoneJob { twist: 0.0, ..*job };
        let limbs =
            |jobs: &[TwoBoneJob]| [Limbs::new(jobs), Limbs { twist: None, ..Limbs::new(jobs) }];
        Self {
            arm,
            cursors,
            jobs_without_twist: jobs.iter().map(without_twist).collect(),
            limbs: limbs(&jobs),
            #[cfg(feature = "parallel")]
            many_limbs: limbs(&jobs.repeat(16)),
            jobs,
        }
    }

    /// All cases, the solve first.
    fn cases(&self) -> Vec<Case<'_>> {
        self.cases_on_one_thread().into_iter().chain(self.cases_on_all_cores()).collect()
    }

    fn cases_on_one_thread(&self) -> [Case<'_>; 6] {
        let solve_arm = |(cursor, twist): &(Vec3, f32)| {
            black_box(black_box(self.arm).solve(*cursor, *twist));
        };
        let solve_by_angles = |(cursor, twist): &(Vec3, f32)| {
            black_box(by_angles(black_box(200.0), black_box(300.0), *cursor, *twist));
        };
        let run = |job: &TwoBoneJob| {
            let _ = black_box(job.run());
        };
        let [limbs, limbs_without_twist] = &self.limbs;
        [
            Case::of_each("solve", &self.cursors, solve_arm),
            Case::of_each("by angles", &self.cursors, solve_by_angles),
            Case::of_each("job", &self.jobs, run),
            Case::of_each("job without twist", &self.jobs_without_twist, run),
            limbs.case("job batch", solve),
            limbs_without_twist.case("job batch without twist", solve),
        ]
    }

    #[cfg(feature = "parallel")]
    fn cases_on_all_cores(&self) -> [Case<'_>; 2] {
        use ik_arm_kinematics::job::batch::solve_on_all_cores;
        let [limbs, limbs_without_twist] = &self.many_limbs;
        let name = "job batch without twist on all cores";
        [
            limbs.case("job batch on all cores", solve_on_all_cores),
            limbs_without_twist.case(name, solve_on_all_cores),
        ]
    }

    #[cfg(not(feature = "parallel"))]
    fn cases_on_all_cores(&self) -> [Case<'_>; 0] {
        []
    }
}

fn two_bone(criterion: &mut Criterion) {
    let inputs = Inputs::new();
    let mut group = criterion.benchmark_group("two_bone");
    for Case { name, limbs, mut pass } in inputs.cases() {
        group.throughput(criterion::Throughput::Elements(limbs as u64));
        group.bench_function(name, |bencher| bencher.iter(&mut pass));
    }
    group.finish();
}

/// Prints the fastest of many passes of each case, and its ratio to the solve. The cases take
/// turns, so that all of them meet the same changes of the machine's clock.
fn print_ratios() {
    const PASSES: usize = 2_000;
    let inputs = Inputs::new();
    let mut cases = inputs.cases();
    let mut fastest = vec![f64::INFINITY; cases.len()];
    for _ in 0..PASSES {
        for (Case { limbs, pass, .. }, fastest) in cases.iter_mut().zip(&mut fastest) {
            let start = Instant::now();
            pass();
            *fastest = fastest.min(1e9 * start.elapsed().as_secs_f64() / *limbs as f64);
        }
    }
    println!("\nFastest of {PASSES} passes, in turn:\n");
    println!("| case | ns per limb | relative to `solve` |\n| --- | --- | --- |");
    for (Case { name, .. }, time) in cases.iter().zip(&fastest) {
        println!("| {name} | {time:.1} | {:.2} |", time / fastest[0]);
    }
}

/// Jobs of a limb of a skeleton that stands somewhere, bent, with a pole, a hinge and a twist.
fn jobs(arm: TwoBone, cursors: &[(Vec3, f32)]) -> Vec<TwoBoneJob> {
    let local = |turn: f32, along: f32| {
        let turn = Quat::from_euler(EulerRot::XYZ, 0.3 * turn.sin(), 0.2, 0.9 + 0.5 * turn.cos());
        Affine3A::from_rotation_translation(turn, along * Vec3::X)
    };
    let job = |(cursor, twist): &(Vec3, f32)| {
        let stand = Affine3A::from_rotation_translation(Quat::from_rotation_y(*twist), *cursor);
        let start = stand * local(*twist, 0.0);
        let middle = start * local(2.0 * twist, arm.upper());
        let end = middle * local(0.0, arm.lower());
        let target = start.transform_point3(*cursor);
        let job = TwoBoneJob::new(start, middle, end, target);
        TwoBoneJob { pole: Some(Vec3::Y), hinge: Some(Vec3::Z), twist: *twist, ..job }
    };
    cursors.iter().map(job).collect()
}

type Column = [Vec<f32>; 3];

/// Jobs as a structure of arrays.
struct Limbs {
    start: [Column; 4],
    middle: [Column; 4],
    end: Column,
    target: Column,
    pole: Column,
    hinge: Column,
    twist: Option<Vec<f32>>,
}

impl Limbs {
    fn new(jobs: &[TwoBoneJob]) -> Self {
        let column = |point: &dyn Fn(&TwoBoneJob) -> Vec3| {
            [0, 1, 2].map(|part| jobs.iter().map(|job| point(job)[part]).collect())
        };
        let joint = |joint: &dyn Fn(&TwoBoneJob) -> Affine3A| {
            [
                column(&|job| joint(job).matrix3.x_axis.into()),
                column(&|job| joint(job).matrix3.y_axis.into()),
                column(&|job| joint(job).matrix3.z_axis.into()),
                column(&|job| joint(job).translation.into()),
            ]
        };
        Self {
            start: joint(&|job| job.start),
            middle: joint(&|job| job.middle),
            end: column(&|job| job.end.translation.into()),
            target: column(&|job| job.target),
            pole: column(&|job| job.pole.unwrap_or_default()),
            hinge: column(&|job| job.hinge.unwrap_or_default()),
            twist: Some(jobs.iter().map(|job| job.twist).collect()),
        }
    }

    fn case<'a>(
        &'a self,
        name: &'static str,
        solve: impl Fn(&JobInputs<'_>, JobOutputs<'_>) -> Result<(), LenError> + 'a,
    ) -> Case<'a> {
        let inputs = self.inputs();
        let zeros = || vec![0.0; inputs.len()];
        let [mut start, mut middle] = [(); 2].map(|()| [zeros(), zeros(), zeros(), zeros()]);
        let (mut hand_error, mut reach) = (zeros(), vec![Ok(Reach::Reached); inputs.len()]);
        let pass = move || {
            let outputs = JobOutputs {
                start_correction: QuaternionsMut::of(&mut start),
                middle_correction: QuaternionsMut::of(&mut middle),
                hand_error: &mut hand_error,
                reach: &mut reach,
            };
            solve(black_box(&inputs), outputs).expect("arrays of equal lengths");
        };
        Case { name, limbs: inputs.len(), pass: Box::new(pass) }
    }

    fn inputs(&self) -> JobInputs<'_> {
        fn points([x, y, z]: &Column) -> Points<'_> {
            Points { x, y, z }
        }
        fn joints([x, y, z, translation]: &[Column; 4]) -> Joints<'_> {
            Joints {
                x_axis: points(x),
                y_axis: points(y),
                z_axis: points(z),
                translation: points(translation),
            }
        }
        JobInputs {
            start: joints(&self.start),
            middle: joints(&self.middle),
            end: points(&self.end),
            target: points(&self.target),
            pole: Some(points(&self.pole)),
            hinge: Some(points(&self.hinge)),
            twist: self.twist.as_deref(),
            weight: None,
            softness: 0.0,
        }
    }
}

criterion_group!(benches, two_bone);

fn main() {
    benches();
    if std::env::args().any(|argument| argument == "--bench") {
        print_ratios();
    }
}
