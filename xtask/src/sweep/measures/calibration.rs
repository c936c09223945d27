//! Whether poses that get probability p collide with rate p.

use cloudtouch_geom::seed;
use rand::RngExt;

use super::{Clusters, Sample};

/// Bins of equal width over [0, 1]; the last one contains 1.
const BINS: usize = 15;

/// Simulated truths behind [`chance_error`].
const SIMULATIONS: u64 = 200;

/// The poses whose probabilities fall in one bin.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Bin {
    /// Mean probability.
    pub(crate) mean: f64,
    /// Share of collisions.
    pub(crate) observed: f64,
    /// 95 % interval of the rate of collisions (Wilson); answers to the same pose share its truth
    /// and count as one trial.
    pub(crate) interval: [f64; 2],
    /// Number of answers.
    pub(crate) count: usize,
}

/// Expected calibration error: the mean over the answers of how far their bin's mean probability
/// is from its share of collisions; NaN without probabilities.
///
/// Too large for few answers: compare with [`chance_error`]. The replicates of a bootstrap are
/// larger still, so that the interval lies high.
pub(super) fn calibration_error(sample: &Sample, weights: &[f64]) -> f64 {
    let Some(probabilities) = &sample.probabilities else { return f64::NAN };
    let gaps = probabilities.iter().zip(&sample.collides).zip(weights);
    error_of(gaps.map(|((&p, &collides), &weight)| (p, collides, weight)))
}

/// The calibration error that chance alone gives.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct ChanceError {
    /// Its expectation.
    pub(crate) mean: f64,
    /// Exceeded in 5 % of the simulations.
    pub(crate) high: f64,
}

/// The calibration error of a perfect forecaster who says the same probabilities, by simulating
/// the truths from them; `None` without probabilities.
///
/// The answers to one pose share one draw: its truth is the same in every condition.
pub(crate) fn chance_error(sample: &Sample, clusters: &Clusters, seed: u64) -> Option<ChanceError> {
    let probabilities = sample.probabilities.as_ref()?;
    let mut errors: Vec<f64> = (0..SIMULATIONS)
        .map(|simulation| {
            let mut rng = seed::generator(seed::derive(seed, simulation, 0));
            let draws: Vec<f64> = (0..clusters.count()).map(|_| rng.random()).collect();
            let answers = probabilities.iter().zip(clusters.of_pose());
            error_of(answers.map(|(&p, &cluster)| (p, draws[cluster as usize] < p, 1.0)))
        })
        .collect();
    errors.sort_by(f64::total_cmp);
    let high = errors[(0.95 * errors.len() as f64) as usize];
    Some(ChanceError { mean: errors.iter().sum::<f64>() / errors.len() as f64, high })
}

/// The bins that are not empty, by rising probability; none without probabilities.
pub(crate) fn reliability(sample: &Sample, clusters: &Clusters) -> Vec<Bin> {
    let Some(probabilities) = &sample.probabilities else { return Vec::new() };
    let mut members: Vec<Vec<usize>> = vec![Vec::new(); BINS];
    for (i, &p) in probabilities.iter().enumerate() {
        members[bin_of(p)].push(i);
    }
    members.retain(|members| !members.is_empty());
    members
        .iter()
        .map(|members| {
            let count = members.len() as f64;
            let hits = members.iter().filter(|&&i| sample.collides[i]).count() as f64;
            let mut poses: Vec<u32> = members.iter().map(|&i| clusters.of_pose()[i]).collect();
            poses.sort_unstable();
            poses.dedup();
            Bin {
                mean: members.iter().map(|&i| probabilities[i]).sum::<f64>() / count,
                observed: hits / count,
                interval: wilson(hits / count, poses.len() as f64),
                count: members.len(),
            }
        })
        .collect()
}

/// The 95 % interval of a rate observed in so many trials.
fn wilson(rate: f64, trials: f64) -> [f64; 2] {
    let z2 = 1.96_f64.powi(2);
    let center = (rate + 0.5 * z2 / trials) / (1.0 + z2 / trials);
    let half = (rate * (1.0 - rate) * z2 / trials + (0.5 * z2 / trials).powi(2)).sqrt()
        / (1.0 + z2 / trials);
    [(center - half).max(0.0), (center + half).min(1.0)]
}

/// Probability, truth and weight of each answer to the calibration error.
fn error_of(answers: impl Iterator<Item = (f64, bool, f64)>) -> f64 {
    let (mut excess, mut total) = ([0.0; BINS], 0.0);
    for (p, collides, weight) in answers {
        excess[bin_of(p)] += weight * (p - f64::from(collides));
        total += weight;
    }
    excess.iter().map(|e: &f64| e.abs()).sum::<f64>() / total
}

fn bin_of(p: f64) -> usize {
    ((p * BINS as f64) as usize).min(BINS - 1)
}

#[cfg(test)]
mod tests {
    use super::{super::sample::tests::sample, *};

    /// So many poses with uniform probabilities, each a collision at that rate.
    fn calibrated(count: u64) -> Sample {
        let scored: Vec<(f64, bool)> = (0..count)
            .map(|i| {
                let p = seed::unit(seed::derive(3, i, 0));
                (p, seed::unit(seed::derive(3, i, 1)) < p)
            })
            .collect();
        sample(&scored)
    }

    #[test]
    fn the_error_of_known_answers() {
        // Two bins: p = .52, .48 (same bin of 15) with one of two colliding, p = 1 and free.
        let known = sample(&[(0.52, true), (0.48, false), (1.0, false), (1.0, true)]);
        let ones = known.ones();
        assert!((calibration_error(&known, &ones) - 1.0 / 4.0).abs() < 1e-12);
        assert!((calibration_error(&known, &[1.0, 1.0, 1.0, 3.0]) - 1.0 / 6.0).abs() < 1e-12);
        let scores = sample(&[(2.0, true)]);
        assert!(calibration_error(&scores, &[1.0]).is_nan());
        assert!(chance_error(&scores, &Clusters::separate(1), 0).is_none());
        assert!(reliability(&scores, &Clusters::separate(1)).is_empty());
    }

    #[test]
    fn chance_explains_the_error_of_a_calibrated_forecaster_and_no_other() {
        let sample = calibrated(400);
        let chance = chance_error(&sample, &Clusters::separate(400), 7).unwrap();
        let error = calibration_error(&sample, &sample.ones());
        assert!(error < chance.high, "{error} {chance:?}");
        // A bin of n with rate about p: E|observed − p| ≈ √(2 p (1 − p) / (π n)); averaged over
        // uniform p and 15 bins of 400/15 that is .0606.
        assert!((chance.mean - 0.0606).abs() < 0.004, "{chance:?}");
        let mut overconfident = sample.clone();
        let far = |p: &f64| if *p > 0.5 { 0.98 } else { 0.02 };
        overconfident.probabilities = sample.probabilities.map(|p| p.iter().map(far).collect());
        let error = calibration_error(&overconfident, &overconfident.ones());
        let chance = chance_error(&overconfident, &Clusters::separate(400), 7).unwrap();
        assert!(error > 0.15 && chance.high < 0.05, "{error} {chance:?}");
    }

    #[test]
    fn repeated_answers_have_the_chance_error_of_their_poses() {
        let once = chance_error(&calibrated(40), &Clusters::separate(40), 7).unwrap();
        let mut repeated = calibrated(400);
        repeated.probabilities = calibrated(40).probabilities.map(|p| p.repeat(10));
        let shared = Clusters::new((0..400).map(|i| i % 40));
        let shared = chance_error(&repeated, &shared, 7).unwrap();
        assert!((shared.mean - once.mean).abs() < 1e-12, "{shared:?} {once:?}");
        let separate = chance_error(&repeated, &Clusters::separate(400), 7).unwrap();
        assert!(separate.mean < 0.5 * once.mean, "{separate:?} {once:?}");
    }

    #[test]
    fn bins_have_means_rates_and_counts() {
        let sample = sample(&[(0.0, false), (0.06, true), (0.5, true), (0.5, false), (1.0, true)]);
        let bins = reliability(&sample, &Clusters::new([0, 1, 2, 2, 3]));
        let of = |bin: &Bin| (bin.mean, bin.observed, bin.count);
        let rows: Vec<_> = bins.iter().map(of).collect();
        assert_eq!(rows, [(0.03, 0.5, 2), (0.5, 0.5, 2), (1.0, 1.0, 1)]);
        // Two answers to one pose are one trial.
        assert!(bins[1].interval[1] > bins[0].interval[1]);
    }

    #[test]
    fn wilson_of_known_rates() {
        // 8 of 10, as tabulated: [.490, .943].
        let [low, high] = wilson(0.8, 10.0);
        assert!((low - 0.4902).abs() < 1e-4 && (high - 0.9433).abs() < 1e-4, "{low} {high}");
        assert_eq!(wilson(0.0, 5.0)[0], 0.0);
        assert_eq!(wilson(1.0, 5.0)[1], 1.0);
    }
}
