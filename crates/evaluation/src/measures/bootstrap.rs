//! Intervals from resampled draws and poses.

use std::collections::BTreeMap;
use std::fmt;

use cloudtouch_geom::seed;
use rand::RngExt;
use rayon::prelude::*;

use crate::SEED;

/// Resamples behind an interval.
const RESAMPLES: u64 = 300;

/// Which answers share a draw of a scene, and which a pose of it: they are not independent.
#[derive(Debug, Clone, PartialEq)]
pub struct Clusters {
    /// For each answer its pose, counted over all draws.
    pub(super) pose_of: Vec<u32>,
    /// For each pose its draw, counted over all families.
    pub(super) draw_of: Vec<u32>,
    /// For each family the draws it has.
    draws: Vec<Vec<u32>>,
}

impl Clusters {
    /// Family, draw within the family and pose within the draw of each answer.
    pub fn of<'a>(answers: impl IntoIterator<Item = (&'a str, u32, u32)>) -> Self {
        let (mut poses, mut draws, mut families) =
            (BTreeMap::new(), BTreeMap::new(), BTreeMap::new());
        let mut clusters = Self { pose_of: Vec::new(), draw_of: Vec::new(), draws: Vec::new() };
        for (family, draw, pose) in answers {
            let of_pose = number(&mut poses, (family, draw, pose));
            let of_draw = number(&mut draws, (family, draw));
            let of_family = number(&mut families, family);
            clusters.pose_of.push(of_pose);
            if of_pose as usize == clusters.draw_of.len() {
                clusters.draw_of.push(of_draw);
            }
            clusters.draws.resize(families.len(), Vec::new());
            let known = &mut clusters.draws[of_family as usize];
            if !known.contains(&of_draw) {
                known.push(of_draw);
            }
        }
        clusters
    }

    /// How often a resample draws each answer: draws of a scene with replacement within each
    /// family, then the poses of a draw. Families stay: they are chosen and no sample of anything.
    fn weights(&self, number: u64) -> Vec<f64> {
        let mut rng = seed::generator(seed::derive(SEED, number, 0));
        let mut times = vec![0.0; self.draws.iter().map(Vec::len).sum()];
        for draws in &self.draws {
            for _ in draws {
                times[draws[rng.random_range(0..draws.len())] as usize] += 1.0;
            }
        }
        let mut members = vec![Vec::new(); times.len()];
        for (pose, &draw) in self.draw_of.iter().enumerate() {
            members[draw as usize].push(pose);
        }
        let mut of_pose = vec![0.0; self.draw_of.len()];
        for (poses, times) in members.iter().zip(times) {
            for _ in poses {
                of_pose[poses[rng.random_range(0..poses.len())]] += times;
            }
        }
        self.pose_of.iter().map(|&pose| of_pose[pose as usize]).collect()
    }

    /// A statistic, which is a function of the weights of the answers. All statistics are resampled
    /// with the same weights, so that a difference of two is paired.
    pub fn estimate(&self, statistic: impl Fn(&[f64]) -> f64 + Sync) -> Estimate {
        let resample = |number| statistic(&self.weights(number));
        let mut values: Vec<f64> = (0..RESAMPLES).into_par_iter().map(resample).collect();
        // Resamples without the statistic (one kind of truth only) say nothing.
        values.retain(|v| !v.is_nan());
        values.sort_by(f64::total_cmp);
        let at = |share: f64| {
            let rank = (share * values.len() as f64) as usize;
            values.get(rank.min(values.len().saturating_sub(1))).copied().unwrap_or(f64::NAN)
        };
        let value = statistic(&vec![1.0; self.pose_of.len()]);
        Estimate { value, low: at(0.025), high: at(0.975) }
    }
}

/// The number of a key, counted from 0 in the order of first use.
fn number<K: Ord>(known: &mut BTreeMap<K, u32>, key: K) -> u32 {
    let next = known.len() as u32;
    *known.entry(key).or_insert(next)
}

/// A value with its 95 % interval.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate {
    /// Of the answers as they are.
    pub value: f64,
    /// 2.5 % of the resamples are below.
    pub low: f64,
    /// 2.5 % of the resamples are above.
    pub high: f64,
}

impl Estimate {
    /// Whether the interval lies on one side of zero.
    pub fn excludes_zero(&self) -> bool {
        self.low > 0.0 || self.high < 0.0
    }
}

impl fmt::Display for Estimate {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.value.is_nan() {
            return out.pad("–");
        }
        let short = |value: f64| {
            let text = if out.sign_plus() { format!("{value:+.3}") } else { format!("{value:.3}") };
            text.replacen("0.", ".", usize::from(value.abs() < 0.9995))
        };
        out.pad(&format!("{} [{}, {}]", short(self.value), short(self.low), short(self.high)))
    }
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
        // 400 draws of one pose each, values of variance 1/12: ±1.96 √(1/12/400) = ±.0283.
        let values: Vec<f64> = (0..400).map(|i| seed::unit(seed::derive(1, i, 0))).collect();
        let clusters = Clusters::of((0..400).map(|i| ("a", i, 0)));
        let found = clusters.estimate(|w| mean(&values, w));
        assert!((found.high - found.low - 2.0 * 0.0283).abs() < 0.009, "{found:?}");
        assert!(found.low < found.value && found.value < found.high);
    }

    #[test]
    fn answers_of_one_draw_are_not_independent() {
        // The same values, but forty answers to each of ten draws agree.
        let values: Vec<f64> = (0..400).map(|i| seed::unit(seed::derive(1, i / 40, 0))).collect();
        let width = |clusters: Clusters| {
            let found = clusters.estimate(|w| mean(&values, w));
            found.high - found.low
        };
        let together = width(Clusters::of((0..400).map(|i| ("a", i / 40, i % 40))));
        let apart = width(Clusters::of((0..400).map(|i| ("a", i, 0))));
        assert!(together > 3.0 * apart, "{together} {apart}");
    }

    #[test]
    fn families_are_no_sample() {
        // Each family agrees with itself, so nothing is left to chance.
        let families = ["a", "b", "c"];
        let clusters = Clusters::of((0..30).map(|i| (families[i as usize % 3], i, 0)));
        let values: Vec<f64> = (0..30).map(|i| f64::from(i % 3)).collect();
        let found = clusters.estimate(|w| mean(&values, w));
        assert_eq!((found.low, found.high), (1.0, 1.0));
    }
}
