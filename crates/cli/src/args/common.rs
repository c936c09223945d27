//! What the commands that ask about bodies share.

use clap::Args;
use cloudtouch::geom::message::number;
use cloudtouch::noise::SensorModel;
use cloudtouch::{FilterSettings, OutlierSettings, QuerySettings};
use cloudtouch_io::LengthUnit;

use crate::sensor::SensorChoice;

use super::caution::{CautionArguments, EffortArguments};
use super::depth::DepthArguments;
use super::limits::LimitArguments;
use super::parse::{
    parse_accept, parse_fraction, parse_length, parse_outliers, parse_positive, parse_reject,
};

/// What all of them take.
#[derive(Debug, Args)]
pub(crate) struct CommonArguments {
    /// Sensor of scene clouds; see below [iso:0.005]
    #[arg(long, value_name = "SPEC", help_heading = "Files")]
    pub sensor: Option<SensorChoice>,
    /// Unit of meshes: m, cm, mm or in [m]
    #[arg(long, help_heading = "Files")]
    pub unit: Option<LengthUnit>,
    /// Unit of clouds: m, cm, mm or in [m]
    #[arg(long, value_name = "UNIT", help_heading = "Files")]
    pub cloud_unit: Option<LengthUnit>,
    #[command(flatten)]
    pub depth: DepthArguments,
    /// In collision above this probability, 0.5 to 1 [0.9]
    #[arg(long, value_name = "A", value_parser = parse_accept, allow_negative_numbers = true, help_heading = "Estimate")]
    pub accept: Option<f64>,
    /// Free below this probability, 0 to 0.5 [0.1]
    #[arg(long, value_name = "B", value_parser = parse_reject, allow_negative_numbers = true, help_heading = "Estimate")]
    pub reject: Option<f64>,
    /// Calibrated: share of your poses that collide, above 0 and below 1 [0.5]
    #[arg(long, value_name = "P", value_parser = parse_fraction, allow_negative_numbers = true, help_heading = "Estimate")]
    pub prior: Option<f64>,
    /// Drop points nearer to the sensor [images of a camera or lidar: 0.1]
    #[arg(long, value_name = "METRES", value_parser = parse_length, allow_negative_numbers = true, help_heading = "Cleaning")]
    pub min_range: Option<f64>,
    /// Drop points farther from the sensor
    #[arg(long, value_name = "METRES", value_parser = parse_positive, allow_negative_numbers = true, help_heading = "Cleaning")]
    pub max_range: Option<f64>,
    /// Drop outliers: neighbours and standard deviations, such as 8,3
    #[arg(long, value_name = "K,M", value_parser = parse_outliers, allow_hyphen_values = true, help_heading = "Cleaning")]
    pub outliers: Option<OutlierSettings>,
    /// Keep veil points at the edges of camera images, dropped otherwise
    #[arg(long, help_heading = "Cleaning")]
    pub keep_veil: bool,
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

    /// Refuses ranges that keep nothing.
    pub(super) fn check(&self) -> Result<(), String> {
        match (self.min_range, self.max_range) {
            (Some(min), Some(max)) if min >= max => Err(format!(
                "--min-range {} and --max-range {} leave no point: give the smaller first",
                number(min),
                number(max)
            )),
            _ => Ok(()),
        }
    }

    /// Changes the cleaning that suits a sensor.
    pub(crate) fn change(&self, filter: &mut FilterSettings) {
        filter.min_range = self.min_range.or(filter.min_range);
        filter.max_range = self.max_range.unwrap_or(filter.max_range);
        filter.outliers = self.outliers;
        if self.keep_veil {
            filter.veil = None;
        }
    }
}
