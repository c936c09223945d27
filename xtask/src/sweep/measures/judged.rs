//! Poses picked from the table of answers, with what several methods say of them.

use super::{Clusters, Sample};
use crate::{
    common::statistics::quantile,
    sweep::record::{Answers, Condition, Said, Truth},
};

/// Poses under one or more conditions with one answer of each method.
#[derive(Debug, Clone)]
pub(crate) struct Judged {
    pub(crate) truths: Vec<Truth>,
    /// Answers to one pose under several conditions belong together.
    pub(crate) clusters: Clusters,
    /// Name of a method and its answers, in the order of the truths.
    pub(crate) methods: Vec<(String, Vec<Said>)>,
}

impl Judged {
    /// The poses that `keep` wants, as answered by these methods.
    ///
    /// A condition that one of the methods has not answered is left out, so that all of them are
    /// compared on the same poses.
    pub(crate) fn pick(
        answers: &Answers,
        methods: &[&str],
        keep: impl Fn(&Condition, &Truth) -> bool,
    ) -> Self {
        let mut truths = Vec::new();
        let mut keys = Vec::new();
        let mut of_method = vec![Vec::new(); methods.len()];
        for block in answers.blocks() {
            let said: Option<Vec<&[Said]>> =
                methods.iter().map(|method| block.said(method)).collect();
            let Some(said) = said else { continue };
            for (i, truth) in block.truths.iter().enumerate() {
                if keep(&block.condition, truth) {
                    truths.push(*truth);
                    keys.push((block.condition.family, block.poses[i]));
                    of_method.iter_mut().zip(&said).for_each(|(all, said)| all.push(said[i]));
                }
            }
        }
        let methods = methods.iter().map(|m| (*m).to_owned()).zip(of_method).collect();
        Self { truths, clusters: Clusters::new(keys), methods }
    }

    /// So many of the answers (or all, if fewer), evenly from the whole: for figures of single poses.
    pub(crate) fn thinned(&self, count: usize) -> Self {
        let total = self.truths.len();
        let kept: Vec<usize> =
            (0..count.min(total)).map(|i| i * total / count.min(total)).collect();
        let of_method = |(name, said): &(String, Vec<Said>)| {
            (name.clone(), kept.iter().map(|&i| said[i]).collect())
        };
        Self {
            truths: kept.iter().map(|&i| self.truths[i]).collect(),
            clusters: Clusters::new(kept.iter().map(|&i| self.clusters.of_pose()[i])),
            methods: self.methods.iter().map(of_method).collect(),
        }
    }

    /// Each method's answers beside the truth, in the order of the methods.
    pub(crate) fn samples(&self) -> Vec<Sample> {
        self.methods.iter().map(|(_, said)| Sample::new(&self.truths, said)).collect()
    }

    /// Number of answers of each method, and how many of the poses collide.
    pub(crate) fn counts(&self) -> (usize, usize) {
        (self.truths.len(), self.truths.iter().filter(|t| t.collides).count())
    }

    /// The time within which a share of a method's queries is answered, ms; NaN without poses or
    /// such a method.
    pub(crate) fn query_ms(&self, method: &str, share: f64) -> f64 {
        let said = self.methods.iter().find(|(name, _)| name == method).map(|(_, said)| said);
        let times: Vec<f64> = said.into_iter().flatten().map(|s| 1e-3 * s.micros).collect();
        quantile(&times, share)
    }
}

#[cfg(test)]
mod tests {
    use cloudtouch_testkit::noise::NoiseKind;

    use super::*;
    use crate::sweep::record::Block;

    #[test]
    fn only_common_conditions_and_wanted_poses_are_kept() {
        let said =
            |micros| Said { score: 0.0, probability: None, bounds: None, evidence: None, micros };
        let block = |family, std, methods: &[&str]| Block {
            condition: Condition { family, points: 1, noise: NoiseKind::Gaussian, std },
            poses: vec![0, 1],
            truths: [-0.1, 0.2].map(|d| Truth { collides: d < 0.0, signed_distance: d }).to_vec(),
            methods: methods
                .iter()
                .map(|m| ((*m).to_owned(), vec![said(1000.0), said(3000.0)]))
                .collect(),
        };
        let mut answers = Answers::default();
        for block in [
            block("a", 0.0, &["x", "y"]),
            block("a", 0.01, &["y", "x"]),
            block("b", 0.0, &["x", "y"]),
            block("b", 0.01, &["x"]),
        ] {
            answers.add(block).unwrap();
        }
        let both = Judged::pick(&answers, &["y", "x"], |_, _| true);
        assert_eq!(both.counts(), (6, 3));
        // Two poses of a under two conditions, two of b under one.
        assert_eq!(both.clusters.of_pose(), [0, 1, 0, 1, 2, 3]);
        let near = Judged::pick(&answers, &["x"], |c, t| c.family == "b" && t.collides);
        assert_eq!(near.counts(), (2, 2));
        assert_eq!(near.clusters.count(), 1);
        assert_eq!((both.query_ms("x", 0.5), both.query_ms("x", 1.0)), (1.0, 3.0));
        assert!(both.query_ms("z", 0.5).is_nan());
        // Answers 0, 2 and 4 of six.
        let few = both.thinned(3);
        assert_eq!(few.counts(), (3, 3));
        assert_eq!(few.clusters.of_pose(), [0, 0, 1]);
        assert_eq!(few.methods[0].1.len(), 3);
        assert_eq!(both.thinned(100).counts(), (6, 3));
    }
}
