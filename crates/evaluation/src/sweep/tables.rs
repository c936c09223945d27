//! The answers by kind of pair, kind of scene, family and noise, as rows of tables.

use cloudtouch_testkit::family::Kind;
use cloudtouch_testkit::poses::NEAR;

use super::judged::Judged;
use super::plan::STDS;
use super::{GEOMETRY, ORACLE, OURS};
use crate::answers::{Answers, Pair, Question};
use crate::measures::{Estimate, Measure};
use crate::report::Table;

/// Whether a pose is within 3 cm of contact.
pub(super) fn is_near(question: &Question) -> bool {
    question.signed_distance.abs() < NEAR
}

/// Whether a question is one of a pair about one kind of scenes.
pub(super) fn is_of(pair: Pair, kind: Kind) -> impl Fn(&Question) -> bool + Copy {
    move |q: &Question| q.pair == pair && q.kind == kind
}

/// The same about ordinary scenes.
pub fn ordinary(pair: Pair) -> impl Fn(&Question) -> bool + Copy {
    is_of(pair, Kind::Ordinary)
}

impl Answers {
    /// Methods other than ours, whole, true or without the classifier.
    pub(super) fn alternatives(&self) -> impl Iterator<Item = &str> {
        let names = self.methods.iter().map(String::as_str);
        names.filter(|name| ![OURS, ORACLE, GEOMETRY].contains(name))
    }

    /// A row for every method, and by how much its AUC differs from ours on the same questions.
    pub(super) fn by_method(&self, keep: impl Fn(&Question) -> bool + Copy) -> Table {
        let mut table = headed("method", &["AUC minus ours", "query (ms)"]);
        for name in &self.methods {
            let mut row = self.row(name, name, keep);
            let judged = Judged::pick(self, &[name, OURS], keep);
            row.push(judged.compared(name, OURS, Measure::Auc));
            let dense = |q: &Question| keep(q) && q.condition.points == 10_000;
            let judged = Judged::pick(self, &[name], dense);
            row.push(format!("{:.2}", judged.query_ms(name)));
            table.row(row);
        }
        table
    }

    /// Ours on every family, judged with constants fitted on the others, and the oracle's AUC.
    pub(super) fn by_family(&self, pair: Pair) -> Table {
        let mut table = headed("family", &["AUC of the oracle"]);
        for kind in [Kind::Ordinary, Kind::Adversarial, Kind::Real] {
            for family in self.families() {
                let keep = move |q: &Question| q.family == family && is_of(pair, kind)(q);
                if Judged::pick(self, &[OURS], keep).questions().is_empty() {
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
    pub(super) fn by_noise(&self, pair: Pair) -> Table {
        let mut table = headed("noise", &["AUC of the oracle", "best alternative", "its AUC"]);
        for std in STDS {
            let keep = |q: &Question| ordinary(pair)(q) && q.condition.std == std;
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
    ) -> (&str, String) {
        let all = self.alternatives().map(|name| (name, self.auc(name, keep)));
        let best = all
            .filter(|(_, auc)| !auc.value.is_nan())
            .max_by(|(_, a), (_, b)| a.value.total_cmp(&b.value));
        best.map_or(("none", "–".into()), |(name, auc)| (name, auc.to_string()))
    }

    fn row(
        &self,
        name: &str,
        method: &str,
        keep: impl Fn(&Question) -> bool + Copy,
    ) -> Vec<String> {
        let judged = Judged::pick(self, &[method], keep);
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

    /// The AUC of a method on the questions it answers.
    pub(super) fn auc(&self, method: &str, keep: impl Fn(&Question) -> bool) -> Estimate {
        Judged::pick(self, &[method], keep).estimate(method, Measure::Auc)
    }
}

/// A table for rows as [`Answers::row`] makes them, with more at their ends.
fn headed(first: &str, more: &[&str]) -> Table {
    let rest =
        ["AUC", "AUC near", "Brier", "ECE (by chance)", "false stops at 1 % misses", "at 5 %"];
    Table::new([&[first], &rest[..], more].concat())
}
