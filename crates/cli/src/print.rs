//! Reports for people and for programs.

use std::fmt::Write as _;

use anyhow::Result;
use cloudtouch::{Body, Report, StageReport, Verdict};
use serde::Serialize;

/// A report with the name of its case: one line of JSON.
#[derive(Serialize)]
struct Line<'a> {
    id: &'a str,
    #[serde(flatten)]
    report: &'a Report,
}

/// A case without an answer.
#[derive(Serialize)]
struct ErrorLine<'a> {
    id: &'a str,
    error: &'a str,
}

pub(crate) fn json_line(id: &str, report: &Report) -> Result<String> {
    Ok(serde_json::to_string(&Line { id, report })?)
}

pub(crate) fn json_error_line(id: &str, error: &str) -> Result<String> {
    Ok(serde_json::to_string(&ErrorLine { id, error })?)
}

pub(crate) fn verdict(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Free => "free",
        Verdict::InContact => "in contact",
        Verdict::InCollision => "in collision",
        Verdict::Undecided => "undecided",
    }
}

/// A probability with the digits that mean something.
pub(crate) fn probability(p: f64) -> String {
    if p == 0.0 || p >= 1e-3 { format!("{p:.3}") } else { format!("{p:.0e}") }
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
    let _ = writeln!(text, "verdict                {}", verdict(report.verdict));
    match report.clearance_m {
        Some(c) => {
            let _ = writeln!(
                text,
                "clearance              {:+.1} mm, std {:.1} mm",
                1e3 * c.mean,
                1e3 * c.std
            );
        }
        None => text.push_str("clearance              not computed: everything was culled\n"),
    }
    if !report.contacts.is_empty() {
        text.push_str("contacts               point (m)                 normal scene to object    P      gap (mm)\n");
    }
    for contact in report.contacts.iter().take(5) {
        let (p, n) = (contact.point, contact.normal_a_to_b);
        let _ = writeln!(
            text,
            "                       {:7.3} {:7.3} {:7.3}   {:6.2} {:6.2} {:6.2}   {:>7}   {:+.1}",
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
    let s = &report.stats;
    let _ = writeln!(
        text,
        "work                   {} node pairs, {} leaf pairs, {} linear certificates, \
         {} kernel solves, {} fallbacks, {} undecided",
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
pub(crate) fn body(name: &str, body: &Body) -> String {
    match body {
        Body::Cloud(cloud) => {
            format!("{name}: cloud of {} points ({})", cloud.len(), stages(cloud.filter_stages()))
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
