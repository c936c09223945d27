//! The table of a batch, a row at a time.

use std::collections::BTreeSet;
use std::mem::discriminant;
use std::path::Path;

use anyhow::Result;
use cloudtouch::{Report, Warning};

use crate::answers::print;
use crate::margin::Nearness;
use crate::remedies;
use cloudtouch_cli::files::case::Case;
use cloudtouch_io::recording::file_of;

/// Widths of the columns, and what the last line is made of.
pub(crate) struct Table {
    id_width: usize,
    label_width: usize,
    /// The head of the column about a margin, where one is asked for.
    margin: Option<String>,
    /// Names that files of several folders have: those are shown with their folders.
    shared_names: BTreeSet<String>,
    answers: usize,
    errors: usize,
    query_us: Vec<u64>,
    prepare_us: Vec<u64>,
    warned: Vec<Warned>,
}

/// No column is wider for the sake of one long text, which then moves its row alone.
const WIDEST: usize = 48;

impl Table {
    /// For these cases, of which only names and labels are looked at, and the margin asked about, m.
    pub(crate) fn new(cases: &[(String, Result<Case>)], margin: Option<f64>) -> Self {
        let width = |texts: &mut dyn Iterator<Item = String>, least: usize| {
            texts.map(|text| text.chars().count()).fold(least, usize::max).min(WIDEST)
        };
        let cases_read = cases.iter().filter_map(|(_, case)| case.as_ref().ok());
        let files: BTreeSet<&Path> =
            cases_read.flat_map(|case| [case.scene.as_path(), case.object.as_path()]).collect();
        let mut names = BTreeSet::new();
        let again = |name: &String| !names.insert(name.clone());
        Self {
            id_width: width(&mut cases.iter().map(|(id, _)| print::one_line(id)), 4),
            label_width: width(&mut cases.iter().map(|(_, case)| label(case)), 5),
            margin: margin.map(|margin| format!("P(<{})", print::margin(margin))),
            shared_names: files.into_iter().map(name).filter(again).collect(),
            answers: 0,
            errors: 0,
            query_us: Vec::new(),
            prepare_us: Vec::new(),
            warned: Vec::new(),
        }
    }

    pub(crate) fn head(&self) -> String {
        let Self { id_width, label_width, margin, .. } = self;
        let margin = margin.as_ref().map_or(String::new(), |head| format!("  {head}"));
        format!(
            "{:<id_width$}  {:<label_width$}  {:>5}  {:<14}  {:<12}  {:>14}{margin}  {:>10}  scene / object\n",
            "case", "label", "P", "bounds", "verdict", "clearance (mm)", "time"
        )
    }

    pub(crate) fn row(
        &mut self,
        id: &str,
        case: &Result<Case>,
        answer: Result<(&Report, Option<&Nearness>), &str>,
    ) -> String {
        let (id_width, label_width) = (self.id_width, self.label_width);
        let start = format!("{:<id_width$}  {:<label_width$}", print::one_line(id), label(case));
        let (report, nearness) = match answer {
            Ok(answer) => answer,
            Err(error) => {
                self.errors += 1;
                return format!("{start}  error: {}\n", print::one_line(error));
            }
        };
        self.answers += 1;
        self.query_us.push(report.stats.query_us);
        self.prepare_us.push(report.stats.prepare_us);
        let [low, high] = report.bounds.map(print::probability);
        let files = case.as_ref().map_or(String::new(), |c| {
            format!("{} / {}", self.name(&c.scene), self.name(&c.object))
        });
        let reason = report
            .undecided_by
            .map_or(String::new(), |by| format!("  ({})", remedies::undecided(by)));
        let margin = self.margin.as_ref().map_or(String::new(), |head| {
            let likely =
                nearness.map_or("-".to_owned(), |of| print::probability(of.within.probability));
            format!("  {likely:>width$}", width = head.len())
        });
        for warning in &report.warnings {
            let is_same = |known: &&mut Warned| discriminant(&known.first) == discriminant(warning);
            match self.warned.iter_mut().find(is_same) {
                Some(known) => known.count += 1,
                None => self.warned.push(Warned { id: id.to_owned(), first: *warning, count: 1 }),
            }
        }
        format!(
            "{start}  {:>5}  {:<14}  {:<12}  {:>14}{margin}  {:>7.1} ms  {}{reason}\n",
            print::probability(report.collision_probability),
            format!("{low} .. {high}"),
            report.verdict,
            print::gap_mm(report.clearance_m),
            report.stats.query_us as f64 / 1e3,
            print::one_line(&files),
        )
    }

    fn name(&self, path: &Path) -> String {
        let short = name(path);
        if self.shared_names.contains(&short) { path.display().to_string() } else { short }
    }

    pub(crate) fn foot(&self) -> String {
        let counted =
            |count: usize, of: &str| format!("{count} {of}{}", if count == 1 { "" } else { "s" });
        let (answers, errors) = (counted(self.answers, "answer"), counted(self.errors, "error"));
        let mut text = format!("{answers}, {errors}");
        if self.answers > 0 {
            text += &format!(
                "; median query {:.2} ms, median preparation {:.1} ms",
                median(&self.query_us) / 1e3,
                median(&self.prepare_us) / 1e3,
            );
        }
        text += "\n";
        for Warned { id, first, count } in &self.warned {
            let cases = counted(*count, "case");
            let (id, first) = (print::one_line(id), remedies::warning(first));
            text += &format!("warning in {cases}, first {id}: {first}\n");
        }
        text
    }
}

/// Warnings of one kind: thousands of cases have the same.
struct Warned {
    id: String,
    first: Warning,
    count: usize,
}

/// A file without its folder; a scan of a recording with its topic, in which slashes may be too.
fn name(path: &Path) -> String {
    let file = file_of(path);
    let folder = file.parent().unwrap_or(Path::new(""));
    path.strip_prefix(folder).unwrap_or(path).display().to_string()
}

fn label(case: &Result<Case>) -> String {
    let label = case.as_ref().ok().and_then(|case| case.label.as_deref());
    label.map_or("-".to_owned(), print::one_line)
}

fn median(values: &[u64]) -> f64 {
    let mut values = values.to_vec();
    values.sort_unstable();
    let middle = values.len() / 2;
    if values.len() % 2 == 1 {
        values[middle] as f64
    } else {
        0.5 * (values[middle - 1] + values[middle]) as f64
    }
}
