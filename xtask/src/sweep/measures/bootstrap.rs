//! Intervals from resampled poses.

use std::{collections::BTreeMap, fmt};

use cloudtouch_geom::seed;
use rand::RngExt;

/// Which answers belong to the same pose: they are drawn together or not at all.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Clusters {
    of_pose: Vec<u32>,
    count: usize,
}

impl Clusters {
    /// Answers with the same key belong together.
    pub(crate) fn new<K: Ord>(keys: impl IntoIterator<Item = K>) -> Self {
        let mut numbers = BTreeMap::new();
        let mut number = |key| {
            let next = numbers.len() as u32;
            *numbers.entry(key).or_insert(next)
        };
        let of_pose = keys.into_iter().map(&mut number).collect();
        Self { of_pose, count: numbers.len() }
    }

    /// Every answer is of a pose of its own.
    #[cfg(test)]
    pub(crate) fn separate(count: usize) -> Self {
        Self::new(0..count)
    }

    /// For each answer the number of its cluster, from 0.
    pub(crate) fn of_pose(&self) -> &[u32] {
        &self.of_pose
    }

    /// Number of clusters.
    pub(crate) fn count(&self) -> usize {
        self.count
    }
}

/// How to resample.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Bootstrap {
    pub(crate) resamples: usize,
    pub(crate) seed: u64,
}

impl Bootstrap {
    /// 400 resamples: the ends of an interval are then good to about a tenth of its width.
    pub(crate) fn new(seed: u64) -> Self {
        Self { resamples: 400, seed }
    }
}

/// A value with its 95 % interval.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Estimate {
    pub(crate) value: f64,
    pub(crate) low: f64,
    pub(crate) high: f64,
}

impl Estimate {
    /// Whether the interval of a difference excludes zero.
    pub(crate) fn excludes_zero(&self) -> bool {
        self.low > 0.0 || self.high < 0.0
    }
}

/// `.967 [.958, .975]`, with the sign of a difference under `{:+}`; a dash when undefined.
impl fmt::Display for Estimate {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.value.is_nan() {
            return out.pad("–");
        }
        let short = |value: f64| {
            let text = if out.sign_plus() { format!("{value:+.3}") } else { format!("{value:.3}") };
            // −0.000 is no direction.
            let text = if text == "-0.000" { "0.000".to_owned() } else { text };
            text.replacen("0.", ".", usize::from(value.abs() < 0.9995))
        };
        out.pad(&format!("{} [{}, {}]", short(self.value), short(self.low), short(self.high)))
    }
}

/// Several statistics of the poses as they are and of every resample.
#[derive(Debug, Clone)]
pub(crate) struct Replicates {
    values: Vec<f64>,
    /// One list of statistics for each resample.
    resampled: Vec<Vec<f64>>,
}

/// Computes statistics of the poses and of the resamples, poses drawn with replacement.
///
/// `statistics` is given the weight of each answer: how often its pose was drawn.
pub(crate) fn replicate(
    clusters: &Clusters,
    bootstrap: Bootstrap,
    statistics: impl Fn(&[f64]) -> Vec<f64>,
) -> Replicates {
    let values = statistics(&vec![1.0; clusters.of_pose.len()]);
    let mut rng = seed::generator(bootstrap.seed);
    let resampled = (0..bootstrap.resamples)
        .map(|_| {
            let mut times = vec![0.0; clusters.count];
            for _ in 0..clusters.count {
                times[rng.random_range(0..clusters.count)] += 1.0;
            }
            let weights: Vec<f64> =
                clusters.of_pose.iter().map(|&cluster| times[cluster as usize]).collect();
            statistics(&weights)
        })
        .collect();
    Replicates { values, resampled }
}

impl Replicates {
    /// One statistic with its percentile interval.
    pub(crate) fn estimate(&self, statistic: usize) -> Estimate {
        self.of(|statistics| statistics[statistic])
    }

    /// The first statistic minus the second on the same poses, with its percentile interval.
    pub(crate) fn difference(&self, first: usize, second: usize) -> Estimate {
        self.of(|statistics| statistics[first] - statistics[second])
    }

    /// Resamples in which the statistic is undefined say nothing about it.
    fn of(&self, pick: impl Fn(&[f64]) -> f64) -> Estimate {
        let value = pick(&self.values);
        let mut all: Vec<f64> = self.resampled.iter().map(|s| pick(s)).collect();
        all.retain(|v| !v.is_nan());
        all.sort_by(f64::total_cmp);
        Estimate { value, low: percentile(&all, 0.025), high: percentile(&all, 0.975) }
    }
}

/// Linear between the sorted values; NaN of nothing.
fn percentile(sorted: &[f64], share: f64) -> f64 {
    let Some(last) = sorted.len().checked_sub(1) else { return f64::NAN };
    let at = share * last as f64;
    let (below, rest) = (at.floor() as usize, at.fract());
    let (low, high) = (sorted[below], sorted[(below + 1).min(last)]);
    // Equal infinities have no difference.
    if low == high { low } else { low + rest * (high - low) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mean(values: &[f64], weights: &[f64]) -> f64 {
        let sum: f64 = values.iter().zip(weights).map(|(v, w)| v * w).sum();
        sum / weights.iter().sum::<f64>()
    }

    #[test]
    fn the_interval_of_a_mean_is_that_of_theory() {
        let values: Vec<f64> = (0..500).map(|i| seed::unit(seed::derive(9, i, 0))).collect();
        let replicates =
            replicate(&Clusters::separate(500), Bootstrap::new(1), |w| vec![mean(&values, w)]);
        let Estimate { value, low, high } = replicates.estimate(0);
        // Uniform: standard deviation 1/√12, interval ±1.96/√(12·500) = ±.0253.
        assert!((value - low - 0.0253).abs() < 0.004, "{value} {low} {high}");
        assert!((high - value - 0.0253).abs() < 0.004, "{value} {low} {high}");
    }

    #[test]
    fn repeated_answers_do_not_narrow_the_interval() {
        let once: Vec<f64> = (0..100).map(|i| seed::unit(seed::derive(9, i, 0))).collect();
        let values: Vec<f64> = once.iter().cycle().take(900).copied().collect();
        let width = |clusters: &Clusters| {
            let replicates = replicate(clusters, Bootstrap::new(1), |w| vec![mean(&values, w)]);
            let Estimate { low, high, .. } = replicates.estimate(0);
            high - low
        };
        let ratio =
            width(&Clusters::new((0..900).map(|i| i % 100))) / width(&Clusters::separate(900));
        // √9, within the error of two percentile intervals.
        assert!((ratio - 3.0).abs() < 0.5, "{ratio}");
    }

    #[test]
    fn differences_are_paired() {
        let values: Vec<f64> = (0..200).map(|i| seed::unit(seed::derive(9, i, 0))).collect();
        let shifted: Vec<f64> = values.iter().map(|v| v + 0.125).collect();
        let replicates = replicate(&Clusters::separate(200), Bootstrap::new(1), |w| {
            vec![mean(&shifted, w), mean(&values, w)]
        });
        let Estimate { value, low, high } = replicates.difference(0, 1);
        // The shift is the same in every resample; apart, each mean has an interval of ±.04.
        for shift in [value, low, high] {
            assert!((shift - 0.125).abs() < 1e-12);
        }
        assert!(replicates.difference(0, 1).excludes_zero());
        assert!(!replicates.difference(0, 0).excludes_zero());
    }

    #[test]
    fn equal_seeds_give_equal_intervals() {
        let of = |seed| {
            let clusters = Clusters::separate(20);
            let bootstrap = Bootstrap { resamples: 50, seed };
            replicate(&clusters, bootstrap, |w| vec![mean(&[1.0, 2.0, 4.0], &w[..3])]).estimate(0)
        };
        assert_eq!(of(1), of(1));
        assert_ne!(of(1), of(2));
    }

    #[test]
    fn undefined_resamples_are_left_out_and_nothing_is_a_dash() {
        let replicates = replicate(&Clusters::separate(1), Bootstrap::new(1), |w| {
            vec![if w[0] == 1.0 { f64::NAN } else { 0.0 }]
        });
        assert_eq!(replicates.estimate(0).to_string(), "–");
        assert!(percentile(&[], 0.5).is_nan());
        assert_eq!(percentile(&[1.0, 2.0, 4.0], 0.75), 3.0);
    }

    #[test]
    fn estimates_are_short() {
        let estimate = Estimate { value: 0.967, low: 0.9581, high: 0.99996 };
        assert_eq!(estimate.to_string(), ".967 [.958, 1.000]");
        let difference = Estimate { value: -0.0121, low: -1.25, high: 0.03 };
        assert_eq!(format!("{difference:+}"), "-.012 [-1.250, +.030]");
        let zero = Estimate { value: -0.0, low: 0.0, high: 10.5 };
        assert_eq!(zero.to_string(), ".000 [.000, 10.500]");
    }

    #[test]
    fn clusters_are_numbered_by_first_sight() {
        let clusters = Clusters::new(["b", "a", "b", "c"]);
        assert_eq!((clusters.of_pose(), clusters.count()), (&[0, 1, 0, 2][..], 3));
    }
}
