//! Which bodies of a scene may touch, for programs and for people.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use anyhow::Result;
use cloudtouch::geom::Point3;
use cloudtouch::{BodyWarning, Checked, Outside, PairAnswer, Report, Undecided, Verdict, Warning};
use serde::Serialize;

use crate::answers::print::{self, one_line, probability};
use crate::answers::text::{between, labelled};
use crate::load::Input;
use crate::remedies;

/// Of many bodies far from all others no more are named.
const OUTSIDE_TOLD: usize = 3;

/// Of the warnings of pairs no more are told: JSON has all.
const WARNINGS_TOLD: usize = 6;

/// Why a scene is undecided of which no pair was checked, for programs.
pub(crate) const UNCHECKED: &str = "unchecked";

/// The same for people.
pub(crate) const NONE_ASKED: &str =
    "all pairs may touch by what was said, so that none was asked about";

/// Says so where all pairs were left out: nothing was looked at.
pub(crate) fn warn_of_nothing_asked(checked: &Checked) {
    if checked.is_unchecked() {
        tracing::warn!("{NONE_ASKED}: name fewer in `allowed`, --srdf or --may-touch");
    }
}

/// Why an answer is undecided: by its worst pair, where that has an answer.
fn undecided_by(checked: &Checked) -> Option<&'static str> {
    if checked.is_unchecked() {
        return Some(UNCHECKED);
    }
    let worst = checked.pairs.first()?.answer.as_ref().ok()?;
    worst.undecided_by.map(Undecided::code)
}

/// What a scene answers, in JSON.
#[derive(Serialize)]
pub(crate) struct Line<'a> {
    verdict: Verdict,
    undecided_by: Option<&'static str>,
    threshold: f64,
    pairs: Vec<Pair<'a>>,
    counts: Counts,
    unchecked: &'a [String],
    outside: &'a [Outside],
    warnings: &'a [BodyWarning],
    boxes: BTreeMap<&'a str, [Point3; 2]>,
    bodies: BTreeMap<&'a str, &'a Input>,
}

#[derive(Serialize)]
struct Counts {
    pairs: usize,
    allowed: usize,
    ruled_out: usize,
    asked: usize,
}

#[derive(Serialize)]
pub(crate) struct Pair<'a> {
    a: &'a str,
    b: &'a str,
    #[serde(flatten)]
    report: Option<&'a Report>,
    #[serde(skip_serializing_if = "Option::is_none")]
    error: Option<String>,
}

impl<'a> From<&'a PairAnswer> for Pair<'a> {
    fn from(pair: &'a PairAnswer) -> Self {
        let (report, error) = match &pair.answer {
            Ok(report) => (Some(report), None),
            Err(error) => (None, Some(error.to_string())),
        };
        Self { a: &pair.a, b: &pair.b, report, error }
    }
}

/// The bodies of a scene: what each was read from, and the box around it in the frame of the scene.
#[derive(Debug, Clone)]
pub(crate) struct Bodies<'a> {
    pub inputs: BTreeMap<&'a str, &'a Input>,
    pub boxes: BTreeMap<&'a str, [Point3; 2]>,
}

pub(crate) fn json_line(checked: &Checked, threshold: f64, bodies: Bodies<'_>) -> Result<String> {
    told(&line(checked, threshold, bodies), &checked.pairs, &checked.warnings)
}

/// A line of JSON, whose warnings are those of these pairs and bodies, with the options that mend them.
pub(crate) fn told<'a>(
    line: &impl Serialize,
    pairs: impl IntoIterator<Item = &'a PairAnswer>,
    of_bodies: &'a [BodyWarning],
) -> Result<String> {
    let reports = pairs.into_iter().filter_map(|pair| pair.answer.as_ref().ok());
    let warnings = reports.flat_map(|report| &report.warnings);
    let warnings = warnings.chain(of_bodies.iter().map(|of| &of.warning));
    Ok(remedies::in_json(serde_json::to_string(line)?, warnings))
}

pub(crate) fn line<'a>(checked: &'a Checked, threshold: f64, bodies: Bodies<'a>) -> Line<'a> {
    let Checked { count, allowed, ruled_out, asked, .. } = *checked;
    Line {
        verdict: checked.verdict(),
        undecided_by: undecided_by(checked),
        threshold,
        pairs: checked.pairs.iter().map(Pair::from).collect(),
        counts: Counts { pairs: count, allowed, ruled_out, asked },
        unchecked: &checked.unchecked,
        outside: &checked.outside,
        warnings: &checked.warnings,
        boxes: bodies.boxes,
        bodies: bodies.inputs,
    }
}

/// The same as a table.
pub(crate) fn text(checked: &Checked, threshold: f64) -> String {
    let mut text = doubts(checked);
    if !checked.pairs.is_empty() {
        let names: Vec<String> = checked.pairs.iter().map(names).collect();
        let width = names.iter().map(|name| name.chars().count()).fold(4, usize::max);
        let _ = writeln!(
            text,
            "{:<width$}  {:>5}  {:<14}  {:<12}  {:>14}",
            "pair", "P", "bounds", "verdict", "clearance (mm)"
        );
        for (name, pair) in names.iter().zip(&checked.pairs) {
            let _ = writeln!(text, "{name:<width$}  {}", row(pair));
        }
        text += &of_pairs(checked);
    }
    let Checked { count, allowed, ruled_out, asked, .. } = *checked;
    if checked.is_unchecked() {
        return text + &format!("{}: {NONE_ASKED} ({allowed} left out)", checked.verdict());
    }
    let _ = write!(
        text,
        "{}: {} of {count} pairs may be at or above {}; {asked} asked, {ruled_out} ruled out by their \
         boxes, {allowed} left out",
        checked.verdict(),
        checked.pairs.len(),
        probability(threshold),
    );
    text
}

/// What is to be said of the pairs of the table, beyond what is of their bodies; the same of several once, at the
/// worst of them.
fn of_pairs<'a>(checked: &'a Checked) -> String {
    let mut told: Vec<(&PairAnswer, &Warning)> = Vec::new();
    let warnings_of = |pair: &'a PairAnswer| pair.answer.iter().flat_map(|report| &report.warnings);
    let all = checked.pairs.iter().flat_map(|pair| warnings_of(pair).map(move |of| (pair, of)));
    for (pair, warning) in all {
        // Of thousands no two may be the same.
        if told.len() == WARNINGS_TOLD {
            break;
        }
        if !is_of_a_body(checked, warning) && told.iter().all(|(_, other)| *other != warning) {
            told.push((pair, warning));
        }
    }
    let line = |(pair, warning): &(&PairAnswer, &Warning)| {
        labelled("warning", &format!("{}: {}", names(pair), remedies::warning(warning))) + "\n"
    };
    told.iter().map(line).collect()
}

/// Whether a warning of a pair is one of its bodies, which are told of by themselves.
pub(crate) fn is_of_a_body(checked: &Checked, warning: &Warning) -> bool {
    checked.warnings.iter().any(|of| of.warning == *warning)
}

/// Where a body lies in the frame of the scene.
pub(crate) fn place(corners: &[Point3; 2]) -> String {
    format!("in {}", between(corners.map(|corner| corner.coords.into())))
}

/// A line for each body that something is to be said of by itself, and for each far from all others: that is
/// free for certain, and seldom meant.
pub(crate) fn doubts(checked: &Checked) -> String {
    let all = warnings(checked).map(|words| labelled("warning", &one_line(&words)) + "\n");
    let mut text: String = all.collect();
    if let Some(more) = checked.outside.len().checked_sub(OUTSIDE_TOLD).filter(|more| *more > 0) {
        text += &labelled("", &format!("{more} more bodies are as far from the rest"));
        text += "\n";
    }
    text
}

/// The same, a sentence or a few for each.
pub(crate) fn warnings(checked: &Checked) -> impl Iterator<Item = String> {
    let warned = |BodyWarning { name, warning, .. }: &BodyWarning| {
        format!("{name}: {}", remedies::warning(warning))
    };
    let far = checked.outside.iter().take(OUTSIDE_TOLD).map(Outside::to_string);
    checked.warnings.iter().map(warned).chain(far).chain(unchecked(checked))
}

/// Of whom nothing was asked, where it was of others.
fn unchecked(checked: &Checked) -> Option<String> {
    let names = &checked.unchecked;
    if names.is_empty() || checked.is_unchecked() {
        return None;
    }
    let their = if names.len() == 1 { "its" } else { "their" };
    let names = names.join(", ");
    Some(format!("nothing was asked about {names}: all {their} pairs may touch by what was said"))
}

fn names(pair: &PairAnswer) -> String {
    format!("{} / {}", one_line(&pair.a), one_line(&pair.b))
}

fn row(pair: &PairAnswer) -> String {
    let report = match &pair.answer {
        Ok(report) => report,
        Err(error) => return format!("error: {}", one_line(&error.to_string())),
    };
    let [low, high] = report.bounds.map(probability);
    let reason =
        report.undecided_by.map_or(String::new(), |by| format!("  ({})", remedies::undecided(by)));
    format!(
        "{:>5}  {:<14}  {:<12}  {:>14}{reason}",
        probability(report.collision_probability),
        format!("{low} .. {high}"),
        report.verdict,
        print::gap_mm(report.clearance_m),
    )
}
