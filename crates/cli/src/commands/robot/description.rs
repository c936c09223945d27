//! What the files say of a robot, its base and its joints.

use anyhow::{Context as _, Error, Result, bail};
use cloudtouch::geom::Pose;
use cloudtouch_cli::files::joints::{self, Joints};
use cloudtouch_cli::files::scene::SceneFile;
use cloudtouch_robot::Robot;

use super::held;
use crate::args::RobotArguments;
use crate::load;
use crate::usage::WrongUsage;

pub(super) struct Description {
    pub robot: Robot,
    /// One position or several, at each of which the robot can be.
    pub path: Vec<Joints>,
    /// From the base into the frame of the scan.
    pub base: Pose,
    /// What it holds.
    pub held: SceneFile,
}

pub(super) fn read(arguments: &RobotArguments) -> Result<Description> {
    let options = &arguments.robot;
    let limits = arguments.common.limits.read_limits();
    let path = joints::read(&options.joints, limits.bytes)?;
    let pose = |path| load::pose::read(path, limits.bytes);
    let base = options.base_pose.as_deref().map(pose).transpose()?.unwrap_or_default();
    let robot = Robot::from_urdf_within(&options.urdf, &options.package, &limits)?;
    check_packages(arguments, &robot)?;
    let robot = with_srdf(robot, arguments)?;
    check_positions(arguments, &robot, &path)?;
    check_links(arguments, &robot)?;
    let held = held::read(arguments, &robot)?;
    Ok(Description { robot, path, base, held })
}

/// Refuses the folder of a package that no link needs: its name is misspelt, and another may have been read.
fn check_packages(arguments: &RobotArguments, robot: &Robot) -> Result<()> {
    let used = robot.packages();
    let options = &arguments.robot;
    if let Some((name, folder)) =
        options.package.iter().find(|(name, _)| !used.contains(name.as_str()))
    {
        let names = used.into_iter().collect::<Vec<_>>().join(", ");
        let remedy = if names.is_empty() {
            "leave it out".to_owned()
        } else {
            format!("leave it out, or correct it to one of {names}")
        };
        bail!(WrongUsage(format!(
            "--package {name}={}: no <collision> mesh of {} is in the package `{name}`: {remedy}",
            folder.display(),
            options.urdf.display()
        )));
    }
    Ok(())
}

fn with_srdf(robot: Robot, arguments: &RobotArguments) -> Result<Robot> {
    let Some(srdf) = &arguments.robot.srdf else { return Ok(robot) };
    let robot = robot.with_srdf_within(srdf, &arguments.common.limits.read_limits())?;
    if !robot.unknown_links().is_empty() {
        tracing::warn!(
            "{}: disable_collisions names {}, no link of {} ({}): correct the name, unless it is of \
             another variant of the robot",
            srdf.display(),
            robot.unknown_links().join(", "),
            arguments.robot.urdf.display(),
            robot.links().join(", ")
        );
    }
    Ok(robot)
}

fn check_positions(arguments: &RobotArguments, robot: &Robot, path: &[Joints]) -> Result<()> {
    let named = || arguments.robot.joints.display().to_string();
    for (index, joints) in path.iter().enumerate() {
        let posed = robot.link_poses(joints).map(|_| ()).map_err(Error::from);
        let placed = if path.len() > 1 { posed.context(joints::place(index)) } else { posed };
        placed.with_context(named)?;
    }
    Ok(())
}

/// A link that may touch the scan is one of the robot's.
fn check_links(arguments: &RobotArguments, robot: &Robot) -> Result<()> {
    let links = robot.links();
    match arguments.robot.may_touch.iter().find(|link| !links.contains(link)) {
        None => Ok(()),
        Some(link) => {
            bail!(WrongUsage(format!(
                "--may-touch {link}: no link of that name, of {}",
                links.join(", ")
            )))
        }
    }
}
