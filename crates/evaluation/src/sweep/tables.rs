//! The answers by kind of pair, kind of scene, family and noise, as rows of tables.

use cloudtouch_testkit::{family::Kind, poses::NEAR};

use super::{GEOMETRY, ORACLE, OURS, judged::Judged, plan::STDS};
use crate::{
    answers::{Answers, Pair, Question},
    measures::{Estimate, Measure},
    table::Table,
};

/// All answers of a sweep, with what tables ask of them.
pub(super) struct Answered<'a> {
    /// The table of answers.
    pub answers: &'a Answers,
    /// Methods other than ours, whole, true or without the classifier.
    pub alternatives: Vec<&'a str>,
}

/// Whether a pose is within 3 cm of contact.
pub(super) fn is_near(question: &Question) -> bool {
    question.signed_distance.abs() < NEAR
}

impl<'a> Answered<'a> {
    pub(super) fn new(answers: &'a Answers) -> Self {
        let mut alternatives: Vec<&str> = answers.methods.iter().map(String::as_str).collect();
        alternatives.retain(|name| ![OURS, ORACLE, GEOMETRY].contains(name));
        Self { answers, alternatives }
    }

    /// A pair's questions about one kind of scenes.
    pub(super) fn is_of(pair: Pair, kind: Kind) -> impl Fn(&Question) -> bool + Copy {
        move |q: &Question| q.pair == pair && q.kind == kind
    }

    /// How many questions, how many of them collisions: the base rate.
    pub(super) fn base_rate(&self, keep: impl Fn(&Question) -> bool) -> String {
        let (count, collisions) = Judged::pick(self.answers, &[OURS], keep).counts();
        let share = 100.0 * collisions as f64 / count as f64;
        format!("{count} answers, {share:.0} % of them to collisions")
    }

    /// A row for every method, and by how much its AUC differs from ours on the same questions.
    pub(super) fn methods(&self, keep: impl Fn(&Question) -> bool + Copy) -> Table {
        let mut table = Table::new(
            header("method").into_iter().chain(["AUC minus ours", "query (ms)"].map(String::from)),
        );
        for name in &self.answers.methods {
            let mut row = self.row(name, name, keep);
            let judged = Judged::pick(self.answers, &[name, OURS], keep);
            row.push(judged.compared(name, OURS, Measure::Auc));
            let dense = |q: &Question| keep(q) && q.condition.points == 10_000;
            let judged = Judged::pick(self.answers, &[name], dense);
            row.push(format!("{:.2}", judged.query_ms(name, 0.5)));
            table.row(row);
        }
        table
    }

    /// Ours on every family, judged with constants fitted on the others, and the oracle's AUC.
    pub(super) fn families(&self, pair: Pair) -> Table {
        let header = header("family").into_iter().chain(["AUC of the oracle".into()]);
        let mut table = Table::new(header);
        for kind in [Kind::Ordinary, Kind::Adversarial, Kind::Real] {
            for family in self.answers.families() {
                let keep = move |q: &Question| q.family == family && Self::is_of(pair, kind)(q);
                if Judged::pick(self.answers, &[OURS], keep).counts().0 == 0 {
                    continue;
                }
                let is_hard = kind == Kind::Adversarial;
                let name = if is_hard { format!("({family})") } else { family.to_owned() };
                let mut row = self.row(&name, OURS, keep);
                row.push(self.auc(ORACLE, keep).to_string());
                table.row(row);
            }
        }
        table
    }

    /// Ours by noise, on ordinary scenes, with the oracle and the best alternative.
    pub(super) fn noises(&self, pair: Pair) -> Table {
        let extra = ["AUC of the oracle", "best alternative", "its AUC"].map(String::from);
        let mut table = Table::new(header("noise").into_iter().chain(extra));
        for std in STDS {
            let keep =
                |q: &Question| Self::is_of(pair, Kind::Ordinary)(q) && q.condition.std == std;
            let name = format!("{} mm", 1e3 * std);
            let mut row = self.row(&name, OURS, keep);
            let (best, auc) = self.best_alternative(keep);
            row.extend([self.auc(ORACLE, keep).to_string(), best.to_owned(), auc]);
            table.row(row);
        }
        table
    }

    /// The alternative with the largest AUC, and that AUC.
    pub(super) fn best_alternative(
        &self,
        keep: impl Fn(&Question) -> bool + Copy,
    ) -> (&'a str, String) {
        let all = self.alternatives.iter().map(|&name| (name, self.auc(name, keep)));
        let best = all
            .filter(|(_, auc)| !auc.value.is_nan())
            .max_by(|(_, a), (_, b)| a.value.total_cmp(&b.value));
        best.map_or(("none", "–".into()), |(name, auc)| (name, auc.to_string()))
    }

    fn row(
        &self,
        name: &str,
        method: &'a str,
        keep: impl Fn(&Question) -> bool + Copy,
    ) -> Vec<String> {
        let judged = Judged::pick(self.answers, &[method], keep);
        let of = |measure| judged.estimate(method, measure).to_string();
        let error = judged.estimate(method, Measure::CalibrationError).value;
        let by_chance = || format!("{error:.3} ({:.3})", judged.chance_error(method));
        vec![
            name.to_owned(),
            of(Measure::Auc),
            self.auc(method, |q| keep(q) && is_near(q)).to_string(),
            of(Measure::Brier),
            if error.is_nan() { "–".into() } else { by_chance() },
            of(Measure::FalseStops(0.01)),
            of(Measure::FalseStops(0.05)),
        ]
    }

    /// The AUC of a method on the questions it answered.
    pub(super) fn auc(&self, method: &'a str, keep: impl Fn(&Question) -> bool) -> Estimate {
        Judged::pick(self.answers, &[method], keep).estimate(method, Measure::Auc)
    }
}

fn header(first: &str) -> Vec<String> {
    let rest =
        ["AUC", "AUC near", "Brier", "ECE (by chance)", "false stops at 1 % misses", "at 5 %"];
    std::iter::once(first).chain(rest).map(String::from).collect()
}
