//! `cloudtouch query`: one object in one scene at one pose.

use std::io::Write as _;
use std::process::ExitCode;

use anyhow::Result;
use cloudtouch::geom::{Pose, Vector3};
use cloudtouch::{Query, Verdict};

use crate::args::QueryArguments;
use crate::load::{self, Role};
use crate::{picture, pose_file, print};

pub(crate) fn run(arguments: &QueryArguments) -> Result<ExitCode> {
    let common = &arguments.common;
    let query = Query::new(common.query_settings())?;
    let pose = pose(arguments)?;
    let object_sensor = common.object_sensor.as_ref().unwrap_or(&common.sensor);
    let scene = load::body(&arguments.scene, Role::Scene, &common.sensor, common)?;
    let object = load::body(&arguments.object, Role::Object, object_sensor, common)?;
    let report = query.run(&scene, &object, &pose)?;
    if let Some(path) = &arguments.ply {
        picture::write(path, &scene, &object, &pose, &report)?;
    }
    let mut out = std::io::stdout().lock();
    if arguments.json {
        writeln!(out, "{}", print::json_line("query", &report)?)?;
    } else {
        writeln!(out, "{}", print::body("scene", &scene))?;
        writeln!(out, "{}", print::body("object", &object))?;
        writeln!(out, "{}", print::report(&report))?;
    }
    Ok(if arguments.exit_code { exit_code(report.verdict) } else { ExitCode::SUCCESS })
}

fn pose(arguments: &QueryArguments) -> Result<Pose> {
    if let Some(path) = &arguments.pose {
        return pose_file::read(path);
    }
    let triple = |given: &Option<Vec<f64>>| match given.as_deref() {
        Some(&[x, y, z]) => [x, y, z],
        _ => [0.0; 3],
    };
    let [translate, rotate] = [&arguments.translate, &arguments.rotate_rpy].map(triple);
    if let Some(value) = translate.iter().chain(&rotate).find(|v| !v.is_finite()) {
        anyhow::bail!("the pose contains {value}: give finite numbers");
    }
    Ok(Pose::from_translation_rpy(Vector3::from(translate), rotate))
}

fn exit_code(verdict: Verdict) -> ExitCode {
    ExitCode::from(match verdict {
        Verdict::Free => 0,
        Verdict::InContact => 10,
        Verdict::InCollision => 20,
        Verdict::Undecided => 30,
    })
}
