//! Reports for people and for programs.

use std::fmt::Write as _;
use std::io::{ErrorKind, Write as _};

use anyhow::{Context, Result};
use cloudtouch::geom::Pose;
use cloudtouch::{Clearance, Placement, Report, StageReport, Stats, Undecided, Unseen, Verdict};
use serde::Serialize;

use crate::body::{Body, PreparedCloud};
use crate::load::{Input, Loaded};

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

/// A report with where the object was.
pub(crate) struct Answer<'a> {
    pub report: &'a Report,
    pub placement: &'a Placement,
    /// Object to scene.
    pub pose: &'a Pose,
}

/// An answer with the name of its case: one line of JSON.
#[derive(Serialize)]
struct Line<'a> {
    id: &'a str,
    #[serde(flatten)]
    report: &'a Report,
    placement: &'a Placement,
    pose: [[f64; 4]; 4],
    scene: &'a Input,
    object: &'a Input,
}

/// A case without an answer.
#[derive(Serialize)]
struct ErrorLine<'a> {
    id: &'a str,
    error: &'a str,
}

pub(crate) fn json_error_line(id: &str, error: &str) -> Result<String> {
    Ok(serde_json::to_string(&ErrorLine { id, error })?)
}

impl Answer<'_> {
    pub(crate) fn json_line(&self, id: &str, [scene, object]: [&Input; 2]) -> Result<String> {
        let matrix = self.pose.isometry().to_homogeneous();
        let pose = std::array::from_fn(|row| std::array::from_fn(|column| matrix[(row, column)]));
        let Self { report, placement, .. } = self;
        Ok(serde_json::to_string(&Line { id, report, placement, pose, scene, object })?)
    }

    /// All that a person wants to know; with what it cost if `shows_work`.
    pub(crate) fn text(&self, shows_work: bool) -> String {
        let mut text = report(self.report);
        text.push_str(&place(self.placement));
        for warning in &self.report.warnings {
            let _ = writeln!(text, "{}", labelled("warning", &warning.to_string()));
        }
        if shows_work {
            text.push_str(&work(&self.report.stats));
        }
        text.truncate(text.trim_end().len());
        text
    }
}

pub(crate) fn verdict(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Free => "free",
        Verdict::Uncertain => "uncertain",
        Verdict::InCollision => "in collision",
        Verdict::Undecided => "undecided",
    }
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

/// What was found, in a few lines.
fn report(report: &Report) -> String {
    let mut text = String::new();
    let [low, high] = report.bounds.map(probability);
    // Writing to a string cannot fail.
    let _ = writeln!(
        text,
        "collision probability  {}   (within {low} .. {high})",
        probability(report.collision_probability)
    );
    let reason = report.undecided_by.map_or(String::new(), |by| format!(": {}", undecided(by)));
    let _ =
        writeln!(text, "{}", labelled("verdict", &(verdict(report.verdict).to_owned() + &reason)));
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
    if let Some(unseen) = &report.unseen {
        let _ = writeln!(text, "{}", labelled("unseen", &unseen_words(unseen)));
    }
    text
}

/// Columns that a line has at most, and where its words begin.
const WIDTH: usize = 100;
const INDENT: usize = 23;

/// A line of a report, with as many lines after it as its words take.
fn labelled(label: &str, words: &str) -> String {
    let mut text = format!("{label:<INDENT$}");
    let mut column = INDENT;
    for word in words.split(' ') {
        let length = word.chars().count();
        if column > INDENT && column + length > WIDTH {
            text.truncate(text.trim_end().len());
            let _ = write!(text, "\n{:INDENT$}", "");
            column = INDENT;
        }
        let _ = write!(text, "{word} ");
        column += length + 1;
    }
    text.truncate(text.trim_end().len());
    text
}

/// Why there is no decision.
pub(crate) fn undecided(by: Undecided) -> &'static str {
    match by {
        Undecided::Unseen => "the camera saw too little of where the object is",
        Undecided::Enclosed => "one cloud is all around the other: hollow or solid is not known",
        Undecided::Units => "sizes or distance cannot be meant",
        Undecided::Sparse => "one body fits between the points of the other",
        Undecided::Noise => "the noise is larger than a body",
        Undecided::NoSurface => "a cloud spans no surface",
        Undecided::Missing => "too many rows have no return",
        Undecided::Sensor => "the sensor cannot have seen this cloud",
        Undecided::Unsolved => "a classifier could not be trained",
        Undecided::Bounds => "what was not looked at, or is too noisy, could still collide",
        _ => "see undecided_by in the JSON",
    }
}

fn unseen_words(unseen: &Unseen) -> String {
    let percent = |share: f64| format!("{:.0} %", 100.0 * share);
    let all = [
        ("behind the camera", unseen.behind_camera),
        ("outside of its view", unseen.outside_view),
        ("in holes of the image", unseen.hole),
        ("behind what it saw", unseen.behind_returns),
    ];
    let shares: Vec<String> = all
        .iter()
        .filter(|(_, share)| *share > 0.0)
        .map(|(place, share)| format!("{} {place}", percent(*share)))
        .collect();
    if shares.is_empty() {
        return format!("nothing of the {}", unseen.body);
    }
    format!("{} of the {}: {}", percent(unseen.share()), unseen.body, shares.join(", "))
}

fn place(placement: &Placement) -> String {
    let corner = |p: [f64; 3]| format!("({:.3}, {:.3}, {:.3})", p[0], p[1], p[2]);
    let [low, high] = placement.object_box.map(corner);
    let [scene_low, scene_high] = placement.scene_box.map(corner);
    let gap = if placement.box_gap_m > 0.0 {
        format!(", {:.3} m outside of it", placement.box_gap_m)
    } else {
        String::new()
    };
    let nearest = placement.nearest_m.map_or(String::new(), |nearest| {
        format!("; nearest point about {:.1} mm away", 1e3 * nearest)
    });
    let words = format!(
        "object in {low} to {high} m, scene in {scene_low} to {scene_high} m{gap}{nearest}"
    );
    labelled("where", &words) + "\n"
}

fn work(stats: &Stats) -> String {
    let done = format!(
        "{} node pairs, {} leaf pairs; {} settled by a plane, {} kernel solves, {} fallbacks, {} \
         undecided",
        stats.nodes_visited,
        stats.leaf_pairs,
        stats.linear_certificates,
        stats.kernel_solves,
        stats.fallbacks,
        stats.undecided
    );
    let time = format!(
        "prepare {:.1} ms, query {:.2} ms",
        stats.prepare_us as f64 / 1e3,
        stats.query_us as f64 / 1e3
    );
    format!("{}\n{}\n", labelled("work", &done), labelled("time", &time))
}

/// What a body is, what it was taken for and what the filter did to it, in a few lines.
pub(crate) fn body<C: PreparedCloud>(name: &str, loaded: &Loaded<C>) -> String {
    let Input { unit, sensor, sensor_because, .. } = &loaded.input;
    match &loaded.body {
        Body::Cloud(cloud) => {
            let because = sensor_because.map_or(String::new(), |why| format!(" ({why})"));
            let sensor = sensor.as_deref().unwrap_or_default();
            format!(
                "{name}: cloud of {} points in {unit}, sensor {sensor}{because} ({})",
                cloud.count(),
                stages(cloud.stages())
            )
        }
        Body::Mesh(mesh) => {
            let kind = if mesh.is_watertight() { "watertight" } else { "open" };
            let count = mesh.triangle_count();
            format!(
                "{name}: {kind} mesh of {count} triangles in {unit}, {:.3} m across",
                mesh.size()
            )
        }
    }
}

fn stages(stages: &[StageReport]) -> String {
    let removed: Vec<String> =
        stages.iter().map(|s| format!("{} removed {}", s.stage, s.removed)).collect();
    removed.join(", ")
}

/// A name of a case in one line of a table: what steers a terminal is spelled out.
pub(crate) fn one_line(name: &str) -> String {
    name.chars()
        .flat_map(|c| if c.is_control() { c.escape_default().collect() } else { vec![c] })
        .collect()
}
