//! How well scores order the poses, and what a yes or no costs.

use super::Sample;

/// Chance that a collision has a higher score than a free pose, ties counting half (area under
/// the ROC curve); NaN without both kinds.
pub fn auc(sample: &Sample, weights: &[f64]) -> f64 {
    let (mut wins, mut free_below, mut hits_below) = (0.0, 0.0, 0.0);
    for [hits, free] in sample.groups(weights) {
        wins += hits * (free_below + 0.5 * free);
        free_below += free;
        hits_below += hits;
    }
    wins / (hits_below * free_below)
}

/// Share of the free poses stopped at the highest threshold that misses at most `miss_rate` of the
/// collisions, a pose being stopped when its score is at or above it; NaN without both kinds.
pub fn false_stops(sample: &Sample, weights: &[f64], miss_rate: f64) -> f64 {
    let groups: Vec<[f64; 2]> = sample.groups(weights).collect();
    let [all_hits, all_free] = [0, 1].map(|of| groups.iter().map(|group| group[of]).sum::<f64>());
    // Room for the rounding of miss_rate · all_hits where it should be a whole number.
    let allowed = miss_rate * all_hits + 1e-9;
    let (mut missed, mut free_below) = (0.0, 0.0);
    for [hits, free] in groups {
        missed += hits;
        // The next threshold up would miss this group too.
        if missed > allowed {
            return 1.0 - free_below / all_free;
        }
        free_below += free;
    }
    f64::NAN
}

/// Free poses whose score is at or above a threshold, of how many, and collisions below it, of how many.
pub fn wrong_from(sample: &Sample, weights: &[f64], from: f64) -> [[f64; 2]; 2] {
    let mut found = [[0.0; 2]; 2];
    for ((&collides, &score), weight) in sample.collides.iter().zip(&sample.scores).zip(weights) {
        let [wrong, all] = &mut found[usize::from(collides)];
        *all += weight;
        *wrong += if (score >= from) == collides { 0.0 } else { *weight };
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    fn known() -> Sample {
        let collides = [true, true, false, false, true, false];
        Sample::of_probabilities([0.9, 0.4, 0.4, 0.1, 0.2, 0.3].into_iter().zip(collides))
    }

    #[test]
    fn auc_counts_pairs_and_half_of_ties() {
        // Of nine pairs: .9 wins three, .4 wins two and ties one, .2 wins one.
        let sample = known();
        assert!((auc(&sample, &sample.ones()) - 6.5 / 9.0).abs() < 1e-12);
        // Twice the first collision, without the last: 2 · 3 + 2.5 of nine.
        let weights = [2.0, 1.0, 1.0, 1.0, 0.0, 1.0];
        assert!((auc(&sample, &weights) - 8.5 / 9.0).abs() < 1e-12);
        assert!(auc(&sample, &[0.0; 6]).is_nan());
    }

    #[test]
    fn stops_and_misses_of_a_threshold_are_counted_apart() {
        let sample = known();
        // .4 is a collision once, and free once; .2 is missed.
        assert_eq!(wrong_from(&sample, &sample.ones(), 0.4), [[1.0, 3.0], [1.0, 3.0]]);
        let weights = [1.0, 0.0, 2.0, 0.0, 1.0, 0.0];
        assert_eq!(wrong_from(&sample, &weights, 0.3), [[2.0, 2.0], [1.0, 2.0]]);
    }

    #[test]
    fn false_stops_at_the_highest_threshold_allowed() {
        let sample = known();
        // No miss: threshold .2, two of three free poses are stopped.
        assert!((false_stops(&sample, &sample.ones(), 0.0) - 2.0 / 3.0).abs() < 1e-12);
        // One of three may be missed: threshold .4, with one free pose at it.
        assert!((false_stops(&sample, &sample.ones(), 0.34) - 1.0 / 3.0).abs() < 1e-12);
        assert!(false_stops(&sample, &[0.0; 6], 0.0).is_nan());
    }
}
