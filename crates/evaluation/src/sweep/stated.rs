//! What is stated and what happens.

use cloudtouch_testkit::family::Kind;

use super::OURS;
use super::judged::Judged;
use super::tables::is_of;
use crate::answers::{Answers, Pair};
use crate::measures::reliability;
use crate::report::{Axis, Figure, Panel, Series};

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
