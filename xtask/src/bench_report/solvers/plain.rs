//! The classifier without ellipsoids by linfa-svm, at the gap that ours is asked for.

use anyhow::{Result, anyhow};
use cloudtouch_svm::{Class, Sample};
use linfa::{Dataset, ParamGuard, traits::Fit};
use linfa_svm::Svm;
use ndarray::{Array1, Array2};

use super::super::timing::timed;

/// How much tighter linfa's tolerance gets from one try to the next.
const TIGHTER: f64 = 0.3;
/// The tightest tolerance tried.
const TIGHTEST: f64 = 1e-8;

/// Where a solver got to and how long that took.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Solved {
    /// s.
    pub(super) seconds: f64,
    /// (primal − dual) / primal.
    pub(super) gap: f64,
}

/// Solves with the loosest of linfa's tolerances that reaches the gap, and times that one alone.
///
/// Its tolerance is on gradients, so it has to be found; the search is not timed.
pub(super) fn linfa(samples: &[Sample], gamma: f64, wanted: f64, repeats: usize) -> Result<Solved> {
    let mut tolerance = 1.0;
    let mut solved = fit(samples, gamma, tolerance)?;
    while solved.gap > wanted && tolerance > TIGHTEST {
        tolerance *= TIGHTER;
        solved = fit(samples, gamma, tolerance)?;
    }
    for _ in 1..repeats {
        solved.seconds = solved.seconds.min(fit(samples, gamma, tolerance)?.seconds);
    }
    Ok(solved)
}

fn fit(samples: &[Sample], gamma: f64, tolerance: f64) -> Result<Solved> {
    let Some(penalty) = samples.first().map(|s| s.penalty) else {
        return Err(anyhow!("linfa-svm: no samples"));
    };
    // Its kernel is exp(−|x − y|² / width); every point here has the same penalty.
    let parameters = Svm::<f64, bool>::params()
        .gaussian_kernel(gamma.recip())
        .pos_neg_weights(penalty, penalty)
        .eps(tolerance)
        .check()?;
    let train = || {
        let places =
            Array2::from(samples.iter().map(|s| s.point.mean.into()).collect::<Vec<[f64; 3]>>());
        let sides = Array1::from_iter(samples.iter().map(|s| s.class == Class::A));
        parameters.fit(&Dataset::new(places, sides))
    };
    let (model, seconds) = timed(train);
    Ok(Solved { seconds, gap: relative_gap(samples, gamma, &model?.alpha) })
}

/// (primal − dual) / primal at multipliers that carry the sign of their class, with the best bias.
pub(super) fn relative_gap(samples: &[Sample], gamma: f64, signed: &[f64]) -> f64 {
    let kernel =
        |a: &Sample, b: &Sample| (-gamma * (a.point.mean - b.point.mean).norm_squared()).exp();
    let terms = || samples.iter().zip(signed).filter(|(_, alpha)| **alpha != 0.0);
    let f: Vec<f64> =
        samples.iter().map(|x| terms().map(|(s, alpha)| alpha * kernel(s, x)).sum()).collect();
    let squared_norm: f64 = signed.iter().zip(&f).map(|(alpha, f)| alpha * f).sum();
    let losses = |bias: f64| -> f64 {
        let loss =
            |(s, f): (&Sample, &f64)| s.penalty * (1.0 - s.class.sign() * (f + bias)).max(0.0);
        samples.iter().zip(&f).map(loss).sum()
    };
    // Piecewise linear and convex: the least is where one of the terms starts.
    let starts = samples.iter().zip(&f).map(|(s, f)| s.class.sign() - f);
    let least = starts.map(losses).fold(f64::INFINITY, f64::min);
    let primal = 0.5 * squared_norm + least;
    let dual = signed.iter().map(|alpha| alpha.abs()).sum::<f64>() - 0.5 * squared_norm;
    (primal - dual) / primal
}

#[cfg(test)]
mod tests {
    use cloudtouch_svm::{Kernel, Problem, Settings};

    use super::{super::cells::CELLS, *};

    #[test]
    fn both_reach_the_gap_and_the_gap_is_that_of_the_library() {
        for (cell, from) in CELLS.into_iter().zip(1..) {
            let mut samples = cell.problem(20, from);
            samples.iter_mut().for_each(|s| s.radius = 0.0);
            let theirs = linfa(&samples, cell.gamma, 1e-4, 1).unwrap();
            assert!(theirs.gap <= 1e-4 && theirs.gap > -1e-12, "{}: {theirs:?}", cell.name);

            let kernel = Kernel::Gaussian { gamma: cell.gamma };
            let settings = Settings { relative_gap: 1e-4, ..Settings::default() };
            let ours = Problem::try_new(&samples, kernel).unwrap().solve(&settings).unwrap();
            let signed: Vec<f64> =
                ours.alpha.iter().zip(&samples).map(|(alpha, s)| alpha * s.class.sign()).collect();
            let gap = relative_gap(&samples, cell.gamma, &signed);
            assert!((gap - ours.relative_gap).abs() < 1e-9, "{gap} and {}", ours.relative_gap);
        }
    }
}
