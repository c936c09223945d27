//! Which link of a robot touches what, for programs and for people.

use std::fmt::Write as _;

use anyhow::Result;
use cloudtouch::geom::Point3;
use cloudtouch::{Checked, PairAnswer, Verdict, Warning};
use cloudtouch_page::Fact;
use cloudtouch_robot::{PathChecked, SURROUNDINGS};
use serde::Serialize;
use serde_json::value::RawValue;

use crate::answers::print::{one_line, probability};
use crate::answers::scene::{self, Bodies, Pair};
use crate::answers::text::{between, labelled};
use crate::remedies;

#[derive(Serialize)]
struct Line<'a> {
    verdict: Verdict,
    undecided_by: Option<&'static str>,
    threshold: f64,
    certified_free_until: f64,
    stopped: Option<Stopped<'a>>,
    later: Option<Stopped<'a>>,
    looked_at: usize,
    /// Each as the answer to one position.
    given: Vec<Box<RawValue>>,
    #[serde(flatten)]
    asked: Asked<'a>,
}

/// The answer to one position.
#[derive(Serialize)]
struct Position<'a> {
    #[serde(flatten)]
    scene: scene::Line<'a>,
    #[serde(flatten)]
    asked: Asked<'a>,
}

/// What was asked, and so what was not.
#[derive(Debug, Clone, Copy, Serialize)]
pub(crate) struct Asked<'a> {
    /// Links that can be seen and have no `<collision>`.
    pub unchecked_links: &'a [String],
    /// Links that may touch the scan.
    pub may_touch: &'a [String],
    /// Whether the robot was removed from the scan.
    pub self_filter: bool,
    /// Whether links were asked about one another.
    pub self_collision: bool,
}

impl Asked<'_> {
    /// What is not asked about, in words.
    pub(crate) fn facts(&self) -> Vec<Fact> {
        let named = |links: &[String]| Some(links.join(", ")).filter(|names| !names.is_empty());
        let unchecked = named(self.unchecked_links)
            .map(|names| Fact::new("not checked", names + " (no <collision> in the URDF)"));
        let may_touch = named(self.may_touch).map(|names| Fact::new("may touch the scan", names));
        let filter = "none: give --scan-joints if the scan shows the robot";
        let filter = (!self.self_filter).then(|| Fact::new("self filter", filter));
        let itself = "not asked: give --self-collision";
        let itself = (!self.self_collision).then(|| Fact::new("self collision", itself));
        [unchecked, may_touch, filter, itself].into_iter().flatten().collect()
    }

    /// The same, a line each.
    pub(crate) fn text(&self) -> String {
        let line = |fact: &Fact| format!("{:<22} {}\n", fact.label, one_line(&fact.text));
        self.facts().iter().map(line).collect()
    }
}

pub(crate) fn json_line(
    checked: &Checked,
    threshold: f64,
    bodies: Bodies<'_>,
    asked: Asked<'_>,
) -> Result<String> {
    let scene = scene::line(checked, threshold, bodies);
    scene::told(&Position { scene, asked }, &checked.pairs, &checked.warnings)
}

#[derive(Serialize)]
struct Stopped<'a> {
    segment: usize,
    t: f64,
    pair: Option<Pair<'a>>,
    nearest: Option<Nearest<'a>>,
}

#[derive(Serialize)]
struct Nearest<'a> {
    a: &'a str,
    b: &'a str,
    at_most: f64,
}

impl<'a> From<&'a cloudtouch_robot::Stopped> for Stopped<'a> {
    fn from(at: &'a cloudtouch_robot::Stopped) -> Self {
        let nearest = at.nearest.as_ref();
        Self {
            segment: at.segment,
            t: at.t,
            pair: at.pair.as_ref().map(Pair::from),
            nearest: nearest.map(|pair| Nearest { a: &pair.a, b: &pair.b, at_most: pair.at_most }),
        }
    }
}

pub(crate) fn path_line(
    checked: &PathChecked,
    threshold: f64,
    bodies: Vec<Bodies<'_>>,
    asked: Asked<'_>,
) -> Result<String> {
    let given = checked.given.iter().zip(bodies).map(|(at, bodies)| {
        let line = scene::json_line(at, threshold, bodies)?;
        Ok(RawValue::from_string(line)?)
    });
    let line = Line {
        verdict: checked.verdict(),
        undecided_by: undecided_by(checked),
        threshold,
        certified_free_until: checked.certified_free_until,
        stopped: checked.stopped.as_ref().map(Stopped::from),
        later: checked.later.as_ref().map(Stopped::from),
        looked_at: checked.looked_at,
        given: given.collect::<Result<_>>()?,
        asked,
    };
    // Those of the positions have theirs.
    let others = [&checked.stopped, &checked.later].into_iter().flatten();
    scene::told(&line, others.filter_map(|at| at.pair.as_ref()), &[])
}

/// Why a path is undecided: by the first pair found on it that is, where one is.
fn undecided_by(checked: &PathChecked) -> Option<&'static str> {
    if checked.verdict() != Verdict::Undecided {
        return None;
    }
    if checked.is_unchecked() {
        return Some(scene::UNCHECKED);
    }
    let given = checked.given.iter().flat_map(|at| at.pairs.first());
    let mut found = given.chain(checked.stopped.iter().flat_map(|at| &at.pair));
    found.find_map(|pair| Some(pair.answer.as_ref().ok()?.undecided_by?.code()))
}

/// The worst pair in a few lines, above the table of all and what is to be said of them.
pub(crate) fn worst(checked: &Checked) -> String {
    checked.pairs.first().map_or(String::new(), |pair| described("worst pair", pair))
}

/// Where the robot is beside what was scanned.
pub(crate) fn place(Bodies { boxes, .. }: &Bodies<'_>) -> String {
    let corners = |of: &[Point3; 2]| of.map(|corner| corner.coords.into());
    let links = boxes.iter().filter(|(name, _)| **name != SURROUNDINGS);
    let all = links.map(|(_, corners)| *corners).reduce(|[low, high], [other_low, other_high]| {
        [low.inf(&other_low), high.sup(&other_high)]
    });
    let (Some(robot), Some(scan)) = (all, boxes.get(SURROUNDINGS)) else { return String::new() };
    let (robot, scan) = (between(corners(&robot)), between(corners(scan)));
    labelled("where", &format!("robot in {robot}, scan in {scan}")) + "\n"
}

pub(crate) fn path_text(checked: &PathChecked) -> String {
    let mut text = format!(
        "free for certain       until {:.1} % of the path\n",
        100.0 * checked.certified_free_until
    );
    if let Some(at) = &checked.stopped {
        let _ =
            writeln!(text, "then                   segment {}, t = {:.3}", at.segment + 1, at.t);
        if let Some(pair) = &at.pair {
            text += &warned(pair, checked);
        } else if let Some(near) = &at.nearest {
            let (a, b) = (one_line(&near.a), one_line(&near.b));
            let at_most = probability(near.at_most);
            let _ = writeln!(
                text,
                "nearest pair there     {a} / {b}: free there, up to P = {at_most} around it"
            );
        }
    }
    if let Some(at) = &checked.later {
        let _ =
            writeln!(text, "later                  segment {}, t = {:.3}", at.segment + 1, at.t);
        text += &at.pair.as_ref().map_or(String::new(), |pair| warned(pair, checked));
    }
    let far = checked.given.iter().find(|at| !at.outside.is_empty());
    text += &far.or(checked.given.first()).map(scene::doubts).unwrap_or_default();
    for (index, at) in checked.given.iter().enumerate() {
        let pairs =
            at.pairs.iter().map(|pair| format!("{} / {}", one_line(&pair.a), one_line(&pair.b)));
        let pairs = pairs.collect::<Vec<_>>().join(", ");
        let of = if pairs.is_empty() { String::new() } else { format!(": {pairs}") };
        let _ = writeln!(text, "position {:<13} {}{of}", index + 1, at.verdict());
    }
    let _ = if checked.is_unchecked() {
        write!(text, "{}: {}", checked.verdict(), scene::NONE_ASKED)
    } else {
        write!(text, "{}: {} positions looked at", checked.verdict(), checked.looked_at)
    };
    text
}

fn described(label: &str, pair: &PairAnswer) -> String {
    let mut text =
        format!("{label:<22} {} / {}: {}\n", one_line(&pair.a), one_line(&pair.b), pair.verdict());
    let Ok(report) = &pair.answer else { return text };
    let [low, high] = report.bounds.map(probability);
    let p = probability(report.collision_probability);
    let _ = writeln!(text, "collision probability  {p}   (within {low} .. {high})");
    if let Some(contact) = report.contacts.first() {
        let p = contact.point;
        let _ = writeln!(text, "contact                {:.3} {:.3} {:.3} m", p.x, p.y, p.z);
    }
    text
}

/// A pair on a path with what is to be said of it, without what is told of its bodies by themselves.
fn warned(pair: &PairAnswer, of: &PathChecked) -> String {
    let known =
        |warning: &Warning| of.given.first().is_some_and(|at| scene::is_of_a_body(at, warning));
    let warnings = pair.answer.iter().flat_map(|report| &report.warnings);
    let line = |warning| labelled("warning", &remedies::warning(warning)) + "\n";
    let lines = warnings.filter(|warning| !known(warning)).map(line);
    described("worst pair there", pair) + &lines.collect::<String>()
}
