//! `cloudtouch query`: one object in one scene at one pose.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::{Context as _, Result, bail};
use cloudtouch::geom::{Pose, Vector3};
use cloudtouch::{PaperQuery, Placement, PoseDistribution, Query, Report};
use cloudtouch_cli::numbers::{PoseStd, Triple, Turn};
use cloudtouch_io::read_colors_within;
use cloudtouch_page::{Fact, Page, View};
use nalgebra::UnitQuaternion;

use crate::answers::per_point::{self, Details};
use crate::answers::print;
use crate::answers::query::Answer;
use crate::args::{ModeName, PoseArguments, QueryArguments, exit_code};
use crate::body::{self, Body, PreparedCloud};
use crate::doubt::Doubt;
use crate::inside::with_points_inside;
use crate::load::{self, Loaded, Role};
use crate::output::Output;
use crate::{answers, output, pages, picture, unused};

pub(crate) fn run(arguments: &QueryArguments, shows_work: bool) -> Result<ExitCode> {
    let common = &arguments.common;
    match arguments.mode.mode {
        ModeName::Calibrated => {
            run_by(&Query::new(common.query_settings())?, arguments, shows_work)
        }
        ModeName::Paper => {
            run_by(&PaperQuery::new(arguments.mode.paper_settings(common))?, arguments, shows_work)
        }
    }
}

fn run_by<P: body::Path>(
    query: &P,
    arguments: &QueryArguments,
    shows_work: bool,
) -> Result<ExitCode> {
    let (common, options) = (&arguments.common, &arguments.bodies());
    // What can be told without work comes first.
    let inputs = [&arguments.scene, &arguments.object]
        .into_iter()
        .chain(&arguments.also)
        .chain(&arguments.kappas)
        .chain(options.robot);
    inputs.clone().try_for_each(|path| load::check(path))?;
    let outputs = [
        Output::of("ply", &arguments.ply),
        Output::table(&arguments.csv),
        Output::of("html", &arguments.html),
    ];
    let settings = options.settings.map(|file| &file.path);
    let inputs = inputs.chain(&arguments.pose.pose).chain(settings).map(PathBuf::as_path);
    output::check(&outputs, inputs, arguments.force)?;
    let pose = pose(&arguments.pose)?;
    let doubt = arguments.pose.quaternion.and_then(|Turn(turn)| Doubt::of_option(&turn));
    if let Some(doubt) = &doubt {
        tracing::warn!("{}", doubt.words);
    }
    let scans: Vec<&Path> =
        std::iter::once(&arguments.scene).chain(&arguments.also).map(PathBuf::as_path).collect();
    let scene = load::bodies::<P::Cloud>(&scans, Role::Scene, common.scene_sensor(), options)?;
    let scene = with_kappas(scene, arguments)?;
    let object =
        load::body::<P::Cloud>(&arguments.object, Role::Object, options.object_sensor(), options)?;
    unused::check(options, scene.files(Role::Scene).chain(object.files(Role::Object)))?;
    let scene = scene.refined_for(1, common.effort.refine())?;
    let object = object.refined_for(1, common.effort.refine())?;
    let (report, classifiers, nearness) = if arguments.explain {
        let (report, classifiers) = query.explain(&scene.body, &object.body, &pose)?;
        (report, classifiers, None)
    } else {
        let (report, nearness) =
            query.ask_within(&scene.body, &object.body, &pose, arguments.mode.margin)?;
        (report, Vec::new(), nearness)
    };
    let placement = query.place(&scene.body, &object.body, &pose);
    let pose_uncertainty = match arguments.pose.pose_std {
        Some(PoseStd(stds)) => {
            let poses = PoseDistribution::from_std(pose, stds);
            query.uncertain(&scene.body, &object.body, &poses)?
        }
        None => None,
    };
    let slopes = match arguments.gradient {
        true => query.slopes(&scene.body, &object.body, &pose)?,
        false => None,
    };
    let way_out = |probability| query.way_out(&scene.body, &object.body, &pose, probability);
    let out = arguments.penetration.map(way_out).transpose()?;
    let shown = with_points_inside(report.clone(), (&scene.body, &object.body), &pose);
    if let Some(path) = &arguments.csv {
        per_point::write_csv(path, &scene.body, &object.body, &pose, &shown)?;
    }
    if let Some(path) = &arguments.ply {
        let limits = common.limits.read_limits();
        let files = [&arguments.scene, &arguments.object];
        let [of_scene, of_object] = files.map(|file| read_colors_within(file, &limits));
        let (of_scene, of_object) = (of_scene?, of_object?);
        let scene = (&scene.body, of_scene.as_deref());
        let object = (&object.body, of_object.as_deref());
        picture::write(path, scene, object, &pose, &shown)?;
    }
    let more: Vec<Fact> = nearness
        .as_ref()
        .map(answers::text::nearness)
        .into_iter()
        .chain(pose_uncertainty.as_ref().map(answers::text::over_poses))
        .collect();
    if arguments.html.is_some() {
        let answer = (&shown, &placement, &more[..]);
        write_page(arguments, (&scene, &object), &pose, answer)?;
    }
    let text = if arguments.json {
        let details = Details {
            points: arguments.points.then(|| (&report).into()),
            pose_uncertainty,
            gradient: slopes,
            penetration: out,
            classifiers: arguments.explain.then_some(&classifiers[..]),
        };
        let (doubt, report, placement, pose) = (doubt.as_ref(), &report, &placement, &pose);
        let answer = Answer { report, placement, pose, details, nearness, doubt };
        answer.json_line("query", [&scene.input, &object.input])?
    } else {
        let of_scene = answers::text::Scene {
            is_cloud: !scene.is_mesh(),
            is_placed: options.sensor_pose.is_some(),
        };
        let mut parts = vec![
            print::body("scene", &scene),
            print::body("object", &object),
            answers::text::text(&report, &placement, of_scene, shows_work),
        ];
        parts.extend(more.iter().map(answers::text::line));
        parts.extend(slopes.as_ref().map(answers::gradient::text));
        if let Some(probability) = arguments.penetration {
            parts.push(answers::penetration::text(out.flatten().as_ref(), probability));
        }
        if !arguments.pose.is_given() {
            parts.push("pose                   not given: the identity".to_owned());
        }
        parts.join("\n")
    };
    print::to_stdout(&format!("{text}\n"))?;
    Ok(if arguments.exit_code { exit_code(report.verdict) } else { ExitCode::SUCCESS })
}

/// Both bodies and the answer, to look at.
fn write_page<C: PreparedCloud>(
    arguments: &QueryArguments,
    (scene, object): (&Loaded<C>, &Loaded<C>),
    pose: &Pose,
    (report, placement, more): (&Report, &Placement, &[Fact]),
) -> Result<()> {
    let Some(path) = &arguments.html else { return Ok(()) };
    let limits = arguments.common.limits.read_limits();
    // Rows of several scans are not those of the first file.
    let scan = Some(arguments.scene.as_path()).filter(|_| arguments.also.is_empty());
    let bodies = [
        pages::body(scene, scan, &limits)?,
        pages::body(object, Some(&arguments.object), &limits)?,
    ];
    let view = View {
        name: "The pose asked about".to_owned(),
        scene: 0,
        object: 1,
        scene_from_object: *pose,
        report,
        placement: Some(placement),
        more: more.to_vec(),
    };
    let title = format!("{} in {}", bodies[1].name, bodies[0].name);
    let page = Page { title, bodies: bodies.into(), views: vec![view], ..Page::default() };
    pages::write(path, page)
}

/// Gives each row of the scene its own κ, where a file says so.
fn with_kappas<C: PreparedCloud>(
    scene: Loaded<C>,
    arguments: &QueryArguments,
) -> Result<Loaded<C>> {
    let Some(path) = &arguments.kappas else { return Ok(scene) };
    let named = || path.display().to_string();
    let Body::Cloud(cloud) = scene.body else { bail!("{}: the scene is a mesh, exact", named()) };
    let text = std::fs::read_to_string(path).with_context(named)?;
    let kappas: Result<Vec<f64>, _> = text.split_whitespace().map(str::parse).collect();
    let rule = arguments.mode.paper_settings(&arguments.common).radius_rule;
    let cloud = cloud.with_kappas(&kappas.with_context(named)?, rule).with_context(named)?;
    Ok(Loaded { body: Body::Cloud(cloud), ..scene })
}

fn pose(arguments: &PoseArguments) -> Result<Pose> {
    if let Some(path) = &arguments.pose {
        return load::pose::read(path);
    }
    let offset = arguments.translate.map_or(Vector3::zeros(), |Triple(offset)| offset.into());
    let turn = arguments.turn().map_or(UnitQuaternion::identity(), |turn| turn.0);
    Ok(Pose::from_translation_rotation(offset, turn))
}
