use std::path::PathBuf;

use clap::ValueEnum;

use crate::cli::argument::{
    GuidesArgument, LengthArgument, NumberArgument, PointArgument, SizeArgument, ThemeName,
    TimeArgument,
};
use crate::cli::open;
use crate::cli::open_args::OpenArgs;
use crate::cli::time_limit::TimeLimitArgs;
use crate::cli::view_name::ViewName;
use crate::rig::{Crowd, Processor};

#[derive(clap::Args)]
#[command(after_help = "Without FILE the arm is drawn, posed by --hand, --twist and the lengths:
  ik-arm render -o arm.png --hand 250,120,60 --twist 30
With FILE its rig is drawn with its own camera, unless --view is given:
  ik-arm render human.json -o human.png --view front
Measure a crowd without drawing a picture:
  ik-arm render --crowd 100000 --frames 60 --timings --solve gpu")]
pub struct RenderArgs {
    #[arg(help = open::input_help("File to draw"), value_name = "FILE", conflicts_with_all = ["hand", "twist", "root", "upper", "lower"])]
    pub file: Option<PathBuf>,
    #[command(flatten)]
    pub open: OpenArgs,
    #[command(flatten)]
    pub time_limit: TimeLimitArgs,
    /// Time of the picture in seconds, at which keys and moving targets are evaluated
    #[arg(long, value_name = "S", allow_hyphen_values = true, default_value = "0")]
    pub time: TimeArgument,
    /// PNG file to write
    #[arg(short, long, value_name = "OUT.png", required_unless_present = "timings")]
    pub output: Option<PathBuf>,
    /// Width and height in pixels, each 1 to 8192
    #[arg(long, value_name = "WxH", default_value = "1280x800")]
    pub size: SizeArgument,
    /// Position of the Cursor, the hand's target, relative to the Root
    #[arg(long, value_name = "x,y,z", allow_hyphen_values = true)]
    pub hand: Option<PointArgument>,
    /// Socket twist: rotation of the elbow about the Pointer, in degrees
    #[arg(long, value_name = "DEG", allow_hyphen_values = true, default_value = "0")]
    pub twist: NumberArgument,
    /// Position of the Root (the shoulder) in the world
    #[arg(long, value_name = "x,y,z", allow_hyphen_values = true, default_value = "0,0,0")]
    pub root: PointArgument,
    /// Length of the upper limb
    #[arg(long, value_name = "N", allow_hyphen_values = true, default_value = "200")]
    pub upper: LengthArgument,
    /// Length of the lower limb
    #[arg(long, value_name = "N", allow_hyphen_values = true, default_value = "300")]
    pub lower: LengthArgument,
    /// Guides to show: any of cursor, pointer, inner, outer, circle; or none [default: the file's,
    /// else cursor,pointer]
    #[arg(long, value_name = "LIST")]
    pub guides: Option<GuidesArgument>,
    /// Camera that frames the rig from this side [default: the file's camera, else perspective]
    #[arg(long, value_enum)]
    pub view: Option<ViewName>,
    /// Colours of the picture
    #[arg(long, value_enum, default_value_t = ThemeName::Dark)]
    pub theme: ThemeName,
    /// Draw this many arms instead, each with a target of its own
    #[arg(
        long,
        value_name = "N",
        conflicts_with_all = ["file", "hand", "twist", "root", "guides"],
        value_parser = clap::value_parser!(u32).range(1..=i64::from(Crowd::MOST))
    )]
    pub crowd: Option<u32>,
    /// Solver of the crowd
    #[arg(long, value_enum, requires = "crowd", default_value_t = CrowdSolverName::Cpu)]
    pub solve: CrowdSolverName,
    /// Number of frames to time
    #[arg(
        long,
        value_name = "N",
        requires = "timings",
        default_value_t = 60,
        value_parser = clap::value_parser!(u32).range(1..=100_000)
    )]
    pub frames: u32,
    /// Print median frame times as one line of JSON
    #[arg(long)]
    pub timings: bool,
}

#[derive(Clone, Copy, ValueEnum)]
pub enum CrowdSolverName {
    /// Batch solver on all cores
    Cpu,
    /// Compute shader with the same formulas
    Gpu,
}

impl From<CrowdSolverName> for Processor {
    fn from(name: CrowdSolverName) -> Self {
        match name {
            CrowdSolverName::Cpu => Self::Cpu,
            CrowdSolverName::Gpu => Self::Gpu,
        }
    }
}
