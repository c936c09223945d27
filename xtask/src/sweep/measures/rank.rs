//! How well scores order the poses.

use super::Sample;

/// Chance that a collision has a higher score than a free pose, ties counting half (area under
/// the ROC curve); NaN without both kinds.
pub(super) fn auc(sample: &Sample, weights: &[f64]) -> f64 {
    let (mut wins, mut free_below, mut hits_below) = (0.0, 0.0, 0.0);
    sample.score_groups(weights, |_, hits, free| {
        wins += hits * (free_below + 0.5 * free);
        free_below += free;
        hits_below += hits;
    });
    wins / (hits_below * free_below)
}

/// Points (share of free poses stopped, share of collisions found) of all thresholds, from (0, 0)
/// to (1, 1); empty without both kinds.
pub(crate) fn roc(sample: &Sample) -> Vec<(f64, f64)> {
    let weights = sample.ones();
    let (all_hits, all_free) = sample.totals(&weights);
    if all_hits == 0.0 || all_free == 0.0 {
        return Vec::new();
    }
    let mut points = vec![(1.0, 1.0)];
    let (mut hits_below, mut free_below) = (0.0, 0.0);
    sample.score_groups(&weights, |_, hits, free| {
        hits_below += hits;
        free_below += free;
        points.push((1.0 - free_below / all_free, 1.0 - hits_below / all_hits));
    });
    points.reverse();
    points
}

/// Spearman's correlation of the score with minus the signed distance, ties at their mean rank;
/// NaN when either is constant.
pub(super) fn spearman(sample: &Sample, weights: &[f64]) -> f64 {
    let by_score = ranks(&sample.by_score, &sample.scores, weights);
    let by_depth = ranks(&sample.by_depth, &sample.depths, weights);
    let mean_score = sample.mean(weights, |i| by_score[i]);
    let mean_depth = sample.mean(weights, |i| by_depth[i]);
    let (mut both, mut score, mut depth) = (0.0, 0.0, 0.0);
    for (i, &weight) in weights.iter().enumerate() {
        let (a, b) = (by_score[i] - mean_score, by_depth[i] - mean_depth);
        both += weight * a * b;
        score += weight * a * a;
        depth += weight * b * b;
    }
    both / (score * depth).sqrt()
}

/// The rank of each pose when every pose counts as often as its weight says.
fn ranks(order: &[usize], values: &[f64], weights: &[f64]) -> Vec<f64> {
    let mut ranks = vec![0.0; order.len()];
    let mut below = 0.0;
    for group in order.chunk_by(|&a, &b| values[a] == values[b]) {
        let count: f64 = group.iter().map(|&i| weights[i]).sum();
        for &i in group {
            ranks[i] = below + 0.5 * (count + 1.0);
        }
        below += count;
    }
    ranks
}

#[cfg(test)]
mod tests {
    use cloudtouch_geom::seed;

    use super::{super::sample::tests::sample, *};
    use crate::{
        common::statistics,
        sweep::record::{Said, Truth},
    };

    #[test]
    fn auc_is_that_of_all_pairs() {
        // Scores on a coarse grid, so that ties are common.
        let scored: Vec<(f64, bool)> = (0..300)
            .map(|i| {
                let collides = seed::unit(seed::derive(1, i, 0)) < 0.3;
                let u = seed::unit(seed::derive(1, i, 1)) + if collides { 0.2 } else { 0.0 };
                ((10.0 * u).floor(), collides)
            })
            .collect();
        let of_pairs = statistics::auc(&scored);
        let sample = sample(&scored);
        assert!((auc(&sample, &sample.ones()) - of_pairs).abs() < 1e-12);
        assert!(of_pairs > 0.5 && of_pairs < 0.9);
    }

    #[test]
    fn a_weight_is_a_repetition() {
        let scored = [(1.0, true), (2.0, false), (3.0, true), (2.0, true), (0.5, false)];
        let weights = [2.0, 1.0, 0.0, 3.0, 2.0];
        let repeated: Vec<(f64, bool)> = scored
            .iter()
            .zip(weights)
            .flat_map(|(s, w)| std::iter::repeat_n(*s, w as usize))
            .collect();
        let (light, long) = (sample(&scored), sample(&repeated));
        for measure in [auc, spearman] {
            let (a, b) = (measure(&light, &weights), measure(&long, &long.ones()));
            assert!((a - b).abs() < 1e-12, "{a} {b}");
        }
    }

    #[test]
    fn without_both_kinds_there_is_no_order() {
        let free = sample(&[(0.1, false), (0.2, false)]);
        assert!(auc(&free, &free.ones()).is_nan());
        assert!(roc(&free).is_empty());
        assert!(spearman(&free, &free.ones()).is_nan());
    }

    #[test]
    fn roc_goes_up_and_right_and_joins_ties() {
        let curve = roc(&sample(&[(0.9, true), (0.4, true), (0.4, false), (0.1, false)]));
        assert_eq!(curve, [(0.0, 0.0), (0.0, 0.5), (0.5, 1.0), (1.0, 1.0)]);
    }

    #[test]
    fn spearman_of_known_ranks() {
        let of = |pairs: &[(f64, f64)]| {
            let truths: Vec<Truth> = pairs
                .iter()
                .map(|&(_, d)| Truth { collides: d <= 0.0, signed_distance: d })
                .collect();
            let said: Vec<Said> = pairs
                .iter()
                .map(|&(score, _)| Said {
                    score,
                    probability: None,
                    bounds: None,
                    evidence: None,
                    micros: 1.0,
                })
                .collect();
            let sample = Sample::new(&truths, &said);
            spearman(&sample, &sample.ones())
        };
        // Any monotone scale: nearer always scores higher.
        assert!((of(&[(9.0, -1.0), (2.0, 0.0), (1.5, 7.0)]) - 1.0).abs() < 1e-12);
        assert!((of(&[(1.0, -1.0), (2.0, 0.0), (3.0, 7.0)]) + 1.0).abs() < 1e-12);
        // Ranks 1 2 3 4 5 against 2 1 4 3 5: 1 − 6·4/(5·24) = 0.8.
        let five = [(1.0, 4.0), (2.0, 5.0), (3.0, 2.0), (4.0, 3.0), (5.0, 1.0)];
        assert!((of(&five) - 0.8).abs() < 1e-12);
        // Ranks 1 2.5 2.5 4 against 1 2 3 4: 4.5/√(4.5·5).
        let tied = [(1.0, 4.0), (2.0, 3.0), (2.0, 2.0), (3.0, 1.0)];
        assert!((of(&tied) - 4.5 / 22.5_f64.sqrt()).abs() < 1e-12);
    }
}
