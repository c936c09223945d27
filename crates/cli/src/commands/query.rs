//! `cloudtouch query`: one object in one scene at one pose.

use std::process::ExitCode;

use anyhow::Result;
use cloudtouch::geom::{Pose, Vector3};
use cloudtouch::{PaperQuery, Query, Verdict};

use crate::args::{ModeName, QueryArguments, Triple};
use crate::body::Path;
use crate::load::{self, Role};
use crate::{picture, pose_file, print};

pub(crate) fn run(arguments: &QueryArguments) -> Result<ExitCode> {
    let common = &arguments.common;
    match common.mode {
        ModeName::Calibrated => run_by(&Query::new(common.query_settings())?, arguments),
        ModeName::Paper => run_by(&PaperQuery::new(common.paper_settings())?, arguments),
    }
}

fn run_by<P: Path>(query: &P, arguments: &QueryArguments) -> Result<ExitCode> {
    let common = &arguments.common;
    let pose = pose(arguments)?;
    let object_sensor = common.object_sensor.as_ref().unwrap_or(&common.sensor);
    let scene = load::body::<P::Cloud>(&arguments.scene, Role::Scene, &common.sensor, common)?;
    let object = load::body::<P::Cloud>(&arguments.object, Role::Object, object_sensor, common)?;
    let report = query.ask(&scene, &object, &pose)?;
    if let Some(path) = &arguments.ply {
        picture::write(path, &scene, &object, &pose, &report)?;
    }
    let text = if arguments.json {
        print::json_line("query", &report)?
    } else {
        [print::body("scene", &scene), print::body("object", &object), print::report(&report)]
            .join("\n")
    };
    print::to_stdout(&format!("{text}\n"))?;
    Ok(if arguments.exit_code { exit_code(report.verdict) } else { ExitCode::SUCCESS })
}

fn pose(arguments: &QueryArguments) -> Result<Pose> {
    if let Some(path) = &arguments.pose {
        return pose_file::read(path);
    }
    let given = |triple: Option<Triple>| triple.map_or([0.0; 3], |Triple(numbers)| numbers);
    let offset = Vector3::from(given(arguments.translate));
    Ok(Pose::from_translation_rpy(offset, given(arguments.rotate_rpy)))
}

fn exit_code(verdict: Verdict) -> ExitCode {
    ExitCode::from(match verdict {
        Verdict::Free => 0,
        Verdict::InContact => 10,
        Verdict::InCollision => 20,
        Verdict::Undecided => 30,
    })
}
