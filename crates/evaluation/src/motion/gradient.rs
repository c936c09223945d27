//! Gradients by the pose, against queries at poses a little aside.

use std::time::Instant;

use anyhow::Result;
use cloudtouch::{BodyRef, PoseGradient, Query, QuerySettings, Report};
use cloudtouch_geom::{Pose, Vector3};
use nalgebra::{UnitQuaternion, Vector6};

use super::near_contact::{Bodies, answers};
use crate::answers::{Answers, Pair, Said};
use crate::methods::{Draw, Method, Prepared};
use crate::report::{Findings, Section, Table, Target};

/// Steps of the differences, m; rotations by as much at this arm, m.
const STEPS: [f64; 2] = [4e-6, 1e-6];
/// See [`STEPS`].
const ARM: f64 = 0.1;
/// Two differences farther apart than this, relative to their size, are of no smooth place.
const SMOOTH: f64 = 2e-3;
/// A gradient is right that is off by no more than this, relative to its size.
const MOST_ERROR: f64 = 1e-2;
/// The share of smooth places where it is to be right.
const RIGHT: f64 = 0.95;

const TEXT: &str = "Gradients of the log odds (and with them of the probability) and of the clearance \
beside central differences of queries at poses 1 and 4 µm, and 10 and 40 µrad, to either side; the scenes of \
the ways out. *Smooth*: poses where both differences agree to 0.2 % and are not nothing. *Right*: share of \
these where the gradient is within 1 % of the difference.";

/// Of what a gradient is asked for.
#[derive(Clone, Copy)]
struct Of {
    name: &'static str,
    /// A smaller slope, per metre, is none.
    flat: f64,
    value: fn(&Report) -> Option<f64>,
    gradient: fn(&PoseGradient) -> Option<[f64; 6]>,
}

const ALL: [Of; 2] = [
    Of {
        name: "log odds",
        flat: 1e-2,
        value: |report| report.log_likelihood_ratio,
        gradient: |gradient| Some(gradient.log_odds),
    },
    Of {
        name: "clearance",
        flat: 1e-3,
        value: |report| report.clearance_m.filter(|gap| !gap.is_bound).map(|gap| gap.mean),
        gradient: |gradient| gradient.clearance,
    },
];

/// Tells how far gradients are off.
struct Compared(Of);

impl Method for Compared {
    fn name(&self) -> String {
        self.0.name.to_owned()
    }

    fn prepare(&self, draw: &Draw<'_>) -> Result<Prepared> {
        let bodies = Bodies::prepare(draw)?;
        let Self(of) = *self;
        // Without an early stop, and separated to the last digit: differences tell of nothing else.
        let settings = QuerySettings { stop_above: 2.0, relative_gap: 1e-9, ..Default::default() };
        let query = Query::new(settings)?;
        Ok(Box::new(move |pair, a_from_b| {
            let start = Instant::now();
            let bodies = bodies.pair(pair);
            let (_, gradient) = query.gradient(bodies.0, bodies.1, a_from_b)?;
            let Some(found) = (of.gradient)(&gradient) else { return Ok(None) };
            let found = Vector6::from_fn(|k, _| if k < 3 { found[k] } else { found[k] / ARM });
            let difference = difference(&query, bodies, a_from_b, of)?;
            let known = difference.filter(|known| known.norm() > of.flat);
            Ok(known.map(|known| Said::score((found - known).norm() / known.norm(), start)))
        }))
    }
}

/// Central differences; `None` where those with two steps do not agree.
fn difference(
    query: &Query,
    (a, b): (BodyRef<'_>, BodyRef<'_>),
    pose: &Pose,
    of: Of,
) -> Result<Option<Vector6<f64>>> {
    let mut both = [Vector6::zeros(); 2];
    for (difference, step) in both.iter_mut().zip(STEPS) {
        for axis in 0..6 {
            let at = |step: f64| -> Result<Option<f64>> {
                Ok((of.value)(&query.run(a, b, &moved(pose, axis, step))?))
            };
            let (Some(above), Some(below)) = (at(step)?, at(-step)?) else { return Ok(None) };
            difference[axis] = (above - below) / (2.0 * step);
        }
    }
    let [wide, narrow] = both;
    Ok(((wide - narrow).norm() <= SMOOTH * narrow.norm()).then_some(narrow))
}

/// A pose after a small motion along or about an axis of the object.
fn moved(pose: &Pose, axis: usize, step: f64) -> Pose {
    let along = Vector3::ith(axis % 3, step);
    pose.after(&if axis < 3 {
        Pose::from_translation(along)
    } else {
        let turn = UnitQuaternion::from_scaled_axis(along / ARM);
        Pose::from_translation_rotation(Vector3::zeros(), turn)
    })
}

/// How often gradients are right.
pub(super) fn measure(draws: u32, poses: usize) -> Findings {
    let mut table = Table::new(["of", "pair", "poses", "smooth", "right"]);
    let mut targets = Vec::new();
    for of in ALL {
        let answers = answers(draws, poses, Compared(of))?;
        for pair in Pair::ALL {
            let (poses, smooth, right) = count(&answers, pair);
            let share = right as f64 / smooth as f64;
            let [poses, smooth] = [poses, smooth].map(|count| count.to_string());
            table.row([of.name, &pair.to_string(), &poses, &smooth, &format!("{share:.3}")]);
            let name = of.name;
            let what = format!("{pair}: gradient of {name} within 1 % at ≥ 95 % of smooth poses");
            targets.push(Target::new(what, format!("{:.1} %", 100.0 * share), share >= RIGHT));
        }
    }
    Ok((Section::new("Gradients").text(TEXT).text(table), targets))
}

/// Poses of a kind of pair, those that are smooth, and those of them with the right gradient.
fn count(answers: &Answers, pair: Pair) -> (usize, usize, usize) {
    let rows = || answers.rows.iter().filter(|(question, _)| question.pair == pair);
    let errors = || rows().filter_map(|(_, said)| said.first().copied().flatten());
    (rows().count(), errors().count(), errors().filter(|said| said.score <= MOST_ERROR).count())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::answers::tests::question;

    #[test]
    fn what_is_off_by_more_than_a_hundredth_is_not_right() {
        let mut answers = Answers { methods: vec!["log odds".to_owned()], rows: Vec::new() };
        for (pose, error) in [Some(0.001), Some(0.02), None].into_iter().enumerate() {
            let said = error.map(|error| Said::score(error, Instant::now()));
            answers.push((question("a", 0, pose as u32, false), vec![said])).unwrap();
        }
        assert_eq!(count(&answers, Pair::CloudCloud), (3, 2, 1));
    }
}
