//! The classifier without ellipsoids by linfa-svm, at the gap that ours is asked for.

use anyhow::{Context, Error, Result};
use cloudtouch_svm::{Class, Sample};
use linfa::{Dataset, ParamGuard, traits::Fit};
use linfa_svm::Svm;
use ndarray::{Array1, Array2};

use super::timing::least_of;

/// How much tighter linfa's tolerance gets from one try to the next.
const TIGHTER: f64 = 0.3;
/// The tightest tolerance tried.
const TIGHTEST: f64 = 1e-8;

/// Solves with the loosest of linfa's tolerances that reaches the gap wanted, and times that one
/// alone: the relative gap reached, and the least of several times, s.
///
/// Its tolerance is on gradients, so it has to be found; the search is not timed.
pub(super) fn solve(
    samples: &[Sample],
    gamma: f64,
    wanted: f64,
    repeats: usize,
) -> Result<(f64, f64)> {
    let mut tolerance = 1.0;
    let gap_at =
        |tolerance| Ok::<_, Error>(relative_gap(samples, gamma, &fit(samples, gamma, tolerance)?));
    while gap_at(tolerance)? > wanted && tolerance > TIGHTEST {
        tolerance *= TIGHTER;
    }
    let (signed, seconds) = least_of(repeats, || fit(samples, gamma, tolerance))?;
    Ok((relative_gap(samples, gamma, &signed), seconds))
}

/// Multipliers that carry the sign of their class.
fn fit(samples: &[Sample], gamma: f64, tolerance: f64) -> Result<Vec<f64>> {
    // Every point here has the same penalty.
    let penalty = samples.first().context("linfa-svm: no samples")?.penalty;
    // Its kernel is exp(−|x − y|² / width).
    let parameters = Svm::<f64, bool>::params()
        .gaussian_kernel(gamma.recip())
        .pos_neg_weights(penalty, penalty)
        .eps(tolerance)
        .check()?;
    let places: Vec<[f64; 3]> = samples.iter().map(|s| s.point.mean.into()).collect();
    let sides = Array1::from_iter(samples.iter().map(|s| s.class == Class::A));
    Ok(parameters.fit(&Dataset::new(Array2::from(places), sides))?.alpha)
}

/// (primal − dual) / primal at multipliers that carry the sign of their class, with the best bias.
fn relative_gap(samples: &[Sample], gamma: f64, signed: &[f64]) -> f64 {
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

    use super::{super::leaf_problems::CELLS, *};

    #[test]
    fn both_reach_the_gap_and_the_gap_is_that_of_the_library() {
        for (cell, from) in CELLS.into_iter().zip(1..) {
            let mut samples = cell.problem(20, from);
            samples.iter_mut().for_each(|s| s.radius = 0.0);
            let (theirs, _) = solve(&samples, cell.gamma, 1e-4, 1).unwrap();
            assert!(theirs <= 1e-4 && theirs > -1e-12, "{}: {theirs}", cell.name);

            let kernel = Kernel::Gaussian { gamma: cell.gamma };
            let settings = Settings::with_relative_gap(1e-4).unwrap();
            let ours = Problem::try_new(&samples, kernel).unwrap().solve(&settings);
            let signed: Vec<f64> =
                ours.alpha.iter().zip(&samples).map(|(alpha, s)| alpha * s.class.sign()).collect();
            let gap = relative_gap(&samples, cell.gamma, &signed);
            assert!((gap - ours.relative_gap).abs() < 1e-9, "{gap} and {}", ours.relative_gap);
        }
    }
}
