//! What no pose about a pose exceeds.

use cloudtouch_geom::Pose;

use crate::body::BodyRef;
use crate::error::QueryError;
use crate::judge::ContactEvidence;

use super::run::Query;

/// Between samples on a grid a surface comes through another with up to two deviations between the nearest of their
/// samples: nearer than this, it may on the way.
const THROUGH_DEVIATIONS: f64 = 2.5;

impl Query {
    /// A bound on the probability of a collision at any pose about this one at which no point of `b` is farther
    /// than `way` metres from where it is here, however it is turned for that.
    ///
    /// By the least gap of surface anywhere, less the way, taken for a contact of the likeliest shape of which a
    /// classifier says the worst: never too low but for what samples do not show, often too high. 1 where the way
    /// may leave less than two and a half deviations of a gap, where it reaches into what a depth image did not see, or when the deadline is over.
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
        let (report, within) = self.within(a, b, a_from_b, way)?;
        let [_, upper] = within.bounds;
        let Some(ContactEvidence { noise_over_spacing, .. }) = report.evidence else {
            // Two meshes are exact.
            return Ok(upper);
        };
        if within.deviations < THROUGH_DEVIATIONS {
            return Ok(1.0);
        }
        let judge = self.settings().judge.for_noise(noise_over_spacing);
        Ok(judge.at_most(self.settings().prior, within.deviations, 0.0).max(upper))
    }
}
