//! Logistic regression by Newton's method.

use anyhow::{Result, anyhow, ensure};
use nalgebra::{DMatrix, DVector};

/// More Newton steps than this mean that the problem is ill posed; a regular one takes about ten.
const STEPS: usize = 100;
/// Halvings of a Newton step that does not descend.
const HALVINGS: usize = 40;
/// The decrease, relative to the weight of all records, below which nothing is left to gain.
const GAIN: f64 = 1e-13;

/// A fitted model: p = 1 / (1 + exp(−(c₀ + Σ cⱼ xⱼ))).
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Fit {
    /// c₀ first, then one for each feature, in the features' own units.
    pub(crate) coefficients: Vec<f64>,
    /// Whether Newton's method ended because nothing was left to gain.
    pub(crate) converged: bool,
    /// Weighted mean −ln of the probability given to what is true, in nats, without the ridge.
    pub(crate) log_loss: f64,
}

impl Fit {
    /// The probability at these features; missing ones count as 0.
    pub(crate) fn probability(&self, features: &[f64]) -> f64 {
        let slopes = self.coefficients[1..].iter().zip(features);
        sigmoid(self.coefficients[0] + slopes.map(|(c, x)| c * x).sum::<f64>())
    }
}

/// Keeps the slope of a feature that separates the classes finite.
const RIDGE: f64 = 1e-3;

/// A fit in which every record counts once, with a ridge that is lost among a hundred records.
///
/// # Errors
///
/// Those of [`fit_logistic`], and when it does not converge.
pub(crate) fn fit_plainly(features: &[Vec<f64>], truths: &[bool]) -> Result<Fit> {
    let fit = fit_logistic(features, truths, &vec![1.0; truths.len()], RIDGE)?;
    ensure!(fit.converged, "the fit did not converge: {fit:?}");
    Ok(fit)
}

/// Minimises Σ wᵢ·(−ln p(truthᵢ)) + ½·ridge·Σ (cⱼ·sdⱼ)², sdⱼ the weighted standard deviation of
/// feature j.
///
/// The ridge acts on standardised slopes and leaves the intercept alone, so that the fit does not
/// depend on the features' units, and the mean probability equals the observed rate. It keeps the
/// slopes finite when a feature separates the classes; 1e-3 does, and is lost among a hundred
/// records otherwise. A record with two outcomes of known share goes in twice, with those weights.
///
/// # Errors
///
/// When the lists differ in length, a value is not finite, a weight or the ridge negative, one
/// class is missing, or features depend on one another and the ridge is 0.
fn fit_logistic(
    features: &[Vec<f64>],
    truths: &[bool],
    weights: &[f64],
    ridge: f64,
) -> Result<Fit> {
    check(features, truths, weights, ridge)?;
    let scaling = Scaling::of(features, weights);
    let problem = Problem { rows: scaling.rows(features), truths, weights, ridge };
    let total: f64 = weights.iter().sum();
    let hits: f64 = truths.iter().zip(weights).filter(|(t, _)| **t).map(|(_, w)| w).sum();

    let mut coefficients = DVector::zeros(problem.rows.ncols());
    coefficients[0] = (hits / (total - hits)).ln();
    let mut objective = problem.objective(&coefficients);
    let mut converged = false;
    for _ in 0..STEPS {
        let (gradient, hessian) = problem.derivatives(&coefficients);
        let step = hessian
            .cholesky()
            .ok_or_else(|| anyhow!("features depend on one another: drop one or give a ridge"))?
            .solve(&gradient);
        // The decrease that the quadratic model promises.
        let promised = 0.5 * gradient.dot(&step);
        let Some((next, value)) = problem.descend(&coefficients, &step, objective) else {
            // Rounding hides what is left to gain.
            converged = promised <= 1e3 * GAIN * total;
            break;
        };
        (coefficients, objective) = (next, value);
        if promised <= GAIN * total {
            converged = true;
            break;
        }
    }
    let plain = Problem { ridge: 0.0, ..problem };
    let log_loss = plain.objective(&coefficients) / total;
    Ok(Fit { coefficients: scaling.undo(&coefficients), converged, log_loss })
}

fn check(features: &[Vec<f64>], truths: &[bool], weights: &[f64], ridge: f64) -> Result<()> {
    let counts = [features.len(), truths.len(), weights.len()];
    ensure!(
        counts[0] == counts[1] && counts[1] == counts[2],
        "{} records, {} truths and {} weights",
        counts[0],
        counts[1],
        counts[2]
    );
    ensure!(ridge >= 0.0 && ridge.is_finite(), "ridge {ridge} is not a number from 0 up");
    let width = features.first().map_or(0, Vec::len);
    for (i, (row, weight)) in features.iter().zip(weights).enumerate() {
        ensure!(row.len() == width, "record {i} has {} features, not {width}", row.len());
        if let Some(value) = row.iter().find(|v| !v.is_finite()) {
            anyhow::bail!("record {i} has the feature {value}: clamp it or leave the record out");
        }
        ensure!(
            *weight >= 0.0 && weight.is_finite(),
            "record {i} has weight {weight}, which is not a number from 0 up"
        );
    }
    for class in [true, false] {
        let has_one = truths.iter().zip(weights).any(|(t, w)| *t == class && *w > 0.0);
        ensure!(has_one, "no record with truth {class}: its probability has no finite fit");
    }
    Ok(())
}

/// Makes features have mean 0 and standard deviation 1, so that Newton's matrix is well scaled.
struct Scaling {
    means: Vec<f64>,
    deviations: Vec<f64>,
}

impl Scaling {
    fn of(features: &[Vec<f64>], weights: &[f64]) -> Self {
        let total: f64 = weights.iter().sum();
        let mean = |value: &dyn Fn(&Vec<f64>) -> f64| {
            features.iter().zip(weights).map(|(row, w)| w * value(row)).sum::<f64>() / total
        };
        let width = features.first().map_or(0, Vec::len);
        let means: Vec<f64> = (0..width).map(|j| mean(&|row| row[j])).collect();
        let deviations = (0..width).map(|j| {
            let deviation = mean(&|row| (row[j] - means[j]).powi(2)).sqrt();
            // A constant feature says nothing; any scale keeps its slope at 0.
            if deviation > 1e-12 * means[j].abs() { deviation } else { f64::INFINITY }
        });
        Self { deviations: deviations.collect(), means }
    }

    /// A column of ones, then the scaled features.
    fn rows(&self, features: &[Vec<f64>]) -> DMatrix<f64> {
        DMatrix::from_fn(features.len(), self.means.len() + 1, |i, j| match j.checked_sub(1) {
            None => 1.0,
            Some(j) => (features[i][j] - self.means[j]) / self.deviations[j],
        })
    }

    fn undo(&self, scaled: &DVector<f64>) -> Vec<f64> {
        let slopes: Vec<f64> = scaled
            .iter()
            .skip(1)
            .zip(&self.deviations)
            .map(|(c, deviation)| c / deviation)
            .collect();
        let shift: f64 = slopes.iter().zip(&self.means).map(|(c, mean)| c * mean).sum();
        std::iter::once(scaled[0] - shift).chain(slopes).collect()
    }
}

struct Problem<'a> {
    rows: DMatrix<f64>,
    truths: &'a [bool],
    weights: &'a [f64],
    ridge: f64,
}

impl Problem<'_> {
    fn objective(&self, coefficients: &DVector<f64>) -> f64 {
        let logits = &self.rows * coefficients;
        let losses = logits.iter().zip(self.truths).zip(self.weights);
        let loss: f64 =
            losses.map(|((z, truth), w)| w * softplus(if *truth { -z } else { *z })).sum();
        let slopes: f64 = coefficients.iter().skip(1).map(|c| c * c).sum();
        loss + 0.5 * self.ridge * slopes
    }

    fn derivatives(&self, coefficients: &DVector<f64>) -> (DVector<f64>, DMatrix<f64>) {
        let width = coefficients.len();
        let mut gradient = DVector::zeros(width);
        let mut hessian = DMatrix::zeros(width, width);
        let logits = &self.rows * coefficients;
        for (i, logit) in logits.iter().enumerate() {
            let p = sigmoid(*logit);
            let row = self.rows.row(i).transpose();
            let residual = p - f64::from(self.truths[i]);
            gradient.axpy(self.weights[i] * residual, &row, 1.0);
            hessian.ger(self.weights[i] * p * (1.0 - p), &row, &row, 1.0);
        }
        for j in 1..width {
            gradient[j] += self.ridge * coefficients[j];
            hessian[(j, j)] += self.ridge;
        }
        (gradient, hessian)
    }

    /// The whole step or the longest half of a half of it that descends.
    fn descend(
        &self,
        from: &DVector<f64>,
        step: &DVector<f64>,
        objective: f64,
    ) -> Option<(DVector<f64>, f64)> {
        (0..HALVINGS).find_map(|halvings| {
            let next = from - step * 0.5_f64.powi(halvings as i32);
            let value = self.objective(&next);
            (value < objective).then_some((next, value))
        })
    }
}

fn sigmoid(z: f64) -> f64 {
    // Neither branch overflows.
    if z >= 0.0 { 1.0 / (1.0 + (-z).exp()) } else { z.exp() / (1.0 + z.exp()) }
}

/// ln(1 + eᶻ) without overflow.
fn softplus(z: f64) -> f64 {
    z.max(0.0) + (-z.abs()).exp().ln_1p()
}

#[cfg(test)]
mod tests {
    use cloudtouch_geom::seed;

    use super::*;

    fn ones(count: usize) -> Vec<f64> {
        vec![1.0; count]
    }

    #[test]
    fn one_binary_feature_gives_log_odds() {
        // x = 0: 3 of 12 collide; x = 1: 8 of 10. Maximum likelihood in closed form.
        let groups = [(0.0, true, 3), (0.0, false, 9), (1.0, true, 8), (1.0, false, 2)];
        let records = groups.iter().flat_map(|&(x, t, n)| std::iter::repeat_n((vec![x], t), n));
        let (features, truths): (Vec<_>, Vec<_>) = records.unzip();
        let fit = fit_logistic(&features, &truths, &ones(22), 0.0).unwrap();
        let (low, high) = ((3.0_f64 / 9.0).ln(), (8.0_f64 / 2.0).ln());
        assert!(fit.converged);
        assert!((fit.coefficients[0] - low).abs() < 1e-9, "{fit:?}");
        assert!((fit.coefficients[1] - (high - low)).abs() < 1e-9, "{fit:?}");
        assert!((fit.probability(&[0.0]) - 0.25).abs() < 1e-9);
        assert!((fit.probability(&[1.0]) - 0.8).abs() < 1e-9);
        let loss = [(3.0, 0.25_f64), (9.0, 0.75), (8.0, 0.8), (2.0, 0.2)];
        let loss = -loss.iter().map(|(n, p)| n * p.ln()).sum::<f64>() / 22.0;
        assert!((fit.log_loss - loss).abs() < 1e-12);
        // The same as four records with weights.
        let features: Vec<_> = groups.iter().map(|g| vec![g.0]).collect();
        let weights: Vec<f64> = groups.iter().map(|g| g.2 as f64).collect();
        let weighted = fit_logistic(&features, &groups.map(|g| g.1), &weights, 0.0).unwrap();
        for (a, b) in fit.coefficients.iter().zip(&weighted.coefficients) {
            assert!((a - b).abs() < 1e-9);
        }
    }

    /// Three features of different size, and truths drawn from a known model of them.
    fn drawn(truth: [f64; 4], count: u64) -> (Vec<Vec<f64>>, Vec<bool>) {
        (0..count)
            .map(|i| {
                let u = |j| seed::unit(seed::derive(5, i, j)) - 0.5;
                let x = vec![4.0 * u(0), 1e-3 * u(1) + 7.0, 1e4 * (u(0) + u(2))];
                let logit = truth[0] + truth[1..].iter().zip(&x).map(|(c, x)| c * x).sum::<f64>();
                let collides = seed::unit(seed::derive(5, i, 9)) < sigmoid(logit);
                (x, collides)
            })
            .unzip()
    }

    #[test]
    fn drawn_truths_give_back_the_coefficients() {
        let truth = [-10_499.5, 0.8, 1500.0, -2e-4];
        let (features, truths) = drawn(truth, 40_000);
        let fit = fit_logistic(&features, &truths, &ones(truths.len()), 1e-3).unwrap();
        assert!(fit.converged);
        // Four standard errors; the logit has an information of about .2 a record.
        let error = 4.0 / (0.2_f64 * 40_000.0).sqrt();
        for (j, deviation) in [(1, 4.0), (2, 1e-3), (3, 1e4)] {
            let off = (fit.coefficients[j] - truth[j]) * deviation / 12.0_f64.sqrt();
            assert!(off.abs() < 1.5 * error, "feature {j}: {off}");
        }
        // The intercept is free: the mean probability is the rate.
        let mean = features.iter().map(|x| fit.probability(x)).sum::<f64>() / truths.len() as f64;
        let rate = truths.iter().filter(|t| **t).count() as f64 / truths.len() as f64;
        assert!((mean - rate).abs() < 1e-7, "{mean} {rate}");
    }

    #[test]
    fn the_gradient_vanishes_at_the_fit() {
        let (features, truths) = drawn([-3500.0, -1.0, 500.0, 1e-4], 500);
        let (weights, ridge) = ((0..500).map(|i| f64::from(i % 3)).collect::<Vec<_>>(), 2.0);
        let fit = fit_logistic(&features, &truths, &weights, ridge).unwrap();
        let scaling = Scaling::of(&features, &weights);
        let objective = |c: &[f64]| {
            let p = Fit { coefficients: c.to_vec(), ..fit.clone() };
            let losses = features.iter().zip(&truths).zip(&weights).map(|((x, t), w)| {
                let p = p.probability(x);
                -w * if *t { p } else { 1.0 - p }.ln()
            });
            let slopes = c[1..].iter().zip(&scaling.deviations).map(|(c, d)| (c * d).powi(2));
            losses.sum::<f64>() + 0.5 * ridge * slopes.sum::<f64>()
        };
        // Feature 2 is 7 ± 3e-4: its slope moves with the intercept.
        let least = objective(&fit.coefficients);
        for (j, step) in [(0, 1e-3), (1, 1e-3), (3, 1e-7)] {
            for sign in [-1.0, 1.0] {
                let mut moved = fit.coefficients.clone();
                moved[j] += sign * step;
                assert!(objective(&moved) > least, "coefficient {j}");
            }
        }
    }

    #[test]
    fn separated_classes_stay_finite_and_right() {
        let features: Vec<Vec<f64>> = (0..20).map(|i| vec![f64::from(i), 3.0]).collect();
        let truths: Vec<bool> = (0..20).map(|i| i >= 10).collect();
        let fit = fit_logistic(&features, &truths, &ones(20), 1e-3).unwrap();
        assert!(fit.converged, "{fit:?}");
        assert!(fit.coefficients.iter().all(|c| c.is_finite()));
        // Records at ±½, ±1½ ... from the middle pull at the slope as much as the ridge does; the
        // variance of 0 to 19 is 33.25.
        let slope = fit.coefficients[1];
        let pull = |i: u32| (f64::from(i) + 0.5) * 2.0 * sigmoid(-slope * (f64::from(i) + 0.5));
        let pulls: f64 = (0..10).map(pull).sum();
        assert!((pulls - 1e-3 * 33.25 * slope).abs() < 1e-7, "{pulls} {slope}");
        assert!((fit.probability(&[9.5, 3.0]) - 0.5).abs() < 1e-7);
        // A constant feature gets no slope.
        assert_eq!(fit.coefficients[2], 0.0);
        // Without a ridge the slope grows without end, which the fit must not call converged, or
        // the loss has reached zero.
        let free = fit_logistic(&features, &truths, &ones(20), 0.0);
        assert!(free.is_err() || free.is_ok_and(|f| !f.converged || f.log_loss < 1e-9));
    }

    #[test]
    fn no_features_give_the_rate() {
        let fit = fit_logistic(&vec![vec![]; 4], &[true, false, false, false], &ones(4), 1e-3);
        assert!((fit.unwrap().probability(&[]) - 0.25).abs() < 1e-12);
    }

    #[test]
    fn what_cannot_be_fitted_is_named() {
        let good = [vec![1.0], vec![2.0]];
        for (features, truths, weights, ridge, named) in [
            (vec![vec![1.0]], vec![true, false], ones(2), 0.1, "1 records, 2 truths"),
            (good.to_vec(), vec![true, true], ones(2), 0.1, "no record with truth false"),
            (good.to_vec(), vec![true, false], vec![0.0, 1.0], 0.1, "no record with truth true"),
            (good.to_vec(), vec![true, false], vec![-1.0, 1.0], 0.1, "record 0 has weight"),
            (good.to_vec(), vec![true, false], ones(2), f64::NAN, "ridge"),
            (vec![vec![1.0], vec![]], vec![true, false], ones(2), 0.1, "record 1 has 0 features"),
            (vec![vec![1.0], vec![f64::INFINITY]], vec![true, false], ones(2), 0.1, "record 1"),
            (vec![vec![1.0], vec![1.0]], vec![true, false], ones(2), 0.0, "depend on one another"),
        ] {
            let error = fit_logistic(&features, &truths, &weights, ridge).unwrap_err().to_string();
            assert!(error.contains(named), "{error}");
        }
        assert!(fit_logistic(&[], &[], &[], 0.1).is_err());
    }
}
