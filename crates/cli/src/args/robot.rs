//! Options about a robot and where it is.

use std::path::PathBuf;

use clap::Args;

use super::parse::parse_length;

/// A robot and where it is.
#[derive(Debug, Args)]
pub(crate) struct RobotOptions {
    /// The robot; its meshes are .stl, .obj or .ply
    pub urdf: PathBuf,
    /// JSON object of joint names and positions (rad, m), or a list: a path
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
    /// With --scan-joints: points this near to a link go too
    #[arg(long, value_name = "METRES", default_value_t = 0.01, value_parser = parse_length, allow_negative_numbers = true,
          requires = "scan_joints")]
    pub padding: f64,
    /// Scene file whose bodies are `attached_to` links: what the robot holds
    #[arg(long, value_name = "FILE.json")]
    pub held: Option<PathBuf>,
    /// Links that may touch the scan, such as a bolted base
    #[arg(long, value_name = "LINK", value_delimiter = ',')]
    pub may_touch: Vec<String>,
    /// Also ask whether links touch one another, but neighbours
    #[arg(long)]
    pub self_collision: bool,
    /// With --self-collision: SRDF whose disabled pairs may touch
    #[arg(long, value_name = "FILE", requires = "self_collision")]
    pub srdf: Option<PathBuf>,
}

fn parse_package(text: &str) -> Result<(String, PathBuf), String> {
    match text.split_once('=') {
        Some((name, folder)) if !name.is_empty() && !folder.is_empty() => {
            Ok((name.to_owned(), folder.into()))
        }
        _ => Err("write NAME=FOLDER, such as my_robot=/opt/robots/my_robot".to_owned()),
    }
}
