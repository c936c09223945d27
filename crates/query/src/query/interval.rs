//! Between what distances two bodies lie, from how likely they are within margins.

use cloudtouch_geom::{Point3, Pose};

use crate::body::BodyRef;
use crate::error::QueryError;
use crate::placement::boxes;
use crate::report::Report;

use super::run::Query;
use super::within::Within;

/// The ends of an interval are told this well, relative to themselves.
const PRECISION: f64 = 1e-3;
/// Nothing is told finer, m.
const FINEST: f64 = 1e-5;

impl Query {
    /// Between what distances (m) the surfaces lie with a probability of `share`: a central interval, its ends the
    /// margins that the bounds of [`Self::within`] leave so likely. The first is 0 where a collision alone is, or may be: where nothing is known of what
    /// a camera did not see, nor of how far off it is.
    ///
    /// The nearest of many pieces that face each other count, so that surfaces are told nearer than they are:
    /// the true distance is hardly ever below the first, and beyond the second more often than it says.
    ///
    /// # Errors
    /// When the share is not between 0 and 1, and those of [`Self::run`].
    pub fn clearance_interval<'a>(
        &self,
        a: impl Into<BodyRef<'a>>,
        b: impl Into<BodyRef<'a>>,
        a_from_b: &Pose,
        share: f64,
    ) -> Result<[f64; 2], QueryError> {
        if !(share > 0.0 && share < 1.0) {
            return Err(QueryError::Share { value: share });
        }
        let bodies = (a.into(), b.into());
        let this = self.with_probability().begun_now();
        let report = this.run(bodies.0, bodies.1, a_from_b)?;
        this.interval(bodies, a_from_b, &report, share)
    }

    /// The answers to [`Self::within`] and [`Self::clearance_interval`], by one query.
    ///
    /// # Errors
    /// Those of both.
    pub fn nearness<'a>(
        &self,
        a: impl Into<BodyRef<'a>>,
        b: impl Into<BodyRef<'a>>,
        a_from_b: &Pose,
        margin: f64,
        share: f64,
    ) -> Result<(Report, Within, [f64; 2]), QueryError> {
        if !(share > 0.0 && share < 1.0) {
            return Err(QueryError::Share { value: share });
        }
        let bodies = (a.into(), b.into());
        let this = self.with_probability().begun_now();
        let (report, within) = this.within(bodies.0, bodies.1, a_from_b, margin)?;
        let interval = this.interval(bodies, a_from_b, &report, share)?;
        Ok((report, within, interval))
    }

    fn interval(
        &self,
        bodies: (BodyRef<'_>, BodyRef<'_>),
        a_from_b: &Pose,
        report: &Report,
        share: f64,
    ) -> Result<[f64; 2], QueryError> {
        let below = 0.5 * (1.0 - share);
        let of = |wanted, of: fn([f64; 2]) -> f64| {
            self.margin_of(bodies, a_from_b, wanted, |margin| {
                Ok(of(self.beyond_collision(bodies, a_from_b, margin, report)?.bounds))
            })
        };
        // What is not known may be either: nearer than the first end, and farther than the second.
        let ([low, _], [_, high]) =
            (of(below, |[_, most]| most)?, of(1.0 - below, |[least, _]| least)?);
        Ok([low, high.max(low)])
    }

    /// The least margin within which the bodies are as likely as wanted: it is between these.
    fn margin_of(
        &self,
        bodies: (BodyRef<'_>, BodyRef<'_>),
        a_from_b: &Pose,
        wanted: f64,
        likely: impl Fn(f64) -> Result<f64, QueryError>,
    ) -> Result<[f64; 2], QueryError> {
        let is_likely = |margin: f64| Ok::<_, QueryError>(likely(margin)? >= wanted);
        if is_likely(0.0)? {
            return Ok([0.0; 2]);
        }
        // Beyond the far corners of both boxes there is no surface: there doubling ends.
        let most = span(boxes(bodies.0.shape(), bodies.1.shape(), a_from_b));
        let (mut low, mut high) = (0.0, FINEST);
        while !is_likely(high)? {
            if high > most {
                return Ok([most; 2]);
            }
            (low, high) = (high, 4.0 * high);
        }
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
}

/// The longest way from a corner of the boxes of both bodies to another, m.
fn span([[low, high], [low_of_b, high_of_b]]: [[Point3; 2]; 2]) -> f64 {
    (high.sup(&high_of_b) - low.inf(&low_of_b)).norm()
}
