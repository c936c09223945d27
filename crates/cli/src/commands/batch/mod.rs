//! `cloudtouch batch`: many poses; scenes and objects are prepared once.

mod answers;
mod bodies;

use std::io::{self, Write};
use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::{Error, Result};
use cloudtouch::{PaperQuery, Query};
use cloudtouch_cli::files::case::{self, CaseFile};
use cloudtouch_io::write_atomically;

use self::answers::{Batch, Done};
use crate::answers::print;
use crate::args::{BatchArguments, BodyOptions, ModeName};
use crate::body;
use crate::output::{self, Output};
use crate::pages::batch::Shown;

pub(crate) fn run(arguments: &BatchArguments) -> Result<ExitCode> {
    let common = &arguments.asked.common;
    match arguments.asked.mode.mode {
        ModeName::Calibrated => run_by(&Query::new(common.query_settings())?, arguments),
        ModeName::Paper => {
            run_by(&PaperQuery::new(arguments.asked.mode.paper_settings(common))?, arguments)
        }
    }
}

fn run_by<P: body::Estimator>(query: &P, arguments: &BatchArguments) -> Result<ExitCode> {
    let limits = arguments.asked.common.limits.read_limits();
    let file = case::read(&arguments.cases, limits.bytes)?;
    let good = || file.cases.iter().filter_map(|(_, case)| case.as_ref().ok());
    let options = &arguments.asked.bodies();
    check_files(arguments, options, &file)?;
    bodies::sensors_for(arguments).check(&file)?;
    warn_of_same_names(arguments, &file);
    let bodies = bodies::prepare::<P::Cloud>(arguments, options, good())?;
    bodies::warn_of_sensors_of_meshes(arguments, options, good(), &bodies);
    // What cannot be read may be what a sensor is for.
    if good().count() == file.cases.len() {
        bodies::warn_of_unused_sensors(arguments, options, good(), &bodies);
    }
    let batch = Batch { query, arguments, options, file: &file, bodies: &bodies };
    let mut done = Done { has_failed: false, unprinted: None, shown: Shown::new() };
    let mut write = |jsonl: &mut dyn Write| batch.write(jsonl, &mut done);
    let written = match &arguments.jsonl {
        Some(path) => write_atomically(path, write).map_err(Error::from),
        None => write(&mut io::sink()).map_err(Error::from),
    };
    if let Some(error) = done.unprinted.take() {
        return Err(error);
    }
    written?;
    if let Some(path) = &arguments.html {
        let cases = arguments.cases.file_name().unwrap_or_default().to_string_lossy();
        done.shown.write(path, &cases, &limits)?;
    }
    Ok(if done.has_failed { ExitCode::FAILURE } else { ExitCode::SUCCESS })
}

/// Whether no file would be written that is there, or is read.
fn check_files(
    arguments: &BatchArguments,
    options: &BodyOptions<'_>,
    file: &CaseFile,
) -> Result<()> {
    let cases = file.cases.iter().filter_map(|(_, case)| case.as_ref().ok());
    let files = cases.flat_map(|case| [case.scene.as_path(), case.object.as_path()]);
    let settings = options.settings.map(|file| &file.path);
    let others = options.robot.iter().chain([&arguments.cases]).chain(settings);
    let inputs = files.chain(others.map(PathBuf::as_path)).chain(options.depth.file());
    let outputs = [Output::table(&arguments.jsonl), Output::of("html", &arguments.html)];
    output::check(&outputs, inputs, arguments.force)
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
