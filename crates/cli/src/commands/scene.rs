//! `cloudtouch scene`: many bodies, each with its own pose.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::Arc;

use anyhow::{Context as _, Result, anyhow, ensure};
use cloudtouch::geom::{Point3, TriangleMesh};
use cloudtouch::{Cloud, Mesh, Query, QuerySettings, Scene, SceneError};
use cloudtouch_cli::files::scene::{self, BodyEntry, SceneFile};
use cloudtouch_io::{LengthUnit, is_depth_image};
use rayon::prelude::*;

use crate::answers::print;
use crate::answers::scene::{Bodies, place};
use crate::args::{BodyOptions, CommonArguments, SceneArguments};
use crate::body::Body;
use crate::load::{self, Input, Loaded, Role};
use crate::sensor::SensorChoice;
use crate::usage::WrongUsage;
use crate::{answers, pages, unused};

/// A file, the unit it is said to be in, the sensor that saw it, by its spec, and what is said of it as a
/// depth image, spelt out.
type BodyKey = (PathBuf, Option<LengthUnit>, String, String);

/// What several bodies of a scene may share.
struct Prepared {
    body: Arc<cloudtouch::Body>,
    input: Input,
    /// What it is, for people.
    words: String,
}

pub(crate) fn run(arguments: &SceneArguments) -> Result<ExitCode> {
    let common = &arguments.common;
    let named = || arguments.scene.display().to_string();
    let file = scene::read(&arguments.scene, common.limits.read_limits().bytes)?;
    let query = Query::new(settings(common, &file).with_context(named)?)?;
    let of_bodies = file.bodies.iter().map(|of| of.file.as_path());
    arguments.answer.check_page(of_bodies.chain([arguments.scene.as_path()]))?;
    // What can be told without work comes first.
    let mut scene = outline(&file).with_context(named)?;
    let keys = keys(common, &file).with_context(named)?;
    let prepared = prepare(common, &file, &keys).with_context(named)?;
    check_sensors(common, &file, &keys, &prepared).with_context(named)?;
    let bodies: BTreeMap<&str, &Prepared> =
        file.bodies.iter().zip(&keys).map(|(of, key)| (of.name.as_str(), &prepared[key])).collect();
    for (name, prepared) in &bodies {
        scene.replace(name, Arc::clone(&prepared.body))?;
    }
    let checked = scene.check(&query);
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

impl Prepared {
    fn words_of(&self, entry: &BodyEntry) -> String {
        let attached = entry.attached_to.as_deref().map(print::one_line);
        let attached = attached.map_or(String::new(), |to| format!(", attached to {to}"));
        format!("{}: {}{attached}", print::one_line(&entry.name), self.words)
    }
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

/// What to read for each body, after a look whether it is there.
fn keys(common: &CommonArguments, file: &SceneFile) -> Result<Vec<BodyKey>> {
    let key = |(index, entry): (usize, &BodyEntry)| {
        let place = || format!("body {} `{}`", index + 1, entry.name);
        let BodyEntry { file, sensor, unit, depth, .. } = entry;
        load::check(file).with_context(place)?;
        check_image(entry).with_context(place)?;
        let sensor = match sensor {
            Some(spec) => spec.parse::<SensorChoice>().map_err(|error| anyhow!("{error}")),
            None => Ok(common.scene_sensor()),
        };
        Ok((file.clone(), *unit, sensor.with_context(place)?.to_string(), format!("{depth:?}")))
    };
    file.bodies.iter().enumerate().map(key).collect()
}

/// Refuses what is said of a depth image where the file is none, and a unit where it is one.
fn check_image(entry: &BodyEntry) -> Result<()> {
    let file = entry.file.display();
    let is_image = is_depth_image(&entry.file);
    ensure!(
        is_image || entry.depth.is_empty(),
        "`intrinsics` and `depth_scale` are of a depth image (.png), and {file} is none: leave them out"
    );
    ensure!(
        !is_image || entry.unit.is_none(),
        "`unit` is not for a depth image, and {file} is one: give `depth_scale`, metres a step"
    );
    Ok(())
}

/// Refuses a sensor of a mesh, and one of all clouds where each has its own.
fn check_sensors(
    common: &CommonArguments,
    file: &SceneFile,
    keys: &[BodyKey],
    prepared: &BTreeMap<BodyKey, Prepared>,
) -> Result<()> {
    let mut any_without = false;
    for (index, (entry, key)) in file.bodies.iter().zip(keys).enumerate() {
        let is_mesh = matches!(*prepared[key].body, cloudtouch::Body::Mesh(_));
        ensure!(
            !is_mesh || entry.sensor.is_none(),
            "body {} `{}`: {}",
            index + 1,
            entry.name,
            unused::of_a_mesh("sensor", &prepared[key].input.file)
        );
        any_without |= !is_mesh && entry.sensor.is_none();
    }
    let each_has_one = "--sensor is for clouds without a `sensor` of their own, and each cloud has one: \
                        leave it out";
    ensure!(any_without || common.sensor.is_none(), WrongUsage(each_has_one.to_owned()));
    Ok(())
}

/// Reads every file once for all bodies that take it for the same.
fn prepare(
    common: &CommonArguments,
    file: &SceneFile,
    keys: &[BodyKey],
) -> Result<BTreeMap<BodyKey, Prepared>> {
    // Of several bodies of one file the first.
    let place = |key: &BodyKey| keys.iter().position(|other| other == key).unwrap_or_default();
    let first = |key: &BodyKey| {
        let index = place(key);
        format!("body {} `{}`", index + 1, file.bodies[index].name)
    };
    let wanted: BTreeMap<&BodyKey, usize> = keys.iter().fold(BTreeMap::new(), |mut wanted, key| {
        *wanted.entry(key).or_default() += 1;
        wanted
    });
    let wanted: Vec<(&BodyKey, usize)> = wanted.into_iter().collect();
    let loaded = wanted.into_par_iter().map(|(key, bodies)| {
        let (path, unit, sensor, _) = key;
        let sensor = sensor.parse::<SensorChoice>().map_err(|error| anyhow!("{error}"))?;
        let usual = common.bodies();
        let depth = file.bodies[place(key)].depth.or(&usual.depth);
        let options = BodyOptions { depth, ..usual };
        let loaded = load::body_in::<Cloud>(path, *unit, sensor, &options);
        let loaded = loaded.with_context(|| first(key))?;
        Ok((key, loaded.refined_for(bodies, common.effort.refine())?))
    });
    let loaded: Vec<(&BodyKey, Loaded<Cloud>)> = loaded.collect::<Result<_>>()?;
    let are = loaded.iter().flat_map(|(_, loaded)| loaded.files(Role::Scene));
    unused::check(&common.bodies(), are)?;
    let prepared = loaded.into_iter().map(|(key, loaded)| {
        let words = print::about(&loaded);
        let body = Arc::new(match loaded.body {
            Body::Cloud(cloud) => cloud.into(),
            Body::Mesh(mesh) => mesh.into(),
        });
        (key.clone(), Prepared { body, input: loaded.input, words })
    });
    Ok(prepared.collect())
}
