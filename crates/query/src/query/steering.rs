//! How far a search looks beyond the nearest places, and when it ends.

use std::cell::Cell;

use crate::judge::probability;
use crate::search::{Course, Found, Looked, Progress, WITH_EXTENT, WITHOUT_EXTENT};

use super::task::Task;

/// What decides after each pair of leaves.
#[derive(Debug)]
pub(super) struct Steering<'t> {
    looked: &'t Looked,
    task: &'t Task<'t>,
    /// Whether nothing beyond the least is to be looked for where the pair is free whatever else is about as near.
    may_narrow: bool,
    /// Whether nothing beyond the least is looked for.
    is_narrow: Cell<bool>,
    /// Whether it was narrow and should not have been.
    has_lost: Cell<bool>,
    told: Cell<Option<Progress>>,
}

impl<'t> Steering<'t> {
    /// Looks at all that may count.
    pub(super) fn wide(looked: &'t Looked, task: &'t Task<'t>) -> Self {
        let [is_narrow, has_lost] = [false, false].map(Cell::new);
        Self { looked, task, may_narrow: false, is_narrow, has_lost, told: Cell::new(None) }
    }

    /// The same, but where no more than the verdict is asked for no farther than it takes to tell that a pair is free.
    pub(super) fn as_asked(looked: &'t Looked, task: &'t Task<'t>) -> Self {
        let may_narrow = task.settings.decided_above().is_some();
        Self { may_narrow, ..Self::wide(looked, task) }
    }

    /// How the search goes on.
    pub(super) fn course(&self, now: Progress) -> Course {
        if self.task.clock.is_over() {
            return Course::Stop;
        }
        // Most pairs of leaves change nothing, and what was not enough is not now.
        if self.told.replace(Some(now)) != Some(now) {
            let given = self.looked.deviations_given(now.deviations);
            if is_enough(given, now.clearness, self.task) {
                return Course::Stop;
            }
            // PERF: where boxes still overlap the nearest places are yet to be found.
            if self.may_narrow && !now.is_amid_overlap {
                let is_free = is_surely_free(given, now.clearness, self.task);
                self.has_lost.set(self.is_narrow.get() && !is_free);
                self.is_narrow.set(is_free);
            }
        }
        match (self.has_lost.get(), self.is_narrow.get()) {
            (true, _) => Course::Stop,
            (false, true) => Course::Further(0.0),
            (false, false) if self.task.judge.counts_extent() => Course::Further(WITH_EXTENT),
            (false, false) => Course::Further(WITHOUT_EXTENT),
        }
    }

    /// Whether the search that it led has looked at all that is needed.
    pub(super) fn has_sufficed(&self, found: &Found<'_>) -> bool {
        // The clearest place may not be the one that was told of last.
        let is_free = || {
            let given = self.looked.deviations_given(found.deviations);
            is_surely_free(given, found.crossings.clearness(), self.task)
        };
        !self.has_lost.get() && (!self.is_narrow(found) || is_free())
    }

    /// Whether the search that it led looked at all that is as near as the nearest, and at nothing else.
    pub(super) fn is_narrow(&self, found: &Found<'_>) -> bool {
        found.is_complete && self.is_narrow.get()
    }
}

/// Whether further evidence, which only raises the odds, could change nothing that is asked.
pub(super) fn is_enough(deviations: f64, clearness: f64, task: &Task<'_>) -> bool {
    let (settings, judge) = (task.settings, &task.judge);
    let of = |log_odds| probability(log_odds, settings.prior);
    let log_odds = judge.log_odds_by_place(deviations, clearness.ln_1p());
    // What the extent and a classifier could take off the odds is taken off.
    let [least, _] = judge.with_any_extent(log_odds);
    let is_above = |decided| of(judge.revise(least, 0.0)) > decided;
    of(least) > settings.stop_above || settings.decided_above().is_some_and(is_above)
}

/// Whether a pair is free, over how many pieces the bodies are about as near and whatever a classifier says.
fn is_surely_free(deviations: f64, clearness: f64, task: &Task<'_>) -> bool {
    let judge = &task.judge;
    let [_, most] = judge.with_any_extent(judge.log_odds_by_place(deviations, clearness.ln_1p()));
    probability(judge.revise(most, f64::INFINITY), task.settings.prior) < task.settings.reject
}
