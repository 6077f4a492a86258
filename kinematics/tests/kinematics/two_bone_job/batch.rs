//! Batches of jobs: bit-identical to running each job alone.

use glam::{Affine3A, Vec3};
use ik_arm_kinematics::batch::{Points, QuaternionsMut};
use ik_arm_kinematics::job::batch::{JobInputs, JobOutputs, Joints, LenError, solve};
use ik_arm_kinematics::job::{JobError, TwoBoneJob};
use ik_arm_kinematics::two_bone::Reach;

use crate::common::Random;
use crate::two_bone_job::skeleton::*;

type Column = [Vec<f32>; 3];

/// Jobs as a structure of arrays.
struct Limbs {
    start: [Column; 4],
    middle: [Column; 4],
    end: Column,
    target: Column,
    pole: Option<Column>,
    hinge: Option<Column>,
    twist: Option<Vec<f32>>,
    weight: Option<Vec<f32>>,
    softness: f32,
}

/// Results with the bits of each number.
#[derive(Clone, Debug, PartialEq)]
struct Answers {
    corrections: [[Vec<u32>; 4]; 2],
    hand_error: Vec<u32>,
    reach: Vec<Result<Reach, JobError>>,
}

type Solve = fn(&JobInputs<'_>, JobOutputs<'_>) -> Result<(), LenError>;

fn column(jobs: &[TwoBoneJob], point: impl Fn(&TwoBoneJob) -> Vec3) -> Column {
    [0, 1, 2].map(|part| jobs.iter().map(|job| point(job)[part]).collect())
}

fn columns(jobs: &[TwoBoneJob], joint: impl Fn(&TwoBoneJob) -> Affine3A) -> [Column; 4] {
    [
        column(jobs, |job| joint(job).matrix3.x_axis.into()),
        column(jobs, |job| joint(job).matrix3.y_axis.into()),
        column(jobs, |job| joint(job).matrix3.z_axis.into()),
        column(jobs, |job| joint(job).translation.into()),
    ]
}

fn points([x, y, z]: &Column) -> Points<'_> {
    Points { x, y, z }
}

impl Limbs {
    fn new(jobs: &[TwoBoneJob]) -> Self {
        Self {
            start: columns(jobs, |job| job.start),
            middle: columns(jobs, |job| job.middle),
            end: column(jobs, |job| job.end.translation.into()),
            target: column(jobs, |job| job.target),
            pole: Some(column(jobs, |job| job.pole.unwrap_or_default())),
            hinge: Some(column(jobs, |job| job.hinge.unwrap_or_default())),
            twist: Some(jobs.iter().map(|job| job.twist).collect()),
            weight: Some(jobs.iter().map(|job| job.weight).collect()),
            softness: 0.0,
        }
    }

    fn inputs(&self) -> JobInputs<'_> {
        JobInputs {
            start: joints(&self.start),
            middle: joints(&self.middle),
            end: points(&self.end),
            target: points(&self.target),
            pole: self.pole.as_ref().map(points),
            hinge: self.hinge.as_ref().map(points),
            twist: self.twist.as_deref(),
            weight: self.weight.as_deref(),
            softness: self.softness,
        }
    }

    fn solved_by(&self, solve: Solve) -> Answers {
        let limbs = self.twist.as_ref().map_or(self.end[0].len(), Vec::len);
        let none = || [(); 4].map(|()| vec![0.0_f32; limbs]);
        let (mut start, mut middle, mut hand_error) = (none(), none(), vec![0.0; limbs]);
        let mut reach = vec![Ok(Reach::TooClose); limbs];
        let outputs = JobOutputs {
            start_correction: QuaternionsMut::of(&mut start),
            middle_correction: QuaternionsMut::of(&mut middle),
            hand_error: &mut hand_error,
            reach: &mut reach,
        };
        solve(&self.inputs(), outputs).expect("arrays of equal lengths");
        let bits = |of: Vec<f32>| of.into_iter().map(f32::to_bits).collect();
        Answers {
            corrections: [start, middle].map(|turns| turns.map(bits)),
            hand_error: bits(hand_error),
            reach,
        }
    }

    /// The jobs, each run alone.
    fn run_alone(&self) -> Answers {
        let inputs = self.inputs();
        let mut answers =
            Answers { corrections: Default::default(), hand_error: Vec::new(), reach: Vec::new() };
        for limb in 0..inputs.len() {
            let result = inputs.job(limb).run();
            let (turns, hand_error) = match result {
                Ok(of) => ([of.start_correction, of.middle_correction], of.hand_error),
                Err(_) => Default::default(),
            };
            for (of, turn) in answers.corrections.iter_mut().zip(turns) {
                for (of, part) in of.iter_mut().zip(turn.to_array()) {
                    of.push(part.to_bits());
                }
            }
            let hand_error = if result.is_ok() { hand_error } else { f32::NAN };
            answers.hand_error.push(hand_error.to_bits());
            answers.reach.push(result.map(|of| of.reach));
        }
        answers
    }
}

fn joints([x, y, z, translation]: &[Column; 4]) -> Joints<'_> {
    Joints {
        x_axis: points(x),
        y_axis: points(y),
        z_axis: points(z),
        translation: points(translation),
    }
}

/// Usual jobs, and with `any` also jobs of every other kind and refused ones.
fn jobs(random: &mut Random, count: usize, any: bool) -> Vec<TwoBoneJob> {
    let mut job = || {
        let skeleton = match random.below(8) {
            0 if any => Skeleton::straight(),
            _ => Skeleton::random(random),
        };
        let direction = random.direction().as_dvec3();
        let target = skeleton.point_in_reach(direction, random.within(-0.2..1.2).into());
        let job = TwoBoneJob {
            pole: Some(random.vector(1.0)),
            hinge: Some(random.vector(1.0)),
            twist: random.within(-4.0..4.0),
            ..skeleton.job(target)
        };
        match random.below(16) {
            _ if !any => job,
            0 => TwoBoneJob { pole: Some(job.target), ..job },
            1 => TwoBoneJob { target: job.start.translation.into(), ..job },
            2 => TwoBoneJob { start: Affine3A::from_scale(Vec3::new(1.0, 0.0, 1.0)), ..job },
            3 => TwoBoneJob { middle: Affine3A::from_scale(Vec3::new(1.0, 2.0, 1.0)), ..job },
            4 => TwoBoneJob { target: Vec3::new(0.0, f32::NAN, 0.0), ..job },
            5 => TwoBoneJob { hinge: Some(Vec3::new(0.0, f32::INFINITY, 0.0)), ..job },
            6 => TwoBoneJob { weight: random.within(0.0..1.0), ..job },
            7 => TwoBoneJob { weight: 2.0, ..job },
            8 => TwoBoneJob { end: job.middle, ..job },
            9 => TwoBoneJob { twist: f32::NEG_INFINITY, ..job },
            10 => TwoBoneJob { start: Affine3A::from_scale(Vec3::ZERO), ..job },
            _ => job,
        }
    };
    (0..count).map(|_| job()).collect()
}

const SOLVES: &[Solve] = &[
    solve,
    #[cfg(feature = "parallel")]
    ik_arm_kinematics::job::batch::solve_on_all_cores,
];

#[test]
fn a_batch_gives_the_bits_of_its_jobs_alone() {
    let mut random = Random(7);
    for (count, any) in [(0, true), (1, false), (127, true), (129, false), (9_000, true)] {
        let limbs = Limbs::new(&jobs(&mut random, count, any));
        let alone = limbs.run_alone();
        for solve in SOLVES {
            assert!(limbs.solved_by(*solve) == alone, "{count} limbs differ");
        }
    }
}

#[test]
fn options_that_are_not_given_are_those_of_a_job_without_them() {
    let jobs = jobs(&mut Random(8), 300, true);
    for option in 0..5 {
        let mut limbs = Limbs::new(&jobs);
        match option {
            0 => limbs.pole = None,
            1 => limbs.hinge = None,
            2 => limbs.twist = None,
            3 => limbs.weight = None,
            _ => limbs.softness = 0.3,
        }
        assert!(limbs.solved_by(solve) == limbs.run_alone(), "option {option}");
    }
}

#[test]
fn the_error_of_a_limb_leaves_the_others_alone() {
    let mut jobs = jobs(&mut Random(9), 40, false);
    let before = Limbs::new(&jobs).solved_by(solve);
    jobs[17].target.y = f32::NAN;
    let after = Limbs::new(&jobs).solved_by(solve);
    assert_eq!(
        after.reach[17].map_err(|error| error.to_string()),
        Err("target must be finite".into())
    );
    assert!(f32::from_bits(after.hand_error[17]).is_nan());
    for limb in (0..jobs.len()).filter(|limb| *limb != 17) {
        assert_eq!(before.hand_error[limb], after.hand_error[limb]);
        assert_eq!(before.reach[limb], after.reach[limb]);
    }
}

#[test]
fn arrays_of_different_lengths_are_refused_by_name() {
    let jobs = jobs(&mut Random(10), 3, false);
    let said = |change: fn(&mut Limbs)| {
        let mut limbs = Limbs::new(&jobs);
        change(&mut limbs);
        let (mut start, mut middle) = ([[0.0; 3]; 4], [[0.0; 3]; 4]);
        let outputs = JobOutputs {
            start_correction: QuaternionsMut::of(&mut start),
            middle_correction: QuaternionsMut::of(&mut middle),
            hand_error: &mut [0.0; 3],
            reach: &mut [Ok(Reach::Reached); 3],
        };
        solve(&limbs.inputs(), outputs).expect_err("refused").to_string()
    };
    assert_eq!(
        said(|limbs| limbs.start[3][2].push(0.0)),
        "start.translation.z has 4 numbers; target.x has 3, and there must be as many"
    );
    assert_eq!(
        said(|limbs| limbs.hinge.as_mut().expect("axes")[1].truncate(1)),
        "hinge.y has 1 numbers; target.x has 3, and there must be as many"
    );
    assert_eq!(
        said(|limbs| limbs.weight = Some(Vec::new())),
        "weight has 0 numbers; target.x has 3, and there must be as many"
    );
}

#[test]
fn a_usual_job_is_solved_as_by_the_steps_for_any_job() {
    // A weight that is not 1, even by half an ulp, is not usual.
    let nearly = 1.0_f32.next_down();
    for job in jobs(&mut Random(11), 20_000, false) {
        let (usual, any) = (run(job), run(TwoBoneJob { weight: nearly, ..job }));
        for (usual, any) in [
            (usual.start_correction, any.start_correction),
            (usual.middle_correction, any.middle_correction),
        ] {
            let off = apart(usual.as_dquat(), any.as_dquat());
            assert!(off < 2e-6, "{off:e}: {job:?}");
        }
    }
}
