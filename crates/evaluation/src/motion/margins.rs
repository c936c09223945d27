//! How likely bodies are within a margin of each other, against how often they are.

use anyhow::{Context, Result};
use cloudtouch::{WITHIN_KNOTS, WITHIN_NOISES};

use crate::answers::{Answers, Pair, Question, Row, Said};
use crate::measures::{Axis, SurfaceSample, fit_surface};
use crate::methods::Ours;
use crate::report::{Findings, Section, Table, Target};
use crate::statistics::share;
use crate::sweep::{Asked, Judged, Plan, ask, ordinary};

/// Margins asked about, m.
const MARGINS: [f64; 3] = [0.01, 0.03, 0.1];
/// What is stated of a margin may be wrong by this much on average.
const MOST_ERROR: f64 = 0.05;

const MARGIN: &str = "The bodies of the sweep's scenes, at its poses and noises, asked how likely they are nearer to \
one another than a margin. *Nearer*: share of the poses where the exact surfaces are. *ECE*: expected calibration \
error with what chance alone makes of it taken off, as for collisions; *worst family*: the same of the ordinary \
family where it is largest. The log odds of margins were fitted on other draws of the same families.";

/// Log odds at the knots fitted to some draws, printed.
pub(super) fn fit(draws: u32, poses: usize) -> Result<()> {
    println!("{:?}", fit_margins(&answers(Plan::evidence(draws, poses))?)?);
    Ok(())
}

/// How well stated margins are.
pub(super) fn measure(draws: u32, poses: usize) -> Findings {
    margins(&answers(Plan::full(draws, poses))?)
}

fn answers(mut plan: Plan) -> Result<Answers> {
    // Coarse clouds at one noise only: they take as long and say the same.
    plan.conditions.retain(|c| c.std > 0.0 && (c.points == 10_000 || c.std == 0.002));
    let method = |margin: f64| Ok(Asked::always(Ours::new(&name(margin))?.within(margin)));
    let methods: Vec<Asked> = MARGINS.into_iter().map(method).collect::<Result<_>>()?;
    ask(&plan, &methods)
}

fn name(margin: f64) -> String {
    format!("{:.0} cm", 100.0 * margin)
}

/// Log odds at the knots, for each noise.
fn fit_margins(answers: &Answers) -> Result<Vec<Vec<f64>>> {
    let mut samples: Vec<SurfaceSample<2>> = Vec::new();
    for margin in MARGINS {
        let method = answers.index(&name(margin)).context("a margin that was asked about")?;
        for (question, said) in &answers.rows {
            let Said { score, evidence, .. } = said[method].context("an answer")?;
            let noise = evidence.context("an answer with evidence")?.scatter_over_spacing;
            let came = question.signed_distance < margin;
            samples.push(SurfaceSample { at: [noise, -score], came, weight: 1.0 });
        }
    }
    let mut nearness = WITHIN_KNOTS.map(|z| -z);
    nearness.reverse();
    let noise = Axis { knots: &WITHIN_NOISES, usual: None };
    let nearness = Axis { knots: &nearness, usual: Some(2.0) };
    let fitted = fit_surface(&samples, [noise, nearness], &[]);
    let of_noise = |values: &[f64]| values.iter().rev().copied().collect();
    Ok(fitted.chunks(WITHIN_KNOTS.len()).map(of_noise).collect())
}

fn margins(answers: &Answers) -> Findings {
    let mut table = Table::new(["pair", "margin", "poses", "nearer", "ECE"]);
    let mut targets = Vec::new();
    for pair in Pair::ALL {
        for margin in MARGINS {
            let (name, nearer) = (name(margin), within(answers, margin));
            let judged = Judged::pick(&nearer, &[&name], ordinary(pair));
            let error = judged.error_above_chance(&name).clamp(0.0, 1.0);
            let of = judged.questions();
            table.row([
                pair.to_string(),
                name.clone(),
                of.len().to_string(),
                format!("{:.2}", share(of.iter().map(|q| q.collides))),
                format!("{error:.3}"),
            ]);
            let what = format!("{pair}, {name}: ECE ≤ {MOST_ERROR}");
            targets.push(Target::new(what, format!("{error:.3}"), error <= MOST_ERROR));
        }
    }
    Ok((Section::new("Margins").text(MARGIN).text(table), targets))
}

/// The same, where being nearer than a margin counts as the collision.
fn within(answers: &Answers, margin: f64) -> Answers {
    let row = |(question, said): &Row| {
        let collides = question.signed_distance < margin;
        (Question { collides, ..question.clone() }, said.clone())
    };
    Answers { methods: answers.methods.clone(), rows: answers.rows.iter().map(row).collect() }
}

#[cfg(test)]
mod tests {
    use std::time::Instant;

    use super::*;
    use crate::answers::tests::{evidence, question};

    fn answers(stated: f64) -> Answers {
        let mut answers = Answers { methods: MARGINS.map(name).to_vec(), rows: Vec::new() };
        for pose in 0..200 {
            // A tenth of them is 2 cm apart, the others half a metre.
            let distance = if pose % 10 == 0 { 0.02 } else { 0.5 };
            let said = |margin: f64| {
                let probability =
                    if margin == 0.03 { stated } else { f64::from(distance < margin) };
                let evidence = Some(evidence(2.0, 0.0, 0.3));
                let score = Said::score((distance - margin) / 0.01, Instant::now());
                Some(Said { probability: Some(probability), evidence, ..score })
            };
            let question = Question { signed_distance: distance, ..question("a", 0, pose, false) };
            answers.push((question, MARGINS.map(said).to_vec())).unwrap();
        }
        answers
    }

    #[test]
    fn what_is_stated_as_often_as_it_comes_has_no_error_and_else_the_difference() {
        let error = |stated| {
            let answers = within(&answers(stated), 0.03);
            let judged = Judged::pick(&answers, &["3 cm"], ordinary(Pair::CloudCloud));
            let collide = judged.questions().iter().filter(|q| q.collides).count();
            assert_eq!((judged.questions().len(), collide), (200, 20));
            judged.error_above_chance("3 cm")
        };
        assert!(error(0.1) < 0.01 && (error(0.6) - 0.5).abs() < 0.05);
    }

    #[test]
    fn fitted_log_odds_fall_with_deviations() {
        for fitted in fit_margins(&answers(0.1)).unwrap() {
            let falls = fitted.is_sorted_by(|a, b| a >= b);
            assert!(falls && fitted[0] > 2.0 && fitted[8] < -2.0, "{fitted:?}");
        }
    }
}
