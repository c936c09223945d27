//! The figures of the pages.

use super::{ORACLE, OURS, judged::Judged, plan::STDS, tables::Answered};
use crate::{
    answers::{Kind, Pair, Question},
    figure::{Axis, Figure, Panel, Series},
    measures::{Measure, reliability, roc},
};

/// Queries in the figure after the paper's figure 4.
const QUERIES: usize = 100;

/// Observed rate of collisions against stated probability, each kind of pair in a panel.
pub(super) fn reliability_figure(answered: &Answered<'_>) -> Figure {
    let panel = |pair: Pair| {
        let axes = (Axis::unit("stated probability"), Axis::unit("share that collides"));
        let mut panel = Panel::new(axes.0, axes.1)
            .title(pair.name())
            .series(Series::guide([(0.0, 0.0), (1.0, 1.0)]));
        let kinds =
            [("ordinary scenes", Kind::Ordinary), ("adversarial scenes", Kind::Adversarial)];
        for (name, kind) in kinds {
            let judged = Judged::pick(answered.answers, &[OURS], Answered::is_of(pair, kind));
            let bins = judged.sample(OURS).map(reliability).unwrap_or_default();
            panel = panel.series(Series::curve(name, bins.iter().map(|b| (b.mean, b.observed))));
        }
        panel
    };
    let [clouds, mesh] = Pair::ALL.map(panel);
    Figure::new("What is stated and what happens").panel(clouds).panel(mesh)
}

/// Collisions found against free poses stopped, on ordinary scenes.
pub(super) fn roc_figure(answered: &Answered<'_>) -> Figure {
    let panel = |pair: Pair| {
        let axes = (Axis::unit("free poses stopped"), Axis::unit("collisions found"));
        let mut panel = Panel::new(axes.0, axes.1).title(pair.name());
        for name in answered.answers.names() {
            let judged =
                Judged::pick(answered.answers, &[name], Answered::is_of(pair, Kind::Ordinary));
            if let Some(sample) = judged.sample(name).filter(|_| judged.counts().1 > 0) {
                panel = panel.series(Series::line(name, thinned(&roc(sample))));
            }
        }
        panel
    };
    let [clouds, mesh] = Pair::ALL.map(panel);
    Figure::new("ROC, ordinary scenes").panel(clouds).panel(mesh)
}

/// A few hundred places of a curve do for a figure.
fn thinned(curve: &[(f64, f64)]) -> Vec<(f64, f64)> {
    let step = (curve.len() / 200).max(1);
    let last = curve.last().copied();
    curve.iter().copied().step_by(step).chain(last).collect()
}

/// AUC and Brier score against noise, on ordinary scenes.
pub(super) fn noise_figure(answered: &Answered<'_>) -> Figure {
    let mut figure = Figure::new("Ranking and error against noise, ordinary scenes");
    for pair in Pair::ALL {
        for measure in [Measure::Auc, Measure::Brier] {
            let axes = (Axis::linear("noise (mm)"), Axis::linear(&measure.name()));
            let mut panel = Panel::new(axes.0, axes.1).title(pair.name());
            for name in answered.answers.names() {
                let at = |std: f64| {
                    let keep = |q: &Question| {
                        Answered::is_of(pair, Kind::Ordinary)(q) && q.condition.std == std
                    };
                    let judged = Judged::pick(answered.answers, &[name], keep);
                    let sample = judged.sample(name)?;
                    Some((1e3 * std, measure.of(sample, &sample.ones())))
                };
                let places: Vec<(f64, f64)> =
                    STDS.into_iter().filter_map(at).filter(|(_, v)| !v.is_nan()).collect();
                if !places.is_empty() {
                    panel = panel.series(Series::curve(name, places));
                }
            }
            figure = figure.panel(panel);
        }
    }
    figure
}

/// Median query time against what is missing of a perfect ranking, on ordinary scenes.
pub(super) fn speed_figure(answered: &Answered<'_>) -> Figure {
    let panel = |pair: Pair| {
        let axes = (Axis::log("median query (ms)"), Axis::linear("1 − AUC"));
        let mut panel = Panel::new(axes.0, axes.1).title(pair.name());
        for name in answered.answers.names() {
            let keep = |q: &Question| {
                Answered::is_of(pair, Kind::Ordinary)(q) && q.condition.points == 10_000
            };
            let judged = Judged::pick(answered.answers, &[name], keep);
            let Some(sample) = judged.sample(name).filter(|_| judged.counts().0 > 0) else {
                continue;
            };
            let place = (judged.query_ms(name, 0.5), 1.0 - Measure::Auc.of(sample, &sample.ones()));
            panel = panel.series(Series::points(name, [place]).size(6));
        }
        panel
    };
    let [clouds, mesh] = Pair::ALL.map(panel);
    Figure::new("Speed against error, 10,000 points").panel(clouds).panel(mesh)
}

/// After the paper's figure 4: probability against distance at two noises.
pub(super) fn distance_figure(answered: &Answered<'_>) -> Figure {
    let mut figure = Figure::new("Probability against distance, ordinary scenes, two clouds");
    for std in [0.002, 0.01] {
        let keep = |q: &Question| {
            Answered::is_of(Pair::CloudCloud, Kind::Ordinary)(q)
                && q.condition.points == 10_000
                && q.condition.std == std
                && q.signed_distance.abs() < 0.1
        };
        let judged = Judged::pick(answered.answers, &[OURS, ORACLE], keep);
        let step = (judged.counts().0 / QUERIES).max(1);
        let places = |method| {
            let said = judged.questions().iter().zip(judged.said(method)).step_by(step);
            said.map(|(q, s)| (100.0 * q.signed_distance, s.score)).collect::<Vec<_>>()
        };
        let axes = (Axis::linear("signed distance (cm)"), Axis::unit("collision probability"));
        let panel = Panel::new(axes.0, axes.1)
            .title(&format!("noise {} mm", 1e3 * std))
            .series(Series::guide([(0.0, 0.0), (0.0, 1.0)]))
            .series(Series::points(OURS, places(OURS)).opacity(0.7))
            .series(Series::points(ORACLE, places(ORACLE)).opacity(0.4));
        figure = figure.panel(panel);
    }
    figure
}
