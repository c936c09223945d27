//! Options about the scan of a scene and about a pair of bodies, and all that is said of bodies.

use std::path::PathBuf;

use clap::Args;
use cloudtouch_cli::intrinsics::DepthImages;
use cloudtouch_cli::numbers::{self, Rigid};

use crate::paper_settings::SettingsFile;
use crate::sensor::SensorChoice;

use super::common::CommonArguments;
use super::parse::{parse_length, parse_positive};

/// What is said of a scene that is one scan.
#[derive(Debug, Args)]
pub(crate) struct ScanArguments {
    /// Where the sensor of scene clouds stood in their frame; a camera looks along its own z
    #[arg(long, value_name = "X,Y,Z[,QX,QY,QZ,QW]", value_parser = numbers::rigid,
          allow_hyphen_values = true, help_heading = "Files")]
    sensor_pose: Option<Rigid>,
    /// Replace scene points by the occupied cells of a grid
    #[arg(long, value_name = "METRES", value_parser = parse_positive, allow_negative_numbers = true, help_heading = "Cleaning")]
    collision_map: Option<f64>,
}

/// What is said of one object in one scene.
#[derive(Debug, Args)]
pub(crate) struct PairArguments {
    /// Sensor of object clouds; that of the scene when not given
    #[arg(long, value_name = "SPEC", help_heading = "Files")]
    object_sensor: Option<SensorChoice>,
    #[command(flatten)]
    scan: ScanArguments,
    /// Robot link in the scene's frame: points inside go; repeatable
    #[arg(long, value_name = "MESH", help_heading = "Cleaning")]
    pub robot: Vec<PathBuf>,
    /// With --robot: points this near to a link go too
    #[arg(long, value_name = "METRES", default_value_t = 0.01, value_parser = parse_length, allow_negative_numbers = true,
          requires = "robot", help_heading = "Cleaning")]
    robot_padding: f64,
}

/// All that the options say of the bodies; what a command does not take is not given.
pub(crate) struct BodyOptions<'a> {
    pub common: &'a CommonArguments,
    /// Of bodies that are depth images.
    pub depth: DepthImages,
    pub object_sensor: Option<SensorChoice>,
    pub sensor_pose: Option<Rigid>,
    /// Whether a scene file says that, and no option.
    pub is_of_file: bool,
    pub collision_map: Option<f64>,
    /// Links in the scene's frame, and how near to them points go.
    pub robot: &'a [PathBuf],
    pub robot_padding: f64,
    /// Of the paper's mode.
    pub settings: Option<&'a SettingsFile>,
}

impl CommonArguments {
    /// What all commands take.
    pub(crate) fn bodies(&self) -> BodyOptions<'_> {
        BodyOptions {
            common: self,
            depth: self.depth.images(),
            object_sensor: None,
            sensor_pose: None,
            is_of_file: false,
            collision_map: None,
            robot: &[],
            robot_padding: 0.0,
            settings: None,
        }
    }
}

impl ScanArguments {
    pub(crate) fn bodies<'a>(&self, common: &'a CommonArguments) -> BodyOptions<'a> {
        let Self { sensor_pose, collision_map } = *self;
        BodyOptions { sensor_pose, collision_map, ..common.bodies() }
    }
}

impl PairArguments {
    pub(crate) fn bodies<'a>(&'a self, common: &'a CommonArguments) -> BodyOptions<'a> {
        let Self { object_sensor, scan, robot, robot_padding } = self;
        BodyOptions {
            object_sensor: *object_sensor,
            robot,
            robot_padding: *robot_padding,
            ..scan.bodies(common)
        }
    }
}

impl BodyOptions<'_> {
    pub(crate) fn object_sensor(&self) -> SensorChoice {
        self.object_sensor.unwrap_or(self.common.scene_sensor())
    }
}
