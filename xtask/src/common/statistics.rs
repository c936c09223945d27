//! Scores of probabilities against the truth, and ranks of times.

/// The value below which the share `q` lies (nearest rank); NaN of nothing.
pub(crate) fn quantile(values: &[f64], q: f64) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let rank = (q * sorted.len() as f64).ceil() as usize;
    sorted.get(rank.saturating_sub(1)).copied().unwrap_or(f64::NAN)
}

/// Chance that a collision gets a higher probability than a free pair, ties counting half; NaN
/// when there are none of one kind.
pub(crate) fn auc(scored: &[(f64, bool)]) -> f64 {
    let of = |kind| scored.iter().filter(move |s| s.1 == kind).map(|s| s.0);
    let (mut wins, mut pairs) = (0.0, 0.0);
    for hit in of(true) {
        for free in of(false) {
            pairs += 1.0;
            wins += if hit > free {
                1.0
            } else if hit == free {
                0.5
            } else {
                0.0
            };
        }
    }
    wins / pairs
}

/// Mean squared difference of probability and truth; NaN of nothing.
pub(crate) fn brier(scored: &[(f64, bool)]) -> f64 {
    let squares = scored.iter().map(|&(p, truth)| (p - f64::from(u8::from(truth))).powi(2));
    squares.sum::<f64>() / scored.len() as f64
}

/// How far a series falls below its own running maximum, at most.
pub(crate) fn largest_drop(values: impl IntoIterator<Item = f64>) -> f64 {
    let (mut highest, mut drop) = (f64::NEG_INFINITY, 0.0_f64);
    for value in values {
        highest = highest.max(value);
        drop = drop.max(highest - value);
    }
    drop
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_are_values_of_the_list() {
        let values: Vec<f64> = (1..=20).rev().map(f64::from).collect();
        assert_eq!([0.0, 0.5, 0.95, 1.0].map(|q| quantile(&values, q)), [1.0, 10.0, 19.0, 20.0]);
        assert!(quantile(&[], 0.5).is_nan());
    }

    #[test]
    fn scores_of_known_answers() {
        let scored = [(0.9, true), (0.4, true), (0.4, false), (0.1, false)];
        assert_eq!(auc(&scored), 3.5 / 4.0);
        assert!((brier(&scored) - (0.01 + 0.36 + 0.16 + 0.01) / 4.0).abs() < 1e-12);
    }

    #[test]
    fn the_drop_is_taken_from_the_running_maximum() {
        assert_eq!(largest_drop([0.0, 0.5, 0.25, 0.75, 0.625]), 0.25);
        assert_eq!(largest_drop([]), 0.0);
    }
}
