//! How likely two bodies are within a margin of each other.

use std::time::Instant;

use cloudtouch_geom::Pose;
use serde::Serialize;

use crate::body::BodyRef;
use crate::doubt::taken::taken_for_robot;
use crate::doubt::unseen::{Unseen, may_be_unseen_within};
use crate::error::QueryError;
use crate::exact::are_within;
use crate::judge::{ContactEvidence, JudgeOfPair, MOST_DEVIATIONS, log_odds_within, probability};
use crate::report::Report;
use crate::search::least_beyond;

use super::run::Query;

/// How likely two surfaces are within a margin of each other; the collision is the margin of nothing.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Within {
    /// The margin, m.
    pub margin_m: f64,
    /// Probability that the distance of the two underlying surfaces is below the margin.
    pub probability: f64,
    /// Lower and upper bound on it, as [`Report::bounds`]; the probability lies within.
    pub bounds: [f64; 2],
    /// How many standard deviations the nearest pieces of surface are from being within the margin,
    /// from 6 down to −6, which is clearly within it.
    pub deviations: f64,
}

impl Query {
    /// How likely the surfaces behind two bodies are within `margin` metres of each other: the
    /// answer to [`Self::run`], and this.
    ///
    /// Never less likely than a collision, to the bit as likely without a margin, and never less
    /// likely with a larger one. By geometry alone: the classifier, which is asked about the collision, says
    /// nothing of distances. What [`Self::run`] says of surface that no point stands for holds here
    /// too; where the margin reaches into what a depth image did not see, or what a self filter may have taken for
    /// the robot, with as much of the body as may not lie there, the upper bound is 1.
    ///
    /// ```
    /// use cloudtouch::geom::{Point3, PointCloud, Pose, Vector3};
    /// use cloudtouch::noise::SensorModel;
    /// use cloudtouch::{Cloud, CloudSettings, Query, QuerySettings};
    ///
    /// let sheet = |z: f64| -> Vec<Point3> {
    ///     (0..400).map(|i| Point3::new(0.01 * (i % 20) as f64, 0.01 * (i / 20) as f64, z)).collect()
    /// };
    /// let settings = CloudSettings::new(SensorModel::Isotropic { std: 0.001 });
    /// let prepare = |z| Cloud::prepare(&PointCloud::from_points(sheet(z)), &settings);
    /// let (table, plate) = (prepare(0.0)?, prepare(0.05)?);
    /// let query = Query::new(QuerySettings::default())?;
    /// let here = Pose::identity();
    /// let (report, near) = query.within(&table, &plate, &here, 0.03)?;
    /// let (_, far) = query.within(&table, &plate, &here, 0.07)?;
    /// assert!(report.collision_probability < 0.01 && near.probability < 0.01);
    /// assert!(far.probability > 0.9);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// When the margin is negative or not finite, and those of [`Self::run`].
    pub fn within<'a>(
        &self,
        a: impl Into<BodyRef<'a>>,
        b: impl Into<BodyRef<'a>>,
        a_from_b: &Pose,
        margin: f64,
    ) -> Result<(Report, Within), QueryError> {
        if !(0.0..f64::INFINITY).contains(&margin) {
            return Err(QueryError::Margin { value: margin });
        }
        let (a, b) = (a.into(), b.into());
        let this = self.with_probability().begun_now();
        let report = this.run(a, b, a_from_b)?;
        let within = this.beyond_collision((a, b), a_from_b, margin, &report)?;
        Ok((report, within))
    }

    /// What a margin adds to the report on a pair.
    pub(super) fn beyond_collision(
        &self,
        (a, b): (BodyRef<'_>, BodyRef<'_>),
        a_from_b: &Pose,
        margin: f64,
        report: &Report,
    ) -> Result<Within, QueryError> {
        let known = report.collision_probability;
        let [low, high] = report.bounds;
        let at_least = |least: f64, high: f64, deviations: f64| {
            let bounds = [low.max(least), high.max(least)];
            Within { margin_m: margin, probability: known.max(least), bounds, deviations }
        };
        let local = a.shape().local_from(&b.shape(), a_from_b);
        let Some(evidence) = report.evidence else {
            // Two meshes are exact.
            let is_within = known == 1.0
                || match (report.clearance_m, a, b) {
                    (Some(gap), ..) => gap.mean < margin,
                    (None, BodyRef::Mesh(a), BodyRef::Mesh(b)) => {
                        are_within((a, b), &local, margin)?
                    }
                    (None, ..) => true,
                };
            let (least, deviations) =
                if is_within { (1.0, -MOST_DEVIATIONS) } else { (0.0, MOST_DEVIATIONS) };
            return Ok(at_least(least, high, deviations));
        };
        let deviations = evidence.deviations;
        if margin == 0.0 {
            return Ok(at_least(0.0, high, deviations));
        }
        let beyond = BeyondEvidence::new(self, (a, b), local, evidence);
        let clock = self.clock(Instant::now());
        let found = least_beyond((a, b), &local, margin, &clock)?;
        let is_known = found.is_complete && (high == 1.0 || !beyond.may_be_hidden(margin));
        let high = if is_known { high } else { 1.0 };
        let least = beyond.probability(found.deviations, margin);
        Ok(at_least(least, high, found.deviations.min(deviations)))
    }
}

/// What margins add to the evidence about two bodies.
pub(super) struct BeyondEvidence<'a> {
    pub query: &'a Query,
    pub bodies: (BodyRef<'a>, BodyRef<'a>),
    /// From the local frame of B to that of A.
    pub local: Pose,
    judge: JudgeOfPair,
    evidence: ContactEvidence,
    spacing: f64,
}

impl<'a> BeyondEvidence<'a> {
    pub(super) fn new(
        query: &'a Query,
        (a, b): (BodyRef<'a>, BodyRef<'a>),
        local: Pose,
        evidence: ContactEvidence,
    ) -> Self {
        let judge = query.settings().judge.for_blur(evidence.blur());
        let spacing = a.shape().spacing().max(b.shape().spacing());
        Self { query, bodies: (a, b), local, judge, evidence, spacing }
    }

    /// How likely they are within a margin that the nearest pieces are so many deviations beyond; the fewer, the
    /// likelier.
    pub(super) fn probability(&self, beyond: f64, margin: f64) -> f64 {
        let ContactEvidence { deviations, crossing, extent, scatter_over_spacing, .. } =
            self.evidence;
        let beyond = beyond.min(deviations);
        let by_place = self.judge.log_odds_by_place(beyond, crossing);
        let collision = self.judge.with_extent(by_place, extent);
        let blur = (scatter_over_spacing, self.spacing);
        let log_odds = log_odds_within(beyond, margin, blur, collision);
        probability(log_odds, self.query.settings().prior)
    }

    /// Whether something may be within a margin where nothing was seen, or what was seen is gone.
    pub(super) fn may_be_hidden(&self, margin: f64) -> bool {
        let limits = &self.query.settings().safeguards;
        let shapes = (self.bodies.0.shape(), self.bodies.1.shape());
        let exceeds = |unseen: &Unseen| limits.exceeded_by(unseen).is_some();
        may_be_unseen_within(shapes, &self.local, margin, exceeds)
            || taken_for_robot(shapes, &self.local, margin, limits).is_some()
    }
}
