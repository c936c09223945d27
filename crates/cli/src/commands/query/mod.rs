//! `cloudtouch query`: one object in one scene at one pose.

mod ask;
mod question;
mod tell;
mod write;

use std::process::ExitCode;

use anyhow::Result;
use cloudtouch::{PaperQuery, Query};

use crate::answers::print;
use crate::args::{ModeName, QueryArguments, exit_code};
use crate::body;
use crate::progress::Steps;

pub(crate) fn run(arguments: &QueryArguments, shows_work: bool) -> Result<ExitCode> {
    let common = &arguments.asked.common;
    match arguments.asked.mode.mode {
        ModeName::Calibrated => {
            run_by(&Query::new(common.query_settings())?, arguments, shows_work)
        }
        ModeName::Paper => run_by(
            &PaperQuery::new(arguments.asked.mode.paper_settings(common))?,
            arguments,
            shows_work,
        ),
    }
}

fn run_by<P: body::Estimator>(
    query: &P,
    arguments: &QueryArguments,
    shows_work: bool,
) -> Result<ExitCode> {
    // What can be told without work comes first.
    question::check_files(arguments)?;
    let steps = Steps::about(question::bodies(arguments));
    steps.tell("reading and preparing");
    let question = question::load(arguments)?;
    steps.tell("asking");
    let found = ask::ask(query, &question)?;
    write::files(&question, &found)?;
    let text = match arguments.json {
        true => tell::json(&question, &found)?,
        false => tell::text(&question, &found, shows_work),
    };
    print::to_stdout(&format!("{text}\n"))?;
    let verdict = found.report.verdict;
    Ok(if arguments.exit_code { exit_code(verdict) } else { ExitCode::SUCCESS })
}
