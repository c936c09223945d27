//! Many poses of one pair of bodies.

use cloudtouch_geom::Pose;
use rayon::prelude::*;

use crate::body::BodyRef;
use crate::error::QueryError;
use crate::report::Report;

use super::run::Query;

impl Query {
    /// [`Self::run`] for every pose of `b`, from its file frame into that of `a`, on all threads of the current
    /// rayon pool, in the order of the poses. An error is that of one pose, and leaves the others alone.
    ///
    /// Apart from times and `leaves_prepared` in the statistics, the reports are the same bits
    /// whatever the number of threads. A deadline is that of each pose; [`Self::begun_now`] makes it that of all.
    #[must_use]
    pub fn run_batch<'a>(
        &self,
        a: impl Into<BodyRef<'a>>,
        b: impl Into<BodyRef<'a>>,
        a_from_b: &[Pose],
    ) -> Vec<Result<Report, QueryError>> {
        let (a, b) = (a.into(), b.into());
        a_from_b.par_iter().map(|pose| self.run(a, b, pose)).collect()
    }
}
