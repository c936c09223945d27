//! One query, from two prepared bodies and a pose to a report.

use std::time::Instant;

use cloudtouch_bvh::TraversalSettings;
use cloudtouch_geom::{Pose, Vector3, normal};

use crate::body::BodyRef;
use crate::cloud::Cloud;
use crate::error::{QueryError, SettingsError};
use crate::mesh::Mesh;
use crate::mode::Mode;
use crate::range::bad_entry;
use crate::report::{Report, Stats, Verdict};

use super::calibrated;
use super::clock::Clock;
use super::estimate::Estimate;
use super::evidence::Evidence;
use super::exact::exact_pair;
use super::leaf_pairs::traverse_leaf_pairs;
use super::pool::{self, Side};
use super::record::{add_exact, add_signed_points};
use super::settings::{Pooling, QuerySettings};
use super::signed::{Wanted, signed_points};
use super::task::Task;
use super::unseen::is_either_hidden;

/// A checked set of settings that answers queries; cheap to copy, shared by threads.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Query {
    settings: QuerySettings,
    /// `cull_probability` in standard deviations.
    cull_deviations: f64,
}

impl Query {
    /// Checks the settings.
    ///
    /// # Errors
    /// Names the setting that is out of range, and its value.
    pub fn new(settings: QuerySettings) -> Result<Self, SettingsError> {
        settings.validate()?;
        Ok(Self { settings, cull_deviations: -normal::quantile(settings.cull_probability) })
    }

    /// The settings, as checked.
    pub fn settings(&self) -> &QuerySettings {
        &self.settings
    }

    fn task(&self, start: Instant) -> Task<'_> {
        Task {
            settings: &self.settings,
            traversal: TraversalSettings {
                kind: self.settings.traversal,
                cull_deviations: self.cull_deviations.max(0.0),
                ..TraversalSettings::default()
            },
            clock: Clock::new(start, self.settings.deadline),
        }
    }

    /// How likely it is that the surfaces behind two bodies collide.
    ///
    /// `a_from_b` maps the file frame of `b` into that of `a`; nothing is rebuilt for it. Contacts
    /// are in the frame of `a`, with normals from `a` to `b`. The answer rests on the points
    /// sampled: surface that no point stands for cannot be found in collision.
    ///
    /// # Errors
    /// When the pose is not finite or beyond 1e10 m, two meshes cannot be tested exactly, or a mesh
    /// takes more parts than allowed to be sampled as densely as the cloud. A pair that could not be
    /// decided is not an error but a verdict, and never reads as free.
    pub fn run<'a>(
        &self,
        a: impl Into<BodyRef<'a>>,
        b: impl Into<BodyRef<'a>>,
        a_from_b: &Pose,
    ) -> Result<Report, QueryError> {
        let start = Instant::now();
        let (a, b) = (a.into(), b.into());
        let span = tracing::debug_span!("query");
        let _entered = span.enter();
        if let Some(value) = bad_entry(a_from_b) {
            return Err(QueryError::Pose { value });
        }
        let local = a.local_from(&b, a_from_b);
        let mut evidence = Evidence::default();
        let estimate = self.estimate(a, b, &local, &self.task(start), &mut evidence)?;
        let mut report = self.report(evidence, estimate, a.origin());
        let micros = |d: std::time::Duration| u64::try_from(d.as_micros()).unwrap_or(u64::MAX);
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

    fn estimate(
        &self,
        a: BodyRef<'_>,
        b: BodyRef<'_>,
        a_from_b: &Pose,
        task: &Task<'_>,
        evidence: &mut Evidence,
    ) -> Result<Estimate, QueryError> {
        let mut estimate = match (a, b) {
            (BodyRef::Mesh(a), BodyRef::Mesh(b)) => {
                add_exact(evidence, &exact_pair(a, b, a_from_b)?);
                self.pooled(evidence, 0)
            }
            _ if self.settings.mode == Mode::Calibrated => {
                calibrated::estimate((a, b), a_from_b, task, evidence)?
            }
            _ => {
                self.gather_evidence(a, b, a_from_b, task, evidence)?;
                self.pooled(evidence, a.point_count() + b.point_count())
            }
        };
        if estimate.probability <= self.settings.accept && is_either_hidden(a, b, a_from_b) {
            evidence.stats.undecided += 1;
            evidence.widen(1.0);
            estimate.bounds[1] = 1.0;
        }
        Ok(estimate)
    }

    /// The probability by the points alone (section 4.4); `total` is how many there are.
    fn pooled(&self, evidence: &mut Evidence, total: usize) -> Estimate {
        let rest = evidence.bound_of_rest();
        let points = evidence.merge_points();
        let (probability, upper) = match self.settings.pooling {
            Pooling::Max => (pool::max(points), pool::max(points).max(rest)),
            Pooling::NoisyOr => (pool::noisy_or(points), pool::noisy_or_bound(points, rest, total)),
        };
        Estimate { probability, bounds: [probability, upper], evidence: None }
    }

    fn gather_evidence(
        &self,
        a: BodyRef<'_>,
        b: BodyRef<'_>,
        a_from_b: &Pose,
        task: &Task<'_>,
        evidence: &mut Evidence,
    ) -> Result<(), QueryError> {
        let b_from_a = a_from_b.inverse();
        let mut settled = false;
        match (a, b) {
            (BodyRef::Cloud(cloud), BodyRef::Mesh(mesh)) if mesh.is_watertight() => {
                let poses = (&b_from_a, &Pose::identity());
                settled = self.add_signed(cloud, mesh, Side::A, poses, task, evidence);
            }
            (BodyRef::Mesh(mesh), BodyRef::Cloud(cloud)) if mesh.is_watertight() => {
                settled =
                    self.add_signed(cloud, mesh, Side::B, (a_from_b, a_from_b), task, evidence);
            }
            _ => {}
        }
        if !settled && evidence.largest() <= self.settings.stop_above {
            traverse_leaf_pairs((a, b), a_from_b, task, evidence)?;
        }
        Ok(())
    }

    /// Adds the points of `cloud` by their signed distance from a watertight mesh, and says
    /// whether that settles the query.
    ///
    /// In the calibrated mode it does: no surface between the two could be better known than the
    /// mesh's own. In the paper's mode it only finds points deep inside, which leaf pairs miss.
    fn add_signed(
        &self,
        cloud: &Cloud,
        mesh: &Mesh,
        side: Side,
        (mesh_from_cloud, a_from_cloud): (&Pose, &Pose),
        task: &Task<'_>,
        evidence: &mut Evidence,
    ) -> bool {
        let wanted = match self.settings.mode {
            Mode::Calibrated => Wanted::Near,
            Mode::Paper => Wanted::Inside,
        };
        let stop_above = self.settings.stop_above;
        let found = signed_points(cloud, mesh, mesh_from_cloud, wanted, (stop_above, &task.clock));
        evidence.stats.nodes_visited += found.nodes_visited;
        evidence.stats.leaf_pairs += found.leaves_visited;
        evidence.stats.leaves_prepared += found.leaves_prepared;
        evidence.widen(found.culled_bound);
        add_signed_points(&found.points, side, a_from_cloud, evidence);
        wanted == Wanted::Near
    }

    fn report(&self, mut evidence: Evidence, estimate: Estimate, origin: Vector3) -> Report {
        let points = evidence.merge_points();
        let (max_probability, noisy_or_probability) = (pool::max(points), pool::noisy_or(points));
        let mut contacts = evidence.top_contacts(self.settings.max_contacts);
        for contact in &mut contacts {
            contact.point += origin;
        }
        let stats: Stats = evidence.stats;
        Report {
            collision_probability: estimate.probability,
            bounds: estimate.bounds,
            verdict: self.verdict(estimate.probability, estimate.bounds[1], stats.undecided),
            clearance_m: evidence.clearance(self.settings.accept),
            contacts,
            evidence: estimate.evidence,
            stats,
            seed: self.settings.seed,
            mode: self.settings.mode,
            max_probability,
            noisy_or_probability,
            point_probabilities: evidence.point_probabilities(),
        }
    }

    fn verdict(&self, probability: f64, upper: f64, undecided: usize) -> Verdict {
        let QuerySettings { accept, reject, .. } = self.settings;
        if probability > accept {
            Verdict::InCollision
        } else if upper < reject && undecided == 0 {
            Verdict::Free
        } else if probability < reject || undecided > 0 {
            // What was culled, left out or not solved could still collide.
            Verdict::Undecided
        } else {
            // NaN would end here too, and not at free.
            Verdict::InContact
        }
    }
}
