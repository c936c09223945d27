//! A report for people: what was found, where, how sure, and what to look at twice.

use std::fmt::Write as _;

use cloudtouch::{Mode, Placement, Report, Stats, UnderPoses, Within};
use cloudtouch_page::{Fact, words, words::length};

use crate::answers::print::{self, probability};
use crate::margin::{Nearness, SHARE};
use crate::remedies::{self, undecided_from};

/// A report for people shows this many contacts; JSON has them all.
const CONTACTS_SHOWN: usize = 5;

/// What a report does not tell of its scene.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Scene {
    /// It may not know what its sensor did not see.
    pub is_cloud: bool,
    /// Whether an option said where its sensor stood.
    pub is_placed: bool,
}

/// All that a person wants to know, with what it cost if `shows_work`.
pub(crate) fn text(
    report: &Report,
    placement: &Placement,
    scene: Scene,
    shows_work: bool,
) -> String {
    let mut text = found(report, scene);
    if let Some(Fact { text: words, .. }) = not_seen(report, scene.is_cloud) {
        let _ = writeln!(text, "{}", labelled("unseen", &words));
    }
    text.push_str(&place(placement));
    for warning in &report.warnings {
        let _ = writeln!(text, "{}", labelled("warning", &remedies::warning(warning)));
    }
    if shows_work {
        text.push_str(&work(&report.stats));
    }
    text.truncate(text.trim_end().len());
    text
}

/// About what the sensor of a cloud did not see, where its rows and columns do not tell; here and on the page.
pub(crate) fn not_seen(report: &Report, is_cloud: bool) -> Option<Fact> {
    // The paper's mode looks at no image either.
    let is_told = !is_cloud || report.unseen.is_some() || report.mode != Mode::Calibrated;
    let words = "not known (no rows and columns): what the sensor did not see counts as empty";
    (!is_told).then(|| Fact::new("Unseen", words))
}

/// About a margin, and between what distances the bodies lie.
pub(crate) fn nearness(nearness: &Nearness) -> Fact {
    let Within { margin_m, bounds, probability: likely, .. } = nearness.within;
    let [low, high] = bounds.map(probability);
    let [q05, q95] = nearness.interval.map(length);
    let label = format!("P(nearer than {})", print::margin(margin_m));
    let likely = probability(likely);
    let share = 100.0 * SHARE;
    let text = format!("{likely}   (within {low} .. {high}); {share:.0} % between {q05} and {q95}");
    Fact::new(label, text)
}

/// About all poses that may be.
pub(crate) fn over_poses(under: &UnderPoses) -> Fact {
    let [low, high] = under.bounds.map(probability);
    let of = probability(under.probability);
    let poses = match under.poses {
        1 => "one pose tells of all".to_owned(),
        count => format!("± {} by {count} poses", probability(under.std_error)),
    };
    Fact::new("over uncertain poses", format!("{of}   (within {low} .. {high}; {poses})"))
}

/// A line of a report, however long.
pub(crate) fn line(Fact { label, text }: &Fact) -> String {
    format!("{label:<22} {text}")
}

/// What is known of surfaces too far apart to be measured.
fn too_far(at_least_m: Option<f64>) -> String {
    match at_least_m.filter(|least| *least > 0.0) {
        Some(least) => format!("clearance              at least {}\n", length(least)),
        None => "clearance              not computed\n".to_owned(),
    }
}

/// What was found, in a few lines.
fn found(report: &Report, scene: Scene) -> String {
    let mut text = String::new();
    let [low, high] = report.bounds.map(probability);
    // Writing to a string cannot fail.
    let _ = writeln!(
        text,
        "collision probability  {}   (within {low} .. {high})",
        probability(report.collision_probability)
    );
    let reason = report
        .undecided_by
        .map_or(String::new(), |by| format!(": {}", undecided_from(by, scene.is_placed)));
    let _ = writeln!(text, "{}", labelled("verdict", &format!("{}{reason}", report.verdict)));
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
        let _ = writeln!(text, "{}", labelled("unseen", &words::unseen(unseen)));
    }
    text
}

/// Columns that a line has at most, and where its words begin.
const WIDTH: usize = 100;
const INDENT: usize = 23;

/// A line of a report, with as many lines after it as its words take.
pub(crate) fn labelled(label: &str, words: &str) -> String {
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

pub(crate) fn place(placement: &Placement) -> String {
    let (object, scene) = (between(placement.object_box), between(placement.scene_box));
    let gap = if placement.box_gap_m > 0.0 {
        format!(", {} outside of it", length(placement.box_gap_m))
    } else {
        String::new()
    };
    let nearest = placement
        .nearest_m
        .map_or(String::new(), |nearest| format!("; nearest point about {} away", length(nearest)));
    labelled("where", &format!("object in {object}, scene in {scene}{gap}{nearest}")) + "\n"
}

/// A box by its lowest and highest corner, m.
pub(crate) fn between(corners: [[f64; 3]; 2]) -> String {
    let [low, high] = corners;
    let longest = (0..3).map(|k| high[k] - low[k]).fold(0.0, f64::max);
    let digits = words::decimals(longest);
    let [low, high] =
        corners.map(|p| format!("({:.digits$}, {:.digits$}, {:.digits$})", p[0], p[1], p[2]));
    format!("{low} to {high} m")
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
