//! One query, from two bodies and a pose to a report, whichever path estimates.

use std::time::{Duration, Instant};

use cloudtouch_geom::{Pose, Vector3};

use crate::check::coordinates::bad_entry;
use crate::doubt::undecided::Undecided;
use crate::doubt::warning::Warning;
use crate::error::QueryError;
use crate::judge::MOST_DEVIATIONS;
use crate::mode::Mode;
use crate::report::Report;
use crate::shape::Shape;
use crate::stats::Stats;

use super::doubt::{CLEAR_DEVIATIONS, Doubts};
use super::estimate::{Estimate, Places};
use super::evidence::Evidence;
use super::pool;
use super::terms::Terms;
use super::verdict::Thresholds;

impl Terms {
    /// Asks `estimate` and reports. It is given when the query began, the pose of B's local frame in
    /// that of A, and where to put its evidence.
    pub(crate) fn ask(
        &self,
        (a, b): (Shape<'_>, Shape<'_>),
        a_from_b: &Pose,
        estimate: impl FnOnce(Instant, &Pose, &mut Evidence) -> Result<Estimate, QueryError>,
    ) -> Result<Report, QueryError> {
        let start = Instant::now();
        let span = tracing::debug_span!("query");
        let _entered = span.enter();
        if let Some(value) = bad_entry(a_from_b) {
            return Err(QueryError::Pose { value });
        }
        let local = a.local_from(&b, a_from_b);
        let mut evidence = Evidence::default();
        let mut estimate = estimate(start, &local, &mut evidence)?;
        let is_clear = estimate.evidence.is_some_and(|of| of.deviations >= CLEAR_DEVIATIONS);
        let may_be_free = estimate.probability <= self.accept;
        // What is too late has an upper bound of 1, which leaves it open as it is.
        let is_left = estimate.is_too_late || estimate.probability >= self.doubted_below;
        let Doubts { unseen, warnings, gravest } = match is_left {
            true => Doubts::default(),
            false => self.doubts((a, b), &local, is_clear, may_be_free),
        };
        if gravest.is_some() {
            evidence.widen(1.0);
            estimate.bounds[1] = 1.0;
        }
        let out_of_reach = self.out_of_reach(&estimate);
        let mut report = self.report(evidence, estimate, a.origin(), gravest);
        (report.unseen, report.warnings) = (unseen, warnings);
        report.warnings.extend(out_of_reach);
        let micros = |d: Duration| u64::try_from(d.as_micros()).unwrap_or(u64::MAX);
        report.stats.prepare_us = micros(a.prepare_time() + b.prepare_time());
        report.stats.query_us = micros(start.elapsed());
        tracing::debug!(
            probability = report.collision_probability,
            leaf_pairs = report.stats.leaf_pairs,
            kernel_solves = report.stats.kernel_solves,
            "query"
        );
        Ok(report)
    }

    /// A threshold for free that the two are not below even with nothing near.
    fn out_of_reach(&self, Estimate { probability, evidence, .. }: &Estimate) -> Option<Warning> {
        let is_least = evidence.is_some_and(|of| of.deviations >= MOST_DEVIATIONS);
        (is_least && *probability >= self.reject)
            .then_some(Warning::RejectBelowLeast { reject: self.reject, least: *probability })
    }

    fn report(
        &self,
        mut evidence: Evidence,
        estimate: Estimate,
        origin: Vector3,
        doubt: Option<Undecided>,
    ) -> Report {
        let points = evidence.merge_points();
        let (max_probability, noisy_or_probability) =
            (pool::max(points), pool::noisy_or(points, &self.closeness));
        let Places { mut contacts, clearance, at_least } =
            estimate.places.unwrap_or_else(|| Places {
                contacts: evidence.top_contacts(self.max_contacts),
                clearance: evidence.clearance(self.accept),
                at_least: None,
            });
        for contact in &mut contacts {
            contact.point += origin;
        }
        let stats: Stats = evidence.stats;
        let thresholds = Thresholds { accept: self.accept, reject: self.reject };
        // Where a classifier only revises what geometry tells, one that is not solved leaves nothing out: it keeps
        // the pair from being free.
        let is_told = self.mode == Mode::Calibrated && estimate.probability >= self.reject;
        let unsolved = if is_told { 0 } else { stats.undecided };
        let (verdict, undecided_by) =
            thresholds.decide(estimate.probability, estimate.bounds[1], unsolved, doubt);
        Report {
            collision_probability: estimate.probability,
            bounds: estimate.bounds,
            verdict,
            undecided_by,
            log_likelihood_ratio: estimate.log_likelihood_ratio,
            clearance_m: clearance,
            // What nobody knows of may be nearer.
            clearance_at_least_m: at_least.filter(|_| doubt.is_none()),
            contacts,
            evidence: estimate.evidence,
            unseen: None,
            warnings: Vec::new(),
            stats,
            seed: self.seed,
            mode: self.mode,
            max_probability,
            noisy_or_probability,
            point_probabilities: evidence.point_probabilities(),
        }
    }
}
