//! Options of `cloudtouch robot`.

use std::path::PathBuf;

use clap::Args;

use super::{CommonArguments, ModeName, SENSORS, parse_length};

#[derive(Debug, Args)]
#[command(after_help = SENSORS)]
pub(crate) struct RobotArguments {
    /// Cloud or mesh of the surroundings (.pcd .ply .xyz .txt .csv .stl .obj)
    pub scan: PathBuf,
    /// The robot; its meshes are .stl, .obj or .ply
    pub urdf: PathBuf,
    /// JSON object of joint names and positions (rad, m), or a list of them: a path
    #[arg(long, value_name = "FILE")]
    pub joints: PathBuf,
    /// Folder of a package that the URDF names; repeatable
    #[arg(long, value_name = "NAME=FOLDER", value_parser = parse_package)]
    pub package: Vec<(String, PathBuf)>,
    /// Text file with a 4x4 row-major matrix, base to scan, m [the identity]
    #[arg(long, value_name = "FILE")]
    pub base_pose: Option<PathBuf>,
    /// Where the joints were when the scan was taken: points on the robot go
    #[arg(long, value_name = "FILE")]
    pub scan_joints: Option<PathBuf>,
    /// Points this near to a link go too
    #[arg(long, value_name = "METRES", default_value_t = 0.01, value_parser = parse_length,
          requires = "scan_joints")]
    pub padding: f64,
    /// Also ask whether links touch one another, but neighbours
    #[arg(long)]
    pub self_collision: bool,
    /// SRDF whose disabled pairs may touch
    #[arg(long, value_name = "FILE", requires = "self_collision")]
    pub srdf: Option<PathBuf>,
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
    pub(super) fn check(&self) -> Result<(), String> {
        let common = &self.common;
        if common.mode == ModeName::Paper {
            return Err("robot is of the calibrated mode: leave --mode out".to_owned());
        }
        let of_objects = [
            ("--object-sensor", common.object_sensor.is_some()),
            ("--margin", common.margin.is_some()),
        ];
        if let Some((option, _)) = of_objects.iter().find(|(_, is_given)| *is_given) {
            return Err(format!("{option} is of one object: leave it out"));
        }
        if !common.robot.is_empty() {
            return Err("--robot is of a scan without a URDF: give --scan-joints".to_owned());
        }
        common.check(&[])
    }
}

fn parse_package(text: &str) -> Result<(String, PathBuf), String> {
    match text.split_once('=') {
        Some((name, folder)) if !name.is_empty() && !folder.is_empty() => {
            Ok((name.to_owned(), folder.into()))
        }
        _ => Err("write NAME=FOLDER, such as my_robot=/opt/robots/my_robot".to_owned()),
    }
}
