//! What a yes or no costs: thresholds on the score.

use super::Sample;

/// The highest threshold that misses at most this share of the collisions, a pose being stopped
/// when its score is at or above it; NaN without collisions.
pub(crate) fn false_stop_threshold(sample: &Sample, weights: &[f64], miss_rate: f64) -> f64 {
    let (all_hits, _) = sample.totals(weights);
    // Room for the rounding of miss_rate · all_hits where it should be a whole number.
    let allowed = miss_rate * all_hits + 1e-9;
    let (mut missed, mut threshold) = (0.0, f64::NAN);
    sample.score_groups(weights, |score, hits, _| {
        missed += hits;
        // The next threshold up would miss this group too.
        if missed > allowed && threshold.is_nan() {
            threshold = score;
        }
    });
    threshold
}

/// Share of the free poses that are stopped at [`false_stop_threshold`]; NaN without both kinds.
pub(super) fn false_stops(sample: &Sample, weights: &[f64], miss_rate: f64) -> f64 {
    let threshold = false_stop_threshold(sample, weights, miss_rate);
    let (mut stopped, mut all) = (0.0, 0.0);
    for (i, &weight) in weights.iter().enumerate() {
        if !sample.collides[i] {
            all += weight;
            stopped += if sample.scores[i] >= threshold { weight } else { 0.0 };
        }
    }
    if threshold.is_nan() { f64::NAN } else { stopped / all }
}

/// The threshold with most right verdicts and their share, a pose being a collision when its
/// score is at or above it; the lowest of several, NaN share of nothing.
///
/// Chosen on the poses it is judged on, so a little too good for few poses; the same for every
/// method.
pub(crate) fn best_threshold(sample: &Sample, weights: &[f64]) -> (f64, f64) {
    let (all_hits, all_free) = sample.totals(weights);
    let (mut hits_below, mut free_below) = (0.0, 0.0);
    let (mut threshold, mut right) = (f64::INFINITY, f64::NEG_INFINITY);
    sample.score_groups(weights, |score, hits, free| {
        let here = all_hits - hits_below + free_below;
        if here > right {
            (threshold, right) = (score, here);
        }
        hits_below += hits;
        free_below += free;
    });
    // Above every score: nothing is a collision.
    if all_free > right {
        (threshold, right) = (f64::INFINITY, all_free);
    }
    (threshold, right / (all_hits + all_free))
}

#[cfg(test)]
mod tests {
    use super::{super::sample::tests::sample, *};

    /// Collisions at 1..=100, free poses at 0.5, 2.5 and so on up to 38.5.
    fn ladder() -> Sample {
        let hits = (1..=100).map(|i| (f64::from(i), true));
        let free = (0..20).map(|i| (0.5 + 2.0 * f64::from(i), false));
        sample(&hits.chain(free).collect::<Vec<_>>())
    }

    #[test]
    fn false_stops_of_a_ladder() {
        let sample = ladder();
        let ones = sample.ones();
        for (rate, threshold, stops) in
            [(0.0, 1.0, 0.95), (0.01, 2.0, 0.95), (0.05, 6.0, 0.85), (0.4, 41.0, 0.0)]
        {
            assert_eq!(false_stop_threshold(&sample, &ones, rate), threshold);
            assert_eq!(false_stops(&sample, &ones, rate), stops, "{rate}");
        }
    }

    #[test]
    fn tied_collisions_are_missed_together_or_not_at_all() {
        let tied = sample(&[(0.5, true), (0.5, true), (0.5, false), (0.2, false), (0.9, true)]);
        assert_eq!(false_stops(&tied, &tied.ones(), 0.4), 0.5);
        assert_eq!(false_stops(&tied, &tied.ones(), 0.7), 0.0);
    }

    #[test]
    fn without_one_kind_there_are_no_false_stops() {
        for collides in [true, false] {
            let one = sample(&[(0.5, collides)]);
            assert!(false_stops(&one, &one.ones(), 0.01).is_nan());
        }
    }

    #[test]
    fn the_best_threshold_may_lie_beyond_all_scores() {
        let of = |scored: &[(f64, bool)]| {
            let sample = sample(scored);
            best_threshold(&sample, &sample.ones())
        };
        assert_eq!(of(&[(0.1, false), (0.3, true), (0.2, false), (0.25, true)]), (0.25, 1.0));
        assert_eq!(of(&[(0.1, false), (0.3, false), (0.2, true)]), (0.2, 2.0 / 3.0));
        assert_eq!(of(&[(0.1, true), (0.3, false), (0.4, false)]), (f64::INFINITY, 2.0 / 3.0));
        assert_eq!(of(&[(0.1, true), (0.3, true), (0.4, false)]), (0.1, 2.0 / 3.0));
        assert!(of(&[]).1.is_nan());
    }
}
