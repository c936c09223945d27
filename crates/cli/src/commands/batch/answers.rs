//! Answers case by case, as they come.

use std::io::{self, Write};

use anyhow::{Error, Result};
use cloudtouch_cli::files::case::{Case, CaseFile};

use super::bodies::{Bodies, guessed, keys};
use crate::answers::per_point::Details;
use crate::answers::print;
use crate::answers::query::{Answer as Line, json_error_line};
use crate::answers::table::Table;
use crate::args::{BatchArguments, BodyOptions};
use crate::body;
use crate::ordered;
use crate::pages::batch::{Answered, Shown};
use crate::progress::progress_bar;

/// A batch that is asked about.
pub(super) struct Batch<'a, P: body::Estimator> {
    pub query: &'a P,
    pub arguments: &'a BatchArguments,
    pub options: &'a BodyOptions<'a>,
    pub file: &'a CaseFile,
    pub bodies: &'a Bodies<P::Cloud>,
}

/// What became of one case: a report, or the reason why there is none.
type Answer<'a, C> = Result<Answered<'a, C>, String>;

/// What is left to tell when all cases are asked.
pub(super) struct Done<'a, C> {
    /// Whether a case has no answer.
    pub has_failed: bool,
    /// Why nothing more was printed: no fault of the file that is written beside.
    pub unprinted: Option<Error>,
    /// For the page; nothing where none is wanted.
    pub shown: Shown<'a, C>,
}

impl<'a, P: body::Estimator> Batch<'a, P> {
    /// Asks about all cases: writes a line of JSON for each, and prints these or a table.
    pub(super) fn write(
        &self,
        jsonl: &mut dyn Write,
        done: &mut Done<'a, P::Cloud>,
    ) -> io::Result<()> {
        let (file, in_json) = (self.file, self.arguments.json);
        let cases = &file.cases;
        let progress = progress_bar(cases.len(), "queries");
        let mut table = Table::new(cases, self.arguments.asked.mode.margin);
        if !in_json {
            to_stdout(&(guessed(self.bodies) + &table.head()), done)?;
        }
        let threads = rayon::current_num_threads();
        let work = |index: usize| self.answer(&cases[index].1);
        ordered::for_each(cases.len(), threads, work, |index, answer: Answer<'_, _>| {
            let (id, case) = &cases[index];
            let line = line(id, &answer).map_err(io::Error::other)?;
            done.has_failed |= answer.is_err();
            writeln!(jsonl, "{line}")?;
            progress.inc(1);
            let told = answer
                .as_ref()
                .map(|answered| (&answered.report, answered.nearness.as_ref()))
                .map_err(String::as_str);
            progress.suspend(|| {
                let row = table.row(id, case, told);
                to_stdout(&if in_json { format!("{line}\n") } else { row }, done)
            })?;
            if self.arguments.html.is_some() {
                done.shown.push(id, answer);
            }
            Ok::<(), io::Error>(())
        })?;
        progress.finish_and_clear();
        if in_json { Ok(()) } else { to_stdout(&table.foot(), done) }
    }

    fn answer(&self, case: &'a Result<Case>) -> Answer<'a, P::Cloud> {
        let case = case.as_ref().map_err(|error| format!("{error:#}"))?;
        let [scene, object] =
            keys(self.arguments, self.options, case).map(|key| match self.bodies.get(&key) {
                Some(Ok(loaded)) => Ok(loaded),
                Some(Err(error)) => Err(error.clone()),
                None => Err(format!("{}: not prepared", key.0.display())),
            });
        let (scene, object, pose) = (scene?, object?, &case.scene_from_object);
        let (report, nearness) = self
            .query
            .ask_within(&scene.body, &object.body, pose, self.arguments.asked.mode.margin)
            .map_err(|error| error.to_string())?;
        let bodies = [(case.scene.as_path(), scene), (case.object.as_path(), object)];
        let placement = self.query.place(&scene.body, &object.body, pose);
        Ok(Answered { report, placement, pose, bodies, nearness })
    }
}

/// A line of JSON.
fn line<C>(id: &str, answer: &Answer<'_, C>) -> Result<String> {
    match answer {
        Ok(Answered { report, placement, pose, bodies, nearness }) => {
            let (details, nearness) = (Details::default(), *nearness);
            let inputs = bodies.map(|(_, loaded)| &loaded.input);
            Line { report, placement, pose, details, nearness, doubt: None }.json_line(id, inputs)
        }
        Err(error) => json_error_line(id, error),
    }
}

fn to_stdout<C>(text: &str, done: &mut Done<'_, C>) -> io::Result<()> {
    print::to_stdout(text).map_err(|error| {
        done.unprinted = Some(error);
        io::Error::other("standard output")
    })
}
