//! The figures of the pages.

use cloudtouch_testkit::family::Kind;

use super::{
    ORACLE, OURS,
    judged::Judged,
    tables::{is_of, ordinary},
};
use crate::{
    answers::{Answers, Pair, Question},
    figure::{Axis, Figure, Panel, Series},
    measures::reliability,
};

/// Queries in the figure after the paper's figure 4.
const QUERIES: usize = 100;

/// Observed rate of collisions against stated probability, each kind of pair in a panel.
pub(super) fn reliability_figure(answers: &Answers) -> Figure {
    let panel = |pair: Pair| {
        let mut series = vec![Series::line("", [(0.0, 0.0), (1.0, 1.0)])];
        let kinds =
            [("ordinary scenes", Kind::Ordinary), ("adversarial scenes", Kind::Adversarial)];
        for (name, kind) in kinds {
            let judged = Judged::pick(answers, &[OURS], is_of(pair, kind));
            let bins = reliability(judged.sample(OURS));
            series.push(Series::curve(name, bins.iter().map(|b| (b.mean, b.observed))));
        }
        let (x, y) = (Axis::unit("stated probability"), Axis::unit("share that collides"));
        Panel { title: pair.name().into(), x, y, series }
    };
    Figure::new("What is stated and what happens", Pair::ALL.map(panel))
}

/// After the paper's figure 4: probability against distance at two noises.
pub(super) fn distance_figure(answers: &Answers) -> Figure {
    let panel = |std: f64| {
        let keep = |q: &Question| {
            ordinary(Pair::CloudCloud)(q)
                && q.condition.points == 10_000
                && q.condition.std == std
                && q.signed_distance.abs() < 0.1
        };
        let judged = Judged::pick(answers, &[OURS, ORACLE], keep);
        let step = (judged.counts().0 / QUERIES).max(1);
        let points = |method| {
            let said = judged.questions().iter().zip(judged.said(method)).step_by(step);
            Series::points(method, said.map(|(q, s)| (100.0 * q.signed_distance, s.score)))
        };
        let contact = Series::line("", [(0.0, 0.0), (0.0, 1.0)]);
        let (x, y) = (Axis::linear("signed distance (cm)"), Axis::unit("collision probability"));
        let series = vec![contact, points(OURS), points(ORACLE)];
        Panel { title: format!("noise {} mm", 1e3 * std), x, y, series }
    };
    let title = "Probability against distance, ordinary scenes, two clouds";
    Figure::new(title, [0.002, 0.01].map(panel))
}
