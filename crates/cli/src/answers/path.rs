//! What is known along a path, for programs and for people.

use anyhow::Result;
use cloudtouch::geom::Pose;
use cloudtouch::{AlongPath, Contact, Placement, SweepStats, Swept, Undecided, Verdict, Warning};
use cloudtouch_page::Fact;
use serde::Serialize;

use crate::answers::print::probability;
use crate::answers::query::matrix;
use crate::answers::text::{self, labelled};
use crate::doubt::{Doubt, READ_AS};
use crate::load::Input;
use crate::remedies::{self, undecided_from};

#[derive(Serialize)]
struct Line<'a> {
    max_probability: f64,
    bounds: [f64; 2],
    verdict: Verdict,
    undecided_by: Option<Undecided>,
    warnings: Vec<Warned<'a>>,
    most_probable: Place<'a>,
    first: Option<First<'a>>,
    certified_free_until: f64,
    stats: SweepStats,
    placement: Placement,
    scene: &'a Input,
    object: &'a Input,
}

/// Of the poses, or of the file they are in.
#[derive(Serialize)]
#[serde(untagged)]
enum Warned<'a> {
    Pose(&'a Warning),
    File(&'a Doubt),
}

#[derive(Serialize)]
struct First<'a> {
    #[serde(flatten)]
    at: Place<'a>,
    not_before: f64,
}

#[derive(Serialize)]
struct Place<'a> {
    segment: usize,
    t: f64,
    share: f64,
    pose: [[f64; 4]; 4],
    probability: f64,
    contacts: &'a [Contact],
}

impl<'a> From<&'a AlongPath> for Place<'a> {
    fn from(at: &'a AlongPath) -> Self {
        Self {
            segment: at.segment,
            t: at.t,
            share: at.share,
            pose: matrix(&at.pose),
            probability: at.report.collision_probability,
            contacts: &at.report.contacts,
        }
    }
}

pub(crate) fn json_line(
    (swept, placement): (&Swept, Placement),
    doubt: Option<&Doubt>,
    [scene, object]: [&Input; 2],
) -> Result<String> {
    let of_poses = swept.warnings.iter().map(Warned::Pose);
    let line = Line {
        max_probability: swept.most_probable.report.collision_probability,
        bounds: swept.bounds,
        verdict: swept.verdict,
        undecided_by: swept.undecided_by,
        warnings: of_poses.chain(doubt.map(Warned::File)).collect(),
        most_probable: (&swept.most_probable).into(),
        first: swept
            .first
            .as_ref()
            .map(|first| First { at: (&first.at).into(), not_before: first.not_before }),
        certified_free_until: swept.certified_free_until,
        stats: swept.stats,
        placement,
        scene,
        object,
    };
    Ok(remedies::in_json(serde_json::to_string(&line)?, &swept.warnings))
}

/// The same in a few lines; whether an option said where the sensor of the scene stood is known beside it.
pub(crate) fn text(
    (swept, placement): (&Swept, &Placement),
    doubt: Option<&Doubt>,
    is_placed: bool,
) -> String {
    let [low, high] = swept.bounds.map(probability);
    let best = &swept.most_probable;
    let mut lines = vec![
        format!(
            "largest probability    {}   (within {low} .. {high})",
            probability(best.report.collision_probability)
        ),
        format!("                       at {}", place(best)),
        text::place(placement).trim_end().to_owned(),
        labelled("verdict", &verdict(swept, is_placed)),
        format!("free for certain       until {} of the path", percent(swept.certified_free_until)),
    ];
    if let Some(first) = &swept.first {
        lines.push(format!("in collision from      {}", place(&first.at)));
        lines.push(format!(
            "                       not before {} of the path",
            percent(first.not_before)
        ));
        for contact in first.at.report.contacts.iter().take(1) {
            let p = contact.point;
            lines.push(format!("first contact          {:.3} {:.3} {:.3} m", p.x, p.y, p.z));
        }
    }
    lines.extend(swept.warnings.iter().map(|of| labelled("warning", &remedies::warning(of))));
    lines.extend(doubt.map(|_| labelled("columns", &columns())));
    let SweepStats { poses, stretches, query_us, .. } = swept.stats;
    lines.push(format!(
        "work                   {poses} poses and {stretches} stretches in {:.1} ms",
        1e-3 * query_us as f64
    ));
    lines.join("\n")
}

/// What holds of the whole path, for a page.
pub(crate) fn facts(swept: &Swept, doubt: Option<&Doubt>, is_placed: bool) -> Vec<Fact> {
    let [low, high] = swept.bounds.map(probability);
    let best = &swept.most_probable;
    let likely = probability(best.report.collision_probability);
    let mut facts = vec![
        Fact::new("Verdict on the whole path", verdict(swept, is_placed)),
        Fact::new("Largest probability", format!("{likely} (within {low} .. {high})")),
        Fact::new("Where", place(best)),
        Fact::new(
            "Free for certain",
            format!("until {} of the path", percent(swept.certified_free_until)),
        ),
    ];
    if let Some(first) = &swept.first {
        let before = percent(first.not_before);
        let text = format!("{}; not before {before} of the path", place(&first.at));
        facts.push(Fact::new("In collision from", text));
    }
    facts.extend(swept.warnings.iter().map(|of| Fact::new("Warning", remedies::warning(of))));
    facts.extend(doubt.map(|_| Fact::new("Columns", columns())));
    facts
}

/// Of a file that does not name its columns, which is warned of on standard error at length.
fn columns() -> String {
    format!("read as {READ_AS}, for the file names none")
}

fn verdict(swept: &Swept, is_placed: bool) -> String {
    let reason = swept.undecided_by;
    let reason = reason.map_or(String::new(), |by| format!(": {}", undecided_from(by, is_placed)));
    format!("{}{reason}", swept.verdict)
}

fn place(at: &AlongPath) -> String {
    let origin = origin(&at.pose);
    format!(
        "segment {}, t = {:.3} ({} of the path), origin {origin}",
        // People count poses from 1, and a segment by the pose before it.
        at.segment + 1,
        at.t,
        percent(at.share)
    )
}

fn origin(pose: &Pose) -> String {
    let t = pose.translation();
    format!("{:.3} {:.3} {:.3} m", t.x, t.y, t.z)
}

/// A share of a path.
pub(crate) fn percent(share: f64) -> String {
    format!("{:.1} %", 100.0 * share)
}
