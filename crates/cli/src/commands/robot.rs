//! `cloudtouch robot`: a robot in a scan, at positions of its joints.

use std::collections::BTreeMap;
use std::process::ExitCode;

use anyhow::{Context as _, Result, bail};
use cloudtouch::Query;
use cloudtouch::geom::Pose;
use cloudtouch_cli::files::joints::{self, Joints};
use cloudtouch_robot::{Robot, RobotChecker, SURROUNDINGS, Touching};

use crate::answers::print;
use crate::answers::robot::Asked;
use crate::answers::scene::Bodies;
use crate::args::RobotArguments;
use crate::body::Body;
use crate::load::{self, Role};
use crate::usage::WrongUsage;
use crate::{answers, unused};

pub(crate) fn run(arguments: &RobotArguments) -> Result<ExitCode> {
    let common = &arguments.common;
    let options = &arguments.of_scan.bodies(common);
    let limits = common.limits.read_limits();
    let query = Query::new(common.query_settings())?;
    load::check(&arguments.scan)?;
    let path = joints::read(&arguments.robot.joints, limits.bytes)?;
    let base =
        arguments.robot.base_pose.as_deref().map(load::pose::read).transpose()?.unwrap_or_default();
    let mut robot =
        Robot::from_urdf_within(&arguments.robot.urdf, &arguments.robot.package, &limits)?;
    check_packages(arguments, &robot)?;
    if let Some(srdf) = &arguments.robot.srdf {
        robot = robot.with_srdf(srdf)?;
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
    }
    // Wrong positions are told before a large scan is read.
    let named = || arguments.robot.joints.display().to_string();
    for (index, joints) in path.iter().enumerate() {
        let posed = robot.link_poses(joints).map(|_| ()).map_err(anyhow::Error::from);
        let placed = if path.len() > 1 { posed.context(joints::place(index)) } else { posed };
        placed.with_context(named)?;
    }
    check_links(arguments, &robot)?;
    let links = seen(arguments, &robot, &base)?;
    let scan = load::surroundings(&arguments.scan, links, options)?;
    if common.unit.is_some() && !scan.is_mesh() {
        let of_links = "meshes of links are in metres times the `scale` that the URDF gives them";
        bail!(WrongUsage(format!(
            "--unit is for a scan that is a mesh, and {} is a cloud: give --cloud-unit for it; {of_links}",
            arguments.scan.display()
        )));
    }
    unused::check(options, scan.files(Role::Scene))?;
    let scan = scan.refined_for(path.len(), common.effort.refine())?;
    let unchecked = robot.unchecked_links().to_vec();
    let asked = Asked {
        unchecked_links: &unchecked,
        may_touch: &arguments.robot.may_touch,
        self_filter: arguments.robot.scan_joints.is_some(),
        self_collision: arguments.robot.self_collision,
    };
    let words = format!("{}\n{}", print::body("scan", &scan), asked.text());
    let body: cloudtouch::Body = match scan.body {
        Body::Cloud(cloud) => cloud.into(),
        Body::Mesh(mesh) => mesh.into(),
    };
    let touching =
        if arguments.robot.self_collision { Touching::AndItself } else { Touching::Surroundings };
    let mut checker = RobotChecker::new(robot, body, base, touching)?;
    for link in &arguments.robot.may_touch {
        checker.allow(link, SURROUNDINGS).with_context(|| "--may-touch")?;
    }
    let threshold = query.settings().reject;
    let bodies = path.iter().map(|joints| checker.boxes(joints)).collect::<Result<Vec<_>, _>>()?;
    let bodies = bodies.iter().map(|boxes| Bodies {
        inputs: BTreeMap::from([(SURROUNDINGS, &scan.input)]),
        boxes: boxes.iter().map(|(name, corners)| (name.as_str(), *corners)).collect(),
    });
    let bodies: Vec<Bodies<'_>> = bodies.collect();
    let base = match arguments.robot.base_pose {
        Some(_) => "",
        None => "base                   not given: at the origin of the scan (--base-pose)\n",
    };
    let words = words + base + &bodies.first().map_or(String::new(), answers::robot::place);
    let (text, verdict, failed) = if let ([joints], [bodies]) = (&path[..], &bodies[..]) {
        let checked = checker.check(&query, joints)?;
        let text = if arguments.answer.json {
            answers::robot::json_line(&checked, threshold, bodies.clone(), asked)?
        } else {
            [words, answers::robot::worst(&checked), answers::scene::text(&checked, threshold)]
                .concat()
        };
        (text, checked.verdict(), checked.pairs.iter().any(|pair| pair.answer.is_err()))
    } else {
        let checked = checker.check_path(&query, &path, TOLERANCE)?;
        let text = if arguments.answer.json {
            answers::robot::path_line(&checked, threshold, bodies, asked)?
        } else {
            words + &answers::robot::path_text(&checked)
        };
        let pairs = checked.given.iter().flat_map(|at| &at.pairs);
        let mut pairs = pairs.chain(checked.stopped.as_ref().and_then(|at| at.pair.as_ref()));
        (text, checked.verdict(), pairs.any(|pair| pair.answer.is_err()))
    };
    print::to_stdout(&format!("{text}\n"))?;
    Ok(arguments.answer.exit_code(verdict, failed))
}

/// Refuses the folder of a package that no link needs: its name is misspelt, and another may have been read.
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
    let positions = joints::read(path, arguments.common.limits.read_limits().bytes)?;
    let [joints]: [Joints; 1] = positions
        .try_into()
        .map_err(|_| anyhow::anyhow!("a list: a scan is taken at one position"))
        .with_context(named)?;
    robot.self_filter(&joints, base, arguments.robot.padding).with_context(named)
}
