//! What no pose about a pose exceeds.

use std::time::Instant;

use cloudtouch_geom::Pose;

use crate::body::BodyRef;
use crate::error::QueryError;
use crate::search::reach_around;
use crate::stats::Stats;

use super::run::Query;
use super::settings::Detail;

/// Between samples on a grid a surface comes through another with up to two deviations between the nearest of their
/// samples: nearer than this, it may on the way.
const THROUGH_DEVIATIONS: f64 = 2.5;

impl Query {
    /// A bound on the probability of a collision at any pose about this one at which no point of `b` is farther
    /// than `way` metres from where it is here, however it is turned for that.
    ///
    /// By the fewest deviations and the clearest crossings that any two pieces of surface may have there, of which
    /// the extent and a classifier say the worst: never too low but for what samples do not show, often too high. 1
    /// where the way may leave less than two and a half deviations of a gap, where more than the accept threshold is
    /// likely, where it reaches into what a depth image did not see or what may have been taken for the robot, or
    /// when the deadline is over.
    ///
    /// # Errors
    /// When the way is negative or not finite, and those of [`Self::run`].
    pub fn bound_around<'a>(
        &self,
        a: impl Into<BodyRef<'a>>,
        b: impl Into<BodyRef<'a>>,
        a_from_b: &Pose,
        way: f64,
    ) -> Result<f64, QueryError> {
        let (a, b) = (a.into(), b.into());
        // PERF: how far two meshes are from each other takes far longer to tell than whether they are so near.
        let this = match (a, b) {
            (BodyRef::Mesh(_), BodyRef::Mesh(_)) => self.with_detail(Detail::Verdict).begun_now(),
            _ => self.begun_now(),
        };
        let (report, within) = this.within(a, b, a_from_b, way)?;
        let [_, upper] = within.bounds;
        let Some(evidence) = report.evidence else {
            // Two meshes are exact.
            return Ok(upper);
        };
        if within.deviations < THROUGH_DEVIATIONS || upper == 1.0 {
            return Ok(1.0);
        }
        let settings = self.settings();
        let (judge, clock) = (settings.judge.for_blur(evidence.blur()), this.clock(Instant::now()));
        let at_most = |deviations, clearness| judge.at_most(settings.prior, deviations, clearness);
        let is_enough = |deviations: f64, clearness: f64| {
            deviations < THROUGH_DEVIATIONS
                || at_most(deviations, clearness) > settings.accept
                || clock.is_over()
        };
        let local = a.shape().local_from(&b.shape(), a_from_b);
        let reach = reach_around((a, b), &local, way, is_enough, &mut Stats::default())?;
        if !reach.is_complete || is_enough(reach.deviations, reach.clearness) {
            return Ok(1.0);
        }
        let of_reach = at_most(reach.deviations.min(within.deviations), reach.clearness);
        // The greater of a number and none is the number.
        Ok(if of_reach.is_nan() { 1.0 } else { of_reach.max(upper) })
    }
}
