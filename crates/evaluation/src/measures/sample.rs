//! One method's answers beside the truth, sorted once so that every measure is one pass.

/// One method's answers to a set of questions.
///
/// A measure takes a weight for each question (how often a resample drew it), so that a bootstrap
/// sorts nothing again.
#[derive(Debug, Clone)]
pub struct Sample {
    pub(super) collides: Vec<bool>,
    pub(super) scores: Vec<f64>,
    /// Collision probabilities; empty when one answer has none.
    pub(super) probabilities: Vec<f64>,
    /// Questions by rising score.
    by_score: Vec<u32>,
}

impl Sample {
    /// Truths, scores (larger = more likely a collision), and probabilities or nothing, each in the same order.
    pub fn new(collides: Vec<bool>, scores: Vec<f64>, probabilities: Vec<f64>) -> Self {
        let mut by_score: Vec<u32> = (0..scores.len() as u32).collect();
        by_score.sort_by(|&a, &b| scores[a as usize].total_cmp(&scores[b as usize]));
        Self { collides, scores, probabilities, by_score }
    }

    /// Probabilities that are their own scores.
    pub fn of_probabilities(answers: impl IntoIterator<Item = (f64, bool)>) -> Self {
        let (probabilities, collides): (Vec<f64>, Vec<bool>) = answers.into_iter().unzip();
        Self::new(collides, probabilities.clone(), probabilities)
    }

    /// Every question once.
    pub fn ones(&self) -> Vec<f64> {
        vec![1.0; self.collides.len()]
    }

    /// The groups of equal score, rising: the weights of the collisions and of the free poses.
    pub(super) fn groups(&self, weights: &[f64]) -> impl Iterator<Item = [f64; 2]> {
        let score = |i: u32| self.scores[i as usize];
        self.by_score.chunk_by(move |&a, &b| score(a) == score(b)).map(|group| {
            let mut of_group = [0.0; 2];
            for i in group.iter().map(|&i| i as usize) {
                of_group[usize::from(!self.collides[i])] += weights[i];
            }
            of_group
        })
    }
}
