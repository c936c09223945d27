//! How often a verdict changes while the pose stays.

use crate::sweep::measures::{Bootstrap, Clusters, Estimate, replicate};

/// Share of steps at which the verdict changes, over the series of all poses.
///
/// A series holds the verdicts on one pose as noise is drawn anew or grows; a step is two
/// verdicts in a row. A right and steady method has 0, a coin has ½. NaN without any step. Poses
/// are resampled with their whole series.
pub(super) fn flips(series: &[Vec<bool>], bootstrap: Bootstrap) -> Estimate {
    let of_pose: Vec<(f64, f64)> = series
        .iter()
        .map(|verdicts| {
            let changes = verdicts.windows(2).filter(|pair| pair[0] != pair[1]).count();
            (changes as f64, verdicts.len().saturating_sub(1) as f64)
        })
        .collect();
    let share = |weights: &[f64]| {
        let (mut changes, mut steps) = (0.0, 0.0);
        for ((c, s), weight) in of_pose.iter().zip(weights) {
            changes += weight * c;
            steps += weight * s;
        }
        vec![changes / steps]
    };
    replicate(&Clusters::new(0..series.len()), bootstrap, share).estimate(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn changes_are_counted_within_a_series_only() {
        let series = [vec![true, true, false, true], vec![false, false], vec![true], vec![]];
        let estimate = flips(&series, Bootstrap::new(1));
        assert_eq!(estimate.value, 0.5);
        // A resample has none but the first pose, or all but it.
        assert_eq!((estimate.low, estimate.high), (0.0, 2.0 / 3.0));
        assert!(flips(&[vec![true]], Bootstrap::new(1)).value.is_nan());
        assert!(flips(&[], Bootstrap::new(1)).value.is_nan());
    }
}
