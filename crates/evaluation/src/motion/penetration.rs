//! The least translation out of a collision, against that of the exact meshes.

use std::time::Instant;

use anyhow::Result;
use cloudtouch::{Query, QuerySettings};

use super::near_contact::{Bodies, answers};
use crate::{
    answers::{Answers, Pair, Said},
    methods::{Draw, Method, Prepared},
    page::Section,
    table::Table,
    targets::{Findings, Target},
};

/// After the translation a collision is less likely than this.
const PROBABILITY: f64 = 0.1;
/// Deeper overlaps are not counted, m.
const DEEPEST: f64 = 0.1;
/// A distance is good that is off by no more than this, m, or by this share.
const MOST_OFF: f64 = 0.01;
/// See [`MOST_OFF`].
const MOST_SHARE: f64 = 0.25;
/// The share of overlaps where it is to be good.
const GOOD: f64 = 0.8;

const TEXT: &str = "The translation after which a collision is less likely than a tenth, beside the \
shortest that was found to free the exact meshes (162 directions, then closer around the best; itself an \
upper bound), where these overlap by up to 10 cm; ordinary families, 10,000 points, noise of 2 and 10 mm. \
*Good*: off by no more than 25 % or 1 cm. *Median off*: distance less depth. *None*: no direction freed it. \
*Time*: median of a call.";

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
            Ok(out.map(|out| Said::score(out.distance_m, start)))
        }))
    }
}

/// How near distances come to the exact depth.
pub(super) fn measure(draws: u32, poses: usize) -> Findings {
    Ok(judge(&answers(draws, poses, WayOut)?))
}

/// Depths and distances of one kind of pair, where there is one, and times.
fn overlaps(answers: &Answers, pair: Pair) -> Vec<(f64, Option<(f64, f64)>)> {
    let rows = answers.rows.iter().filter(|(question, _)| {
        question.pair == pair
            && question.signed_distance < 0.0
            && question.signed_distance >= -DEEPEST
    });
    rows.map(|(question, said)| {
        let told = said.first().copied().flatten();
        (-question.signed_distance, told.map(|said| (said.score, said.micros)))
    })
    .collect()
}

fn is_good(depth: f64, distance: f64) -> bool {
    (distance - depth).abs() <= MOST_OFF.max(MOST_SHARE * depth)
}

fn judge(answers: &Answers) -> (Section, Vec<Target>) {
    let mut table = Table::new(["pair", "overlaps", "good", "median off", "none", "time"]);
    let mut targets = Vec::new();
    for pair in Pair::ALL {
        let overlaps = overlaps(answers, pair);
        let told = || overlaps.iter().filter_map(|(depth, said)| Some((*depth, (*said)?)));
        let good = told().filter(|(depth, (distance, _))| is_good(*depth, *distance)).count();
        let share = good as f64 / overlaps.len() as f64;
        table.row([
            pair.name().to_owned(),
            overlaps.len().to_string(),
            format!("{share:.2}"),
            format!("{:+.1} mm", 1e3 * median(told().map(|(depth, (far, _))| far - depth))),
            (overlaps.len() - told().count()).to_string(),
            format!("{:.2} s", 1e-6 * median(told().map(|(_, (_, micros))| micros))),
        ]);
        let what = format!(
            "{}: distance within 25 % or 1 cm in ≥ {:.0} % of overlaps up to 10 cm",
            pair.name(),
            100.0 * GOOD
        );
        targets.push(Target::new(what, format!("{:.0} %", 100.0 * share), share >= GOOD));
    }
    (Section::new("Penetration").text(TEXT).text(table), targets)
}

fn median(values: impl Iterator<Item = f64>) -> f64 {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::answers::{Question, tests::question};

    #[test]
    fn what_is_off_by_more_and_what_has_no_way_out_is_not_good() {
        let mut answers = Answers { methods: vec!["penetration".to_owned()], rows: Vec::new() };
        let told = [Some(0.049), Some(0.02), None, Some(0.05)];
        for (pose, told) in told.into_iter().enumerate() {
            let said = told.map(|distance| Said::score(distance, Instant::now()));
            let question =
                Question { signed_distance: -0.04, ..question("a", 0, pose as u32, true) };
            answers.push((question, vec![said])).unwrap();
        }
        let (_, targets) = judge(&answers);
        let cloud = format!("{:?}", targets[0]);
        assert!(cloud.contains("50 %") && cloud.contains("met: false"), "{cloud}");
    }
}
