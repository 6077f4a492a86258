//! `ik-arm check`: what is wrong with a motion, as one line of JSON.

use clap::ValueEnum;
use serde::Serialize;

use super::argument::frame_rate;
use super::open::{self, InputArgs};
use super::report::{CommandError, print_json};
use super::time_limit::TimeLimitArgs;
use crate::document::{FramePop, Inspection, LostSpan, SkeletonRig, Timeline, Track};
use crate::io::{Opened, Progress};
use crate::kinematics::skeleton::JointId;
use crate::words;

#[derive(clap::Args)]
#[command(
    after_help = r#"Poses every frame of the file's timeline as the window plays it. The output is one line of JSON:
  {"targets":[{"joint":N,"worst":E,"time":T}, …],
   "lost":[{"target":N,"from":T,"to":T,"miss":E,"sentence":"…"}, …],
   "pops":[{"time":T,"joint":N,"ratio":R,"cause":"…","sentence":"…"}, …],
   "at_limits":[{"joint":N,"from":T,"to":T}, …],
   "slides":[{"target":N,"from":T,"to":T,"by":E}, …]}
Joints are indices in the file's order; targets are named by their joint. Times are seconds, of the
first and the last frame of a span; distances are in world units.
  targets    for each target that poses: the largest distance from its tip, and when
  lost       frames in which a target is missed although its skeleton can reach it: the pose from
             which the motion came is in the way. Miss is the largest distance from its tip
  pops       frames in which a joint moves more than twice as far as the targets do (each measured
             from where the joint angles alone take it; a limb's elbow may move farther near its
             base). Ratio is that of the joint to the targets. Causes: target_jump, fk_jump,
             switched, lost, found, by_itself, limit_met, limit_left, straight, folded, singular,
             straight_fk, turns_over, returns, at_limit, seam, unknown
  at_limits  frames in which an angle of a joint that a target turns is at an end of its range
  slides     frames in which a target of influence 1 rests (moves less than 0.0001 of its chain's
             length, for three frames or more) and its tip moves by more than 0.001: a foot that
             slides while it is planted. By is how far
A file without a motion is checked in its one pose. Documents that show the arm are refused.

  ik-arm check walk.glb --loop --fail-on pops,lost,slides"#,
    mut_arg("file", |file| file.help(open::input_help("File to check")))
)]
pub struct CheckArgs {
    #[command(flatten)]
    input: InputArgs,
    /// Frames per second [default: the timeline's]
    #[arg(long, value_name = "N", allow_hyphen_values = true, value_parser = frame_rate)]
    fps: Option<f64>,
    /// Also look at the step from the last frame to the first, as for a motion that repeats
    #[arg(long = "loop")]
    loops: bool,
    /// Exit with code 1 if there are any of these, separated by commas
    #[arg(long, value_name = "WHAT", value_delimiter = ',')]
    fail_on: Vec<Fault>,
    #[command(flatten)]
    time_limit: TimeLimitArgs,
}

/// A kind of fault that fails the command.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Fault {
    /// Joints that jump
    Pops,
    /// Targets that are lost
    Lost,
    /// Feet that slide while they are planted
    Slides,
}

pub fn run(args: &CheckArgs) -> Result<(), CommandError> {
    let file = args.input.name();
    let limit = args.time_limit.start_long(&args.input.file);
    let Opened { document, order, .. } = args.input.open()?;
    let frame_rate = args.fps.unwrap_or(document.timeline.frame_rate);
    let mut frames = Timeline { frame_rate, ..document.timeline };
    if !document.is_animated() {
        frames.end = frames.start;
    }
    let track = Track::new(&document);
    let inspect = async |progress: &Progress| {
        let total = frames.frames();
        let go_on = async |done| progress.step(done, total).await.is_ok();
        Inspection::new(&track, frames, args.loops, go_on).await
    };
    let Some(found) = limit.run(inspect)? else {
        return Err(CommandError::Stopped(file));
    };
    print_json(&CheckLine::new(&found, &document.rig, &order))?;
    args.failure(&found).map_or(Ok(()), |faults| Err(CommandError::Faults { file, faults }))
}

impl CheckArgs {
    /// The faults that fail the command, in words; `None` without any.
    fn failure(&self, found: &Inspection) -> Option<String> {
        let counts = [
            (Fault::Pops, found.pops.len(), "pop", "pops"),
            (Fault::Lost, found.lost.len(), "lost target", "lost targets"),
            (Fault::Slides, found.slides.len(), "slide", "slides"),
        ];
        let fails = counts.into_iter().filter(|it| it.1 > 0 && self.fail_on.contains(&it.0));
        let words: Vec<String> = fails
            .map(|(_, count, one, several)| {
                format!("{count} {}", if count == 1 { one } else { several })
            })
            .collect();
        (!words.is_empty()).then(|| words.join(", "))
    }
}

/// Output of the command.
#[derive(Serialize)]
struct CheckLine {
    targets: Vec<WorstLine>,
    lost: Vec<LostLine>,
    pops: Vec<PopLine>,
    at_limits: Vec<LimitLine>,
    slides: Vec<SlideLine>,
}

#[derive(Serialize)]
struct WorstLine {
    joint: JointId,
    worst: f32,
    time: f64,
}

#[derive(Serialize)]
struct LostLine {
    target: JointId,
    from: f64,
    to: f64,
    miss: f32,
    sentence: String,
}

#[derive(Serialize)]
struct PopLine {
    time: f64,
    joint: JointId,
    ratio: f32,
    cause: &'static str,
    sentence: String,
}

#[derive(Serialize)]
struct LimitLine {
    joint: JointId,
    from: f64,
    to: f64,
}

#[derive(Serialize)]
struct SlideLine {
    target: JointId,
    from: f64,
    to: f64,
    by: f32,
}

impl CheckLine {
    /// The output for an inspection; `order` has the rig's joints in the file's order.
    fn new(found: &Inspection, rig: &SkeletonRig, order: &[JointId]) -> Self {
        let mut indices = vec![JointId::default(); order.len()];
        for (index, joint) in order.iter().enumerate() {
            indices[joint.index()] = JointId::new(index);
        }
        let index = |joint: JointId| indices[joint.index()];
        let targets = found.worst.iter().map(|it| WorstLine {
            joint: index(it.joint),
            worst: it.error,
            time: it.time,
        });
        let lost = found.lost.iter().map(|span| {
            let LostSpan { target, from, to, miss } = *span;
            LostLine {
                target: index(target),
                from,
                to,
                miss,
                sentence: words::lost(rig, target, miss),
            }
        });
        let pops = found.pops.iter().map(|FramePop { time, pop }| PopLine {
            time: *time,
            joint: index(pop.joint),
            ratio: pop.ratio,
            cause: pop.cause.name(),
            sentence: words::pop(rig, pop),
        });
        let limits = found.at_limits.iter();
        let limits =
            limits.map(|it| LimitLine { joint: index(it.joint), from: it.from, to: it.to });
        let slides = found.slides.iter().map(|it| SlideLine {
            target: index(it.target),
            from: it.from,
            to: it.to,
            by: it.by,
        });
        Self {
            targets: targets.collect(),
            lost: lost.collect(),
            pops: pops.collect(),
            at_limits: limits.collect(),
            slides: slides.collect(),
        }
    }
}
