//! The least translation out of a collision, against that of the exact meshes.

use std::time::Instant;

use anyhow::Result;
use cloudtouch::{Clearance, Query, QuerySettings};

use super::near_contact::{Bodies, STDS, answers};
use crate::answers::{Answers, Pair, Question, Said};
use crate::methods::{Draw, Method, Prepared};
use crate::report::{Findings, Section, Table, Target};
use crate::statistics::{median, share};

/// After the translation a collision is less likely than this.
const PROBABILITY: f64 = 0.1;
/// Deeper overlaps are not counted, m.
const DEEPEST: f64 = 0.1;
/// A depth is good that is off by no more than this, m, or by this share.
const MOST_OFF: f64 = 0.01;
/// See [`MOST_OFF`].
const MOST_SHARE: f64 = 0.25;
/// The share of overlaps where it is to be good.
const GOOD: f64 = 0.8;
/// The share of overlaps where the distance is to be enough: as often as it is told to be.
const ENOUGH: f64 = 1.0 - PROBABILITY;

const TEXT: &str = "How deep the object is in, told as how far it has to move until a collision is as likely as not, \
and how far until it is less likely than a tenth, beside the shortest translation that was found to free the exact \
meshes (162 directions, then closer around the best; itself an upper bound), where these overlap by up to 10 cm; \
ordinary families, 10,000 points. *Good*: off by no more than 25 % or 1 cm; *off*: its median, told less exact. \
*Enough*: the distance is no less than the exact depth. *Time*: median of a call.";

/// Asks for the way out.
struct WayOut;

impl Method for WayOut {
    fn name(&self) -> String {
        "penetration".to_owned()
    }

    fn prepare(&self, draw: &Draw<'_>) -> Result<Prepared> {
        let bodies = Bodies::prepare(draw)?;
        let query = Query::new(QuerySettings::default())?;
        Ok(Box::new(move |pair, a_from_b| {
            let start = Instant::now();
            let (a, b) = bodies.pair(pair);
            let (_, out) = query.penetration(a, b, a_from_b, PROBABILITY)?;
            Ok(out.map(|out| {
                let depth = Clearance::new(-out.depth_m, out.std_m);
                Said { clearance: Some(depth), ..Said::score(out.distance_m, start) }
            }))
        }))
    }
}

/// How near distances come to the exact depth.
pub(super) fn measure(draws: u32, poses: usize) -> Findings {
    Ok(judge(&answers(draws, poses, WayOut)?))
}

/// One overlap: its exact depth, and what is told of it, if anything is.
struct Overlap {
    exact: f64,
    told: Option<Said>,
}

impl Overlap {
    /// How much deeper than it is it is told to be, m.
    fn off(&self) -> Option<f64> {
        Some(-self.told?.clearance?.mean - self.exact)
    }

    fn is_good(&self) -> bool {
        self.off().is_some_and(|off| off.abs() <= MOST_OFF.max(MOST_SHARE * self.exact))
    }

    fn is_enough(&self) -> bool {
        self.told.is_some_and(|out| out.score >= self.exact)
    }
}

/// The overlaps of a kind of pair under some noise.
fn overlaps(answers: &Answers, pair: Pair, has_noise: impl Fn(f64) -> bool) -> Vec<Overlap> {
    let is_asked = |question: &Question| {
        question.pair == pair
            && has_noise(question.condition.std)
            && question.signed_distance < 0.0
            && question.signed_distance >= -DEEPEST
    };
    let rows = answers.rows.iter().filter(|(question, _)| is_asked(question));
    rows.map(|(question, said)| Overlap { exact: -question.signed_distance, told: said[0] })
        .collect()
}

fn judge(answers: &Answers) -> (Section, Vec<Target>) {
    const HEADER: &str = "pair, noise, overlaps, depth good, off, enough, time";
    let mut table = Table::new(HEADER.split(", "));
    let mut targets = Vec::new();
    for pair in Pair::ALL {
        for std in STDS {
            let overlaps = overlaps(answers, pair, |of| of == std);
            table.row(row(pair, std, &overlaps));
        }
        let overlaps = overlaps(answers, pair, |_| true);
        let good = ("depth within 25 % or 1 cm", GOOD, Overlap::is_good as fn(&_) -> _);
        for (what, least, is_met) in [good, ("distance enough", ENOUGH, Overlap::is_enough)] {
            let (share, percent) = (share(overlaps.iter().map(is_met)), 100.0 * least);
            let what = format!("{pair}: {what} in ≥ {percent:.0} % of overlaps up to 10 cm");
            targets.push(Target::new(what, format!("{:.0} %", 100.0 * share), share >= least));
        }
    }
    (Section::new("Penetration").text(TEXT).text(table), targets)
}

fn row(pair: Pair, std: f64, overlaps: &[Overlap]) -> [String; 7] {
    let off: Vec<f64> = overlaps.iter().filter_map(Overlap::off).collect();
    let told = overlaps.iter().filter_map(|overlap| overlap.told);
    let seconds: Vec<f64> = told.map(|told| 1e-6 * told.micros).collect();
    let part = |is_met| format!("{:.2}", share(overlaps.iter().map(is_met)));
    [
        pair.to_string(),
        format!("{:.0} mm", 1e3 * std),
        overlaps.len().to_string(),
        part(Overlap::is_good as fn(&_) -> _),
        format!("{:+.1} mm", 1e3 * median(&off)),
        part(Overlap::is_enough),
        format!("{:.2} s", median(&seconds)),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::answers::tests::question;

    #[test]
    fn what_is_off_by_more_and_what_has_no_way_out_is_not_good() {
        let mut answers = Answers { methods: vec!["penetration".to_owned()], rows: Vec::new() };
        let told = [Some(0.049), Some(0.02), None, Some(0.031)];
        for (pose, told) in told.into_iter().enumerate() {
            let said = told.map(|depth| {
                let clearance = Some(Clearance::new(-depth, 0.0));
                Said { clearance, ..Said::score(depth + 0.01, Instant::now()) }
            });
            let question =
                Question { signed_distance: -0.04, ..question("a", 0, pose as u32, true) };
            answers.push((question, vec![said])).unwrap();
        }
        let (_, targets) = judge(&answers);
        for (target, measured) in targets.iter().zip(["50 %", "50 %"]) {
            let target = format!("{target:?}");
            assert!(target.contains(measured) && target.contains("met: false"), "{target}");
        }
    }
}
