//! `cloudtouch robot`: a robot in a scan, at positions of its joints.

use std::collections::BTreeMap;
use std::process::ExitCode;

use anyhow::{Context as _, Result};
use cloudtouch::Query;
use cloudtouch::geom::Pose;
use cloudtouch_cli::joints_file::{self, Joints};
use cloudtouch_robot::{Robot, RobotChecker, SURROUNDINGS, Touching};

use crate::args::RobotArguments;
use crate::body::Body;
use crate::load::{self, Role};
use crate::{pose_file, print, robot_answer, scene_answer, unused};

pub(crate) fn run(arguments: &RobotArguments) -> Result<ExitCode> {
    let common = &arguments.common;
    let limits = common.limits.read_limits();
    let query = Query::new(common.query_settings())?;
    load::check(&arguments.scan)?;
    let path = joints_file::read(&arguments.robot.joints, limits.bytes)?;
    let base =
        arguments.robot.base_pose.as_deref().map(pose_file::read).transpose()?.unwrap_or_default();
    let mut robot =
        Robot::from_urdf_within(&arguments.robot.urdf, &arguments.robot.package, &limits)?;
    if let Some(srdf) = &arguments.robot.srdf {
        robot = robot.with_srdf(srdf)?;
    }
    // Wrong positions are told before a large scan is read.
    for joints in &path {
        robot.link_poses(joints).with_context(|| arguments.robot.joints.display().to_string())?;
    }
    let links = seen(arguments, &robot, &base)?;
    let scan = load::surroundings(&arguments.scan, links, common)?;
    unused::check(common, &[(Role::Scene, scan.is_mesh())])?;
    let scan = scan.refined_for(path.len(), common.effort.refine())?;
    let words = words(&robot, arguments, &print::body("scan", &scan));
    let body: cloudtouch::Body = match scan.body {
        Body::Cloud(cloud) => cloud.into(),
        Body::Mesh(mesh) => mesh.into(),
    };
    let touching =
        if arguments.robot.self_collision { Touching::AndItself } else { Touching::Surroundings };
    let checker = RobotChecker::new(robot, body, base, touching)?;
    let threshold = query.settings().reject;
    let bodies = BTreeMap::from([(SURROUNDINGS, &scan.input)]);
    let (text, verdict, failed) = if let [joints] = &path[..] {
        let checked = checker.check(&query, joints)?;
        let text = if arguments.answer.json {
            scene_answer::json_line(&checked, threshold, bodies)?
        } else {
            [words, robot_answer::worst(&checked), scene_answer::text(&checked, threshold)].concat()
        };
        (text, checked.verdict(), checked.pairs.iter().any(|pair| pair.answer.is_err()))
    } else {
        let checked = checker.check_path(&query, &path, TOLERANCE)?;
        let text = if arguments.answer.json {
            robot_answer::path_line(&checked, threshold, bodies)?
        } else {
            words + &robot_answer::path_text(&checked)
        };
        let pairs = checked.given.iter().flat_map(|at| &at.pairs);
        let mut pairs = pairs.chain(checked.stopped.as_ref().and_then(|at| at.pair.as_ref()));
        (text, checked.verdict(), pairs.any(|pair| pair.answer.is_err()))
    };
    print::to_stdout(&format!("{text}\n"))?;
    Ok(arguments.answer.exit_code(verdict, failed))
}

/// How finely a path is looked at, as a share of it.
const TOLERANCE: f64 = 0.001;

/// The links where the camera saw them.
fn seen(
    arguments: &RobotArguments,
    robot: &Robot,
    base: &Pose,
) -> Result<Vec<cloudtouch::SelfMesh>> {
    let Some(path) = &arguments.robot.scan_joints else { return Ok(Vec::new()) };
    let named = || path.display().to_string();
    let positions = joints_file::read(path, arguments.common.limits.read_limits().bytes)?;
    let [joints]: [Joints; 1] = positions
        .try_into()
        .map_err(|_| anyhow::anyhow!("a list: a scan is taken at one position"))
        .with_context(named)?;
    robot.self_filter(&joints, base, arguments.robot.padding).with_context(named)
}

/// What was read, and what is not asked about.
fn words(robot: &Robot, arguments: &RobotArguments, scan: &str) -> String {
    let mut text = format!("{scan}\n");
    if !robot.unchecked_links().is_empty() {
        text += &format!(
            "not checked            {} (no <collision> in the URDF)\n",
            robot
                .unchecked_links()
                .iter()
                .map(|link| print::one_line(link))
                .collect::<Vec<_>>()
                .join(", ")
        );
    }
    if arguments.robot.scan_joints.is_none() {
        text += "self filter            none: give --scan-joints if the scan shows the robot\n";
    }
    if !arguments.robot.self_collision {
        text += "self collision         not asked: give --self-collision\n";
    }
    text
}
