//! Whether probabilities are frequencies.

use cloudtouch_geom::seed;
use rand::RngExt;

use super::{Clusters, Sample};
use crate::statistics::share;

/// Bins of equal width over [0, 1]; the last one contains 1.
const BINS: usize = 15;
/// Simulated truths behind [`chance_error`].
const SIMULATIONS: u64 = 100;

/// Mean squared difference of probability and truth; NaN without probabilities.
pub fn brier(sample: &Sample, weights: &[f64]) -> f64 {
    let (mut sum, mut total) = (0.0, 0.0);
    for (p, collides, weight) in answers(sample, weights) {
        sum += weight * (p - f64::from(u8::from(collides))).powi(2);
        total += weight;
    }
    sum / total
}

/// Expected calibration error: the mean over the answers of how far their bin's mean probability
/// is from its share of collisions; NaN without probabilities.
///
/// Chance alone makes it positive: compare with [`chance_error`].
pub fn calibration_error(sample: &Sample, weights: &[f64]) -> f64 {
    error_of(answers(sample, weights))
}

/// The mean calibration error of a perfect forecaster who says the same probabilities, by
/// simulating the truths from them; NaN without probabilities.
///
/// The answers to one pose share one draw: its truth is the same in every condition.
pub fn chance_error(sample: &Sample, clusters: &Clusters, seed: u64) -> f64 {
    let simulated = |simulation| {
        let mut rng = seed::generator(seed::derive(seed, simulation, 0));
        let draws: Vec<f64> = (0..clusters.draw_of.len()).map(|_| rng.random()).collect();
        let answers = sample.probabilities.iter().zip(&clusters.pose_of);
        error_of(answers.map(|(&p, &pose)| (p, draws[pose as usize] < p, 1.0)))
    };
    (0..SIMULATIONS).map(simulated).sum::<f64>() / SIMULATIONS as f64
}

/// The answers whose probabilities fall in one bin.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bin {
    /// Mean probability.
    pub mean: f64,
    /// Share of collisions.
    pub observed: f64,
    /// Number of answers.
    pub count: usize,
}

/// The bins that are not empty, by rising probability.
pub fn reliability(sample: &Sample) -> Vec<Bin> {
    let bins = (0..BINS).map(|number| bin(sample, |p| bin_of(p) == number));
    bins.filter(|bin| bin.count > 0).collect()
}

/// Of the answers with a probability in `range`: how many there are, their mean probability and
/// their share of collisions.
pub fn observed_within(sample: &Sample, range: std::ops::Range<f64>) -> Bin {
    bin(sample, |p| range.contains(&p))
}

fn bin(sample: &Sample, is_within: impl Fn(f64) -> bool) -> Bin {
    let within = sample.probabilities.iter().zip(&sample.collides);
    let (stated, came): (Vec<f64>, Vec<bool>) = within.filter(|(p, _)| is_within(**p)).unzip();
    let count = stated.len();
    Bin { mean: stated.iter().sum::<f64>() / count as f64, observed: share(came), count }
}

/// Probability, truth and weight of each answer.
fn answers(sample: &Sample, weights: &[f64]) -> impl Iterator<Item = (f64, bool, f64)> {
    let all = sample.probabilities.iter().zip(&sample.collides).zip(weights);
    all.map(|((&p, &collides), &weight)| (p, collides, weight))
}

/// The calibration error of answers by probability, truth and weight.
fn error_of(answers: impl Iterator<Item = (f64, bool, f64)>) -> f64 {
    let (mut excess, mut total) = ([0.0_f64; BINS], 0.0);
    for (p, collides, weight) in answers {
        excess[bin_of(p)] += weight * (p - f64::from(u8::from(collides)));
        total += weight;
    }
    excess.iter().map(|e| e.abs()).sum::<f64>() / total
}

fn bin_of(p: f64) -> usize {
    ((p * BINS as f64) as usize).min(BINS - 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A calibrated forecaster: each probability comes true as often as it says.
    fn calibrated(count: u64, seed: u64) -> Sample {
        let unit = |i, k| seed::unit(seed::derive(seed, i, k));
        Sample::of_probabilities((0..count).map(|i| (unit(i, 0), unit(i, 1) < unit(i, 0))))
    }

    #[test]
    fn scores_of_known_answers() {
        let sample =
            Sample::of_probabilities([(0.9, true), (0.4, true), (0.4, false), (0.1, false)]);
        let ones = sample.ones();
        assert!((brier(&sample, &ones) - (0.01 + 0.36 + 0.16 + 0.01) / 4.0).abs() < 1e-12);
        // Bins of .9, of .4 twice with half true, of .1.
        assert!((calibration_error(&sample, &ones) - (0.1 + 0.2 + 0.1) / 4.0).abs() < 1e-12);
    }

    #[test]
    fn chance_explains_the_error_of_a_calibrated_forecaster_and_no_other() {
        let each = Clusters::of((0..400).map(|i| ("a", i, 0)));
        let sample = calibrated(400, 0);
        let chance = chance_error(&sample, &each, 7);
        // A bin of n with rate about p: E|observed − p| ≈ √(2 p (1 − p) / (π n)); averaged over
        // uniform p and 15 bins of 400/15 that is .0606.
        assert!((chance - 0.0606).abs() < 0.004, "{chance}");
        let error = |seed| {
            let sample = calibrated(400, seed);
            calibration_error(&sample, &sample.ones())
        };
        let mean = (0..40).map(error).sum::<f64>() / 40.0;
        assert!((mean - chance).abs() < 0.006, "{mean} {chance}");
        let far = sample.probabilities.iter().map(|p| if *p > 0.5 { 0.98 } else { 0.02 });
        let overconfident = Sample::of_probabilities(far.zip(sample.collides.clone()));
        assert!(calibration_error(&overconfident, &overconfident.ones()) > 0.15);
    }

    #[test]
    fn repeated_answers_have_the_chance_error_of_their_poses() {
        let once = calibrated(40, 5);
        let mut repeated = once.clone();
        repeated.probabilities = once.probabilities.repeat(10);
        let alone = chance_error(&once, &Clusters::of((0..40).map(|i| ("a", 0, i))), 7);
        let shared = Clusters::of((0..400).map(|i| ("a", 0, i % 40)));
        assert!((chance_error(&repeated, &shared, 7) - alone).abs() < 1e-12);
    }

    #[test]
    fn bins_have_means_rates_and_counts() {
        let sample =
            Sample::of_probabilities([(0.0, false), (0.06, true), (0.5, true), (1.0, true)]);
        let rows: Vec<_> =
            reliability(&sample).iter().map(|b| (b.mean, b.observed, b.count)).collect();
        assert_eq!(rows, [(0.03, 0.5, 2), (0.5, 1.0, 1), (1.0, 1.0, 1)]);
        assert_eq!(observed_within(&sample, 0.0..0.1).observed, 0.5);
    }
}
