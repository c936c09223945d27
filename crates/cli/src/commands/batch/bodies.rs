//! The bodies of all cases, each prepared once.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use anyhow::{Result, anyhow};
use cloudtouch_cli::files::case::Case;
use rayon::prelude::*;

use crate::args::{BatchArguments, BodyOptions};
use crate::body::PreparedCloud;
use crate::load::sensor_for::SensorsFor;
use crate::load::{self, Input, Loaded, Role};
use crate::progress::progress_bar;
use crate::sensor::SensorChoice;
use crate::{remedies, unused, usage};

/// A file in a role seen by a sensor (by its spec, which names it fully).
pub(super) type BodyKey = (PathBuf, Role, String);
pub(super) type Bodies<C> = BTreeMap<BodyKey, Result<Loaded<C>, String>>;

/// Prepares each file once for each role and sensor that the cases have it in.
pub(super) fn prepare<'a, C: PreparedCloud>(
    arguments: &BatchArguments,
    options: &BodyOptions<'_>,
    cases: impl Iterator<Item = &'a Case>,
) -> Result<Bodies<C>> {
    // How many poses are asked of each.
    let mut wanted: BTreeMap<BodyKey, usize> = BTreeMap::new();
    for key in cases.flat_map(|case| keys(arguments, options, case)) {
        *wanted.entry(key).or_default() += 1;
    }
    let progress = progress_bar(wanted.len(), "files");
    let wanted: Vec<(BodyKey, usize)> = wanted.into_iter().collect();
    let bodies: Bodies<C> = wanted
        .into_par_iter()
        .map(|(key, poses)| {
            let (path, role, spec) = &key;
            let body = spec
                .parse::<SensorChoice>()
                .map_err(|error| anyhow!("{error}"))
                .and_then(|sensor| load::body(path, *role, sensor, options))
                .and_then(|loaded| loaded.refined_for(poses, options.common.effort.refine()))
                .map_err(|error| remedies::error(&error));
            progress.inc(1);
            (key, body)
        })
        .collect();
    progress.finish_and_clear();
    // What cannot be read may be what an option is for.
    let are = bodies.iter().map(|((path, role, _), body)| {
        body.as_ref().ok().map(|loaded| (path.as_path(), *role, loaded))
    });
    if let Some(are) = are.collect::<Option<Vec<_>>>()
        && !are.is_empty()
    {
        unused::check(options, are.iter().flat_map(|(_, role, loaded)| loaded.files(*role)))?;
        let files: Vec<_> = are.iter().map(|(path, _, loaded)| (*path, loaded.is_mesh())).collect();
        sensors_for(arguments).check_meshes(&files)?;
    }
    Ok(bodies)
}

pub(super) fn keys(
    arguments: &BatchArguments,
    options: &BodyOptions<'_>,
    case: &Case,
) -> [BodyKey; 2] {
    let named = sensors_for(arguments);
    let key = |path: &Path, role, given: Option<SensorChoice>, default: SensorChoice| {
        let sensor = given.or(named.of(path)).unwrap_or(default);
        (path.to_owned(), role, sensor.to_string())
    };
    [
        key(&case.scene, Role::Scene, case.scene_sensor, options.common.scene_sensor()),
        key(&case.object, Role::Object, case.object_sensor, options.object_sensor()),
    ]
}

pub(super) fn sensors_for(arguments: &BatchArguments) -> SensorsFor<'_> {
    SensorsFor { given: &arguments.sensor_for, cases: &arguments.cases }
}

/// Cases are often written by programs, the same fields for clouds and meshes: one is told, and none refused.
pub(super) fn warn_of_sensors_of_meshes<'a, C: PreparedCloud>(
    arguments: &BatchArguments,
    options: &BodyOptions<'_>,
    mut cases: impl Iterator<Item = &'a Case>,
    bodies: &Bodies<C>,
) {
    let found = cases.find_map(|case| {
        let given = [case.scene_sensor.is_some(), case.object_sensor.is_some()];
        let fields = ["scene_sensor", "object_sensor"].into_iter().zip(given);
        fields.zip(keys(arguments, options, case)).find_map(|((field, is_given), key)| {
            let body = bodies.get(&key)?.as_ref().ok()?;
            (is_given && body.is_mesh()).then(|| usage::of_a_mesh(field, &body.input.file))
        })
    });
    if let Some(words) = found {
        tracing::warn!("{}: {words}", arguments.cases.display());
    }
}

/// Tells of sensors that are given for clouds where each has another that goes before: no answer is by them.
pub(super) fn warn_of_unused_sensors<'a, C: PreparedCloud>(
    arguments: &BatchArguments,
    options: &BodyOptions<'_>,
    cases: impl Iterator<Item = &'a Case>,
    bodies: &Bodies<C>,
) {
    let named = sensors_for(arguments);
    let given = |(name, sensor): &(String, SensorChoice)| format!("--sensor-for {name}={sensor}");
    let mut unused: Vec<Option<String>> =
        arguments.sensor_for.iter().map(given).map(Some).collect();
    let [mut of_all, mut of_objects] =
        [("--sensor", options.common.sensor), ("--object-sensor", options.object_sensor)]
            .map(|(option, sensor)| sensor.map(|sensor| format!("{option} {sensor}")));
    for case in cases {
        let given = [case.scene_sensor, case.object_sensor];
        for (key, _) in
            keys(arguments, options, case).iter().zip(given).filter(|(_, given)| given.is_none())
        {
            // What cannot be read may be a cloud.
            if bodies.get(key).is_some_and(|body| body.as_ref().is_ok_and(Loaded::is_mesh)) {
                continue;
            }
            match named.place(&key.0) {
                Some(place) => unused[place] = None,
                None if key.1 == Role::Object && options.object_sensor.is_some() => {
                    of_objects = None
                }
                None => of_all = None,
            }
        }
    }
    unused.extend([of_all, of_objects]);
    for option in unused.into_iter().flatten() {
        tracing::warn!(
            "{}: {option} is of no cloud, each has a sensor that goes before it: leave it out",
            arguments.cases.display()
        );
    }
}

/// What was taken for the sensor of each file where nothing was said.
pub(super) fn guessed<C: PreparedCloud>(bodies: &Bodies<C>) -> String {
    let input = |loaded: &Loaded<C>| {
        let Input { file, sensor, sensor_because, .. } = &loaded.input;
        Some(format!("{file}: sensor {} ({})\n", sensor.as_ref()?, (*sensor_because)?))
    };
    bodies.values().flatten().filter_map(input).collect()
}
