//! The command line.

mod answer;
mod asked;
mod batch;
mod bodies;
mod caution;
mod commas;
mod common;
mod depth;
mod equals;
mod limits;
mod mode;
mod others;
mod parse;
mod pose;
mod query;
mod robot;

use std::path::PathBuf;

use clap::error::ErrorKind;
use clap::{ArgMatches, Args, CommandFactory as _, FromArgMatches as _, Parser, Subcommand};
use cloudtouch_io::LengthUnit;

pub(crate) use answer::{AnswerArguments, exit_code};
pub(crate) use batch::BatchArguments;
pub(crate) use bodies::{BodyOptions, PairArguments, ScanArguments};
pub(crate) use caution::Refine;
pub(crate) use common::CommonArguments;
use depth::DepthArguments;
use limits::LimitArguments;
pub(crate) use mode::ModeName;
use parse::parse_tolerance;
pub(crate) use pose::PoseArguments;
pub(crate) use query::QueryArguments;
pub(crate) use robot::RobotOptions;

/// Sensor specs, for the help of the commands that take them.
const SENSORS: &str = "\
Sensor specs (metres, pixels, radians):
  auto                                    what the cloud suggests, as info does
  exact                                   no noise
  iso:STD                                 the same standard deviation in every direction
  axes:SX,SY,SZ                           one along each axis of the file
  stereo:BASELINE,FOCAL_PX,DISPARITY_STD  a stereo camera; depth noise grows with z squared
  kinect                                  a structured-light depth camera
  tof:STD,PER_METRE                       a time-of-flight camera; range noise grows with the range
  lidar:RANGE_STD,BEAM_RAD                a laser scanner
  grid:RESOLUTION                         points rounded to the cells of a grid
  per-point                               the covariance columns of the file";

const EXAMPLES: &str = "\
Examples:
  cloudtouch demo
  cloudtouch info scan.pcd
  cloudtouch query scan.pcd gripper.stl --sensor kinect --translate 0.4,0,0.9
  cloudtouch query depth.png gripper.stl --intrinsics 525,525,319.5,239.5 --sensor kinect
  cloudtouch path scan.pcd gripper.stl --poses approach.csv
  cloudtouch scene workcell.json
  cloudtouch robot scan.pcd arm.urdf --joints home.json
  cloudtouch batch cases.json --jsonl answers.jsonl
  cloudtouch query run.mcap#/points@12.5 gripper.stl   (built with --features mcap)

Exit codes: 0 done, 1 error, 2 wrong usage; with --exit-code of query, path, scene and robot
  0 free, 10 uncertain, 20 in collision, 30 undecided.";

const SCENE_FILE: &str = "\
A scene file, of which docs/scenes.md has every field:
  {\"format\": 1, \"length_unit\": \"m\",
   \"bodies\": [{\"name\": \"room\", \"file\": \"room.pcd\", \"sensor\": \"kinect\"},
              {\"name\": \"hand\", \"file\": \"hand.stl\", \"unit\": \"mm\", \"pose\": [...]},
              {\"name\": \"cup\", \"file\": \"cup.obj\", \"attached_to\": \"hand\"}],
   \"allowed\": [[\"hand\", \"cup\"]]}";

/// How likely is it that the surfaces behind two noisy point clouds touch?
#[derive(Debug, Parser)]
#[command(name = "cloudtouch", version, after_help = EXAMPLES)]
pub(crate) struct Arguments {
    #[command(subcommand)]
    pub command: Command,
    /// Log what happens inside to standard error (repeat for more)
    #[arg(short, long, action = clap::ArgAction::Count, global = true)]
    verbose: u8,
}

impl Arguments {
    /// Reads the command line, or ends with what is wrong with it.
    pub(crate) fn read() -> Self {
        let tool = Self::command();
        let end = |error| equals::told(others::told(commas::told(error), &tool), &tool).exit();
        let matches = tool.clone().try_get_matches().unwrap_or_else(end);
        let read = Self::from_arg_matches(&matches).unwrap_or_else(|error| error.exit());
        read.check().unwrap_or_else(|message| refused(tool, &matches, message).exit());
        read
    }

    /// Refuses options that contradict one another; the message names them.
    fn check(&self) -> Result<(), String> {
        if let Some(common) = self.common() {
            common.check()?;
        }
        match &self.command {
            Command::Query(arguments) => arguments.check(),
            Command::Batch(arguments) => arguments.asked.check(&[], &[]),
            _ => Ok(()),
        }
    }

    fn common(&self) -> Option<&CommonArguments> {
        match &self.command {
            Command::Query(arguments) => Some(&arguments.asked.common),
            Command::Path(arguments) => Some(&arguments.common),
            Command::Scene(arguments) => Some(&arguments.common),
            Command::Robot(arguments) => Some(&arguments.common),
            Command::Batch(arguments) => Some(&arguments.asked.common),
            Command::Info(_) | Command::Demo(_) | Command::Settings => None,
        }
    }

    /// Whether answers come with what they cost.
    pub(crate) fn shows_work(&self) -> bool {
        self.verbose > 0
    }

    pub(crate) fn log_level(&self) -> tracing::Level {
        match self.verbose {
            0 => tracing::Level::WARN,
            1 => tracing::Level::INFO,
            2 => tracing::Level::DEBUG,
            _ => tracing::Level::TRACE,
        }
    }
}

/// The error of options that contradict one another: as for any other wrong use, with the usage of the command.
fn refused(mut tool: clap::Command, matches: &ArgMatches, message: String) -> clap::Error {
    // The names of all commands begin with that of the tool from here on.
    tool.build();
    let command = matches.subcommand_name().and_then(|name| tool.find_subcommand(name));
    command.unwrap_or(&tool).clone().error(ErrorKind::ArgumentConflict, message)
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// One object in one scene at one pose
    Query(Box<QueryArguments>),
    /// One object along a path in one scene; nothing between its poses is missed
    Path(Box<PathArguments>),
    /// Many bodies, each with its own pose: which of them may touch
    Scene(Box<SceneArguments>),
    /// A robot (URDF) in a scan, at positions of its joints: which link touches what
    Robot(Box<RobotArguments>),
    /// Many poses from a case file; scenes and objects are prepared once
    Batch(Box<BatchArguments>),
    /// What a cloud or mesh file holds, and which sensor suits it
    Info(InfoArguments),
    /// The piano in the room, from free to deep; needs no file
    Demo(DemoArguments),
    /// All settings of the paper's mode with their defaults, as a file for --settings
    Settings,
}

#[derive(Debug, Args)]
#[command(after_help = SENSORS)]
pub(crate) struct PathArguments {
    /// Cloud or mesh of the surroundings (.pcd .ply .xyz .txt .csv .png .stl .obj)
    pub scene: PathBuf,
    /// Cloud or mesh of the object
    pub object: PathBuf,
    /// JSON list of 4x4 row-major matrices, or lines of x,y,z,qw,qx,qy,qz
    #[arg(long, value_name = "PATH.json|csv")]
    pub poses: PathBuf,
    /// Turns about and along one axis from pose to pose; not straight
    #[arg(long)]
    pub screw: bool,
    /// How finely the path is looked at, as a share of it
    #[arg(long, value_name = "SHARE", value_parser = parse_tolerance, default_value_t = 0.01,
          allow_negative_numbers = true)]
    pub tolerance: f64,
    #[command(flatten)]
    pub answer: AnswerArguments,
    #[command(flatten)]
    pub common: CommonArguments,
    #[command(flatten)]
    pub pair: PairArguments,
}

#[derive(Debug, Args)]
#[command(after_help = format!("{SCENE_FILE}\n\n{SENSORS}"))]
pub(crate) struct SceneArguments {
    /// Scene file (JSON); its paths are relative to it
    pub scene: PathBuf,
    #[command(flatten)]
    pub answer: AnswerArguments,
    #[command(flatten)]
    pub common: CommonArguments,
}

#[derive(Debug, Args)]
#[command(after_help = SENSORS)]
pub(crate) struct RobotArguments {
    /// Cloud or mesh of the surroundings (.pcd .ply .xyz .txt .csv .png .stl .obj)
    pub scan: PathBuf,
    #[command(flatten)]
    pub robot: RobotOptions,
    #[command(flatten)]
    pub answer: AnswerArguments,
    #[command(flatten)]
    pub common: CommonArguments,
    #[command(flatten)]
    pub of_scan: ScanArguments,
}

#[derive(Debug, Args)]
pub(crate) struct InfoArguments {
    /// Cloud or mesh file (.pcd .ply .xyz .txt .csv .png .stl .obj), or a recording (.mcap)
    pub file: PathBuf,
    /// Length unit of a mesh file: m, cm, mm or in [m]
    #[arg(long)]
    pub unit: Option<LengthUnit>,
    /// Length unit of a cloud file: m, cm, mm or in [m]
    #[arg(long, value_name = "UNIT")]
    pub cloud_unit: Option<LengthUnit>,
    #[command(flatten)]
    pub depth: DepthArguments,
    #[command(flatten)]
    pub limits: LimitArguments,
}

#[derive(Debug, Args)]
#[command(group = answer::written(&["ply", "html"]))]
pub(crate) struct DemoArguments {
    /// How to estimate: calibrated, or paper (as printed)
    #[arg(long, value_enum, hide_possible_values = true, default_value_t = ModeName::Calibrated)]
    pub mode: ModeName,
    /// Write the pose of the full report in colour
    #[arg(long, value_name = "OUT.ply")]
    pub ply: Option<PathBuf>,
    /// Write a page that shows all poses in any browser
    #[arg(long, value_name = "FILE")]
    pub html: Option<PathBuf>,
    /// Replace an output file that is there already
    #[arg(long, requires = "written")]
    pub force: bool,
}
