//! `cloudtouch batch`: many poses; scenes and objects are prepared once.

use std::collections::BTreeMap;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::{Result, anyhow};
use cloudtouch::{PaperQuery, Query};
use cloudtouch_io::write_atomically;
use indicatif::{ProgressBar, ProgressStyle};
use rayon::prelude::*;

use crate::answers::per_point::Details;
use crate::answers::print;
use crate::answers::query::{Answer as Line, json_error_line};
use crate::answers::table::Table;
use crate::args::{BatchArguments, ModeName};
use crate::body;
use crate::load::sensor_for::SensorsFor;
use crate::load::{self, Input, Loaded, Role};
use crate::output::Output;
use crate::pages::batch::{Answered, Shown};
use crate::sensor::SensorChoice;
use crate::{ordered, output, remedies, unused};
use cloudtouch_cli::files::case::{self, Case, CaseFile};

/// A file in a role seen by a sensor (by its spec, which names it fully).
type BodyKey = (PathBuf, Role, String);
type Bodies<C> = BTreeMap<BodyKey, Result<Loaded<C>, String>>;

/// What became of one case: a report, or the reason why there is none.
type Answer<'a, C> = Result<Answered<'a, C>, String>;

pub(crate) fn run(arguments: &BatchArguments) -> Result<ExitCode> {
    let common = &arguments.common;
    match arguments.mode.mode {
        ModeName::Calibrated => run_by(&Query::new(common.query_settings())?, arguments),
        ModeName::Paper => {
            run_by(&PaperQuery::new(arguments.mode.paper_settings(common))?, arguments)
        }
    }
}

fn run_by<P: body::Path>(query: &P, arguments: &BatchArguments) -> Result<ExitCode> {
    let file = case::read(&arguments.cases, arguments.common.limits.read_limits().bytes)?;
    let good = || file.cases.iter().filter_map(|(_, case)| case.as_ref().ok());
    let files = good().flat_map(|case| [case.scene.as_path(), case.object.as_path()]);
    let options = arguments.bodies();
    let settings = options.settings.map(|file| &file.path);
    let others = options.robot.iter().chain([&arguments.cases]).chain(settings);
    let inputs = files.chain(others.map(PathBuf::as_path));
    let outputs = [Output::table(&arguments.jsonl), Output::of("html", &arguments.html)];
    output::check(&outputs, inputs, arguments.force)?;
    sensors_for(arguments).check(&file)?;
    warn_of_same_names(arguments, &file);
    let bodies = prepare_all::<P::Cloud>(arguments, good())?;
    warn_of_sensors_of_meshes(arguments, good(), &bodies);
    let progress = progress_bar(file.cases.len(), "queries");
    let mut table = Table::new(&file.cases, arguments.mode.margin);
    let mut failed = false;
    let mut shown = Shown::new();
    let mut write = |jsonl: &mut dyn Write| -> io::Result<()> {
        if !arguments.json {
            to_stdout(&guessed(&bodies))?;
            to_stdout(&table.head())?;
        }
        let threads = rayon::current_num_threads();
        let work = |index: usize| match &file.cases[index].1 {
            Ok(case) => answer(arguments, query, &bodies, case),
            Err(error) => Err(format!("{error:#}")),
        };
        ordered::for_each(file.cases.len(), threads, work, |index, answer: Answer<'_, _>| {
            let (id, case) = &file.cases[index];
            let line = match &answer {
                Ok(Answered { report, placement, pose, bodies, nearness }) => {
                    let (details, nearness) = (Details::default(), *nearness);
                    let inputs = bodies.map(|(_, loaded)| &loaded.input);
                    Line { report, placement, pose, details, nearness, doubt: None }
                        .json_line(id, inputs)
                }
                Err(error) => json_error_line(id, error),
            };
            let line = line.map_err(io::Error::other)?;
            failed |= answer.is_err();
            writeln!(jsonl, "{line}")?;
            progress.inc(1);
            let told = answer
                .as_ref()
                .map(|answered| (&answered.report, answered.nearness.as_ref()))
                .map_err(String::as_str);
            progress.suspend(|| {
                let row = table.row(id, case, told);
                to_stdout(&if arguments.json { format!("{line}\n") } else { row })
            })?;
            if arguments.html.is_some() {
                shown.push(id, answer);
            }
            Ok::<(), io::Error>(())
        })?;
        progress.finish_and_clear();
        if arguments.json { Ok(()) } else { to_stdout(&table.foot()) }
    };
    match &arguments.jsonl {
        Some(path) => write_atomically(path, write)?,
        None => write(&mut io::sink())?,
    }
    if let Some(path) = &arguments.html {
        let cases = arguments.cases.file_name().unwrap_or_default().to_string_lossy();
        shown.write(path, &cases, &arguments.common.limits.read_limits())?;
    }
    Ok(if failed { ExitCode::FAILURE } else { ExitCode::SUCCESS })
}

/// Names that more than one case has; of many such names no more are told.
const SAME_NAMES_TOLD: usize = 3;

fn warn_of_same_names(arguments: &BatchArguments, file: &CaseFile) {
    let same = file.same_names();
    for (name, [first, second]) in same.iter().take(SAME_NAMES_TOLD) {
        tracing::warn!(
            "{}: cases {first} and {second} are both `{}`: only the order tells their answers apart",
            arguments.cases.display(),
            print::one_line(name)
        );
    }
    if let Some(more) = same.len().checked_sub(SAME_NAMES_TOLD).filter(|more| *more > 0) {
        tracing::warn!("{}: {more} more names are of several cases", arguments.cases.display());
    }
}

/// Cases are often written by programs, the same fields for clouds and meshes: one is told, and none refused.
fn warn_of_sensors_of_meshes<'a, C: body::PreparedCloud>(
    arguments: &BatchArguments,
    mut cases: impl Iterator<Item = &'a Case>,
    bodies: &Bodies<C>,
) {
    let found = cases.find_map(|case| {
        let given = [case.scene_sensor.is_some(), case.object_sensor.is_some()];
        let fields = ["scene_sensor", "object_sensor"].into_iter().zip(given);
        fields.zip(keys(arguments, case)).find_map(|((field, is_given), key)| {
            let body = bodies.get(&key)?.as_ref().ok()?;
            (is_given && body.is_mesh()).then(|| unused::of_a_mesh(field, &body.input.file))
        })
    });
    if let Some(words) = found {
        tracing::warn!("{}: {words}", arguments.cases.display());
    }
}

/// What was taken for the sensor of each file where nothing was said.
fn guessed<C: body::PreparedCloud>(bodies: &Bodies<C>) -> String {
    let input = |loaded: &Loaded<C>| {
        let Input { file, sensor, sensor_because, .. } = &loaded.input;
        Some(format!("{file}: sensor {} ({})\n", sensor.as_ref()?, (*sensor_because)?))
    };
    bodies.values().flatten().filter_map(input).collect()
}

fn to_stdout(text: &str) -> io::Result<()> {
    print::to_stdout(text).map_err(io::Error::other)
}

fn answer<'a, P: body::Path>(
    arguments: &BatchArguments,
    query: &P,
    bodies: &'a Bodies<P::Cloud>,
    case: &'a Case,
) -> Answer<'a, P::Cloud> {
    let [scene, object] = keys(arguments, case).map(|key| match bodies.get(&key) {
        Some(Ok(loaded)) => Ok(loaded),
        Some(Err(error)) => Err(error.clone()),
        None => Err(format!("{}: not prepared", key.0.display())),
    });
    let (scene, object, pose) = (scene?, object?, &case.scene_from_object);
    let (report, nearness) = query
        .ask_within(&scene.body, &object.body, pose, arguments.mode.margin)
        .map_err(|error| error.to_string())?;
    let bodies = [(case.scene.as_path(), scene), (case.object.as_path(), object)];
    let placement = query.place(&scene.body, &object.body, pose);
    Ok(Answered { report, placement, pose, bodies, nearness })
}

fn sensors_for(arguments: &BatchArguments) -> SensorsFor<'_> {
    SensorsFor { given: &arguments.sensor_for, cases: &arguments.cases }
}

fn keys(arguments: &BatchArguments, case: &Case) -> [BodyKey; 2] {
    let common = &arguments.common;
    let named = sensors_for(arguments);
    let key = |path: &Path, role, given: Option<SensorChoice>, default: SensorChoice| {
        let sensor = given.or(named.of(path)).unwrap_or(default);
        (path.to_owned(), role, sensor.to_string())
    };
    [
        key(&case.scene, Role::Scene, case.scene_sensor, common.scene_sensor()),
        key(&case.object, Role::Object, case.object_sensor, arguments.bodies().object_sensor()),
    ]
}

fn prepare_all<'a, C: body::PreparedCloud>(
    arguments: &BatchArguments,
    cases: impl Iterator<Item = &'a Case>,
) -> Result<Bodies<C>> {
    let options = &arguments.bodies();
    // How many poses are asked of each.
    let mut wanted: BTreeMap<BodyKey, usize> = BTreeMap::new();
    for key in cases.flat_map(|case| keys(arguments, case)) {
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

/// Drawn on standard error, and only when that is a terminal.
fn progress_bar(length: usize, unit: &'static str) -> ProgressBar {
    let style = ProgressStyle::with_template("{bar:40} {pos}/{len} {msg} ({eta})")
        .unwrap_or_else(|_| ProgressStyle::default_bar());
    ProgressBar::new(length as u64).with_style(style).with_message(unit)
}
