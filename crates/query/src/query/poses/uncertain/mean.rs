//! What the answers at several poses say together.

use serde::Serialize;

use crate::report::Report;

/// The outermost of poses that are spread evenly stand for all that is beyond 1.5 deviations. Where it is not sure
/// that poses farther out collide, some of them stand for themselves: how many deviations out, and the share of
/// all between 1.86, 2.4 and 3 deviations and beyond.
pub(super) const TAIL: [(f64, f64); 3] = [(2.1, 0.0233), (2.65, 0.00685), (3.3, 0.00135)];

/// How likely a collision is over all the poses that may be.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[non_exhaustive]
pub struct UnderPoses {
    /// Mean collision probability of the poses.
    pub probability: f64,
    /// Means of the lower and the upper bounds; `probability` lies within.
    pub bounds: [f64; 2],
    /// The standard error that the mean would have if as many poses had been drawn at random; where all of them
    /// collide, or none, as if half a pose did the opposite. As a rule the error is less, for the poses are spread
    /// evenly. 0 where poses that come near enough are out of the question.
    pub std_error: f64,
    /// How many poses were asked about.
    pub poses: usize,
}

/// A probability and its bounds.
pub(super) type Said = [f64; 3];

/// What a report says.
pub(super) fn said(report: &Report) -> Said {
    let [low, high] = report.bounds;
    [report.collision_probability, low, high]
}

impl UnderPoses {
    /// The plain answer.
    pub(super) fn one(report: &Report) -> Self {
        let Report { collision_probability: probability, bounds, .. } = *report;
        Self { probability, bounds, std_error: 0.0, poses: 1 }
    }

    /// The mean of probabilities with their bounds; in the tails others take the place of the outermost.
    pub(super) fn mean(asked: &[Said], tails: &[(Said, Vec<Said>)]) -> Self {
        let count = asked.len() as f64;
        let mut means = [0.0; 3];
        for said in asked {
            means.iter_mut().zip(said).for_each(|(mean, value)| *mean += value / count);
        }
        let square: f64 = asked.iter().map(|[p, ..]| p * p / count).sum();
        let mut poses = asked.len();
        for (outermost, said) in tails {
            poses += said.len();
            for (said, (_, share)) in said.iter().zip(TAIL) {
                let change =
                    |((mean, is), was): ((&mut f64, &f64), &f64)| *mean += share * (is - was);
                means.iter_mut().zip(said).zip(outermost).for_each(change);
            }
        }
        let [probability, low, high] = means.map(|mean| mean.clamp(0.0, 1.0));
        // Half a pose more that does otherwise: none of so many does not mean never.
        let half = 0.5 / (count + 1.0);
        let variance = (square - probability * probability).max(half * (1.0 - half));
        Self { probability, bounds: [low, high], std_error: (variance / count).sqrt(), poses }
    }
}
