//! Reports for people and for programs.

use std::fmt::Write as _;
use std::io::{ErrorKind, Write as _};

use anyhow::{Context, Result};
use cloudtouch::{Clearance, Report, StageReport};
use serde::Serialize;

use crate::body::{Body, PreparedCloud};
use crate::per_point::Details;

/// Prints a whole answer.
///
/// A reader that has seen enough (`cloudtouch … | head`) is no error, and does not change the exit
/// code: a collision must not become a success.
pub(crate) fn to_stdout(text: &str) -> Result<()> {
    let mut out = std::io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
        outcome => outcome.context("standard output: cannot be written"),
    }
}

/// A report for people shows this many contacts; JSON has them all.
const CONTACTS_SHOWN: usize = 5;

/// A report with the name of its case: one line of JSON.
#[derive(Serialize)]
struct Line<'a> {
    id: &'a str,
    #[serde(flatten)]
    report: &'a Report,
    #[serde(flatten)]
    details: &'a Details<'a>,
}

/// A case without an answer.
#[derive(Serialize)]
struct ErrorLine<'a> {
    id: &'a str,
    error: &'a str,
}

pub(crate) fn json_line(id: &str, report: &Report) -> Result<String> {
    detailed_json_line(id, report, &Details::default())
}

pub(crate) fn detailed_json_line(
    id: &str,
    report: &Report,
    details: &Details<'_>,
) -> Result<String> {
    Ok(serde_json::to_string(&Line { id, report, details })?)
}

pub(crate) fn json_error_line(id: &str, error: &str) -> Result<String> {
    Ok(serde_json::to_string(&ErrorLine { id, error })?)
}

/// A probability with the digits that mean something.
pub(crate) fn probability(p: f64) -> String {
    if p == 0.0 || p >= 1e-3 { format!("{p:.3}") } else { format!("{p:.0e}") }
}

/// A gap in millimetres with its standard deviation, or a dash when none was computed.
pub(crate) fn gap_mm(clearance: Option<Clearance>) -> String {
    clearance.map_or("-".to_owned(), |c| {
        let bound = if c.is_bound { "≤ " } else { "" };
        format!("{bound}{:+.1} ± {:.1}", 1e3 * c.mean, 1e3 * c.std)
    })
}

/// What is known of surfaces too far apart to be measured.
fn too_far(at_least_m: Option<f64>) -> String {
    match at_least_m.filter(|least| *least > 0.0) {
        Some(least) => format!("clearance              at least {:.1} mm\n", 1e3 * least),
        None => "clearance              not computed\n".to_owned(),
    }
}

/// A whole report in a few lines.
pub(crate) fn report(report: &Report) -> String {
    let mut text = String::new();
    let [low, high] = report.bounds.map(probability);
    // Writing to a string cannot fail.
    let _ = writeln!(
        text,
        "collision probability  {}   (within {low} .. {high})",
        probability(report.collision_probability)
    );
    let _ = writeln!(text, "verdict                {}", report.verdict);
    match report.clearance_m {
        Some(c) => {
            let _ = writeln!(
                text,
                "clearance              {:+.1} mm{}, std {:.1} mm",
                1e3 * c.mean,
                if c.is_bound { " or deeper" } else { "" },
                1e3 * c.std
            );
        }
        None => text.push_str(&too_far(report.clearance_at_least_m)),
    }
    if !report.contacts.is_empty() {
        text.push_str(
            "contacts               point (m)                 normal scene to object    P       \
             gap (mm)\n",
        );
    }
    for contact in report.contacts.iter().take(CONTACTS_SHOWN) {
        let (p, n) = (contact.point, contact.normal_a_to_b);
        let _ = writeln!(
            text,
            "                       {:7.3} {:7.3} {:7.3}   {:6.2} {:6.2} {:6.2}      {:<7} {:+.1}",
            p.x,
            p.y,
            p.z,
            n.x,
            n.y,
            n.z,
            probability(contact.probability),
            1e3 * contact.clearance_m
        );
    }
    if report.contacts.len() > CONTACTS_SHOWN {
        let more = report.contacts.len() - CONTACTS_SHOWN;
        let _ = writeln!(text, "                       and {more} more");
    }
    let s = &report.stats;
    let _ = writeln!(
        text,
        "work                   {} node pairs, {} leaf pairs; {} settled by a plane, {} kernel \
         solves,\n                       {} fallbacks, {} undecided",
        s.nodes_visited,
        s.leaf_pairs,
        s.linear_certificates,
        s.kernel_solves,
        s.fallbacks,
        s.undecided
    );
    let _ = write!(
        text,
        "time                   prepare {:.1} ms, query {:.2} ms",
        s.prepare_us as f64 / 1e3,
        s.query_us as f64 / 1e3
    );
    text
}

/// What a body is and what the filter did to it, in one line.
pub(crate) fn body<C: PreparedCloud>(name: &str, body: &Body<C>) -> String {
    match body {
        Body::Cloud(cloud) => {
            format!("{name}: cloud of {} points ({})", cloud.count(), stages(cloud.stages()))
        }
        Body::Mesh(mesh) => {
            let kind = if mesh.is_watertight() { "watertight" } else { "open" };
            format!("{name}: {kind} mesh of {} triangles", mesh.triangle_count())
        }
    }
}

fn stages(stages: &[StageReport]) -> String {
    let removed: Vec<String> =
        stages.iter().map(|s| format!("{} removed {}", s.stage, s.removed)).collect();
    removed.join(", ")
}
