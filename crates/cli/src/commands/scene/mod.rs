//! `cloudtouch scene`: many bodies, each with its own pose.

pub(super) mod bodies;
mod of_their_own;

use std::collections::BTreeMap;
use std::process::ExitCode;
use std::sync::Arc;

use anyhow::{Context as _, Result, anyhow, ensure};
use cloudtouch::geom::{Point3, TriangleMesh};
use cloudtouch::{Mesh, Query, QuerySettings, Scene, SceneError};
use cloudtouch_cli::files::scene::{self, BodyEntry, SceneFile};

use self::bodies::{FileBodies, Prepared};
use crate::answers::print;
use crate::answers::scene::{Bodies, place};
use crate::args::{CommonArguments, SceneArguments};
use crate::usage::WrongUsage;
use crate::{answers, pages};

pub(crate) fn run(arguments: &SceneArguments) -> Result<ExitCode> {
    let common = &arguments.common;
    let named = || arguments.scene.display().to_string();
    let file = scene::read(&arguments.scene, common.limits.read_limits().bytes)?;
    let query = Query::new(settings(common, &file).with_context(named)?)?;
    let of_bodies = file.bodies.iter().map(|of| of.file.as_path());
    let of_images = file.bodies.iter().filter_map(|of| of.depth.file());
    let usual = common.depth.images();
    let inputs = of_bodies.chain(of_images).chain(usual.file());
    arguments.answer.check_page(inputs.chain([arguments.scene.as_path()]))?;
    // What can be told without work comes first.
    let mut scene = outline(&file).with_context(named)?;
    let read = FileBodies::read(common, &file.bodies).with_context(named)?;
    read.check_options(common, &[]).with_context(named)?;
    let bodies: BTreeMap<&str, &Prepared> =
        read.all().map(|(of, prepared)| (of.name.as_str(), prepared)).collect();
    for (name, prepared) in &bodies {
        scene.replace(name, Arc::clone(&prepared.body))?;
    }
    let checked = scene.check(&query);
    answers::scene::warn_of_nothing_asked(&checked);
    let threshold = query.settings().reject;
    if let Some(output) = &arguments.answer.html {
        let taken_for = |name: &str| bodies[name].words.clone();
        let found = (&scene, &checked);
        pages::scene::write(output, found, None, (named(), Vec::new()), taken_for)?;
    }
    let text = if arguments.answer.json {
        let inputs = bodies.iter().map(|(name, prepared)| (*name, &prepared.input)).collect();
        let bodies = Bodies { inputs, boxes: scene.boxes() };
        answers::scene::json_line(&checked, threshold, bodies)?
    } else {
        let boxes = scene.boxes();
        let line = |of: &BodyEntry| {
            let name = of.name.as_str();
            format!("{}, {}\n", bodies[name].words_of(of), place(&boxes[name]))
        };
        let lines = file.bodies.iter().map(line);
        lines.collect::<String>() + &answers::scene::text(&checked, threshold)
    };
    print::to_stdout(&format!("{text}\n"))?;
    let has_failed = checked.pairs.iter().any(|pair| pair.answer.is_err());
    Ok(arguments.answer.exit_code(checked.verdict(), has_failed))
}

fn settings(common: &CommonArguments, file: &SceneFile) -> Result<QuerySettings> {
    let both = "has a threshold, and --reject is one too: give one of them";
    let is_twice = file.threshold.is_some() && common.reject.is_some();
    ensure!(!is_twice, WrongUsage(both.to_owned()));
    let usual = common.query_settings();
    Ok(QuerySettings { reject: file.threshold.unwrap_or(usual.reject), ..usual })
}

/// The scene with a triangle in the place of each body, until these are read.
fn outline(file: &SceneFile) -> Result<Scene> {
    let corners = vec![Point3::origin(), Point3::new(1.0, 0.0, 0.0), Point3::new(0.0, 1.0, 0.0)];
    let triangle = Mesh::prepare(&TriangleMesh::new(corners, vec![[0, 1, 2]])?)?;
    let stand_in = Arc::new(cloudtouch::Body::from(triangle));
    let mut scene = Scene::default();
    for (index, BodyEntry { name, pose, .. }) in file.bodies.iter().enumerate() {
        let added = scene.add(name, Arc::clone(&stand_in), *pose);
        added.with_context(|| format!("body {}", index + 1))?;
    }
    for (index, BodyEntry { name, pose, attached_to, .. }) in file.bodies.iter().enumerate() {
        if let Some(to) = attached_to {
            let attached = scene.attach(name, to, *pose).map_err(of_a_file);
            attached.with_context(|| format!("\"attached_to\" of body {}", index + 1))?;
        }
    }
    for (index, [a, b]) in file.allowed.iter().enumerate() {
        let allowed = scene.allow(a, b).map_err(of_a_file);
        allowed.with_context(|| format!("pair {} of \"allowed\"", index + 1))?;
    }
    Ok(scene)
}

/// A program adds the body that is missing; whoever wrote a file has to name one that is there.
fn of_a_file(error: SceneError) -> anyhow::Error {
    match error {
        SceneError::UnknownName { name } => {
            anyhow!("no body is named `{name}`: name a body of the file")
        }
        other => other.into(),
    }
}
