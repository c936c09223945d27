//! The scan, without the robot that it shows.

use anyhow::{Context as _, Result, anyhow, bail};
use cloudtouch::geom::Pose;
use cloudtouch::{Cloud, SelfMesh};
use cloudtouch_cli::files::joints::{self, Joints};
use cloudtouch_robot::Robot;

use crate::args::RobotArguments;
use crate::commands::scene::bodies::{FileBodies, Prepared};
use crate::load::{self, Loaded};
use crate::usage::WrongUsage;

/// Reads the scan, and prepares it to be asked about at so many positions.
pub(super) fn read(
    arguments: &RobotArguments,
    robot: &Robot,
    base: &Pose,
    positions: usize,
) -> Result<Loaded<Cloud>> {
    let common = &arguments.common;
    let options = &arguments.of_scan.bodies(common);
    let links = seen(arguments, robot, base)?;
    let scan = load::surroundings(&arguments.scan, links, options)?;
    scan.refined_for(positions, common.effort.refine())
}

/// Refuses options that neither the scan nor what is held has a use for.
pub(super) fn check_options(
    arguments: &RobotArguments,
    scan: &Prepared,
    held: &FileBodies<'_>,
) -> Result<()> {
    let common = &arguments.common;
    if common.unit.is_some() && !scan.is_mesh() && !held.all().any(|(_, body)| body.is_mesh()) {
        let of_links = "meshes of links are in metres times the `scale` that the URDF gives them";
        bail!(WrongUsage(format!(
            "--unit is for a scan that is a mesh, and {} is a cloud: give --cloud-unit for it; {of_links}",
            arguments.scan.display()
        )));
    }
    held.check_options(common, &[scan])
}

/// The links where the camera saw them.
fn seen(arguments: &RobotArguments, robot: &Robot, base: &Pose) -> Result<Vec<SelfMesh>> {
    let Some(path) = &arguments.robot.scan_joints else { return Ok(Vec::new()) };
    let named = || path.display().to_string();
    let positions = joints::read(path, arguments.common.limits.read_limits().bytes)?;
    let [joints]: [Joints; 1] = positions
        .try_into()
        .map_err(|_| anyhow!("a list: a scan is taken at one position"))
        .with_context(named)?;
    robot.self_filter(&joints, base, arguments.robot.padding).with_context(named)
}
