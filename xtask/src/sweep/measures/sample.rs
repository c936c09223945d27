//! One method's answers beside the truth, sorted once so that every measure is one pass.

use crate::sweep::record::{Said, Truth};

/// One method's answers to a set of poses.
///
/// A measure takes a weight for each pose (how often a resample drew it; ones for the poses as
/// they are), so that a bootstrap sorts nothing again.
#[derive(Debug, Clone)]
pub(crate) struct Sample {
    pub(super) collides: Vec<bool>,
    /// −signed distance, m: larger is deeper.
    pub(super) depths: Vec<f64>,
    pub(super) scores: Vec<f64>,
    /// Present when every answer has one.
    pub(super) probabilities: Option<Vec<f64>>,
    /// Present when every answer has them.
    pub(super) bounds: Option<Vec<[f64; 2]>>,
    /// Probabilities that the bounds should contain, one for each pose.
    pub(super) reference: Option<Vec<f64>>,
    /// Poses by rising score.
    pub(super) by_score: Vec<usize>,
    /// Poses by rising depth.
    pub(super) by_depth: Vec<usize>,
}

impl Sample {
    /// Answers beside the truths of the same poses; what one list has too many is left out.
    pub(crate) fn new(truths: &[Truth], said: &[Said]) -> Self {
        let (truths, said): (Vec<Truth>, Vec<Said>) =
            truths.iter().zip(said).map(|(t, s)| (*t, *s)).unzip();
        let depths: Vec<f64> = truths.iter().map(|t| -t.signed_distance).collect();
        let scores: Vec<f64> = said.iter().map(|s| s.score).collect();
        Self {
            collides: truths.iter().map(|t| t.collides).collect(),
            by_score: rising(&scores),
            by_depth: rising(&depths),
            depths,
            scores,
            probabilities: said.iter().map(|s| s.probability).collect(),
            bounds: said.iter().map(|s| s.bounds).collect(),
            reference: None,
        }
    }

    /// Gives the probabilities that the bounds are judged by, one for each pose.
    pub(crate) fn with_reference(mut self, reference: &[f64]) -> Self {
        self.reference = Some(reference.to_vec());
        self
    }

    /// Number of poses.
    pub(crate) fn len(&self) -> usize {
        self.collides.len()
    }

    /// Every pose once.
    pub(crate) fn ones(&self) -> Vec<f64> {
        vec![1.0; self.len()]
    }

    /// Weighted mean over the poses; NaN of nothing.
    pub(super) fn mean(&self, weights: &[f64], value: impl Fn(usize) -> f64) -> f64 {
        let (mut sum, mut total) = (0.0, 0.0);
        for (i, &weight) in weights.iter().enumerate() {
            sum += weight * value(i);
            total += weight;
        }
        sum / total
    }

    /// Goes through the groups of equal score, rising: the score, and the weights of the
    /// collisions and of the free poses in the group.
    pub(super) fn score_groups(&self, weights: &[f64], mut visit: impl FnMut(f64, f64, f64)) {
        for group in self.by_score.chunk_by(|&a, &b| self.scores[a] == self.scores[b]) {
            let (mut hits, mut free) = (0.0, 0.0);
            for &i in group {
                *(if self.collides[i] { &mut hits } else { &mut free }) += weights[i];
            }
            visit(self.scores[group[0]], hits, free);
        }
    }

    /// Weights of all collisions and of all free poses.
    pub(super) fn totals(&self, weights: &[f64]) -> (f64, f64) {
        let (mut hits, mut free) = (0.0, 0.0);
        for (&collides, weight) in self.collides.iter().zip(weights) {
            *(if collides { &mut hits } else { &mut free }) += weight;
        }
        (hits, free)
    }
}

fn rising(values: &[f64]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|&a, &b| values[a].total_cmp(&values[b]));
    order
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// A sample of scores that are probabilities where they can be.
    pub(in crate::sweep::measures) fn sample(scored: &[(f64, bool)]) -> Sample {
        let truths: Vec<Truth> = scored
            .iter()
            .map(|&(_, collides)| Truth {
                collides,
                signed_distance: if collides { -0.01 } else { 0.01 },
            })
            .collect();
        let said: Vec<Said> = scored
            .iter()
            .map(|&(score, _)| Said {
                score,
                probability: (0.0..=1.0).contains(&score).then_some(score),
                bounds: None,
                evidence: None,
                micros: 1.0,
            })
            .collect();
        Sample::new(&truths, &said)
    }

    #[test]
    fn equal_scores_are_one_group() {
        let sample = sample(&[(0.5, true), (-0.0, false), (0.5, false), (0.0, true)]);
        let mut groups = Vec::new();
        sample.score_groups(&[1.0, 1.0, 3.0, 1.0], |s, h, f| groups.push((s, h, f)));
        assert_eq!(groups, [(0.0, 1.0, 1.0), (0.5, 1.0, 3.0)]);
        assert_eq!(sample.totals(&[1.0, 1.0, 3.0, 1.0]), (2.0, 4.0));
    }

    #[test]
    fn one_missing_probability_means_none() {
        assert!(sample(&[(0.5, true), (7.0, false)]).probabilities.is_none());
        assert!(sample(&[(0.5, true), (0.7, false)]).probabilities.is_some());
    }
}
