//! `ik-arm pose`: the pose of a file's skeleton at a time, as one line of JSON.

mod output;
mod targets;

use std::io::{self, Write as _};

use clap::builder::{PossibleValuesParser, TypedValueParser as _};

use super::argument::time;
use super::open::{self, InputArgs};
use super::report::{CommandError, print_json, say};
use super::time_limit::TimeLimitArgs;
use crate::document::{Posed, Track};
use crate::io::{OpenOptions, Opened};
use crate::kinematics::chain_ik::{Method, SolveError, SolverOptions};
use crate::kinematics::skeleton::JointId;
use output::{AnsweredPose, FileList, PoseLine};
use targets::GivenTarget;

#[derive(clap::Args)]
#[command(
    after_help = r#"The pose is that of the window at this time: FK (joint angles, keys, path), then the targets.
The file is not changed. The output is one line of JSON, in world space:
  {"joints":[{"index":0,"name":"…","parent":null,"rotation_deg":[x,y,z],"base":[x,y,z],
    "tip":[x,y,z],"transform":[16 numbers, column-major]}, …],
   "targets":[{"joint":N,"kind":"limb"|"chain"|"whole_body","influence":I,"target":[x,y,z],
    "tip":[x,y,z],"error":E,"rotation_error_deg":A,"aim_error_deg":A,
    "limb":{"root":[x,y,z],"pointer":[x,y,z],"twist_deg":T,
    "reach":"reached"|"too_far"|"too_close"|"limited"|null,"upper":D1,"lower":D2,"distance":D,
    "along":H,"out":O,"shoulder_angle_deg":A,"elbow_angle_deg":A}|null}, …],
   "balance":{"over":[x,z]|null,"centre":[x,z],"error":E},
   "report":{"solver":"…","iterations":N,"error":E,"converged":true|false},
   "why":[{"cause":"…","target":"JOINT","joints":["…"],"sentence":"…","remedy":"…",
    "residual_with_remedy":E,"rotation_error_with_remedy_deg":A}, …]}
Joints keep the file's order and indices. Targets are the enabled ones; error is the distance from
tip to target in the printed pose, and rotation_error_deg the angle from the rotation of the hand or
foot, or of another target's joint, to that which the target asks for; aim_error_deg is the
angle from the axis that is aimed to its point. Both are null if the target asks for none. Limb has
the figures of a limb's target in the evaluated pose: the place of its base, the unit vector from
there to the hand, the angle of the elbow about it from the Limb frame, the lengths of the bones, the distance to the hand,
the elbow's distances along and from the Pointer, and the angles at the base and at the elbow; null
for other targets, and with --fk and --solver. Balance is there for a document with one: where its
centre of mass is on the ground, and where it should be. The report is that of --solver, or
of the solver of the whole-body targets, else null, also if there is nothing to solve. Why lists the
causes for which targets are not reached, the most likely first, each with the remedy that helps
most and the distance from tip to target and the angle that it leaves, or null if no remedy was
found; it is empty if all targets are reached, and with --fk. Causes: out_of_reach, limits,
rotation_limits, turn, locked, conflict, stalled, lost, singular, out_of_iterations, balance,
short_chain, influence. A solve that does not converge is not an error. `ik-arm solve` solves two
bones without a file.

  ik-arm pose human.json --target left_hand=0.4,1.3,0.3 --rotation left_hand=0,90,0"#,
    mut_arg("file", |file| file.help(open::input_help("File to pose")))
)]
pub struct PoseArgs {
    #[command(flatten)]
    input: InputArgs,
    /// Print what the file has, instead of a pose: its skeletons, animations and targets
    #[arg(long, conflicts_with_all = ["fk", "solver", "targets", "rotations", "aims"])]
    list: bool,
    /// Time in seconds at which keys and moving targets are evaluated
    #[arg(long, value_name = "S", allow_hyphen_values = true, default_value = "0", value_parser = time)]
    time: f64,
    /// Print the FK pose, without the targets
    #[arg(long, conflicts_with_all = ["solver", "targets", "rotations", "aims"])]
    fk: bool,
    /// Add targets to the hands, feet and head of a human-like figure, where they are at this time
    #[arg(long, conflicts_with_all = ["list", "fk"])]
    add_targets: bool,
    /// Put a target at a point in the world, or move the one that is there; repeatable. JOINT is a
    /// name or an index. A hand or foot at the end of two bones gets a limb target for its base,
    /// any other joint a whole-body target for its tip; a target of influence 0 gets influence 1
    #[arg(long = "target", value_name = "JOINT=x,y,z")]
    targets: Vec<GivenTarget>,
    /// Turn the joint of a target to these angles in degrees, as those of a joint, R_z·R_y·R_x, in
    /// the world; repeatable. Of a limb it is the hand or foot. A joint without a target gets one:
    /// of a limb with a place where it is, of any other joint with a free place
    #[arg(long = "rotation", value_name = "JOINT=x,y,z", allow_hyphen_values = true)]
    rotations: Vec<GivenTarget>,
    /// Aim the joint of a target, not of a limb's, at a point in the world; repeatable. The axis is
    /// that of the target's aim, else z of the joint's own space, where faces look. A joint without a
    /// target gets one with a free place: its tip may go anywhere
    #[arg(long = "aim", value_name = "JOINT=x,y,z", allow_hyphen_values = true)]
    aims: Vec<GivenTarget>,
    /// Solve all enabled targets together from the FK pose with this solver, at full influence;
    /// beside others, targets of chains are left out
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
    #[command(flatten)]
    time_limit: TimeLimitArgs,
}

fn method() -> impl clap::builder::TypedValueParser<Value = Method> {
    let parser = PossibleValuesParser::new(Method::ALL.map(Method::name));
    parser.try_map(|name| name.parse::<Method>())
}

fn tolerance(text: &str) -> Result<f32, &'static str> {
    let tolerance = text.trim().parse().ok();
    tolerance
        .filter(|tolerance: &f32| tolerance.is_finite() && *tolerance > 0.0)
        .ok_or("tolerance must be finite and above 0")
}

pub fn run(args: &PoseArgs) -> Result<(), CommandError> {
    let file = args.input.name();
    args.time_limit.start_short(&args.input.file);
    // A list needs no camera, and a skeleton is solved to be framed by one.
    let options = OpenOptions { without_camera: args.list, ..args.input.options() };
    let opened = open::open(&args.input.file, &options)?;
    if args.list {
        let list = FileList::new(&opened, |name| open::another(&args.input.file, name));
        let text = serde_json::to_string_pretty(&list).map_err(io::Error::from)?;
        return Ok(writeln!(io::stdout(), "{text}")?);
    }
    let Opened { mut document, order, .. } = opened;
    if args.add_targets {
        open::add_targets(&mut document, args.time, &file)?;
    }
    let track = Track::new(&document);
    let given = [&args.targets, &args.rotations, &args.aims].map(Vec::as_slice);
    let posed = targets::with_targets(&track, args.time, given, &order)
        .map_err(|error| CommandError::of_file(file.clone(), error))?;
    let answer = answered(&posed, args, &order, &file)?;
    if let Some(remark) = &answer.remark {
        say(&format_args!("{file}: {remark}"));
    }
    let line = PoseLine::new(&posed, &answer, &order)
        .map_err(|name| CommandError::Overflow { file, name: name.to_owned() })?;
    print_json(&line)
}

/// The pose that the arguments ask for.
fn answered(
    posed: &Posed,
    args: &PoseArgs,
    order: &[JointId],
    file: &str,
) -> Result<AnsweredPose, CommandError> {
    let (rig, time) = (&posed.document().rig, posed.time());
    let Some(method) = args.solver else {
        let answer = if args.fk { AnsweredPose::fk } else { AnsweredPose::by_targets };
        return Ok(answer(posed));
    };
    if rig.targets_at(time).is_empty() {
        let reason =
            "has no enabled target, so there is nothing to solve: --target JOINT=x,y,z sets one";
        say(&format_args!("{file} {reason}"));
        return Ok(AnsweredPose::fk(posed));
    }
    let options = SolverOptions {
        method,
        iterations: args.iterations.or(rig.solver.iterations),
        tolerance: args.tolerance.or(rig.solver.tolerance),
        ..rig.solver
    };
    AnsweredPose::solved(posed, &options)
        .map_err(|error| CommandError::of_file(file.to_owned(), with_file_indices(error, order)))
}

/// Replaces the joint's index in an error by the index of the same joint in the file.
fn with_file_indices(mut error: SolveError, order: &[JointId]) -> SolveError {
    use SolveError::{CannotOrient, CannotStiffen, NoJoint, Point, TwoBone, TwoTargets, Weight};
    match &mut error {
        NoJoint(joint)
        | TwoTargets(joint)
        | CannotOrient { joint, .. }
        | CannotStiffen { joint, .. }
        | Point { joint, .. }
        | Weight { joint, .. }
        | TwoBone { joint, .. } => {
            *joint = order.iter().position(|other| other == joint).map_or(*joint, JointId::new);
        }
        _ => {}
    }
    error
}
