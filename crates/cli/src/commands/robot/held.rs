//! What the robot holds.

use std::sync::Arc;

use anyhow::{Context as _, Result, anyhow, bail};
use cloudtouch::SceneError;
use cloudtouch_cli::files::scene::{self, BodyEntry, SceneFile};
use cloudtouch_robot::{Robot, RobotChecker};

use crate::args::RobotArguments;
use crate::commands::scene::bodies::FileBodies;

/// What the file of what is held says, whose links are those of the robot; without a file, nothing.
pub(super) fn read(arguments: &RobotArguments, robot: &Robot) -> Result<SceneFile> {
    let Some(path) = arguments.robot.held.as_deref() else { return Ok(SceneFile::default()) };
    let file = scene::read_held(path, arguments.common.limits.read_limits().bytes)?;
    for (index, body) in file.bodies.iter().enumerate() {
        let link = body.attached_to.as_ref().filter(|link| !robot.links().contains(link));
        if let Some(link) = link {
            bail!(
                "{}: body {} `{}`: `attached_to` is `{link}`, no link of the robot, of {}",
                path.display(),
                index + 1,
                body.name,
                robot.links().join(", ")
            );
        }
    }
    Ok(file)
}

/// The bodies of that file.
pub(super) fn prepare<'a>(
    arguments: &RobotArguments,
    file: &'a SceneFile,
) -> Result<FileBodies<'a>> {
    FileBodies::read(&arguments.common, &file.bodies).with_context(|| named(arguments))
}

/// Has the links hold these bodies, and what may touch touch.
pub(super) fn hold(
    checker: &mut RobotChecker,
    arguments: &RobotArguments,
    of_file: (&SceneFile, &FileBodies<'_>),
) -> Result<()> {
    hold_all(checker, of_file).with_context(|| named(arguments))
}

/// The file, which is there where anything of it can be wrong.
fn named(arguments: &RobotArguments) -> String {
    arguments.robot.held.as_deref().map_or(String::new(), |path| path.display().to_string())
}

fn hold_all(
    checker: &mut RobotChecker,
    (file, bodies): (&SceneFile, &FileBodies<'_>),
) -> Result<()> {
    for (index, (entry, prepared)) in bodies.all().enumerate() {
        let BodyEntry { name, pose, attached_to, .. } = entry;
        let link = attached_to.as_deref().unwrap_or_default();
        let held = checker.hold(name, Arc::clone(&prepared.body), link, *pose);
        held.map_err(of_a_file).with_context(|| format!("body {} `{name}`", index + 1))?;
    }
    for (index, [a, b]) in file.allowed.iter().enumerate() {
        let allowed = checker.allow(a, b).map_err(of_a_file);
        allowed.with_context(|| format!("pair {} of \"allowed\"", index + 1))?;
    }
    Ok(())
}

fn of_a_file(error: SceneError) -> anyhow::Error {
    match error {
        SceneError::UnknownName { name } => {
            anyhow!(
                "nothing with a shape is named `{name}`: name a link with <collision>, a body of the file, or \
             `surroundings`"
            )
        }
        other => other.into(),
    }
}
