//! How deep the object is in, and how well that is known.

use cloudtouch_geom::Vector3;

use super::along::{FINEST, PRECISION, Way};
use super::overlap::Overlap;
use super::shortest::SHORTER;
use crate::body::BodyRef;
use crate::error::QueryError;
use crate::query::run::Query;
use crate::report::Report;

/// How likely a number is above a standard deviation below its mean, above that, and above one more.
const LIKELY: [f64; 3] = [0.841_344_746, 0.5, 0.158_655_254];

impl Overlap<'_> {
    /// The shortest way until a collision is as likely as not, and the standard deviation of its length, m:
    /// from the report `here`, along the way out or another of the directions that were looked along.
    pub(super) fn depth(
        &self,
        query: &Query,
        here: &Report,
        out: &Way,
        looked_along: &[Vector3],
    ) -> Result<(Way, f64), QueryError> {
        // No guarantees but expectations: bounds, which are wider the less is known, would only add to them.
        let [nearer, even, farther] = LIKELY.map(|likely| Overlap {
            query: query.deciding(likely),
            told: |report| report.collision_probability,
            ..*self
        });
        // The way that is shortest until then may be another.
        let mut depth = even.way_out(here, out.direction, out.free)?;
        if depth.free > FINEST {
            for direction in looked_along {
                depth = even.shortened(depth, *direction, &[SHORTER])?;
            }
            depth = even.between(even.turned_aside(depth)?, PRECISION)?;
        }
        let [near, far] = [nearer, farther]
            .map(|until| until.way_out(here, depth.direction, depth.free).map(|way| way.free));
        // Where the probability leaps, that it does is known to what the way was told to.
        let told_to = if self.is_of_exact() { 0.0 } else { depth.free - depth.stuck };
        Ok((depth, 0.5 * (far? - near?).max(told_to)))
    }

    /// Whether both bodies are meshes, of which nothing is uncertain.
    fn is_of_exact(&self) -> bool {
        matches!(self.bodies, (BodyRef::Mesh(_), BodyRef::Mesh(_)))
    }

    /// The way out, or the one that is shortest until a collision is as likely as not where that is out sooner:
    /// places past something else, as between the legs of a table, are met by chance.
    pub(super) fn or_along(&self, out: Way, depth: &Way) -> Result<Way, QueryError> {
        if depth.free >= SHORTER * out.free || depth.direction == out.direction {
            return Ok(out);
        }
        // Exact bodies are out where they are no longer in.
        let shares = [depth.free / out.free, SHORTER];
        self.between(self.shortened(out, depth.direction, &shares)?, PRECISION)
    }
}
