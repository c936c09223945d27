//! What is stated and what happens.

use cloudtouch_testkit::family::Kind;

use super::OURS;
use super::judged::Judged;
use super::tables::{is_of, ordinary};
use crate::answers::{Answers, Pair};
use crate::measures::{Bin, observed_within, reliability};
use crate::report::{Axis, Figure, Panel, Series, Table};

/// Stated probabilities, in ranges.
const STATED: [[f64; 2]; 5] = [[0.0, 0.1], [0.1, 0.4], [0.4, 0.6], [0.6, 0.9], [0.9, 1.01]];

/// The share of collisions where a probability of a range is stated, on ordinary scenes.
pub(super) fn table(answers: &Answers) -> Table {
    let range = |[low, high]: [f64; 2]| format!("{low:.1} to {:.1}", high.min(1.0));
    let mut table = Table::new(std::iter::once("stated".to_owned()).chain(STATED.map(range)));
    for pair in Pair::ALL {
        let judged = Judged::pick(answers, &[OURS], ordinary(pair));
        let cell = |[low, high]: [f64; 2]| {
            let Bin { mean, observed, count } = observed_within(judged.sample(OURS), low..high);
            if count == 0 {
                return "–".to_owned();
            }
            format!("{observed:.2} (mean stated {mean:.2}, {count} answers)")
        };
        table.row(std::iter::once(format!("{pair}: collide")).chain(STATED.map(cell)));
    }
    table
}

/// Observed rate of collisions against stated probability, each kind of pair in a panel.
pub(super) fn figure(answers: &Answers) -> Figure {
    let panel = |pair: Pair| {
        let mut series = vec![Series::line("", [(0.0, 0.0), (1.0, 1.0)])];
        let kinds = [
            ("ordinary scenes", Kind::Ordinary, [0.36, 0.82]),
            ("adversarial scenes", Kind::Adversarial, [0.6, 0.38]),
        ];
        for (name, kind, [x, y]) in kinds {
            let judged = Judged::pick(answers, &[OURS], is_of(pair, kind));
            let bins = reliability(judged.sample(OURS));
            let curve = Series::curve(name, bins.iter().map(|b| (b.mean, b.observed)));
            series.push(curve.named_at(x, y));
        }
        let (x, y) = (Axis::unit("stated probability"), Axis::unit("share that collides"));
        Panel { title: pair.to_string(), x, y, series }
    };
    Figure::new(
        "Does 0.7 mean seven in ten? On the grey line it does; above it more poses collide than stated",
        Pair::ALL.map(panel),
    )
}
