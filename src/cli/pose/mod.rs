//! `ik-arm pose`: a file's skeleton at a time, as it stands or solved, as one line of JSON.

mod line;

use std::io::{self, Write as _};
use std::path::PathBuf;
use std::process::ExitCode;

use clap::builder::{PossibleValuesParser, TypedValueParser as _};
use thiserror::Error;

use super::argument::Time;
use super::open;
use crate::document::{RigKind, SkeletonRig};
use crate::io::{OpenError, Opened};
use crate::kinematics::chain_ik::{self, Method, Report, SolveError, SolverOptions};
use line::Line;

#[derive(clap::Args)]
#[command(after_help = r#"One line of JSON out, in the world:
  {"joints":[{"index":0,"name":"…","parent":null,"rotation_deg":[x,y,z],"base":[x,y,z],
    "tip":[x,y,z],"transform":[16 numbers, column after column]}, …],
   "targets":[{"joint":N,"target":[x,y,z],"tip":[x,y,z],"error":E}, …],
   "report":{"solver":"…","iterations":N,"error":E,"converged":true|false}}
Joints have the order and the numbers of the file; the targets are those that are enabled.
Without --solver no tip is brought anywhere and the report is null. A solve that does not converge is no failure.
A file that shows the arm has no pose here: `ik-arm solve` poses arms."#)]
pub struct Args {
    /// Document of ik-arm, .js3d scene of Scotty3D, .bvh, .glb or .gltf, or - for standard input
    #[arg(value_name = "FILE")]
    file: PathBuf,
    /// Which skeleton of a scene; the first if nothing is said
    #[arg(long, value_name = "NAME")]
    skeleton: Option<String>,
    /// When, in seconds: where keys, targets and what moves by itself are then
    #[arg(long, value_name = "S", allow_hyphen_values = true, default_value = "0")]
    time: Time,
    /// Bring the tips to the targets
    #[arg(long, value_parser = method())]
    solver: Option<Method>,
    /// At most so many iterations; what the file says, else the solver's own budget
    #[arg(long, value_name = "N", requires = "solver")]
    iterations: Option<u32>,
    /// How near every tip must come to its target; what the file says, else 1e-4 of the chain
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
    parser.map(|name| {
        let is_named = |method: &Method| method.name() == name;
        Method::ALL.into_iter().find(is_named).unwrap_or_default()
    })
}

fn tolerance(text: &str) -> Result<f32, String> {
    let number = text.trim().parse().ok();
    number
        .filter(|tolerance: &f32| tolerance.is_finite() && *tolerance > 0.0)
        .ok_or_else(|| format!("{text:?} is not a finite number above 0"))
}

/// Why there is no pose.
#[derive(Debug, Error)]
enum Failure {
    #[error(transparent)]
    Open(#[from] OpenError),
    #[error("{0} shows the arm, which `ik-arm solve` poses; pose is for skeletons")]
    Arm(String),
    #[error("{file}: {error}")]
    Solve { file: String, error: SolveError },
    #[error("{file}: {name:?} is beyond 3.4028235e38; bring it nearer to 0")]
    TooFar { file: String, name: String },
    #[error("cannot write to standard output: {0}")]
    Write(#[from] io::Error),
}

pub fn run(args: &Args) -> ExitCode {
    match pose(args) {
        Ok(()) => ExitCode::SUCCESS,
        Err(Failure::Write(error)) if error.kind() == io::ErrorKind::BrokenPipe => {
            ExitCode::SUCCESS
        }
        Err(failure) => super::fail(&failure),
    }
}

fn pose(args: &Args) -> Result<(), Failure> {
    let file = open::name(&args.file);
    let opened = open::open(&args.file, args.skeleton.as_deref())?;
    if opened.document.rig == RigKind::Arm {
        return Err(Failure::Arm(file));
    }
    let Opened { document, order, .. } = opened;
    let Time(time) = args.time;
    let mut rig = document.at(time).skeleton_rig;
    // As it stands then, where it moves by itself.
    rig.skeleton = rig.at(time);
    let report = match args.solver {
        Some(method) => Some(solved(&mut rig, args, method, &order, &file)?),
        None => None,
    };
    let line = Line::new(&rig, &order, time, report)
        .map_err(|name| Failure::TooFar { file, name: name.to_owned() })?;
    let line = serde_json::to_string(&line).map_err(io::Error::from)?;
    Ok(writeln!(io::stdout(), "{line}")?)
}

fn solved(
    rig: &mut SkeletonRig,
    args: &Args,
    method: Method,
    order: &[usize],
    file: &str,
) -> Result<Report, Failure> {
    let options = SolverOptions {
        method,
        iterations: args.iterations.or(rig.solver.iterations),
        tolerance: args.tolerance.or(rig.solver.tolerance),
        ..rig.solver
    };
    let targets = rig.goals(args.time.0);
    chain_ik::solve(rig.skeleton_mut(), &targets, &options).map_err(|error| {
        let file = file.to_owned();
        Failure::Solve { file, error: numbered_as_in_file(error, order) }
    })
}

fn numbered_as_in_file(mut error: SolveError, order: &[usize]) -> SolveError {
    use SolveError::{Flat, NoJoint, Option, Point, TwoBone, TwoTargets, Weight};
    match &mut error {
        NoJoint(joint)
        | TwoTargets(joint)
        | Point { joint, .. }
        | Weight { joint, .. }
        | TwoBone { joint, .. } => {
            *joint = order.iter().position(|other| other == joint).unwrap_or(*joint);
        }
        Option { .. } | Flat => {}
    }
    error
}
