//! Options that say where the object is.

use std::path::PathBuf;

use clap::Args;
use cloudtouch_cli::numbers::{self, PoseStd, Triple, Turn};

/// Where the object is in the scene.
#[derive(Debug, Args)]
#[command(next_help_heading = "Pose (the identity when not given)")]
pub(crate) struct PoseArguments {
    /// Text file with a 4x4 row-major matrix, object to scene, m
    #[arg(long, value_name = "FILE",
          conflicts_with_all = ["translate", "rotate_rpy", "rotate_deg", "quaternion"])]
    pub pose: Option<PathBuf>,
    /// Where the object's origin goes in the scene, m
    #[arg(long, value_name = "X,Y,Z", value_parser = numbers::place, allow_hyphen_values = true)]
    pub translate: Option<Triple>,
    /// Roll, pitch and yaw of the object about the axes of the scene, rad
    #[arg(long, value_name = "R,P,Y", value_parser = numbers::turn_in_radians,
          allow_hyphen_values = true, conflicts_with_all = ["rotate_deg", "quaternion"])]
    pub rotate_rpy: Option<Turn>,
    /// The same in degrees
    #[arg(long, value_name = "R,P,Y", value_parser = numbers::turn_in_degrees,
          allow_hyphen_values = true, conflicts_with = "quaternion")]
    pub rotate_deg: Option<Turn>,
    /// Turn of the object as a quaternion, in the order of ROS
    #[arg(long, value_name = "X,Y,Z,W", value_parser = numbers::quaternion,
          allow_hyphen_values = true)]
    pub quaternion: Option<Turn>,
    /// Calibrated: deviations along and about the object's axes, m and rad
    #[arg(long, value_name = "X,Y,Z,R,P,Y", value_parser = numbers::pose_std,
          allow_hyphen_values = true)]
    pub pose_std: Option<PoseStd>,
}

impl PoseArguments {
    /// Whether anything was said; else it is the identity.
    pub(crate) fn is_given(&self) -> bool {
        self.pose.is_some() || self.translate.is_some() || self.turn().is_some()
    }

    pub(crate) fn turn(&self) -> Option<Turn> {
        self.rotate_rpy.or(self.rotate_deg).or(self.quaternion)
    }
}
