//! `ik-arm pose`: the pose of a file's skeleton at a time, solved or not, as one line of JSON.

mod pose_line;

use std::io::{self, Write as _};
use std::path::PathBuf;
use std::process::ExitCode;

use clap::builder::{PossibleValuesParser, TypedValueParser as _};
use thiserror::Error;

use super::argument::TimeArgument;
use super::open;
use super::report::fail;
use crate::document::{RigKind, SkeletonRig};
use crate::io::{OpenError, Opened};
use crate::kinematics::chain_ik::{self, Method, Report, SolveError, SolverOptions};
use crate::kinematics::skeleton::JointId;
use pose_line::PoseLine;

#[derive(clap::Args)]
#[command(after_help = r#"The output is one line of JSON, in world space:
  {"joints":[{"index":0,"name":"…","parent":null,"rotation_deg":[x,y,z],"base":[x,y,z],
    "tip":[x,y,z],"transform":[16 numbers, column-major]}, …],
   "targets":[{"joint":N,"target":[x,y,z],"tip":[x,y,z],"error":E}, …],
   "report":{"solver":"…","iterations":N,"error":E,"converged":true|false}}
Joints keep the file's order and indices. Targets are the enabled ones; error is the distance from
tip to target. Without --solver nothing is solved and report is null. A solve that does not converge
is not an error. For documents that show the arm use `ik-arm solve`."#)]
pub struct PoseArgs {
    /// File to pose: ik-arm document (.json), Scotty3D scene (.js3d), .bvh, .glb or .gltf; - reads
    /// standard input
    #[arg(value_name = "FILE")]
    file: PathBuf,
    /// Skeleton to pose, if the file has several [default: the first]
    #[arg(long, value_name = "NAME")]
    skeleton: Option<String>,
    /// Time in seconds at which keys and moving targets are evaluated
    #[arg(long, value_name = "S", allow_hyphen_values = true, default_value = "0")]
    time: TimeArgument,
    /// Solve the targets with this solver
    #[arg(long, value_parser = method())]
    solver: Option<Method>,
    /// Maximum number of iterations [default: the file's, else the solver's own]
    #[arg(long, value_name = "N", requires = "solver")]
    iterations: Option<u32>,
    /// Largest distance between tip and target that counts as converged [default: the file's, else
    /// 1e-4 of the chain length]
    #[arg(
        long,
        value_name = "T",
        requires = "solver",
        allow_hyphen_values = true,
        value_parser = tolerance
    )]
    tolerance: Option<f32>,
}

fn method() -> impl clap::builder::TypedValueParser<Value = Method> {
    let parser = PossibleValuesParser::new(Method::ALL.map(Method::name));
    parser.try_map(|name| name.parse::<Method>())
}

fn tolerance(text: &str) -> Result<f32, String> {
    let number = text.trim().parse().ok();
    number
        .filter(|tolerance: &f32| tolerance.is_finite() && *tolerance > 0.0)
        .ok_or_else(|| "tolerance must be finite and above 0".to_owned())
}

/// Reasons why no pose is printed.
#[derive(Debug, Error)]
enum PoseCommandError {
    #[error(transparent)]
    Open(#[from] OpenError),
    #[error("{0} shows the arm; pose needs a skeleton, and `ik-arm solve` poses arms")]
    Arm(String),
    #[error("{file}: {error}")]
    Solve { file: String, error: SolveError },
    #[error("{file}: the position of joint {name:?} must be within ±3.4028235e38")]
    Overflow { file: String, name: String },
    #[error("cannot write to standard output: {0}")]
    Write(#[from] io::Error),
}

pub fn run(args: &PoseArgs) -> ExitCode {
    match pose(args) {
        Ok(()) => ExitCode::SUCCESS,
        Err(PoseCommandError::Write(error)) if error.kind() == io::ErrorKind::BrokenPipe => {
            ExitCode::SUCCESS
        }
        Err(error) => fail(&error),
    }
}

fn pose(args: &PoseArgs) -> Result<(), PoseCommandError> {
    let file = open::name(&args.file);
    let opened = open::open(&args.file, args.skeleton.as_deref())?;
    if opened.document.rig == RigKind::Arm {
        return Err(PoseCommandError::Arm(file));
    }
    let Opened { document, order, .. } = opened;
    let TimeArgument(time) = args.time;
    let mut rig = document.evaluate(time).skeleton_rig;
    // Applies Follow path, which moves the whole skeleton.
    rig.skeleton = rig.skeleton_at(time);
    let report = match args.solver {
        Some(method) => Some(solve(&mut rig, args, method, &order, &file)?),
        None => None,
    };
    let line = PoseLine::new(&rig, &order, time, report)
        .map_err(|name| PoseCommandError::Overflow { file, name: name.to_owned() })?;
    let line = serde_json::to_string(&line).map_err(io::Error::from)?;
    Ok(writeln!(io::stdout(), "{line}")?)
}

fn solve(
    rig: &mut SkeletonRig,
    args: &PoseArgs,
    method: Method,
    order: &[JointId],
    file: &str,
) -> Result<Report, PoseCommandError> {
    let options = SolverOptions {
        method,
        iterations: args.iterations.or(rig.solver.iterations),
        tolerance: args.tolerance.or(rig.solver.tolerance),
        ..rig.solver
    };
    let targets = rig.targets_at(args.time.0);
    chain_ik::solve(rig.skeleton_mut(), &targets, &options).map_err(|error| {
        let file = file.to_owned();
        PoseCommandError::Solve { file, error: with_file_indices(error, order) }
    })
}

/// Replaces the joint's index in an error by the index of the same joint in the file.
fn with_file_indices(mut error: SolveError, order: &[JointId]) -> SolveError {
    use SolveError::{NoJoint, Point, TwoBone, TwoTargets, Weight};
    match &mut error {
        NoJoint(joint)
        | TwoTargets(joint)
        | Point { joint, .. }
        | Weight { joint, .. }
        | TwoBone { joint, .. } => {
            *joint = order.iter().position(|other| other == joint).map_or(*joint, JointId::new);
        }
        _ => {}
    }
    error
}
