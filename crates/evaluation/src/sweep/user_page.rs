//! docs/accuracy.md: what a user needs to know.

use std::path::Path;

use super::{
    OURS, figures,
    judged::Judged,
    plan::SEED,
    tables::{Answered, shown},
};
use crate::{
    answers::{Kind, Pair, Question},
    measures::{Measure, observed_within},
    page::{Page, Section},
    table::Table,
};

const INTRODUCTION: &str = "How often is cloudtouch right in scenes as users have them: furnished \
rooms, desks, kitchen counters, bins, workbenches, corridors and stairs? Scenes are generated, so \
that the exact answer is known from their meshes; each family of scenes is judged with constants \
fitted on the other families. Half of the poses collide and half are within 3 cm of contact: far \
harder, and with far more collisions, than what a planner meets. Hard cases by design, other \
methods, families one by one, intervals and targets are in [the full report](lab/accuracy.md); \
[what a probability means](probability.md) says what none of this can show.";

/// Stated probabilities, in ranges.
const STATED: [[f64; 2]; 5] = [[0.0, 0.1], [0.1, 0.4], [0.4, 0.6], [0.6, 0.9], [0.9, 1.01]];

pub(super) fn page(root: &Path, arguments: &str, answered: &Answered<'_>) -> Page {
    let names = (("accuracy", "Accuracy"), ("sweep", arguments));
    let mut page = Page::new(names.0, names.1, INTRODUCTION, root, SEED);
    page.section(
        Section::new("How well it tells collisions from free poses")
            .text(
                "AUC: how often a collision gets a higher probability than a free pose (near: of \
                 poses within 3 cm of contact). Brier: mean squared error of the probability. False \
                 stops: share of free poses stopped by a threshold that misses 5 % of the collisions. \
                 The alternative is the best by AUC of: distance of the points, distance of the \
                 smoothed points, 1 cm boxes, a plain support vector machine, the paper's method.",
            )
            .text(ranking(answered)),
    );
    page.section(
        Section::new("What a stated probability is worth")
            .text("The share of poses that collide, of those with such a stated probability.")
            .text(stated(answered))
            .figure(
                "accuracy-stated",
                "Stated probability against observed rate of collisions",
                figures::reliability_figure(answered),
            ),
    );
    page
}

fn ranking(answered: &Answered<'_>) -> Table {
    let mut table = Table::new([
        "what is asked",
        "noise",
        "AUC",
        "AUC near",
        "Brier",
        "false stops",
        "best alternative, its AUC",
    ]);
    for pair in Pair::ALL {
        for std in super::plan::STDS {
            let keep =
                |q: &Question| Answered::is_of(pair, Kind::Ordinary)(q) && q.condition.std == std;
            let stops = Measure::FalseStops(0.05);
            let measured = Judged::pick(answered.answers, &[OURS], keep).measure(&[
                Measure::Auc,
                Measure::Brier,
                stops,
            ]);
            let is_near = |q: &Question| keep(q) && super::tables::is_near(q);
            let near = Judged::pick(answered.answers, &[OURS], is_near).measure(&[Measure::Auc]);
            let (best, auc) = answered.best_alternative(keep);
            table.row([
                pair.name().to_owned(),
                format!("{} mm", 1e3 * std),
                shown(measured.estimate(OURS, Measure::Auc)),
                shown(near.estimate(OURS, Measure::Auc)),
                shown(measured.estimate(OURS, Measure::Brier)),
                shown(measured.estimate(OURS, stops)),
                format!("{best}, {}", shown(auc)),
            ]);
        }
    }
    table
}

fn stated(answered: &Answered<'_>) -> Table {
    let range = |[low, high]: [f64; 2]| format!("{low:.1} to {:.1}", high.min(1.0));
    let mut table = Table::new(std::iter::once("stated".to_owned()).chain(STATED.map(range)));
    for pair in Pair::ALL {
        let judged = Judged::pick(answered.answers, &[OURS], Answered::is_of(pair, Kind::Ordinary));
        let cell = |[low, high]: [f64; 2]| {
            let bin = judged.sample(OURS).map(|s| observed_within(s, low..high));
            bin.filter(|b| b.count > 0).map_or("–".into(), |b| {
                format!("{:.2} (mean stated {:.2}, {} answers)", b.observed, b.mean, b.count)
            })
        };
        table.row(std::iter::once(format!("{}: collide", pair.name())).chain(STATED.map(cell)));
    }
    table
}
