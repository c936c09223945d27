//! Whether families agree on what the same evidence means.

use super::{OURS, judged::Judged, tables::ordinary};
use crate::{
    answers::{Answers, Pair, Question},
    measures::Logistic,
    page::Section,
    table::Table,
};

const INTRODUCTION: &str = "A logistic regression of the truth on the log odds that were stated, for \
every ordinary family by itself; its odds come from fits without it. With a slope of 1 and a shift of \
0 the family is as all the others; a positive shift says that more of its poses collide than stated.";

/// A row for every ordinary family.
pub(super) fn section(answers: &Answers) -> Section {
    let mut table = Table::new(["family", "pair", "slope", "shift at even odds"]);
    for family in answers.families() {
        for pair in Pair::ALL {
            let keep = |q: &Question| q.family == family && ordinary(pair)(q);
            if let Some(fitted) = fit(answers, keep) {
                let numbers = [fitted.slope, fitted.intercept].map(|number| format!("{number:.2}"));
                table.row([family, pair.name()].map(String::from).into_iter().chain(numbers));
            }
        }
    }
    Section::new("Do families agree?").text(INTRODUCTION).text(table)
}

/// `None` where there are no answers, or all alike.
fn fit(answers: &Answers, keep: impl Fn(&Question) -> bool + Copy) -> Option<Logistic> {
    /// Odds beyond this are as good as certain, and single answers there would settle the fit.
    const MOST: f64 = 6.0;
    let judged = Judged::pick(answers, &[OURS], keep);
    let log_odds = |p: f64| (p / (1.0 - p)).ln().clamp(-MOST, MOST);
    let stated: Option<Vec<f64>> =
        judged.said(OURS).iter().map(|said| Some(log_odds(said.probability?))).collect();
    let truths: Vec<bool> = judged.questions().iter().map(|q| q.collides).collect();
    Logistic::fit(&stated?, &truths).ok()
}
