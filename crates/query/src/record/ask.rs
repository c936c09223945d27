//! One query, from two bodies and a pose to a report, whichever path estimates.

use std::time::{Duration, Instant};

use cloudtouch_geom::{Pose, Vector3};

use crate::doubts::doubts;
use crate::enclosed::is_enclosed;
use crate::error::QueryError;
use crate::mode::Mode;
use crate::paper::pool;
use crate::range::bad_entry;
use crate::report::{Report, Stats, Verdict};
use crate::safeguards::Safeguards;
use crate::shape::Shape;
use crate::undecided::Undecided;
use crate::unseen::{is_image, unseen};
use crate::warning::{Warning, Which};

use super::closeness::Closeness;
use super::estimate::{Estimate, Places};
use super::evidence::Evidence;

/// Bodies farther apart than so many standard deviations are so, however large these are said to be.
pub(crate) const CLEAR_DEVIATIONS: f64 = 3.0;

/// Whether a warning counts where bodies are so clear of each other, or not known to be: noise that points do
/// not have only makes them seem nearer than they are.
fn counts(warning: &Warning, is_clear: bool) -> bool {
    !(is_clear && matches!(warning, Warning::NoiseOverstated { .. }))
}

/// By what a path turns what it gathered into a report.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Terms {
    pub mode: Mode,
    pub seed: u64,
    pub accept: f64,
    pub reject: f64,
    pub safeguards: Safeguards,
    /// Whether a body may be too far away to be meant: not where there are many, most far from most.
    pub doubts_distance: bool,
    pub max_contacts: usize,
    /// Which points the noisy-or counts.
    pub closeness: Closeness,
}

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
        let unseen = unseen(a, b, &local);
        let warnings = doubts((a, b), &local, unseen.as_ref(), &self.safeguards);
        let is_clear = estimate.evidence.is_some_and(|of| of.deviations >= CLEAR_DEVIATIONS);
        let doubt = if estimate.probability <= self.accept {
            let counting = warnings.iter().filter(|warning| counts(warning, is_clear));
            self.doubt((a, b), &local, counting)
        } else {
            None
        };
        if doubt.is_some() {
            evidence.widen(1.0);
            estimate.bounds[1] = 1.0;
        }
        let mut report = self.report(evidence, estimate, a.origin(), doubt);
        if report.verdict == Verdict::Undecided {
            let solved = report.stats.undecided == 0;
            let of_search = if solved { Undecided::Bounds } else { Undecided::Unsolved };
            report.undecided_by = Some(doubt.unwrap_or(of_search));
        }
        (report.unseen, report.warnings) = (unseen, warnings);
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

    /// The gravest reason not to believe that a pair is free at a pose, if it should read so, and the
    /// warnings about it; `is_clear` says that they are no fewer than [`CLEAR_DEVIATIONS`] apart.
    pub(crate) fn doubt_at(
        &self,
        (a, b): (Shape<'_>, Shape<'_>),
        a_from_b: &Pose,
        is_clear: bool,
    ) -> (Option<Undecided>, Vec<Warning>) {
        let local = a.local_from(&b, a_from_b);
        let unseen = unseen(a, b, &local);
        let warnings = doubts((a, b), &local, unseen.as_ref(), &self.safeguards);
        let counting = warnings.iter().filter(|warning| counts(warning, is_clear));
        (self.doubt((a, b), &local, counting), warnings)
    }

    fn doubt<'w>(
        &self,
        (a, b): (Shape<'_>, Shape<'_>),
        local: &Pose,
        mut warnings: impl Iterator<Item = &'w Warning>,
    ) -> Option<Undecided> {
        let enclosed = || is_enclosed(a, b, local).then_some(Undecided::Enclosed);
        warnings.find_map(|warning| self.reason(warning)).or_else(enclosed)
    }

    /// Why a pair with this warning does not read as free; `None` where it may.
    fn reason(&self, warning: &Warning) -> Option<Undecided> {
        if matches!(warning, Warning::FarAway { .. }) && !self.doubts_distance {
            return None;
        }
        let counts =
            |reason: &Undecided| *reason != Undecided::Units || self.safeguards.doubt_units;
        warning.undecides().filter(counts)
    }

    /// Whether A may be doubted wherever it lies beside a body no smaller than B: what it is like, how large
    /// it is beside B, and what it did not see.
    pub(crate) fn may_doubt(&self, (a, b): (Shape<'_>, Shape<'_>)) -> bool {
        let is_of_a = |warning: &&Warning| warning.body() == Some(Which::A);
        let warnings = doubts((a, b), &Pose::identity(), None, &self.safeguards);
        // Pairs that nobody looks at are clear of each other.
        let mut of_a = warnings.iter().filter(is_of_a).filter(|warning| counts(warning, true));
        is_image(a) || of_a.any(|warning| self.reason(warning).is_some())
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
        Report {
            collision_probability: estimate.probability,
            bounds: estimate.bounds,
            verdict: self.verdict(estimate.probability, estimate.bounds[1], stats.undecided, doubt),
            undecided_by: None,
            log_likelihood_ratio: estimate.log_likelihood_ratio,
            clearance_m: clearance,
            clearance_at_least_m: at_least,
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

    fn verdict(
        &self,
        probability: f64,
        upper: f64,
        undecided: usize,
        doubt: Option<Undecided>,
    ) -> Verdict {
        let Self { accept, reject, .. } = *self;
        if probability > accept {
            Verdict::InCollision
        } else if doubt.is_some_and(|reason| reason != Undecided::Unseen) {
            // The number itself means nothing. Unseen space only keeps a pair from being free.
            Verdict::Undecided
        } else if upper < reject && undecided == 0 {
            Verdict::Free
        } else if probability < reject || undecided > 0 {
            // What was culled, left out or not solved could still collide.
            Verdict::Undecided
        } else {
            // NaN would end here too, and not at free.
            Verdict::Uncertain
        }
    }
}
