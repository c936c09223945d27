//! The evidence of one pair of bodies: the search, and the classifier where that leaves doubt.

use std::cell::Cell;

use cloudtouch_geom::Pose;

use crate::body::BodyRef;
use crate::error::QueryError;
use crate::judge::{ContactEvidence, probability};
use crate::search::{Found, Looked, WITH_EXTENT, WITHOUT_EXTENT, look_inside, search};
use crate::stats::Stats;

use super::classify::{Misclassified, ask_classifier};
use super::settings::Detail;
use super::task::Task;

/// What a probability rests on, and where that was found.
#[derive(Debug)]
pub(super) struct Weighed<'a> {
    pub found: Found<'a>,
    pub looked: Looked,
    /// Without what the classifier says.
    pub of_geometry: ContactEvidence,
    /// Log odds by the place of contact, and by all of that.
    pub by_place: f64,
    pub by_geometry: f64,
    pub misclassified: Misclassified,
    /// Whether what was left out can change nothing.
    pub is_complete: bool,
}

/// Gathers the evidence of two bodies, of which one is a cloud.
pub(super) fn weigh<'a>(
    (a, b): (BodyRef<'a>, BodyRef<'a>),
    a_from_b: &Pose,
    task: &Task<'_>,
    stats: &mut Stats,
) -> Result<Weighed<'a>, QueryError> {
    let (settings, judge) = (task.settings, &task.judge);
    let of = |log_odds| probability(log_odds, settings.prior);
    let decides = |deviations: f64, clearness: f64| {
        let log_odds = judge.log_odds_by_place(deviations, clearness.ln_1p());
        // More evidence only raises the odds; what the extent and a classifier could take off them is taken
        // off.
        let [least, _] = judge.with_any_extent(log_odds);
        let is_decided = || of(judge.revise(least, 0.0)) > settings.accept;
        of(least) > settings.stop_above || settings.detail == Detail::Verdict && is_decided()
    };
    let looked = look_inside((a, b), a_from_b, &task.clock, |deviations| decides(deviations, 0.0));
    stats.nodes_visited += looked.nodes_visited;
    stats.leaves_prepared += looked.leaves_prepared;
    let told = Cell::new(None);
    let is_enough = |deviations: f64, clearness: f64| {
        if task.clock.is_over() {
            return true;
        }
        // Most pairs of leaves change neither, and what was not enough is not now.
        if told.replace(Some((deviations, clearness))) == Some((deviations, clearness)) {
            return false;
        }
        decides(looked.deviations_given(deviations), clearness)
    };
    let further = if judge.counts_extent() { WITH_EXTENT } else { WITHOUT_EXTENT };
    let found = search((a, b), a_from_b, further, is_enough, stats)?;
    let deviations = looked.deviations_given(found.deviations);
    let crossing = found.crossings.clearness().ln_1p();
    let mut of_geometry = ContactEvidence {
        deviations,
        crossing,
        extent: None,
        misclassified: None,
        noise_over_spacing: task.noise_over_spacing,
    };
    let by_place = judge.log_odds_by_place(deviations, crossing);
    let is_complete = found.is_complete && !looked.is_cut_short;
    if is_complete && judge.may_change_with_extent(by_place) {
        of_geometry.extent = Some(found.extent((a, b), a_from_b));
    }
    let by_geometry = judge.with_extent(by_place, of_geometry.extent);

    // Whatever a classifier says, the verdict is the same.
    let is_settled = || {
        of(judge.revise(by_geometry, f64::INFINITY)) < settings.reject
            || of(judge.revise(by_geometry, 0.0)) > settings.accept
    };
    let is_open = judge.is_open(by_geometry);
    let is_wanted = is_open && !(settings.detail == Detail::Verdict && is_settled());
    let misclassified = if is_complete && is_wanted {
        ask_classifier((a, b), a_from_b, &found, by_geometry, task, stats)?
            .or_inside(looked.surely_inside())
    } else {
        Misclassified::NOT_ASKED
    };
    Ok(Weighed { found, looked, of_geometry, by_place, by_geometry, misclassified, is_complete })
}
