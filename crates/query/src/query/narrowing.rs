//! The margin within which two bodies become as likely as wanted, by bisection.

use std::time::Instant;

use cloudtouch_bvh::NodeId;

use crate::error::QueryError;
use crate::judge::MOST_DEVIATIONS;
use crate::search::{Span, least_of_leaves, least_within};

use super::within::BeyondEvidence;

/// The ends of an interval are told this well, relative to themselves.
const PRECISION: f64 = 1e-3;
/// Nothing is told finer, m.
const FINEST: f64 = 1e-5;

pub(super) const LOWER: usize = 0;
pub(super) const UPPER: usize = 1;

/// The margin where a bound of [`Within`](super::within::Within) becomes as large as wanted.
#[derive(Debug, Clone, Copy)]
pub(super) struct End {
    pub wanted: f64,
    /// [`LOWER`] or [`UPPER`].
    pub bound: usize,
}

/// These margins in fewer searches than a query for each: two leaves that are likely within one margin mostly are
/// within the next one too, and then no search is needed; and of a search no more is asked than whether it is likely.
pub(super) struct Narrowing<'a> {
    beyond: BeyondEvidence<'a>,
    /// The leaves that were likely within the least margin so far.
    leaves: Option<[NodeId; 2]>,
}

impl<'a> Narrowing<'a> {
    pub(super) fn of(beyond: BeyondEvidence<'a>) -> Self {
        Self { beyond, leaves: None }
    }

    /// The least margin within which the bodies are as likely as wanted, and are not without one: it is between
    /// these. As by a query for each, to the bit: a margin that is wider than one that is likely is likely too, and
    /// one that is narrower than one that is not is not either.
    pub(super) fn margin_of(&mut self, end: End, most: f64) -> Result<[f64; 2], QueryError> {
        let Some(widest) = around(most, |margin| self.is_likely(end, margin))? else {
            return Ok([most; 2]);
        };
        loop {
            let [low, high] = narrowed(widest, |margin| Ok(self.is_known_likely(end, margin)))?;
            // Where the leaves end being likely, others may be: one search tells, instead of one for each step.
            if low == widest[0] || !self.is_likely(end, low)? {
                return Ok([low, high]);
            }
            // The time is over: what is not known is likely, by no leaves.
            if !self.is_known_likely(end, low) {
                return narrowed(widest, |margin| self.is_likely(end, margin));
            }
        }
    }

    /// Whether it is as likely as wanted within a margin.
    fn is_likely(&mut self, end: End, margin: f64) -> Result<bool, QueryError> {
        if self.is_known_likely(end, margin) {
            return Ok(true);
        }
        let BeyondEvidence { query, bodies, local, .. } = &self.beyond;
        let clock = query.clock(Instant::now());
        let found = least_within(*bodies, local, margin, self.deciding(end, margin), &clock)?;
        let is_likely = self.beyond.probability(found.deviations, margin) >= end.wanted;
        if is_likely {
            self.leaves = found.leaves;
        }
        Ok(is_likely || (end.bound == UPPER && !found.is_complete))
    }

    /// Whether that is so by what is known without a search.
    fn is_known_likely(&self, end: End, margin: f64) -> bool {
        let BeyondEvidence { bodies, local, .. } = &self.beyond;
        let of = |leaves| least_of_leaves(*bodies, local, margin, MOST_DEVIATIONS, leaves);
        let deviations = self.leaves.map_or(MOST_DEVIATIONS, of);
        self.beyond.probability(deviations, margin) >= end.wanted
            || (end.bound == UPPER && self.beyond.may_be_hidden(margin))
    }

    /// The deviations that decide whether it is as likely as wanted within a margin: more than these are not, and
    /// fewer are.
    fn deciding(&self, end: End, margin: f64) -> Span {
        /// Deviations are told apart no finer: what is between is compared by its probability.
        const FINE: f64 = 0.05;
        let [mut enough, mut most] = [-MOST_DEVIATIONS, MOST_DEVIATIONS];
        while most - enough > FINE {
            let middle = 0.5 * (enough + most);
            if self.beyond.probability(middle, margin) >= end.wanted {
                enough = middle;
            } else {
                most = middle;
            }
        }
        Span { most, enough }
    }
}

/// A margin that is not likely and one that is, a few times as wide; none where none up to `most` is.
pub(super) fn around(
    most: f64,
    mut is_likely: impl FnMut(f64) -> Result<bool, QueryError>,
) -> Result<Option<[f64; 2]>, QueryError> {
    let (mut low, mut high) = (0.0, FINEST);
    while !is_likely(high)? {
        if high > most {
            return Ok(None);
        }
        (low, high) = (high, 4.0 * high);
    }
    Ok(Some([low, high]))
}

/// The same, closer together.
pub(super) fn narrowed(
    [mut low, mut high]: [f64; 2],
    mut is_likely: impl FnMut(f64) -> Result<bool, QueryError>,
) -> Result<[f64; 2], QueryError> {
    while high - low > PRECISION * high + FINEST {
        let middle = 0.5 * (low + high);
        if is_likely(middle)? {
            high = middle;
        } else {
            low = middle;
        }
    }
    Ok([low, high])
}
