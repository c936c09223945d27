//! A probability for a score: logistic regression, by linfa.

use anyhow::{Context, Result, ensure};
use linfa::{Dataset, traits::Fit};
use linfa_logistic::LogisticRegression;
use ndarray::{Array1, Array2};

/// P = 1 / (1 + exp(−(c₀ + c₁ x))).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Logistic {
    /// c₀.
    pub intercept: f64,
    /// c₁.
    pub slope: f64,
}

impl Logistic {
    /// The coefficients of greatest likelihood, without penalty.
    ///
    /// # Errors
    /// When a score is not finite, or the truths are all alike.
    pub fn fit(scores: &[f64], truths: &[bool]) -> Result<Self> {
        ensure!(!scores.is_empty(), "nothing to fit a logistic regression to");
        let count = scores.len();
        // Scores of size 1 let the optimiser end at its tolerance.
        let squares = scores.iter().map(|x| x * x).sum::<f64>();
        let scale = (squares / count as f64).sqrt().max(f64::MIN_POSITIVE);
        let table = Array2::from_shape_fn((count, 1), |(i, _)| scores[i] / scale);
        let fitted = LogisticRegression::default()
            .alpha(0.0)
            .gradient_tolerance(1e-6 * count as f64)
            .max_iterations(1000)
            .fit(&Dataset::new(table, Array1::from(truths.to_vec())))
            .context("fit a logistic regression")?;
        // The class called positive is the library's choice.
        let sign = if fitted.labels().pos.class { 1.0 } else { -1.0 };
        let (intercept, slope) = (sign * fitted.intercept(), sign * fitted.params()[0] / scale);
        ensure!(intercept.is_finite() && slope.is_finite(), "the fit has no finite optimum");
        Ok(Self { intercept, slope })
    }

    /// The probability of an outcome.
    pub fn probability(self, score: f64) -> f64 {
        1.0 / (1.0 + (-(self.intercept + self.slope * score)).exp())
    }
}

#[cfg(test)]
mod tests {
    use cloudtouch_geom::seed;

    use super::*;

    #[test]
    fn what_was_drawn_is_found() {
        let unit = |i, k| seed::unit(seed::derive(7, i, k));
        let drawn = Logistic { intercept: 1.5, slope: -70.0 };
        let scores: Vec<f64> = (0..4000).map(|i| 0.05 * unit(i, 2)).collect();
        let truths: Vec<bool> =
            (0..4000).map(|i| unit(i, 3) < drawn.probability(scores[i as usize])).collect();
        let found = Logistic::fit(&scores, &truths).unwrap();
        assert!((found.intercept - drawn.intercept).abs() < 0.3, "{found:?}");
        assert!((found.slope - drawn.slope).abs() < 10.0, "{found:?}");
        // At the optimum the mean probability is the rate.
        let mean = scores.iter().map(|x| found.probability(*x)).sum::<f64>() / 4000.0;
        let rate = truths.iter().filter(|t| **t).count() as f64 / 4000.0;
        assert!((mean - rate).abs() < 1e-5, "{mean} {rate}");
        assert!(Logistic::fit(&scores[..5], &[true; 5]).is_err());
    }
}
