//! What the commands that ask about bodies share.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use cloudtouch::noise::SensorModel;
use cloudtouch::{FilterSettings, OutlierSettings, PaperSettings, Pooling, QuerySettings};
use cloudtouch_cli::numbers::{self, Rigid};
use cloudtouch_io::LengthUnit;

use crate::paper_settings::{self, SettingsFile};
use crate::sensor::SensorChoice;

use super::caution::{CautionArguments, EffortArguments, Refine};
use super::limits::LimitArguments;
use super::parse::{
    parse_accept, parse_fraction, parse_length, parse_outliers, parse_positive, parse_reject,
};

/// What query and batch share.
#[derive(Debug, Args)]
pub(crate) struct CommonArguments {
    /// Sensor of scene clouds; see below [iso:0.005]
    #[arg(long, value_name = "SPEC", help_heading = "Files")]
    pub sensor: Option<SensorChoice>,
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
    #[arg(long, value_name = "A", value_parser = parse_accept, allow_negative_numbers = true, help_heading = "Estimate")]
    pub accept: Option<f64>,
    /// Free below this probability, 0 to 0.5 [0.1]
    #[arg(long, value_name = "B", value_parser = parse_reject, allow_negative_numbers = true, help_heading = "Estimate")]
    pub reject: Option<f64>,
    /// Paper: its settings, as `cloudtouch settings` prints them
    #[arg(long, value_name = "FILE", value_parser = paper_settings::read,
          help_heading = "Estimate")]
    pub settings: Option<SettingsFile>,
    /// Calibrated: share of your poses that collide, above 0 and below 1 [0.5]
    #[arg(long, value_name = "P", value_parser = parse_fraction, allow_negative_numbers = true, help_heading = "Estimate")]
    pub prior: Option<f64>,
    /// Calibrated: also how likely they are nearer than this; the verdict stays
    #[arg(long, value_name = "METRES", value_parser = parse_length, allow_negative_numbers = true, help_heading = "Estimate")]
    pub margin: Option<f64>,
    /// Paper: how point probabilities make one: max, or noisy-or [max]
    #[arg(long, value_enum, hide_possible_values = true, help_heading = "Estimate")]
    pub pooling: Option<PoolingName>,
    /// Paper: seed of the stochastic traversal [0]
    #[arg(long, value_name = "N", allow_negative_numbers = true, help_heading = "Estimate")]
    pub seed: Option<u64>,
    /// Drop points nearer to the sensor [camera, lidar with a place: 0.1]
    #[arg(long, value_name = "METRES", value_parser = parse_length, allow_negative_numbers = true, help_heading = "Cleaning")]
    pub min_range: Option<f64>,
    /// Drop points farther from the sensor
    #[arg(long, value_name = "METRES", value_parser = parse_length, allow_negative_numbers = true, help_heading = "Cleaning")]
    pub max_range: Option<f64>,
    /// Drop outliers: neighbours and standard deviations, such as 8,3
    #[arg(long, value_name = "K,M", value_parser = parse_outliers, allow_hyphen_values = true, help_heading = "Cleaning")]
    pub outliers: Option<OutlierSettings>,
    /// Keep veil points at depth edges, which are dropped for cameras
    #[arg(long, help_heading = "Cleaning")]
    pub keep_veil: bool,
    /// Replace scene points by the occupied cells of a grid
    #[arg(long, value_name = "METRES", value_parser = parse_positive, allow_negative_numbers = true, help_heading = "Cleaning")]
    pub collision_map: Option<f64>,
    /// Robot link in the scene's frame: points inside go; repeatable
    #[arg(long, value_name = "MESH", help_heading = "Cleaning")]
    pub robot: Vec<PathBuf>,
    /// With --robot: points this near to a link go too
    #[arg(long, value_name = "METRES", default_value_t = 0.01, value_parser = parse_length, allow_negative_numbers = true,
          requires = "robot", help_heading = "Cleaning")]
    pub robot_padding: f64,
    #[command(flatten)]
    pub caution: CautionArguments,
    #[command(flatten)]
    pub effort: EffortArguments,
    #[command(flatten)]
    pub limits: LimitArguments,
}

/// What a cloud is taken to be from where nothing is said.
const USUAL_SENSOR: SensorChoice = SensorChoice::Stated(SensorModel::Isotropic { std: 0.005 });

impl CommonArguments {
    pub(crate) fn scene_sensor(&self) -> SensorChoice {
        self.sensor.unwrap_or(USUAL_SENSOR)
    }

    pub(crate) fn object_sensor(&self) -> SensorChoice {
        self.object_sensor.unwrap_or(self.scene_sensor())
    }

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
        let given = self.settings.as_ref();
        let usual = given.map_or_else(PaperSettings::default, |file| file.settings.query);
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
    pub(super) fn check(&self, more: &[(&str, bool)]) -> Result<(), String> {
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
            _ if self.mode == ModeName::Paper && self.effort.refine == Some(Refine::Yes) => {
                Err("--refine has no effect in the paper's mode: leave it out".to_owned())
            }
            _ => Ok(()),
        }
    }

    /// Refuses what is of the paper's mode for a command that has none.
    pub(super) fn check_calibrated(&self, command: &str) -> Result<(), String> {
        let of_the_paper = [
            ("--mode", self.mode == ModeName::Paper),
            ("--pooling", self.pooling.is_some()),
            ("--seed", self.seed.is_some()),
            ("--settings", self.settings.is_some()),
        ];
        match of_the_paper.iter().find(|(_, is_given)| *is_given) {
            Some((option, _)) => {
                Err(format!("{command} is of the calibrated mode: leave {option} out"))
            }
            None => Ok(()),
        }
    }

    /// Changes the cleaning that suits a sensor; the robot and the collision map concern scenes only.
    pub(crate) fn change(&self, filter: &mut FilterSettings) {
        filter.min_range = self.min_range.or(filter.min_range);
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
