//! `cloudtouch path`: one object along a path in one scene.

use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::Result;
use cloudtouch::geom::Pose;
use cloudtouch::{BodyRef, Cloud, Query};

use crate::answers::print;
use crate::args::PathArguments;
use crate::inside::with_points_inside;
use crate::load::{self, Role};
use crate::progress::Steps;
use crate::{answers, pages, unused};

pub(crate) fn run(arguments: &PathArguments) -> Result<ExitCode> {
    let common = &arguments.common;
    let options = &arguments.pair.bodies(common);
    let query = Query::new(common.query_settings())?;
    let inputs = [&arguments.scene, &arguments.object].into_iter().chain(options.robot);
    inputs.into_iter().try_for_each(|path| load::check(path))?;
    let files = [&arguments.scene, &arguments.object, &arguments.poses];
    let inputs = files.into_iter().chain(options.robot).map(PathBuf::as_path);
    arguments.answer.check_page(inputs.chain(options.depth.file()))?;
    let (path, doubt) =
        load::path::read(&arguments.poses, arguments.screw, common.limits.read_limits().bytes)?;
    let steps = Steps::about([arguments.scene.as_path(), arguments.object.as_path()]);
    steps.tell("reading and preparing");
    let scene = load::bodies::<Cloud>(
        &[arguments.scene.as_path()],
        Role::Scene,
        common.scene_sensor(),
        options,
    )?;
    let object =
        load::body::<Cloud>(&arguments.object, Role::Object, options.object_sensor(), options)?;
    unused::check(options, scene.files(Role::Scene).chain(object.files(Role::Object)))?;
    let scene = scene.refined_for(POSES, common.effort.refine())?;
    let object = object.refined_for(POSES, common.effort.refine())?;
    steps.tell("asking");
    let swept = query.sweep(&scene.body, &object.body, &path, arguments.tolerance)?;
    let is_placed = options.sensor_pose.is_some();
    if let Some(output) = &arguments.answer.html {
        let limits = common.limits.read_limits();
        let bodies = [
            pages::body(&scene, Some(&arguments.scene), &limits)?,
            pages::body(&object, Some(&arguments.object), &limits)?,
        ];
        let facts = answers::path::facts(&swept, doubt.as_ref(), is_placed);
        let (scene, object) = (&scene.body, &object.body);
        let ask = |pose: &Pose| query.run(scene, object, pose);
        let colored = |report, pose: &Pose| with_points_inside(report, (scene, object), pose);
        pages::path::write(output, bodies, (&swept, facts), &path, ask, colored)?;
    }
    let placement =
        BodyRef::from(&scene.body).placement((&object.body).into(), &swept.most_probable.pose);
    let text = if arguments.answer.json {
        answers::path::json_line(
            (&swept, placement),
            doubt.as_ref(),
            [&scene.input, &object.input],
        )?
    } else {
        let bodies = [print::body("scene", &scene), print::body("object", &object)];
        format!(
            "{}\n{}",
            bodies.join("\n"),
            answers::path::text((&swept, &placement), doubt.as_ref(), is_placed)
        )
    };
    print::to_stdout(&format!("{text}\n"))?;
    Ok(arguments.answer.exit_code(swept.verdict, false))
}

/// A path asks about as many poses as a small batch.
const POSES: usize = 10;
