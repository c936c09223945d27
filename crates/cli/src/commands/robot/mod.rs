//! `cloudtouch robot`: a robot in a scan, at positions of its joints.

mod ask;
mod description;
mod held;
mod scan;

use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::Arc;

use anyhow::{Context as _, Result};
use cloudtouch::Query;
use cloudtouch_cli::files::scene::BodyEntry;
use cloudtouch_robot::{RobotChecker, SURROUNDINGS, Touching};

use self::ask::{Ask, Page};
use self::description::Description;
use crate::answers::print;
use crate::answers::robot::Asked;
use crate::args::RobotArguments;
use crate::commands::scene::bodies::{FileBodies, Prepared};
use crate::load;
use crate::progress::Steps;

pub(crate) fn run(arguments: &RobotArguments) -> Result<ExitCode> {
    let query = Query::new(arguments.common.query_settings())?;
    load::check(&arguments.scan)?;
    check_page(arguments)?;
    // Wrong positions are told before a large scan is read.
    let Description { robot, path, base, held } = description::read(arguments)?;
    let bodies = held::prepare(arguments, &held)?;
    let steps = Steps::about([arguments.scan.as_path()]);
    steps.tell("reading and preparing");
    let scan = Prepared::from(scan::read(arguments, &robot, &base, path.len())?);
    scan::check_options(arguments, &scan, &bodies)?;
    let unchecked = robot.unchecked_links().to_vec();
    let asked = Asked {
        unchecked_links: &unchecked,
        may_touch: &arguments.robot.may_touch,
        self_filter: arguments.robot.scan_joints.is_some(),
        self_collision: arguments.robot.self_collision,
    };
    let words = words(arguments, &scan.words, &bodies, asked);
    let touching =
        if arguments.robot.self_collision { Touching::AndItself } else { Touching::Surroundings };
    let placed = RobotChecker::new(robot, Arc::clone(&scan.body), base, touching);
    // The name of a link may be taken.
    let mut checker = placed.with_context(|| arguments.robot.urdf.display().to_string())?;
    for link in &arguments.robot.may_touch {
        checker.allow(link, SURROUNDINGS).with_context(|| "--may-touch")?;
    }
    held::hold(&mut checker, arguments, (&held, &bodies))?;
    let of_held = bodies.all().map(|(body, prepared)| (&*body.name, prepared));
    let prepared = of_held.chain([(SURROUNDINGS, &scan)]).collect();
    let page = arguments.answer.html.as_deref().map(|output| Page {
        output,
        title: format!("{} in {}", arguments.robot.urdf.display(), arguments.scan.display()),
    });
    let in_json = arguments.answer.json;
    let ask = Ask { checker: &checker, query: &query, prepared, asked, in_json, page };
    steps.tell("asking");
    let answer = ask.about(&path)?;
    let text = if in_json { answer.text } else { words + &answer.text };
    print::to_stdout(&format!("{text}\n"))?;
    Ok(arguments.answer.exit_code(answer.verdict, answer.has_failed))
}

fn check_page(arguments: &RobotArguments) -> Result<()> {
    let options = &arguments.robot;
    let others = [&options.base_pose, &options.srdf, &options.scan_joints, &options.held];
    let inputs = [&arguments.scan, &options.urdf, &options.joints].into_iter();
    let inputs = inputs.chain(others.into_iter().flatten()).map(PathBuf::as_path);
    arguments.answer.check_page(inputs.chain(arguments.common.depth.images().file()))
}

/// What the bodies were taken for, and what is not asked about.
fn words(
    arguments: &RobotArguments,
    scan: &str,
    held: &FileBodies<'_>,
    asked: Asked<'_>,
) -> String {
    let held = held.all().map(|(body, is): (&BodyEntry, _)| is.words_of(body) + "\n");
    let base = match &arguments.robot.base_pose {
        Some(_) => "",
        None => "base                   not given: at the origin of the scan (--base-pose)\n",
    };
    format!("scan: {scan}\n{}{}{base}", held.collect::<String>(), asked.text())
}
