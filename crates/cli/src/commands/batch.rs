//! `cloudtouch batch`: many poses; scenes and objects are prepared once.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::Result;
use cloudtouch::noise::SensorModel;
use cloudtouch::{PaperQuery, Query, Report};
use cloudtouch_io::write_atomically;
use indicatif::{ProgressBar, ProgressStyle};
use rayon::prelude::*;

use crate::args::{BatchArguments, ModeName};
use crate::body::{self, Body};
use crate::case_file::{self, Case};
use crate::load::{self, Role};
use crate::print;

/// A file in a role seen by a sensor (by its spec, which names it fully).
type BodyKey = (PathBuf, Role, String);

/// What became of one case: a report, or the reason why there is none.
type Answer = Result<Report, String>;

pub(crate) fn run(arguments: &BatchArguments) -> Result<ExitCode> {
    let common = &arguments.common;
    match common.mode {
        ModeName::Calibrated => run_by(&Query::new(common.query_settings())?, arguments),
        ModeName::Paper => run_by(&PaperQuery::new(common.paper_settings())?, arguments),
    }
}

fn run_by<P: body::Path>(query: &P, arguments: &BatchArguments) -> Result<ExitCode> {
    let file = case_file::read(&arguments.cases, arguments.common.limits.read_limits().bytes)?;
    let bodies = prepare_all(arguments, file.cases.iter().filter_map(|(_, c)| c.as_ref().ok()));
    let progress = progress_bar(file.cases.len(), "queries");
    let answers: Vec<Answer> = file
        .cases
        .par_iter()
        .map(|(_, case)| {
            let answer = match case {
                Ok(case) => answer(arguments, query, &bodies, case),
                Err(error) => Err(format!("{error:#}")),
            };
            progress.inc(1);
            answer
        })
        .collect();
    progress.finish_and_clear();

    let lines = file
        .cases
        .iter()
        .zip(&answers)
        .map(|((id, _), answer)| match answer {
            Ok(report) => print::json_line(id, report),
            Err(error) => print::json_error_line(id, error),
        })
        .collect::<Result<Vec<String>>>()?;
    if let Some(path) = &arguments.jsonl {
        write_atomically(path, |out| lines.iter().try_for_each(|line| writeln!(out, "{line}")))?;
    }
    print::to_stdout(&if arguments.json {
        lines.iter().map(|line| format!("{line}\n")).collect()
    } else {
        table(&file.cases, &answers)
    })?;
    let failed = answers.iter().any(Result::is_err);
    Ok(if failed { ExitCode::FAILURE } else { ExitCode::SUCCESS })
}

fn answer<P: body::Path>(
    arguments: &BatchArguments,
    query: &P,
    bodies: &BTreeMap<BodyKey, Result<Body<P::Cloud>, String>>,
    case: &Case,
) -> Answer {
    let [scene, object] = keys(arguments, case).map(|key| match bodies.get(&key) {
        Some(Ok(body)) => Ok(body),
        Some(Err(error)) => Err(error.clone()),
        None => Err(format!("{}: not prepared", key.0.display())),
    });
    query.ask(scene?, object?, &case.scene_from_object).map_err(|error| error.to_string())
}

fn keys(arguments: &BatchArguments, case: &Case) -> [BodyKey; 2] {
    let common = &arguments.common;
    let named = |path: &Path| {
        let name = path.to_string_lossy();
        let found = arguments.sensor_for.iter().find(|(part, _)| name.contains(part.as_str()));
        found.map(|(_, sensor)| sensor)
    };
    let key = |path: &Path, role, given: &Option<SensorModel>, default: &SensorModel| {
        let sensor = given.as_ref().or(named(path)).unwrap_or(default);
        (path.to_owned(), role, sensor.to_string())
    };
    let object_default = common.object_sensor.as_ref().unwrap_or(&common.sensor);
    [
        key(&case.scene, Role::Scene, &case.scene_sensor, &common.sensor),
        key(&case.object, Role::Object, &case.object_sensor, object_default),
    ]
}

fn prepare_all<'a, C: body::PreparedCloud>(
    arguments: &BatchArguments,
    cases: impl Iterator<Item = &'a Case>,
) -> BTreeMap<BodyKey, Result<Body<C>, String>> {
    let wanted: BTreeSet<BodyKey> = cases.flat_map(|case| keys(arguments, case)).collect();
    let progress = progress_bar(wanted.len(), "files");
    let wanted: Vec<BodyKey> = wanted.into_iter().collect();
    let bodies = wanted
        .into_par_iter()
        .map(|key| {
            let (path, role, spec) = &key;
            let body = spec
                .parse::<SensorModel>()
                .map_err(anyhow::Error::from)
                .and_then(|sensor| load::body(path, *role, &sensor, &arguments.common))
                .map_err(|error| format!("{error:#}"));
            progress.inc(1);
            (key, body)
        })
        .collect();
    progress.finish_and_clear();
    bodies
}

/// Drawn on standard error, and only when that is a terminal.
fn progress_bar(length: usize, unit: &'static str) -> ProgressBar {
    let style = ProgressStyle::with_template("{bar:40} {pos}/{len} {msg} ({eta})")
        .unwrap_or_else(|_| ProgressStyle::default_bar());
    ProgressBar::new(length as u64).with_style(style).with_message(unit)
}

/// One line a case, and a line about all of them.
fn table(cases: &[(String, Result<Case>)], answers: &[Answer]) -> String {
    let label_of = |case: &Result<Case>| {
        case.as_ref().ok().and_then(|c| c.label.clone()).unwrap_or("-".to_owned())
    };
    let width =
        |least: usize, texts: &mut dyn Iterator<Item = usize>| texts.fold(least, usize::max);
    let id_width = width(4, &mut cases.iter().map(|(id, _)| id.chars().count()));
    let label_width = width(5, &mut cases.iter().map(|(_, c)| label_of(c).chars().count()));
    let mut text = format!(
        "{:<id_width$}  {:<label_width$}  {:>5}  {:<14}  {:<12}  {:>14}  {:>10}  scene / object\n",
        "case", "label", "P", "bounds", "verdict", "clearance (mm)", "time"
    );
    // Writing to a string cannot fail.
    for ((id, case), answer) in cases.iter().zip(answers) {
        let label = label_of(case);
        let report = match answer {
            Ok(report) => report,
            Err(error) => {
                let _ = writeln!(text, "{id:<id_width$}  {label:<label_width$}  error: {error}");
                continue;
            }
        };
        let [low, high] = report.bounds.map(print::probability);
        let files = case.as_ref().map_or(String::new(), |c| {
            let name = |p: &Path| p.file_name().unwrap_or_default().to_string_lossy().into_owned();
            format!("{} / {}", name(&c.scene), name(&c.object))
        });
        let _ = writeln!(
            text,
            "{id:<id_width$}  {label:<label_width$}  {:>5}  {:<14}  {:<12}  {:>14}  {:>7.1} ms  {files}",
            print::probability(report.collision_probability),
            format!("{low} .. {high}"),
            report.verdict,
            print::gap_mm(report.clearance_m),
            report.stats.query_us as f64 / 1e3,
        );
    }
    let reports: Vec<&Report> = answers.iter().filter_map(|a| a.as_ref().ok()).collect();
    let _ = write!(text, "{} answers, {} errors", reports.len(), answers.len() - reports.len());
    if !reports.is_empty() {
        let _ = write!(
            text,
            "; median query {:.2} ms, median preparation {:.1} ms",
            median(reports.iter().map(|r| r.stats.query_us)) / 1e3,
            median(reports.iter().map(|r| r.stats.prepare_us)) / 1e3,
        );
    }
    text.push('\n');
    text
}

fn median(values: impl Iterator<Item = u64>) -> f64 {
    let mut values: Vec<u64> = values.collect();
    values.sort_unstable();
    let middle = values.len() / 2;
    if values.len() % 2 == 1 {
        values[middle] as f64
    } else {
        0.5 * (values[middle - 1] + values[middle]) as f64
    }
}
