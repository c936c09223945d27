//! A part of the answers, as the measures take it.

use crate::SEED;
use crate::answers::{Answers, Question, Row, Said};
use crate::measures::{Clusters, Estimate, Measure, Sample, calibration_error, chance_error};
use crate::statistics::median;

/// Questions picked from the table, with what several methods say of them.
pub struct Judged<'a> {
    questions: Vec<&'a Question>,
    clusters: Clusters,
    methods: Vec<OfMethod<'a>>,
}

/// The answers of a method, and the same beside the truth.
struct OfMethod<'a> {
    name: &'a str,
    said: Vec<Said>,
    sample: Sample,
}

impl<'a> Judged<'a> {
    /// The questions wanted that all of these methods answered.
    pub fn pick(
        answers: &'a Answers,
        methods: &[&'a str],
        keep: impl Fn(&Question) -> bool,
    ) -> Self {
        let columns: Option<Vec<usize>> = methods.iter().map(|name| answers.index(name)).collect();
        let picked = |(question, said): &'a Row| -> Option<(&'a Question, Vec<Said>)> {
            let said = columns.as_ref()?.iter().map(|&column| said[column]);
            keep(question).then_some((question, said.collect::<Option<_>>()?))
        };
        let (questions, said): (Vec<&Question>, Vec<Vec<Said>>) =
            answers.rows.iter().filter_map(picked).unzip();
        let of_method = |(which, &name): (usize, &&'a str)| {
            let said: Vec<Said> = said.iter().map(|said| said[which]).collect();
            let truths = questions.iter().map(|q| q.collides).collect();
            let scores = said.iter().map(|s| s.score).collect();
            let probabilities: Option<Vec<f64>> = said.iter().map(|s| s.probability).collect();
            let sample = Sample::new(truths, scores, probabilities.unwrap_or_default());
            OfMethod { name, said, sample }
        };
        let methods = methods.iter().enumerate().map(of_method).collect();
        let clusters = Clusters::of(questions.iter().map(|q| (q.family, q.draw, q.pose)));
        Self { questions, clusters, methods }
    }

    /// The questions.
    pub fn questions(&self) -> &[&'a Question] {
        &self.questions
    }

    /// What was picked of a method.
    ///
    /// # Panics
    /// When it was not picked.
    fn of(&self, method: &str) -> &OfMethod<'a> {
        let found = self.methods.iter().find(|of| of.name == method);
        found.expect("only methods that were picked are asked for")
    }

    /// The answers of a method that was picked.
    pub fn said(&self, method: &str) -> &[Said] {
        &self.of(method).said
    }

    /// A method's answers beside the truth.
    pub fn sample(&self, method: &str) -> &Sample {
        &self.of(method).sample
    }

    /// The ECE that chance alone gives the probabilities of a method.
    pub fn chance_error(&self, method: &str) -> f64 {
        chance_error(self.sample(method), &self.clusters, SEED)
    }

    /// How far the ECE of a method is above what chance alone gives.
    pub fn error_above_chance(&self, method: &str) -> f64 {
        let sample = self.sample(method);
        calibration_error(sample, &sample.ones()) - self.chance_error(method)
    }

    /// Median of the query times, ms.
    pub fn query_ms(&self, method: &str) -> f64 {
        median(&self.said(method).iter().map(|s| 1e-3 * s.micros).collect::<Vec<_>>())
    }

    /// A measure with its interval; not a number where there is nothing to measure.
    pub fn estimate(&self, method: &str, measure: Measure) -> Estimate {
        let sample = self.sample(method);
        self.clusters.estimate(|weights| measure.of(sample, weights))
    }

    /// The first method minus the second, paired.
    pub fn difference(&self, first: &str, second: &str, measure: Measure) -> Estimate {
        let of = [first, second].map(|method| self.sample(method));
        self.clusters.estimate(|weights| measure.of(of[0], weights) - measure.of(of[1], weights))
    }

    /// The difference in words, bold where its interval excludes zero; a dash beside itself.
    pub fn compared(&self, method: &str, with: &str, measure: Measure) -> String {
        if method == with {
            return "–".into();
        }
        let difference = self.difference(method, with, measure);
        let bold = if difference.excludes_zero() { "**" } else { "" };
        format!("{bold}{difference:+}{bold}")
    }
}

#[cfg(test)]
mod tests {
    use std::time::Instant;

    use super::*;
    use crate::answers::tests::question;

    #[test]
    fn only_what_all_methods_answered_is_kept() {
        let names = ["good", "bad"].map(String::from).to_vec();
        let mut answers = Answers { methods: names, rows: Vec::new() };
        let said = |p: f64| Said {
            probability: Some(p),
            micros: 1e3 * p,
            ..Said::score(p, Instant::now())
        };
        for pose in 0..20 {
            let collides = pose % 2 == 0;
            let good = Some(said(if collides { 0.8 } else { 0.3 }));
            let bad = (pose < 16).then(|| said(f64::from(pose) / 20.0));
            answers.push((question("a", pose / 5, pose % 5, collides), vec![good, bad])).unwrap();
        }
        let both = Judged::pick(&answers, &["bad", "good"], |_| true);
        let collisions = |of: &Judged<'_>| of.questions.iter().filter(|q| q.collides).count();
        assert_eq!((both.questions.len(), collisions(&both)), (16, 8));
        let later = Judged::pick(&answers, &["good"], |q| q.draw > 0);
        assert_eq!((later.questions.len(), collisions(&later)), (15, 7));
        assert!(Judged::pick(&answers, &["good", "none"], |_| true).questions.is_empty());
        assert!((both.query_ms("bad") - 0.375).abs() < 1e-12);
        let auc = both.difference("good", "bad", Measure::Auc);
        assert!(auc.value > 0.3 && auc.excludes_zero(), "{auc:?}");
    }
}
