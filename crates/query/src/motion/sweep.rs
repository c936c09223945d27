//! How likely two bodies collide anywhere along a path.

use std::time::{Duration, Instant};

use crate::body::BodyRef;
use crate::doubt::undecided::Undecided;
use crate::error::QueryError;
use crate::query::Query;
use crate::report::Verdict;
use crate::stats::Stats;

use super::along::Sweep;
use super::interval::Interval;
use super::path::Path;
use super::stretch::ask;
use super::swept::{Reached, SweepStats, Swept};
use super::tested::Tested;

/// Stretches are this part of a segment at most, whatever the tolerance: of a path of many poses each would be one,
/// and no pose that it leads through asked about.
const LONGEST: f64 = 0.5;

impl Query {
    /// The finest tolerance of [`Self::sweep`], as a share of a path: a millimetre of a hundred metres. Where a
    /// path stays near contact its bounds leave it open however short the stretches are, for they know neither
    /// the extent of a contact nor what a classifier would say; all of that is cut into pieces of the tolerance
    /// then.
    pub const LEAST_TOLERANCE: f64 = 1e-5;

    /// How likely the surfaces behind two bodies collide anywhere along a path of `b`, and where that
    /// first exceeds the accept threshold.
    ///
    /// Nothing between poses is missed: over a stretch of the path the probability is bounded by what
    /// [`Self::run`] would find at its middle if every piece of surface came as near, and crossed as
    /// clearly, as the motion lets it. Stretches whose bound is not below the reject threshold are
    /// halved, down to `tolerance` as a share of the path; what is open then stays in the bounds. On a path
    /// that stays near contact up to 2 / `tolerance` stretches are bounded; so the tolerance may be no finer than
    /// [`Self::LEAST_TOLERANCE`].
    /// Poses that the path leads through are asked about where they may matter. With [`Detail::Free`](crate::Detail::Free)
    /// it ends at the first pose that is found not to be free, wherever on the path, some of which are asked about
    /// before anything is bounded: for who wants no more than to know whether the path is free. So it does with
    /// [`Detail::Verdict`](crate::Detail::Verdict), which tells of that pose whether it is in collision.
    ///
    /// What [`Self::run`] says of surface that no point stands for holds here too. What a depth image did not see
    /// is looked for at poses along a stretch, between which nothing moves by more than a twentieth of the smaller
    /// body, or by more than the tolerance where that is farther: less of it may be passed over. A deadline
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
    /// When the tolerance is below [`Self::LEAST_TOLERANCE`] or above 1, and those of [`Self::run`].
    pub fn sweep<'a>(
        &self,
        a: impl Into<BodyRef<'a>>,
        b: impl Into<BodyRef<'a>>,
        path: &Path,
        tolerance: f64,
    ) -> Result<Swept, QueryError> {
        if !(Self::LEAST_TOLERANCE..=1.0).contains(&tolerance) {
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
            tested: Tested::of(&begin, self.settings(), (tolerance * segments).min(LONGEST)),
            stats: Stats::default(),
            poses: 0,
            stretches: 0,
        };
        sweep.count(&begin);
        let intervals = sweep.look_along()?;
        Ok(sweep.answer(intervals, start.elapsed()))
    }
}

impl Sweep<'_> {
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
            warnings: self
                .path
                .warning()
                .into_iter()
                .chain(tested.misgivings.into_warnings())
                .collect(),
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
