//! The command line.

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand, ValueEnum};
use cloudtouch::noise::SensorModel;
use cloudtouch::{CloudSettings, Mode, OutlierSettings, Pooling, QuerySettings};
use cloudtouch_io::LengthUnit;

/// How likely is it that the surfaces behind two noisy point clouds touch?
#[derive(Debug, Parser)]
#[command(version, about)]
pub(crate) struct Arguments {
    #[command(subcommand)]
    pub command: Command,
    /// Show what happens inside (repeat for more)
    #[arg(short, long, action = clap::ArgAction::Count, global = true)]
    verbose: u8,
}

impl Arguments {
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
    Query(QueryArguments),
    /// Many poses from a case file; scenes and objects are prepared once
    Batch(BatchArguments),
    /// What a cloud or mesh file holds, and which sensor suits it
    Info(InfoArguments),
    /// The piano in the room, from free to deep; needs no file
    Demo(DemoArguments),
}

#[derive(Debug, Args)]
pub(crate) struct QueryArguments {
    /// Cloud or mesh of the surroundings
    pub scene: PathBuf,
    /// Cloud or mesh of the object
    pub object: PathBuf,
    /// File with a 4x4 row-major matrix, object to scene: 16 numbers, brackets and commas allowed
    #[arg(long, conflicts_with_all = ["translate", "rotate_rpy"])]
    pub pose: Option<PathBuf>,
    /// Where the object's origin goes in the scene, m
    #[arg(long, value_name = "X,Y,Z", value_delimiter = ',', allow_hyphen_values = true, num_args = 3)]
    pub translate: Option<Vec<f64>>,
    /// Roll, pitch and yaw of the object, rad
    #[arg(long, value_name = "R,P,Y", value_delimiter = ',', allow_hyphen_values = true, num_args = 3)]
    pub rotate_rpy: Option<Vec<f64>>,
    #[command(flatten)]
    pub common: CommonArguments,
    /// Print the report as one JSON object
    #[arg(long)]
    pub json: bool,
    /// Exit with 0 free, 10 in contact, 20 in collision, 30 undecided
    #[arg(long)]
    pub exit_code: bool,
    /// Write scene and object in colour: grey to red by probability, object blue, contacts green
    #[arg(long, value_name = "OUT.ply")]
    pub ply: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub(crate) struct BatchArguments {
    /// Case file (JSON); its paths are relative to it
    pub cases: PathBuf,
    /// Write one JSON object per case to this file
    #[arg(long, value_name = "OUT")]
    pub jsonl: Option<PathBuf>,
    /// Print one JSON object per case instead of a table
    #[arg(long)]
    pub json: bool,
    /// Sensor of the files whose name contains NAME; may be repeated, the first match counts
    #[arg(long, value_name = "NAME=SPEC", value_parser = parse_sensor_for)]
    pub sensor_for: Vec<(String, SensorModel)>,
    #[command(flatten)]
    pub common: CommonArguments,
}

#[derive(Debug, Args)]
pub(crate) struct InfoArguments {
    /// Cloud or mesh file
    pub file: PathBuf,
    /// Length unit of a mesh file
    #[arg(long, default_value = "m")]
    pub unit: LengthUnit,
}

#[derive(Debug, Args)]
pub(crate) struct DemoArguments {
    /// As printed in the paper, or calibrated
    #[arg(long, value_enum, default_value_t = ModeName::Calibrated)]
    pub mode: ModeName,
    /// Write the deepest pose in colour
    #[arg(long, value_name = "OUT.ply")]
    pub ply: Option<PathBuf>,
}

/// What query and batch share.
#[derive(Debug, Args)]
pub(crate) struct CommonArguments {
    /// Sensor of scene clouds: exact | iso:STD | axes:SX,SY,SZ |
    /// stereo:BASELINE,FOCAL_PX,DISPARITY_STD | kinect | lidar:RANGE_STD,BEAM_RAD |
    /// grid:RESOLUTION | per-point
    #[arg(long, value_name = "SPEC", default_value = "iso:0.005")]
    pub sensor: SensorModel,
    /// Sensor of object clouds; that of the scene when not given
    #[arg(long, value_name = "SPEC")]
    pub object_sensor: Option<SensorModel>,
    /// Length unit of mesh files
    #[arg(long, default_value = "m")]
    pub unit: LengthUnit,
    /// As printed in the paper, or calibrated
    #[arg(long, value_enum, default_value_t = ModeName::Calibrated)]
    pub mode: ModeName,
    /// In collision above this probability
    #[arg(long, default_value_t = 0.9)]
    pub accept: f64,
    /// Free below this probability
    #[arg(long, default_value_t = 0.1)]
    pub reject: f64,
    /// How point probabilities make one number
    #[arg(long, value_enum, default_value_t = PoolingName::Max)]
    pub pooling: PoolingName,
    /// Seed of the paper's stochastic traversal
    #[arg(long, default_value_t = 0)]
    pub seed: u64,
    /// Drop points nearer to the sensor, m (default: 0.1 for cameras and laser scanners)
    #[arg(long)]
    pub min_range: Option<f64>,
    /// Drop points farther from the sensor, m
    #[arg(long)]
    pub max_range: Option<f64>,
    /// Drop statistical outliers: neighbours and standard deviations, such as 8,3
    #[arg(long, value_name = "K,M", value_delimiter = ',', num_args = 2)]
    pub outliers: Option<Vec<f64>>,
    /// Keep veil points at depth edges, which are dropped for cameras
    #[arg(long)]
    pub keep_veil: bool,
    /// Replace scene points by the occupied cells of a grid of this resolution, m
    #[arg(long, value_name = "RESOLUTION")]
    pub collision_map: Option<f64>,
    /// Mesh of a robot link in the scene's frame: scene points inside it are dropped; repeatable
    #[arg(long, value_name = "MESH")]
    pub robot: Vec<PathBuf>,
    /// Scene points this near to a robot link are dropped too, m
    #[arg(long, default_value_t = 0.01)]
    pub robot_padding: f64,
}

impl CommonArguments {
    pub(crate) fn query_settings(&self) -> QuerySettings {
        QuerySettings {
            accept: self.accept,
            reject: self.reject,
            pooling: self.pooling.into(),
            seed: self.seed,
            ..QuerySettings::new(self.mode.into())
        }
    }

    /// Settings of a cloud seen by `sensor`; the robot and the collision map concern scenes only.
    pub(crate) fn cloud_settings(&self, sensor: SensorModel) -> CloudSettings {
        let mut settings = CloudSettings::new(sensor, self.mode.into());
        let filter = &mut settings.filter;
        filter.min_range = self.min_range.unwrap_or(filter.min_range);
        filter.max_range = self.max_range.unwrap_or(filter.max_range);
        filter.outliers = self.outliers.as_deref().map(|given| OutlierSettings {
            neighbors: given.first().map_or(0, |k| *k as usize),
            deviations: given.get(1).copied().unwrap_or(f64::NAN),
        });
        if self.keep_veil {
            filter.veil = None;
        }
        settings
    }
}

/// Name of a mode on the command line.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum ModeName {
    Calibrated,
    Paper,
}

impl From<ModeName> for Mode {
    fn from(name: ModeName) -> Self {
        match name {
            ModeName::Calibrated => Self::Calibrated,
            ModeName::Paper => Self::Paper,
        }
    }
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

fn parse_sensor_for(text: &str) -> Result<(String, SensorModel), String> {
    let (name, spec) =
        text.split_once('=').ok_or_else(|| format!("`{text}`: write NAME=SPEC, as in mug=kinect"))?;
    let sensor = spec.parse::<SensorModel>().map_err(|error| error.to_string())?;
    Ok((name.to_owned(), sensor))
}
