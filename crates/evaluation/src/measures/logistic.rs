//! A probability for scores: logistic regression, by linfa.

use anyhow::{Context, Result, ensure};
use linfa::{Dataset, traits::Fit};
use linfa_logistic::LogisticRegression;
use ndarray::{Array1, Array2};

/// P = 1 / (1 + exp(−(c₀ + Σ cₖ xₖ))).
#[derive(Debug, Clone, PartialEq)]
pub struct Logistic {
    /// c₀, and the slope of each feature.
    pub coefficients: Vec<f64>,
}

impl Logistic {
    /// The coefficients of greatest likelihood, without penalty.
    ///
    /// # Errors
    /// When a feature is not finite, or the truths are all alike.
    pub fn fit(features: &[Vec<f64>], truths: &[bool]) -> Result<Self> {
        ensure!(!features.is_empty(), "nothing to fit a logistic regression to");
        let width = features.first().map_or(0, Vec::len);
        // Features of a common size let the optimiser end at its tolerance.
        let scales: Vec<f64> = (0..width)
            .map(|k| {
                let squares = features.iter().map(|row| row[k] * row[k]).sum::<f64>();
                (squares / features.len() as f64).sqrt().max(f64::MIN_POSITIVE)
            })
            .collect();
        let table =
            Array2::from_shape_fn((features.len(), width), |(i, k)| features[i][k] / scales[k]);
        let fitted = LogisticRegression::default()
            .alpha(0.0)
            .gradient_tolerance(1e-6 * features.len() as f64)
            .max_iterations(1000)
            .fit(&Dataset::new(table, Array1::from(truths.to_vec())))
            .context("fit a logistic regression")?;
        // The class called positive is the library's choice.
        let sign = if fitted.labels().pos.class { 1.0 } else { -1.0 };
        let slopes = fitted.params().iter().zip(&scales).map(|(slope, scale)| sign * slope / scale);
        let coefficients: Vec<f64> =
            std::iter::once(sign * fitted.intercept()).chain(slopes).collect();
        ensure!(coefficients.iter().all(|c| c.is_finite()), "the fit has no finite optimum");
        Ok(Self { coefficients })
    }

    /// The probability of an outcome.
    pub fn probability(&self, features: &[f64]) -> f64 {
        let [intercept, slopes @ ..] = self.coefficients.as_slice() else { return f64::NAN };
        let x = intercept + slopes.iter().zip(features).map(|(c, x)| c * x).sum::<f64>();
        1.0 / (1.0 + (-x).exp())
    }
}

#[cfg(test)]
mod tests {
    use cloudtouch_geom::seed;

    use super::*;

    #[test]
    fn what_was_drawn_is_found() {
        let unit = |i, k| seed::unit(seed::derive(7, i, k));
        let drawn = Logistic { coefficients: vec![-0.5, 1.1, -70.0] };
        let rows: Vec<Vec<f64>> =
            (0..4000).map(|i| vec![4.0 * unit(i, 1), 0.05 * unit(i, 2)]).collect();
        let truths: Vec<bool> =
            (0..4000).map(|i| unit(i, 3) < drawn.probability(&rows[i as usize])).collect();
        let found = Logistic::fit(&rows, &truths).unwrap();
        for (found, (drawn, error)) in
            found.coefficients.iter().zip(drawn.coefficients.iter().zip([0.3, 0.2, 10.0]))
        {
            assert!((found - drawn).abs() < error, "{found} {drawn}");
        }
        // At the optimum the mean probability is the rate.
        let mean = rows.iter().map(|row| found.probability(row)).sum::<f64>() / 4000.0;
        let rate = truths.iter().filter(|t| **t).count() as f64 / 4000.0;
        assert!((mean - rate).abs() < 1e-5, "{mean} {rate}");
        assert!(Logistic::fit(&rows[..5], &[true; 5]).is_err());
    }
}
