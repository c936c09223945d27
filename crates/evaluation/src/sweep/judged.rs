//! A part of the answers, as the measures take it.

use super::plan::SEED;
use crate::{
    answers::{Answers, Question, Said},
    measures::{Clusters, Estimate, Measure, Replicates, Sample, chance_error},
    statistics::quantile,
};

/// Questions picked from the table, with what several methods say of them.
pub struct Judged<'a> {
    questions: Vec<&'a Question>,
    clusters: Clusters,
    methods: Vec<(&'a str, Vec<Said>)>,
    samples: Vec<Sample>,
}

impl<'a> Judged<'a> {
    /// The questions wanted that all of these methods answered.
    pub fn pick(
        answers: &'a Answers,
        methods: &[&'a str],
        keep: impl Fn(&Question) -> bool,
    ) -> Self {
        let columns: Vec<&[Option<Said>]> =
            methods.iter().filter_map(|method| answers.said(method)).collect();
        let is_answered = |i: usize| columns.iter().all(|said| said[i].is_some());
        let kept: Vec<usize> = (0..answers.questions.len())
            .filter(|&i| columns.len() == methods.len() && is_answered(i))
            .filter(|&i| keep(&answers.questions[i]))
            .collect();
        let questions: Vec<&Question> = kept.iter().map(|&i| &answers.questions[i]).collect();
        let of_method =
            |said: &&[Option<Said>]| kept.iter().filter_map(|&i| said[i]).collect::<Vec<Said>>();
        let methods: Vec<(&str, Vec<Said>)> =
            methods.iter().copied().zip(columns.iter().map(of_method)).collect();
        let truths: Vec<bool> = questions.iter().map(|q| q.collides).collect();
        let sample = |said: &Vec<Said>| {
            let probabilities: Option<Vec<f64>> = said.iter().map(|s| s.probability).collect();
            let scores = said.iter().map(|s| s.score).collect();
            Sample::new(truths.clone(), scores, probabilities.unwrap_or_default())
        };
        let samples = methods.iter().map(|(_, said)| sample(said)).collect();
        let clusters = Clusters::of(questions.iter().map(|q| (q.family, q.draw, q.pose)));
        Self { questions, clusters, methods, samples }
    }

    /// How many questions there are, and how many are collisions.
    pub fn counts(&self) -> (usize, usize) {
        (self.questions.len(), self.questions.iter().filter(|q| q.collides).count())
    }

    /// The questions.
    pub fn questions(&self) -> &[&'a Question] {
        &self.questions
    }

    /// The answers of a method; none when it was not picked.
    pub fn said(&self, method: &str) -> &[Said] {
        self.methods.iter().find(|(name, _)| *name == method).map_or(&[], |(_, said)| said)
    }

    /// A method's answers beside the truth.
    pub fn sample(&self, method: &str) -> Option<&Sample> {
        let at = self.methods.iter().position(|(name, _)| *name == method)?;
        self.samples.get(at)
    }

    /// The ECE that chance alone gives the probabilities of a method.
    pub fn chance_error(&self, method: &str) -> f64 {
        self.sample(method).map_or(f64::NAN, |s| chance_error(s, &self.clusters, SEED))
    }

    /// Query time in milliseconds that the share `q` of the answers stays below.
    pub fn query_ms(&self, method: &str, q: f64) -> f64 {
        let times: Vec<f64> = self.said(method).iter().map(|s| 1e-3 * s.micros).collect();
        quantile(&times, q)
    }

    /// All of these measures of every method, with intervals.
    pub fn measure(&self, measures: &[Measure]) -> Measured<'a> {
        let replicates = Replicates::new(&self.clusters, |weights| {
            let of = |sample: &Sample| -> Vec<f64> {
                measures.iter().map(|m| m.of(sample, weights)).collect()
            };
            self.samples.iter().flat_map(of).collect()
        });
        Measured {
            names: self.methods.iter().map(|(name, _)| *name).collect(),
            measures: measures.to_vec(),
            replicates,
        }
    }
}

/// Measures of several methods on the same questions.
pub struct Measured<'a> {
    names: Vec<&'a str>,
    measures: Vec<Measure>,
    replicates: Replicates,
}

impl Measured<'_> {
    /// A value with its interval; `None` for what was not measured.
    pub fn estimate(&self, method: &str, measure: Measure) -> Option<Estimate> {
        Some(self.replicates.estimate(self.index(method, measure)?))
    }

    /// The first method minus the second, paired.
    pub fn difference(&self, first: &str, second: &str, measure: Measure) -> Option<Estimate> {
        let index = |method| self.index(method, measure);
        Some(self.replicates.difference(index(first)?, index(second)?))
    }

    /// The difference in words, bold where its interval excludes zero; a dash beside itself.
    pub fn compared(&self, method: &str, with: &str, measure: Measure) -> String {
        match self.difference(method, with, measure).filter(|_| method != with) {
            Some(d) if d.excludes_zero() => format!("**{d:+}**"),
            Some(d) => format!("{d:+}"),
            None => "–".into(),
        }
    }

    fn index(&self, method: &str, measure: Measure) -> Option<usize> {
        let method = self.names.iter().position(|m| *m == method)?;
        let measure = self.measures.iter().position(|m| *m == measure)?;
        Some(method * self.measures.len() + measure)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::answers::tests::question;

    #[test]
    fn only_what_all_methods_answered_is_kept() {
        let mut answers = Answers::default();
        let said = |p: f64| Said { probability: Some(p), ..Said::score(p, 1e3 * p) };
        for pose in 0..20 {
            let collides = pose % 2 == 0;
            let good = ("good".to_owned(), said(if collides { 0.8 } else { 0.3 }));
            let bad = ("bad".to_owned(), said(f64::from(pose) / 20.0));
            let both = if pose < 16 { vec![good, bad] } else { vec![good] };
            answers.push(question("a", pose / 5, pose % 5, collides), &both).unwrap();
        }
        let both = Judged::pick(&answers, &["bad", "good"], |_| true);
        assert_eq!(both.counts(), (16, 8));
        assert_eq!(Judged::pick(&answers, &["good"], |q| q.draw > 0).counts(), (15, 7));
        assert_eq!(Judged::pick(&answers, &["good", "none"], |_| true).counts(), (0, 0));
        assert!((both.query_ms("bad", 1.0) - 0.75).abs() < 1e-12);
        let measured = both.measure(&[Measure::Auc, Measure::Brier]);
        let auc = measured.difference("good", "bad", Measure::Auc).unwrap();
        assert!(auc.value > 0.3 && auc.excludes_zero(), "{auc:?}");
        assert!(measured.estimate("good", Measure::CalibrationError).is_none());
    }
}
