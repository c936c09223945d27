//! The search along a path: stretches are bounded, and those left open halved, least certain first.

use std::collections::BinaryHeap;
use std::time::{Duration, Instant};

use crate::body::BodyRef;
use crate::classifier::Clock;
use crate::doubt::undecided::Undecided;
use crate::error::QueryError;
use crate::query::Query;
use crate::report::Verdict;
use crate::stats::Stats;

use super::bound::Drifting;
use super::interval::Interval;
use super::path::Path;
use super::swept::{AlongPath, Reached, SweepStats, Swept};
use super::tested::Tested;

impl Query {
    /// How likely the surfaces behind two bodies collide anywhere along a path of `b`, and where that
    /// first exceeds the accept threshold.
    ///
    /// Nothing between poses is missed: over a stretch of the path the probability is bounded by what
    /// [`Self::run`] would find at its middle if every piece of surface came as near, and crossed as
    /// clearly, as the motion lets it. Stretches whose bound is not below the reject threshold are
    /// halved, down to `tolerance` as a share of the path; what is open then stays in the bounds.
    /// Poses that the path leads through are asked about where they may matter.
    ///
    /// What [`Self::run`] says of surface that no point stands for holds here too. A deadline
    /// counts for the sweep, and for each pose.
    ///
    /// ```
    /// use cloudtouch::geom::{Point3, PointCloud, Pose, Vector3};
    /// use cloudtouch::noise::SensorModel;
    /// use cloudtouch::{Cloud, CloudSettings, Path, Query, QuerySettings, Verdict};
    ///
    /// let sheet = |z: f64| -> Vec<Point3> {
    ///     (0..400).map(|i| Point3::new(0.01 * (i % 20) as f64, 0.01 * (i / 20) as f64, z)).collect()
    /// };
    /// let settings = CloudSettings::new(SensorModel::Isotropic { std: 0.001 });
    /// let prepare = |z| Cloud::prepare(&PointCloud::from_points(sheet(z)), &settings);
    /// let (table, plate) = (prepare(0.0)?, prepare(0.0)?);
    /// let query = Query::new(QuerySettings::default())?;
    /// let at = |x: f64, z: f64| Pose::from_translation(Vector3::new(x, 0.0, z));
    ///
    /// let slide = Path::linear(&at(0.0, 0.05), &at(0.1, 0.05))?;
    /// assert_eq!(query.sweep(&table, &plate, &slide, 0.01)?.certified_free_until, 1.0);
    /// // Aslant through the table in one step: free at both ends.
    /// let aslant = |z: f64| Pose::from_translation_rpy(Vector3::new(0.0, 0.0, z), [0.7, 0.0, 0.0]);
    /// let drop = Path::linear(&aslant(0.05), &aslant(-0.2))?;
    /// let swept = query.sweep(&table, &plate, &drop, 0.01)?;
    /// let first = swept.first.expect("it goes through the table");
    /// // Its lower edge is at the table after 5 of 25 cm.
    /// assert!((0.18..0.35).contains(&first.at.share) && swept.verdict == Verdict::InCollision);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// When the tolerance is not between 0 and 1, and those of [`Self::run`].
    pub fn sweep<'a>(
        &self,
        a: impl Into<BodyRef<'a>>,
        b: impl Into<BodyRef<'a>>,
        path: &Path,
        tolerance: f64,
    ) -> Result<Swept, QueryError> {
        if !(tolerance > 0.0 && tolerance < 1.0) {
            return Err(QueryError::Tolerance { value: tolerance });
        }
        let start = Instant::now();
        let bodies = (a.into(), b.into());
        let segments = path.segments() as f64;
        let begin = ask(self, bodies, path, (0, 0.0))?;
        let mut sweep = Sweep {
            query: self,
            bodies,
            path,
            clock: self.clock(start),
            tested: Tested::of(&begin, self.settings(), tolerance * segments),
            stats: Stats::default(),
            poses: 0,
            stretches: 0,
        };
        sweep.count(&begin);
        let intervals = sweep.look_along()?;
        Ok(sweep.answer(intervals, start.elapsed()))
    }
}

fn ask(
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

struct Sweep<'a> {
    query: &'a Query,
    bodies: (BodyRef<'a>, BodyRef<'a>),
    path: &'a Path,
    clock: Clock,
    tested: Tested,
    stats: Stats,
    poses: usize,
    stretches: usize,
}

impl Sweep<'_> {
    /// Stretches that together are the whole path, in no order.
    fn look_along(&mut self) -> Result<Vec<Interval>, QueryError> {
        let mut whole = Vec::with_capacity(self.path.segments());
        for segment in 0..self.path.segments() {
            whole.push(self.bounded(segment, [0.0, 1.0])?);
        }
        // The poses that were given: no halving comes by them, and whoever asks about these alone knows more.
        for (before, after) in whole.iter().zip(&whole[1..]) {
            let is_wanted = [before, after].iter().any(|at| self.tested.is_wanted(at));
            if is_wanted && before.end() < self.tested.end() {
                self.test(before.segment, 1.0)?;
            }
        }
        if whole.iter().any(|interval| self.tested.is_wanted(interval)) {
            self.test(self.path.segments() - 1, 1.0)?;
        }
        let mut waiting = BinaryHeap::from(whole);
        let mut looked_at = Vec::new();
        while !waiting.is_empty() {
            self.halve(&mut waiting, &mut looked_at)?;
            waiting.extend(self.close(&mut looked_at)?);
        }
        Ok(looked_at)
    }

    /// Halves stretches until none that wait is wanted.
    fn halve(
        &mut self,
        waiting: &mut BinaryHeap<Interval>,
        looked_at: &mut Vec<Interval>,
    ) -> Result<(), QueryError> {
        while let Some(interval) = waiting.pop() {
            if self.clock.is_over()
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
            if !may_be_free {
                self.test(segment, middle)?;
            }
            let first = self.half(&interval, [from, middle], is_open)?;
            if may_be_free && !self.tested.is_free(&first) {
                self.test(segment, middle)?;
            }
            waiting.push(first);
            waiting.push(self.half(&interval, [middle, to], is_open)?);
        }
        Ok(())
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

    fn test(&mut self, segment: usize, t: f64) -> Result<(), QueryError> {
        let asked = ask(self.query, self.bodies, self.path, (segment, t))?;
        self.count(&asked);
        self.tested.add(asked);
        Ok(())
    }

    fn count(&mut self, asked: &AlongPath) {
        self.poses += 1;
        self.stats.nodes_visited += asked.report.stats.nodes_visited;
        self.stats.leaf_pairs += asked.report.stats.leaf_pairs;
        self.stats.kernel_solves += asked.report.stats.kernel_solves;
    }

    fn bounded(&mut self, segment: usize, times: [f64; 2]) -> Result<Interval, QueryError> {
        let cut =
            self.tested.cut(&Interval { segment, times, upper: 1.0, cut: 1.0, is_doubtful: false });
        self.bounded_by(cut, segment, times)
    }

    fn bounded_by(
        &mut self,
        cut: f64,
        segment: usize,
        times: [f64; 2],
    ) -> Result<Interval, QueryError> {
        let (a, b) = self.bodies;
        let leg = self.path.leg(segment);
        let mut interval = Interval { segment, times, upper: 1.0, cut: 1.0, is_doubtful: false };
        if interval.end() >= self.tested.end() {
            // It holds the pose that exceeds the threshold: nothing is left to bound.
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
            let at = segment as f64 + interval.middle();
            let shapes = (a.shape(), b.shape());
            let is_clear = drifting.is_clear(self.query, interval.upper);
            let (doubt, warnings) = self.query.terms().doubt_at(shapes, &a_from_b, is_clear);
            interval.is_doubtful = doubt.is_some();
            if interval.is_doubtful {
                self.tested.not_free_from = self.tested.not_free_from.min(at);
            }
            self.tested.misgivings.add(at, doubt, &warnings);
        }
        Ok(interval)
    }

    fn answer(self, looked_at: Vec<Interval>, elapsed: Duration) -> Swept {
        let Self { tested, stats, poses, stretches, .. } = self;
        let settings = self.query.settings();
        let segments = self.path.segments() as f64;
        let mut intervals = looked_at;
        intervals.sort_by(|p, q| p.start().total_cmp(&q.start()));
        let is_free = |interval: &&Interval| {
            interval.upper < settings.reject && interval.end() < tested.not_free_from
        };
        let certified = intervals.iter().take_while(is_free).last().map_or(0.0, Interval::end);
        let open = intervals.iter().find(|interval| interval.upper > settings.accept);
        let not_before = open.map_or(f64::INFINITY, Interval::start).min(tested.end()) / segments;
        let largest = intervals.iter().map(|interval| interval.upper).fold(0.0, f64::max);
        let doubt = tested.misgivings.earliest();
        let highest = if doubt.is_some() { 1.0 } else { largest.max(tested.bounds[1]) };
        let known = tested.most_probable.report.collision_probability;
        let verdict = if tested.first.is_some() {
            Verdict::InCollision
        } else if certified >= segments {
            Verdict::Free
        } else if doubt.is_some() || known < settings.reject {
            Verdict::Undecided
        } else {
            Verdict::Uncertain
        };
        Swept {
            bounds: [tested.bounds[0], highest],
            verdict,
            undecided_by: (verdict == Verdict::Undecided)
                .then(|| doubt.unwrap_or(Undecided::Bounds)),
            warnings: tested.misgivings.into_warnings(),
            most_probable: tested.most_probable,
            first: tested.first.map(|at| Reached { at, not_before }),
            certified_free_until: certified / segments,
            stats: SweepStats {
                poses,
                stretches,
                nodes_visited: stats.nodes_visited,
                leaf_pairs: stats.leaf_pairs,
                kernel_solves: stats.kernel_solves,
                query_us: u64::try_from(elapsed.as_micros()).unwrap_or(u64::MAX),
            },
        }
    }
}
