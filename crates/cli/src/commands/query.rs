//! `cloudtouch query`: one object in one scene at one pose.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::{Context as _, Result, bail};
use cloudtouch::geom::{Pose, Vector3};
use cloudtouch::{PaperQuery, Query, Verdict};

use crate::args::{ModeName, QueryArguments, Triple};
use crate::body::{self, Body, PreparedCloud};
use crate::load::{self, Role};
use crate::per_point::{self, Details};
use crate::{picture, pose_file, print};

pub(crate) fn run(arguments: &QueryArguments) -> Result<ExitCode> {
    let common = &arguments.common;
    match common.mode {
        ModeName::Calibrated => run_by(&Query::new(common.query_settings())?, arguments),
        ModeName::Paper => run_by(&PaperQuery::new(common.paper_settings())?, arguments),
    }
}

fn run_by<P: body::Path>(query: &P, arguments: &QueryArguments) -> Result<ExitCode> {
    let common = &arguments.common;
    let pose = pose(arguments)?;
    let object_sensor = common.object_sensor.as_ref().unwrap_or(&common.sensor);
    let scans: Vec<&Path> =
        std::iter::once(&arguments.scene).chain(&arguments.also).map(PathBuf::as_path).collect();
    let scene = load::bodies::<P::Cloud>(&scans, Role::Scene, &common.sensor, common)?;
    let scene = with_kappas(scene, arguments)?;
    let object = load::body::<P::Cloud>(&arguments.object, Role::Object, object_sensor, common)?;
    let (report, classifiers) = if arguments.explain {
        query.explain(&scene, &object, &pose)?
    } else {
        (query.ask(&scene, &object, &pose)?, Vec::new())
    };
    if let Some(path) = &arguments.csv {
        per_point::write_csv(path, &scene, &object, &pose, &report)?;
    }
    if let Some(path) = &arguments.ply {
        picture::write(path, &scene, &object, &pose, &report)?;
    }
    let text = if arguments.json {
        let details = Details {
            points: arguments.points.then(|| (&report).into()),
            classifiers: arguments.explain.then_some(&classifiers[..]),
        };
        print::detailed_json_line("query", &report, &details)?
    } else {
        [print::body("scene", &scene), print::body("object", &object), print::report(&report)]
            .join("\n")
    };
    print::to_stdout(&format!("{text}\n"))?;
    Ok(if arguments.exit_code { exit_code(report.verdict) } else { ExitCode::SUCCESS })
}

/// Gives each row of the scene its own κ, where a file says so.
fn with_kappas<C: PreparedCloud>(scene: Body<C>, arguments: &QueryArguments) -> Result<Body<C>> {
    let Some(path) = &arguments.kappas else { return Ok(scene) };
    let named = || path.display().to_string();
    let Body::Cloud(cloud) = scene else { bail!("{}: the scene is a mesh, exact", named()) };
    let text = std::fs::read_to_string(path).with_context(named)?;
    let kappas: Result<Vec<f64>, _> = text.split_whitespace().map(str::parse).collect();
    let rule = arguments.common.paper_settings().radius_rule;
    Ok(Body::Cloud(cloud.with_kappas(&kappas.with_context(named)?, rule).with_context(named)?))
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
