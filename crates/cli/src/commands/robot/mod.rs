//! `cloudtouch robot`: a robot in a scan, at positions of its joints.

mod ask;
mod description;
mod scan;

use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::{Context as _, Result};
use cloudtouch::Query;
use cloudtouch_robot::{RobotChecker, SURROUNDINGS, Touching};

use self::ask::{Ask, Page};
use self::description::Description;
use crate::answers::print;
use crate::answers::robot::Asked;
use crate::args::RobotArguments;
use crate::body::Body;
use crate::load;
use crate::progress::Steps;

pub(crate) fn run(arguments: &RobotArguments) -> Result<ExitCode> {
    let query = Query::new(arguments.common.query_settings())?;
    load::check(&arguments.scan)?;
    let options = &arguments.robot;
    let others = [&options.base_pose, &options.srdf, &options.scan_joints];
    let inputs = [&arguments.scan, &options.urdf, &options.joints].into_iter();
    let inputs = inputs.chain(others.into_iter().flatten()).map(PathBuf::as_path);
    arguments.answer.check_page(inputs)?;
    // Wrong positions are told before a large scan is read.
    let Description { robot, path, base } = description::read(arguments)?;
    let steps = Steps::about([arguments.scan.as_path()]);
    steps.tell("reading and preparing");
    let scan = scan::read(arguments, &robot, &base, path.len())?;
    let unchecked = robot.unchecked_links().to_vec();
    let asked = Asked {
        unchecked_links: &unchecked,
        may_touch: &arguments.robot.may_touch,
        self_filter: arguments.robot.scan_joints.is_some(),
        self_collision: arguments.robot.self_collision,
    };
    let taken_for = print::about(&scan);
    let mut words = format!("scan: {taken_for}\n{}", asked.text());
    if arguments.robot.base_pose.is_none() {
        words += "base                   not given: at the origin of the scan (--base-pose)\n";
    }
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
    let in_json = arguments.answer.json;
    let page = arguments.answer.html.as_deref().map(|output| Page {
        output,
        title: format!("{} in {}", options.urdf.display(), arguments.scan.display()),
        scan: taken_for,
    });
    let ask = Ask { checker: &checker, query: &query, scan: &scan.input, asked, in_json, page };
    steps.tell("asking");
    let answer = ask.about(&path)?;
    let text = if in_json { answer.text } else { words + &answer.text };
    print::to_stdout(&format!("{text}\n"))?;
    Ok(arguments.answer.exit_code(answer.verdict, answer.has_failed))
}
