//! The command line.

mod caution;
mod pose;
mod robot;

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand, ValueEnum};
use cloudtouch::{FilterSettings, OutlierSettings, PaperSettings, Pooling, QuerySettings};
use cloudtouch_cli::numbers::{self, Rigid};
use cloudtouch_io::{LengthUnit, ReadLimits};

use crate::sensor::SensorChoice;
use crate::settings_file::{self, Settings};

pub(crate) use caution::Refine;
use caution::{CautionArguments, EffortArguments};
pub(crate) use pose::PoseArguments;
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
  lidar:RANGE_STD,BEAM_RAD                a laser scanner
  grid:RESOLUTION                         points rounded to the cells of a grid
  per-point                               the covariance columns of the file";

const EXAMPLES: &str = "\
Examples:
  cloudtouch demo
  cloudtouch info scan.pcd
  cloudtouch query scan.pcd gripper.stl --sensor kinect --translate 0.4,0,0.9
  cloudtouch path scan.pcd gripper.stl --poses approach.csv
  cloudtouch scene workcell.json
  cloudtouch robot scan.pcd arm.urdf --joints home.json
  cloudtouch batch cases.json --jsonl answers.jsonl

Exit codes: 0 done, 1 error, 2 wrong usage; query --exit-code tells the verdict.";

/// How likely is it that the surfaces behind two noisy point clouds touch?
#[derive(Debug, Parser)]
#[command(version, after_help = EXAMPLES)]
pub(crate) struct Arguments {
    #[command(subcommand)]
    pub command: Command,
    /// Log what happens inside to standard error (repeat for more)
    #[arg(short, long, action = clap::ArgAction::Count, global = true)]
    verbose: u8,
}

impl Arguments {
    /// Refuses options that contradict one another; the message names them.
    pub(crate) fn check(&self) -> Result<(), String> {
        match &self.command {
            Command::Query(arguments) => arguments.check(),
            Command::Path(arguments) => arguments.check(),
            Command::Scene(arguments) => arguments.check(),
            Command::Robot(arguments) => arguments.check(),
            Command::Batch(arguments) => arguments.common.check(&[]),
            Command::Info(_) | Command::Demo(_) | Command::Settings => Ok(()),
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
pub(crate) struct QueryArguments {
    /// Cloud or mesh of the surroundings (.pcd .ply .xyz .txt .csv .stl .obj)
    pub scene: PathBuf,
    /// Cloud or mesh of the object
    pub object: PathBuf,
    #[command(flatten)]
    pub pose: PoseArguments,
    /// Print the report as one JSON object
    #[arg(long, help_heading = "Output")]
    pub json: bool,
    /// Add to the JSON the probability of each point, and both ways of pooling them
    #[arg(long, requires = "json", help_heading = "Output")]
    pub points: bool,
    /// Paper: add to the JSON each classifier trained, with f, xi, alpha, v and b
    #[arg(long, requires = "json", help_heading = "Output")]
    pub explain: bool,
    /// Write the points of both clouds with their probabilities as a table
    #[arg(long, value_name = "OUT.csv", help_heading = "Output")]
    pub csv: Option<PathBuf>,
    /// Another scan of the same scene, in the same frame; repeatable
    #[arg(long, value_name = "FILE", help_heading = "Files")]
    pub also: Vec<PathBuf>,
    /// Paper: text file with one kappa for each row of the scene
    #[arg(long, value_name = "FILE", conflicts_with = "also", help_heading = "Files")]
    pub kappas: Option<PathBuf>,
    /// Exit with 0 free, 10 uncertain, 20 in collision, 30 undecided
    #[arg(long, help_heading = "Output")]
    pub exit_code: bool,
    /// Write both bodies, redder with probability, contacts green; a mesh as a mesh
    #[arg(long, value_name = "OUT.ply", help_heading = "Output")]
    pub ply: Option<PathBuf>,
    /// Replace an output file that is there already
    #[arg(long, help_heading = "Output")]
    pub force: bool,
    #[command(flatten)]
    pub common: CommonArguments,
}

impl QueryArguments {
    fn check(&self) -> Result<(), String> {
        let of_the_paper = [("--explain", self.explain), ("--kappas", self.kappas.is_some())];
        if self.common.mode == ModeName::Paper && self.pose.pose_std.is_some() {
            return Err("--pose-std has no effect in the paper's mode: leave it out".to_owned());
        }
        self.common.check(&of_the_paper)
    }
}

#[derive(Debug, Args)]
#[command(after_help = SENSORS)]
pub(crate) struct PathArguments {
    /// Cloud or mesh of the surroundings (.pcd .ply .xyz .txt .csv .stl .obj)
    pub scene: PathBuf,
    /// Cloud or mesh of the object
    pub object: PathBuf,
    /// JSON list of 4x4 row-major matrices, or lines of x,y,z,qw,qx,qy,qz
    #[arg(long, value_name = "PATH.json|csv")]
    pub poses: PathBuf,
    /// How finely the path is looked at, as a share of it
    #[arg(long, value_name = "SHARE", value_parser = numbers::finite, default_value_t = 0.01)]
    pub tolerance: f64,
    /// Print the answer as one JSON object
    #[arg(long, help_heading = "Output")]
    pub json: bool,
    /// Exit with 0 free, 10 uncertain, 20 in collision, 30 undecided
    #[arg(long, help_heading = "Output")]
    pub exit_code: bool,
    #[command(flatten)]
    pub common: CommonArguments,
}

impl PathArguments {
    fn check(&self) -> Result<(), String> {
        if self.common.mode == ModeName::Paper {
            return Err("path is of the calibrated mode: leave --mode out".to_owned());
        }
        if self.common.margin.is_some() {
            return Err("--margin has no effect on a path: leave it out".to_owned());
        }
        self.common.check(&[])
    }
}

#[derive(Debug, Args)]
#[command(after_help = SENSORS)]
pub(crate) struct SceneArguments {
    /// Scene file (JSON); its paths are relative to it
    pub scene: PathBuf,
    /// Print the answer as one JSON object
    #[arg(long, help_heading = "Output")]
    pub json: bool,
    /// Exit with the worst verdict: 0 free, 10 uncertain, 20 in collision, 30 undecided
    #[arg(long, help_heading = "Output")]
    pub exit_code: bool,
    #[command(flatten)]
    pub common: CommonArguments,
}

impl SceneArguments {
    fn check(&self) -> Result<(), String> {
        let common = &self.common;
        if common.mode == ModeName::Paper {
            return Err("scene is of the calibrated mode: leave --mode out".to_owned());
        }
        // Of these a scene file says more, or a body has no use for them.
        let of_pairs = [
            ("--object-sensor", common.object_sensor.is_some()),
            ("--sensor-pose", common.sensor_pose.is_some()),
            ("--margin", common.margin.is_some()),
            ("--collision-map", common.collision_map.is_some()),
            ("--robot", !common.robot.is_empty()),
        ];
        if let Some((option, _)) = of_pairs.iter().find(|(_, is_given)| *is_given) {
            return Err(format!("{option} is of one scene and one object: leave it out"));
        }
        common.check(&[])
    }
}

#[derive(Debug, Args)]
#[command(after_help = SENSORS)]
pub(crate) struct RobotArguments {
    /// Cloud or mesh of the surroundings (.pcd .ply .xyz .txt .csv .stl .obj)
    pub scan: PathBuf,
    #[command(flatten)]
    pub robot: RobotOptions,
    /// Print the answer as one JSON object
    #[arg(long, help_heading = "Output")]
    pub json: bool,
    /// Exit with the worst verdict: 0 free, 10 uncertain, 20 in collision, 30 undecided
    #[arg(long, help_heading = "Output")]
    pub exit_code: bool,
    #[command(flatten)]
    pub common: CommonArguments,
}

impl RobotArguments {
    fn check(&self) -> Result<(), String> {
        let common = &self.common;
        if common.mode == ModeName::Paper {
            return Err("robot is of the calibrated mode: leave --mode out".to_owned());
        }
        if common.object_sensor.is_some() || common.margin.is_some() {
            return Err("--object-sensor and --margin are of one object: leave them out".to_owned());
        }
        if !common.robot.is_empty() {
            return Err("--robot is of a scan without a URDF: give --scan-joints".to_owned());
        }
        common.check(&[])
    }
}

#[derive(Debug, Args)]
#[command(after_help = SENSORS)]
pub(crate) struct BatchArguments {
    /// Case file (JSON); its paths are relative to it
    pub cases: PathBuf,
    /// Print one JSON object per case instead of a table
    #[arg(long, help_heading = "Output")]
    pub json: bool,
    /// Write one JSON object per case to this file
    #[arg(long, value_name = "OUT.jsonl", help_heading = "Output")]
    pub jsonl: Option<PathBuf>,
    /// Replace an output file that is there already
    #[arg(long, help_heading = "Output")]
    pub force: bool,
    /// Sensor of files whose path contains NAME; the first match counts
    #[arg(long, value_name = "NAME=SPEC", value_parser = parse_sensor_for,
          help_heading = "Files")]
    pub sensor_for: Vec<(String, SensorChoice)>,
    #[command(flatten)]
    pub common: CommonArguments,
}

#[derive(Debug, Args)]
pub(crate) struct InfoArguments {
    /// Cloud or mesh file (.pcd .ply .xyz .txt .csv .stl .obj)
    pub file: PathBuf,
    /// Length unit of a mesh file: m, cm, mm or in [m]
    #[arg(long)]
    pub unit: Option<LengthUnit>,
    /// Length unit of a cloud file: m, cm, mm or in [m]
    #[arg(long, value_name = "UNIT")]
    pub cloud_unit: Option<LengthUnit>,
    #[command(flatten)]
    pub limits: LimitArguments,
}

/// How large a file may be.
#[derive(Debug, Args)]
pub(crate) struct LimitArguments {
    /// Read at most this many points of a file
    #[arg(long, value_name = "N", default_value_t = ReadLimits::default().points,
          help_heading = "Limits")]
    max_points: usize,
    /// Read at most this many triangles of a file
    #[arg(long, value_name = "N", default_value_t = ReadLimits::default().triangles,
          help_heading = "Limits")]
    max_triangles: usize,
    /// Read at most this many bytes of a file
    #[arg(long, value_name = "N", default_value_t = ReadLimits::default().bytes,
          help_heading = "Limits")]
    max_bytes: u64,
}

impl LimitArguments {
    pub(crate) fn read_limits(&self) -> ReadLimits {
        ReadLimits { bytes: self.max_bytes, points: self.max_points, triangles: self.max_triangles }
    }
}

#[derive(Debug, Args)]
pub(crate) struct DemoArguments {
    /// How to estimate: calibrated, or paper (as printed)
    #[arg(long, value_enum, hide_possible_values = true, default_value_t = ModeName::Calibrated)]
    pub mode: ModeName,
    /// Write the pose of the full report in colour
    #[arg(long, value_name = "OUT.ply")]
    pub ply: Option<PathBuf>,
    /// Replace an output file that is there already
    #[arg(long)]
    pub force: bool,
}

/// What query and batch share.
#[derive(Debug, Args)]
pub(crate) struct CommonArguments {
    /// Sensor of scene clouds; see below
    #[arg(long, value_name = "SPEC", default_value = "iso:0.005", help_heading = "Files")]
    pub sensor: SensorChoice,
    /// Sensor of object clouds; that of the scene when not given
    #[arg(long, value_name = "SPEC", help_heading = "Files")]
    pub object_sensor: Option<SensorChoice>,
    /// Where the sensor of scene clouds stood in their frame; a camera looks along its own z
    #[arg(long, value_name = "X,Y,Z[,QX,QY,QZ,QW]", value_parser = numbers::rigid,
          allow_hyphen_values = true, help_heading = "Files")]
    pub sensor_pose: Option<Rigid>,
    /// Unit of meshes: m, cm, mm or in [m]
    #[arg(long, help_heading = "Files")]
    pub unit: Option<LengthUnit>,
    /// Unit of clouds: m, cm, mm or in [m]
    #[arg(long, value_name = "UNIT", help_heading = "Files")]
    pub cloud_unit: Option<LengthUnit>,
    /// How to estimate: calibrated, or paper (as printed)
    #[arg(long, value_enum, hide_possible_values = true, default_value_t = ModeName::Calibrated, help_heading = "Estimate")]
    pub mode: ModeName,
    /// In collision above this probability, 0.5 to 1 [0.9]
    #[arg(long, value_name = "A", value_parser = parse_accept, help_heading = "Estimate")]
    pub accept: Option<f64>,
    /// Free below this probability, 0 to 0.5 [0.1]
    #[arg(long, value_name = "B", value_parser = parse_reject, help_heading = "Estimate")]
    pub reject: Option<f64>,
    /// Paper: its settings, as `cloudtouch settings` prints them
    #[arg(long, value_name = "FILE", value_parser = settings_file::read,
          help_heading = "Estimate")]
    pub settings: Option<Settings>,
    /// Calibrated: share of your poses that collide, above 0 and below 1 [0.5]
    #[arg(long, value_name = "P", value_parser = parse_prior, help_heading = "Estimate")]
    pub prior: Option<f64>,
    /// Calibrated: also how likely the bodies are nearer than this
    #[arg(long, value_name = "METRES", value_parser = parse_length, help_heading = "Estimate")]
    pub margin: Option<f64>,
    /// Paper: how point probabilities make one: max, or noisy-or [max]
    #[arg(long, value_enum, hide_possible_values = true, help_heading = "Estimate")]
    pub pooling: Option<PoolingName>,
    /// Paper: seed of the stochastic traversal [0]
    #[arg(long, value_name = "N", help_heading = "Estimate")]
    pub seed: Option<u64>,
    /// Drop points nearer to the sensor [cameras and lidar: 0.1]
    #[arg(long, value_name = "METRES", value_parser = parse_length, help_heading = "Cleaning")]
    pub min_range: Option<f64>,
    /// Drop points farther from the sensor
    #[arg(long, value_name = "METRES", value_parser = parse_length, help_heading = "Cleaning")]
    pub max_range: Option<f64>,
    /// Drop outliers: neighbours and standard deviations, such as 8,3
    #[arg(long, value_name = "K,M", value_parser = parse_outliers, help_heading = "Cleaning")]
    pub outliers: Option<OutlierSettings>,
    /// Keep veil points at depth edges, which are dropped for cameras
    #[arg(long, help_heading = "Cleaning")]
    pub keep_veil: bool,
    /// Replace scene points by the occupied cells of a grid
    #[arg(long, value_name = "METRES", value_parser = parse_positive, help_heading = "Cleaning")]
    pub collision_map: Option<f64>,
    /// Robot link in the scene's frame: points inside go; repeatable
    #[arg(long, value_name = "MESH", help_heading = "Cleaning")]
    pub robot: Vec<PathBuf>,
    /// Points this near to a robot link go too
    #[arg(long, value_name = "METRES", default_value_t = 0.01, value_parser = parse_length,
          requires = "robot", help_heading = "Cleaning")]
    pub robot_padding: f64,
    #[command(flatten)]
    caution: CautionArguments,
    #[command(flatten)]
    pub effort: EffortArguments,
    #[command(flatten)]
    pub limits: LimitArguments,
}

impl CommonArguments {
    pub(crate) fn query_settings(&self) -> QuerySettings {
        let usual = QuerySettings::default();
        QuerySettings {
            accept: self.accept.unwrap_or(usual.accept),
            reject: self.reject.unwrap_or(usual.reject),
            prior: self.prior.unwrap_or(usual.prior),
            deadline: self.effort.deadline(),
            safeguards: self.caution.safeguards(usual.safeguards),
            ..usual
        }
    }

    pub(crate) fn paper_settings(&self) -> PaperSettings {
        let usual = self.settings.map_or_else(PaperSettings::default, |file| file.query);
        PaperSettings {
            accept: self.accept.unwrap_or(usual.accept),
            reject: self.reject.unwrap_or(usual.reject),
            pooling: self.pooling.map_or(usual.pooling, Pooling::from),
            seed: self.seed.unwrap_or(usual.seed),
            deadline: self.effort.deadline().or(usual.deadline),
            safeguards: self.caution.safeguards(usual.safeguards),
            ..usual
        }
    }

    /// Refuses options that the mode has no use for; `more` are of the paper's mode, and whether they
    /// are given.
    fn check(&self, more: &[(&str, bool)]) -> Result<(), String> {
        let of_the_paper = [
            ("--pooling", self.pooling.is_some()),
            ("--seed", self.seed.is_some()),
            ("--settings", self.settings.is_some()),
        ];
        match of_the_paper.iter().chain(more).find(|(_, is_given)| *is_given) {
            Some((name, _)) if self.mode == ModeName::Calibrated => Err(format!(
                "{name} has no effect in the calibrated mode: leave it out, or give --mode paper"
            )),
            _ if self.mode == ModeName::Paper && self.margin.is_some() => {
                Err("--margin has no effect in the paper's mode: leave it out".to_owned())
            }
            _ if self.mode == ModeName::Paper && self.prior.is_some() => {
                Err("--prior has no effect in the paper's mode: leave it out".to_owned())
            }
            _ if self.mode == ModeName::Paper && self.effort.refine == Refine::Yes => {
                Err("--refine has no effect in the paper's mode: leave it out".to_owned())
            }
            _ => Ok(()),
        }
    }

    /// Changes the cleaning that suits a sensor; the robot and the collision map concern scenes only.
    pub(crate) fn change(&self, filter: &mut FilterSettings) {
        filter.min_range = self.min_range.unwrap_or(filter.min_range);
        filter.max_range = self.max_range.unwrap_or(filter.max_range);
        filter.outliers = self.outliers;
        if self.keep_veil {
            filter.veil = None;
        }
    }
}

/// Name of a mode on the command line.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum ModeName {
    Calibrated,
    Paper,
}

/// Name of a way of pooling on the command line.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum PoolingName {
    Max,
    NoisyOr,
}

impl From<PoolingName> for Pooling {
    fn from(name: PoolingName) -> Self {
        match name {
            PoolingName::Max => Self::Max,
            PoolingName::NoisyOr => Self::NoisyOr,
        }
    }
}

fn parse_length(text: &str) -> Result<f64, String> {
    let length = numbers::finite(text)?;
    if length >= 0.0 { Ok(length) } else { Err("a length in metres is 0 or more".to_owned()) }
}

fn parse_positive(text: &str) -> Result<f64, String> {
    let length = numbers::finite(text)?;
    if length > 0.0 { Ok(length) } else { Err("it must be above 0, such as 0.01".to_owned()) }
}

fn parse_prior(text: &str) -> Result<f64, String> {
    let prior = numbers::finite(text)?;
    let is_between = prior > 0.0 && prior < 1.0;
    if is_between { Ok(prior) } else { Err("give a number above 0 and below 1".to_owned()) }
}

fn parse_accept(text: &str) -> Result<f64, String> {
    let accept = numbers::finite(text)?;
    if (0.5..=1.0).contains(&accept) { Ok(accept) } else { Err("give 0.5 to 1".to_owned()) }
}

fn parse_reject(text: &str) -> Result<f64, String> {
    let reject = numbers::finite(text)?;
    if (0.0..=0.5).contains(&reject) { Ok(reject) } else { Err("give 0 to 0.5".to_owned()) }
}

/// More neighbours than this take minutes and smooth everything away.
const MOST_NEIGHBORS: usize = 200;

fn parse_outliers(text: &str) -> Result<OutlierSettings, String> {
    let form = "write neighbours and standard deviations, as in 8,3";
    let (neighbors, deviations) = text.split_once(',').ok_or_else(|| form.to_owned())?;
    match neighbors.trim().parse::<usize>() {
        Ok(neighbors) if neighbors > MOST_NEIGHBORS => Err(format!(
            "{neighbors} neighbours are too many: 8 are usual, {MOST_NEIGHBORS} the most"
        )),
        Ok(neighbors) if neighbors > 0 => {
            Ok(OutlierSettings { neighbors, deviations: numbers::finite(deviations)? })
        }
        _ => Err(format!("`{neighbors}` is not a number of neighbours: {form}")),
    }
}

fn parse_sensor_for(text: &str) -> Result<(String, SensorChoice), String> {
    let (name, spec) = text
        .split_once('=')
        .ok_or_else(|| format!("`{text}`: write NAME=SPEC, as in mug=kinect"))?;
    let sensor = spec.parse::<SensorChoice>().map_err(|error| error.to_string())?;
    Ok((name.to_owned(), sensor))
}
