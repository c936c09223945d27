//! Proper scores of probabilities, and how often they commit themselves; NaN without probabilities.

use super::Sample;

/// The log loss takes a probability for no nearer to 0 or 1 than this: one certain and wrong
/// answer costs 13.8 and not infinity.
const CLIP: f64 = 1e-6;

/// Mean squared difference of probability and truth.
pub(super) fn brier(sample: &Sample, weights: &[f64]) -> f64 {
    mean(sample, weights, |p, collides| (p - f64::from(collides)).powi(2))
}

/// Mean −ln of the probability given to what is true, in nats, probabilities clipped at [`CLIP`].
pub(super) fn log_loss(sample: &Sample, weights: &[f64]) -> f64 {
    mean(sample, weights, |p, collides| {
        let of_truth = if collides { p } else { 1.0 - p };
        -of_truth.clamp(CLIP, 1.0 - CLIP).ln()
    })
}

/// Share of probabilities in (0.05, 0.95).
pub(super) fn undecided(sample: &Sample, weights: &[f64]) -> f64 {
    mean(sample, weights, |p, _| f64::from(p > 0.05 && p < 0.95))
}

fn mean(sample: &Sample, weights: &[f64], value: impl Fn(f64, bool) -> f64) -> f64 {
    let Some(probabilities) = &sample.probabilities else { return f64::NAN };
    sample.mean(weights, |i| value(probabilities[i], sample.collides[i]))
}

#[cfg(test)]
mod tests {
    use super::{super::sample::tests::sample, *};

    #[test]
    fn scores_of_known_answers() {
        let sample = sample(&[(0.9, true), (0.4, true), (0.4, false), (0.05, false)]);
        let ones = sample.ones();
        assert!((brier(&sample, &ones) - (0.01 + 0.36 + 0.16 + 0.0025) / 4.0).abs() < 1e-12);
        let loss = -(0.9_f64.ln() + 0.4_f64.ln() + 0.6_f64.ln() + 0.95_f64.ln()) / 4.0;
        assert!((log_loss(&sample, &ones) - loss).abs() < 1e-12);
        // The ends of the interval are decided.
        assert_eq!(undecided(&sample, &ones), 0.75);
        // Weights are repetitions.
        assert!((brier(&sample, &[0.0, 3.0, 1.0, 0.0]) - (3.0 * 0.36 + 0.16) / 4.0).abs() < 1e-12);
    }

    #[test]
    fn a_certain_error_costs_the_clip_and_no_more() {
        let wrong = sample(&[(0.0, true), (1.0, false)]);
        assert!((log_loss(&wrong, &wrong.ones()) + 1e-6_f64.ln()).abs() < 1e-9);
        let right = sample(&[(1.0, true), (0.0, false)]);
        assert!(log_loss(&right, &right.ones()) < 2e-6);
    }

    #[test]
    fn scores_that_are_no_probabilities_have_none_of_these() {
        let sample = sample(&[(3.0, true), (-1.0, false)]);
        for measure in [brier, log_loss, undecided] {
            assert!(measure(&sample, &sample.ones()).is_nan());
        }
    }
}
