//! The search along a path: stretches are bounded, and those left open halved, least certain first.

use std::collections::BinaryHeap;

use crate::body::BodyRef;
use crate::classifier::Clock;
use crate::error::QueryError;
use crate::query::Query;
use crate::stats::Stats;

use super::interval::Interval;
use super::path::Path;
use super::tested::Tested;

/// So many poses beside the first are asked about before anything is bounded, unless more are given: most paths
/// that are not free are not so there, and each takes a quarter of what the bound of a free path does.
const LOOKED_AHEAD: usize = 2;

/// A search along a path, and what it knows.
pub(super) struct Sweep<'a> {
    pub query: &'a Query,
    pub bodies: (BodyRef<'a>, BodyRef<'a>),
    pub path: &'a Path,
    pub clock: Clock,
    pub tested: Tested,
    pub stats: Stats,
    pub poses: usize,
    pub stretches: usize,
}

impl Sweep<'_> {
    /// Stretches that together are the whole path, in no order.
    pub(super) fn look_along(&mut self) -> Result<Vec<Interval>, QueryError> {
        self.look_ahead()?;
        if self.knows_enough() || self.clock.is_over() {
            return Ok((0..self.path.segments()).map(Interval::unknown).collect());
        }
        let mut whole = Vec::with_capacity(self.path.segments());
        for segment in 0..self.path.segments() {
            whole.push(self.bounded(segment, [0.0, 1.0])?);
        }
        // The poses that were given: no halving comes by them, and whoever asks about these alone knows more.
        for (before, after) in whole.iter().zip(&whole[1..]) {
            let is_wanted = [before, after].iter().any(|at| self.tested.is_wanted(at));
            if is_wanted && before.end() < self.tested.end() && !self.clock.is_over() {
                self.test(before.segment, 1.0)?;
            }
        }
        let is_left_to_halving = whole.iter().all(|interval| self.is_open_path(interval));
        if !is_left_to_halving && whole.iter().any(|interval| self.tested.is_wanted(interval)) {
            self.test(self.path.segments() - 1, 1.0)?;
        }
        let mut waiting = BinaryHeap::from(whole);
        let mut looked_at = Vec::new();
        while !waiting.is_empty() {
            self.halve(&mut waiting, &mut looked_at)?;
            if !self.knows_enough() {
                waiting.extend(self.close(&mut looked_at)?);
            }
        }
        Ok(looked_at)
    }

    /// Where no more is wanted than whether the path is free: asks about the poses given, and some between them,
    /// until one is not. It costs little beside a bound, and tells it of most paths that are not.
    fn look_ahead(&mut self) -> Result<(), QueryError> {
        if self.query.settings().decided_above().is_none() {
            return Ok(());
        }
        let segments = self.path.segments();
        let mut parts = 1;
        while parts == 1 || segments * parts <= LOOKED_AHEAD {
            // With two parts and more the new ones are odd: the ends of all others were asked about.
            let new = (1..=parts).step_by(2).map(|k| k as f64 / parts as f64);
            for (segment, t) in (0..segments).flat_map(|s| new.clone().map(move |t| (s, t))) {
                if self.knows_enough() || self.clock.is_over() {
                    return Ok(());
                }
                self.test(segment, t)?;
            }
            parts *= 2;
        }
        Ok(())
    }

    /// Whether no more is wanted than that the path is not free, which is known.
    pub(super) fn knows_enough(&self) -> bool {
        self.query.settings().decided_above().is_some() && self.tested.not_free_from.is_finite()
    }

    /// Halves stretches until none that wait is wanted.
    fn halve(
        &mut self,
        waiting: &mut BinaryHeap<Interval>,
        looked_at: &mut Vec<Interval>,
    ) -> Result<(), QueryError> {
        while let Some(interval) = waiting.pop() {
            if self.clock.is_over()
                || self.knows_enough()
                || !self.tested.is_wanted(&interval)
                || self.tested.is_left(&interval)
            {
                looked_at.push(interval);
                continue;
            }
            if interval.upper == 1.0 && interval.cut < self.tested.cut(&interval) {
                // More than it was looked for may be little enough now.
                waiting.push(self.bounded(interval.segment, interval.times)?);
                continue;
            }
            let Interval { segment, times: [from, to], .. } = interval;
            let middle = interval.middle();
            let is_open = self.tested.is_known_open(&interval);
            // Where all of the first half is free, so is the pose at its end.
            let may_be_free = self.tested.may_be_free(&interval);
            let is_path = self.is_open_path(&interval);
            if !may_be_free {
                self.test(segment, middle)?;
            }
            let first = self.half(&interval, [from, middle], is_open)?;
            if may_be_free && !self.tested.is_free(&first) {
                self.test(segment, middle)?;
            }
            let second = self.half(&interval, [middle, to], is_open)?;
            // The last of the poses that were given: as free as the rest, or asked about for who asks about these.
            if is_path && ![&first, &second].iter().all(|half| self.tested.is_free(half)) {
                self.test(segment, to)?;
            }
            waiting.extend([first, second]);
        }
        Ok(())
    }

    /// Whether it is all of the path, which may be free.
    fn is_open_path(&self, interval: &Interval) -> bool {
        self.path.segments() == 1 && interval.length() == 1.0 && self.tested.may_be_free(interval)
    }

    /// A half of a stretch. What cannot matter any more keeps the bound of the whole; what waits for
    /// [`Self::close`] has none.
    fn half(
        &mut self,
        whole: &Interval,
        times: [f64; 2],
        is_open: bool,
    ) -> Result<Interval, QueryError> {
        let half = Interval { times, ..*whole };
        if half.start() >= self.tested.end() {
            return Ok(half);
        }
        let unbounded = Interval { upper: 1.0, cut: 0.0, is_doubtful: false, ..half };
        match !is_open && self.tested.is_left(&unbounded) {
            true => Ok(unbounded),
            false => self.bounded(whole.segment, times),
        }
    }

    /// Bounds all that is unknown, by the accept threshold: stretches beside one another as one, fewer of
    /// them where that is too much. Those that have to be halved are given back.
    fn close(&mut self, looked_at: &mut Vec<Interval>) -> Result<Vec<Interval>, QueryError> {
        looked_at.sort_by(|p, q| p.start().total_cmp(&q.start()));
        let all = std::mem::take(looked_at);
        let mut bounded = Vec::new();
        let runs = all.chunk_by(|p, q| self.tested.may_join(p, q)).map(<[_]>::to_vec);
        let mut runs: Vec<Vec<Interval>> = runs.collect();
        while let Some(mut run) = runs.pop() {
            let (first, last) = (run[0], run[run.len() - 1]);
            if !self.tested.is_unknown(&first) {
                looked_at.extend(run);
                continue;
            }
            let accept = self.query.settings().accept;
            let times = [first.times[0], last.times[1]];
            let joined = self.bounded_by(accept, first.segment, times)?;
            if joined.upper <= accept || run.len() == 1 {
                bounded.push(joined);
                continue;
            }
            runs.push(run.split_off(run.len().div_ceil(2)));
            runs.push(run);
        }
        let (again, done): (Vec<_>, Vec<_>) =
            bounded.into_iter().partition(|interval| self.tested.is_to_halve(interval));
        looked_at.extend(done);
        Ok(again)
    }
}
