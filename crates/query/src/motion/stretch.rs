//! What is asked about a path: single poses, and stretches as a whole.

use crate::body::BodyRef;
use crate::error::QueryError;
use crate::query::Query;

use super::along::Sweep;
use super::bound::Drifting;
use super::interval::Interval;
use super::path::Path;
use super::swept::AlongPath;

/// Asks about the pose at a time of a segment.
pub(super) fn ask(
    query: &Query,
    (a, b): (BodyRef<'_>, BodyRef<'_>),
    path: &Path,
    (segment, t): (usize, f64),
) -> Result<AlongPath, QueryError> {
    let pose = path.leg(segment).at(t);
    let report = query.run(a, b, &pose)?;
    let share = (segment as f64 + t) / path.segments() as f64;
    Ok(AlongPath { segment, t, share, pose, report })
}

impl Sweep<'_> {
    pub(super) fn test(&mut self, segment: usize, t: f64) -> Result<(), QueryError> {
        let asked = ask(self.query, self.bodies, self.path, (segment, t))?;
        self.count(&asked);
        self.tested.add(asked);
        Ok(())
    }

    pub(super) fn count(&mut self, asked: &AlongPath) {
        self.poses += 1;
        self.stats.nodes_visited += asked.report.stats.nodes_visited;
        self.stats.leaf_pairs += asked.report.stats.leaf_pairs;
        self.stats.kernel_solves += asked.report.stats.kernel_solves;
    }

    pub(super) fn bounded(
        &mut self,
        segment: usize,
        times: [f64; 2],
    ) -> Result<Interval, QueryError> {
        let cut = self.tested.cut(&Interval { times, ..Interval::unknown(segment) });
        self.bounded_by(cut, segment, times)
    }

    pub(super) fn bounded_by(
        &mut self,
        cut: f64,
        segment: usize,
        times: [f64; 2],
    ) -> Result<Interval, QueryError> {
        let (a, b) = self.bodies;
        let leg = self.path.leg(segment);
        let mut interval = Interval { times, ..Interval::unknown(segment) };
        if interval.end() >= self.tested.end() || self.knows_enough() || self.clock.is_over() {
            // It holds the pose that exceeds the threshold, no more is wanted, or there is no time: nothing is left
            // to bound.
            return Ok(interval);
        }
        self.stretches += 1;
        let a_from_b = leg.at(interval.middle());
        let drift = leg.drift(times, &a.shape().origin());
        let drifting = Drifting { bodies: (a, b), a_from_b, drift };
        interval.cut = cut;
        interval.upper =
            drifting.upper_bound(self.query, interval.cut, &self.clock, &mut self.stats)?;
        if interval.upper < self.query.settings().reject {
            match self.is_doubted(&drifting, &interval) {
                Some(is_doubtful) => interval.is_doubtful = is_doubtful,
                // What was not looked at is not free.
                None => interval.upper = 1.0,
            }
        }
        Ok(interval)
    }

    /// Whether something speaks against believing a stretch that reads as free, at its ends or so near to one
    /// another between them that nothing much lies between; `None` where time is over before that is known.
    fn is_doubted(&mut self, drifting: &Drifting<'_>, interval: &Interval) -> Option<bool> {
        let Interval { segment, times: [from, to], .. } = *interval;
        let (a, b) = self.bodies;
        let leg = self.path.leg(segment);
        let is_clear = drifting.is_clear(self.query, interval.upper);
        // What is nearer than the tolerance counts as one place.
        let enough = (interval.length() / self.tested.tolerance()).ceil() as usize + 1;
        let poses = drifting.poses_to_doubt().min(enough.max(2));
        for k in 0..poses {
            if self.clock.is_over() {
                return None;
            }
            let time = from + (to - from) * k as f64 / (poses - 1) as f64;
            let shapes = (a.shape(), b.shape());
            let (doubt, warnings) = self.query.terms().doubt_at(shapes, &leg.at(time), is_clear);
            let at = segment as f64 + time;
            self.tested.misgivings.add(at, doubt, &warnings);
            if doubt.is_some() {
                self.tested.not_free_from = self.tested.not_free_from.min(at);
                return Some(true);
            }
        }
        Some(false)
    }
}
