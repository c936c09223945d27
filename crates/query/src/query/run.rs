//! One query, from two prepared bodies and a pose to a report.

use std::time::Instant;

use cloudtouch_bvh::{Flow, TraversalSettings, traverse};
use cloudtouch_geom::Pose;

use crate::CONTACT_FLOOR;
use crate::body::BodyRef;
use crate::cloud::Cloud;
use crate::error::{QueryError, SettingsError};
use crate::mesh::{ExactPair, Mesh, SignedPoint, Wanted, exact_pair, signed_points};
use crate::report::{Clearance, Contact, Report, Stats, Verdict};

use super::classify::{PairAnswer, PairPoint, PairPoints, classify};
use super::contacts::most_probable_place;
use super::evidence::Evidence;
use super::leaf_pair::{self, gather};
use super::pool::{self, PointProbability, Side};
use super::settings::{Mode, Pooling, QuerySettings};
use super::unseen::is_hidden;

/// A checked set of settings that answers queries; cheap to copy, shared by threads.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Query {
    settings: QuerySettings,
    traversal: TraversalSettings,
}

impl Query {
    /// Checks the settings.
    ///
    /// # Errors
    /// Names the setting that is out of range, and its value.
    pub fn new(settings: QuerySettings) -> Result<Self, SettingsError> {
        settings.check()?;
        let traversal = TraversalSettings {
            kind: settings.traversal,
            cull_probability: settings.cull_probability,
        };
        Ok(Self { settings, traversal })
    }

    /// The settings, as checked.
    pub fn settings(&self) -> &QuerySettings {
        &self.settings
    }

    /// How likely it is that the surfaces behind two bodies collide.
    ///
    /// `a_from_b` maps the file frame of `b` into that of `a`; nothing is rebuilt for it. Contacts
    /// are in the frame of `a`, with normals from `a` to `b`. The answer rests on the points
    /// sampled: surface that no point stands for cannot be found in collision.
    ///
    /// # Errors
    /// When the pose is not finite, or two meshes cannot be tested exactly. A pair that could not be decided is not an error
    /// but a verdict, and never reads as free.
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
        let entries = a_from_b.isometry().to_homogeneous();
        if let Some(&value) = entries.iter().find(|v| !v.is_finite()) {
            return Err(QueryError::Pose { value });
        }
        let local = a.local_from(&b, a_from_b);
        let mut evidence = Evidence::default();
        if let (BodyRef::Mesh(a), BodyRef::Mesh(b)) = (a, b) {
            add_exact(&mut evidence, &exact_pair(a, b, &local)?);
        } else {
            self.gather_evidence(a, b, &local, &mut evidence)?;
        }
        let mut report = self.report(evidence, a, b);
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

    fn gather_evidence(
        &self,
        a: BodyRef<'_>,
        b: BodyRef<'_>,
        a_from_b: &Pose,
        evidence: &mut Evidence,
    ) -> Result<(), QueryError> {
        let b_from_a = a_from_b.inverse();
        let mut settled = false;
        match (a, b) {
            (BodyRef::Cloud(cloud), BodyRef::Mesh(mesh)) if mesh.is_watertight() => {
                let poses = (&b_from_a, &Pose::identity());
                settled = self.add_signed(cloud, mesh, Side::A, poses, evidence);
            }
            (BodyRef::Mesh(mesh), BodyRef::Cloud(cloud)) if mesh.is_watertight() => {
                settled = self.add_signed(cloud, mesh, Side::B, (a_from_b, a_from_b), evidence);
            }
            _ => {}
        }
        if !settled && evidence.largest() <= self.settings.stop_above {
            self.traverse_leaf_pairs(a, b, a_from_b, evidence)?;
        }
        if evidence.largest() <= self.settings.accept {
            let hidden = match (a, b) {
                (BodyRef::Cloud(a), b) if is_hidden(a, b, a_from_b) => true,
                (a, BodyRef::Cloud(b)) => is_hidden(b, a, &b_from_a),
                _ => false,
            };
            if hidden {
                evidence.stats.undecided += 1;
                evidence.widen(1.0);
            }
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
        evidence: &mut Evidence,
    ) -> bool {
        let wanted = match self.settings.mode {
            Mode::Calibrated => Wanted::Near,
            Mode::Paper => Wanted::Inside,
        };
        let stop_above = self.settings.stop_above;
        let found = signed_points(cloud, mesh, mesh_from_cloud, wanted, stop_above);
        evidence.stats.nodes_visited += found.nodes_visited;
        evidence.stats.leaf_pairs += found.leaves_visited;
        evidence.stats.leaves_prepared += found.leaves_prepared;
        evidence.widen(found.culled_bound);
        for point in &found.points {
            evidence.add_point(PointProbability {
                side,
                index: Some(point.index),
                position: a_from_cloud.transform_point(&point.position),
                probability: point.probability,
                correlation_length: CORRELATION_SPACINGS * point.spacing,
            });
            let clearance = Clearance { mean: point.distance, std: point.std };
            evidence.add_clearance(point.probability, clearance);
            if point.probability >= CONTACT_FLOOR {
                evidence.add_contact(signed_contact(point, side, a_from_cloud));
            }
        }
        wanted == Wanted::Near
    }

    fn traverse_leaf_pairs(
        &self,
        a: BodyRef<'_>,
        b: BodyRef<'_>,
        a_from_b: &Pose,
        evidence: &mut Evidence,
    ) -> Result<(), QueryError> {
        let settings = &self.settings;
        let outcome =
            traverse(a.tree(), b.tree(), a_from_b, &self.traversal, settings.seed, |pair| {
                let relevant = match settings.mode {
                    Mode::Calibrated => evidence.relevant_probability(),
                    // As printed, but for pairs that no probability can come from.
                    Mode::Paper => 0.0,
                };
                let next = Flow::Above(relevant.max(settings.cull_probability));
                let stats = &mut evidence.stats;
                let Some(points) = gather((a, pair.a), (b, pair.b), a_from_b, stats) else {
                    evidence.widen(leaf_pair::bound_left_out());
                    return next;
                };
                stats.leaf_pairs += 1;
                let answer = classify(&points, settings, relevant, stats);
                add_pair(&points, &answer, evidence);
                if evidence.largest() > settings.stop_above { Flow::Stop } else { next }
            })?;
        evidence.stats.nodes_visited += outcome.nodes_visited;
        evidence.widen(outcome.culled_bound.max(outcome.pending_bound));
        Ok(())
    }

    fn report(&self, mut evidence: Evidence, a: BodyRef<'_>, b: BodyRef<'_>) -> Report {
        let rest = evidence.bound_of_rest();
        let points = evidence.merge_points();
        let (max_probability, noisy_or_probability) = (pool::max(points), pool::noisy_or(points));
        let (collision_probability, upper) = match self.settings.pooling {
            Pooling::Max => (max_probability, max_probability.max(rest)),
            Pooling::NoisyOr => {
                let total = a.point_count() + b.point_count();
                (noisy_or_probability, pool::noisy_or_bound(points, rest, total))
            }
        };
        let lower = collision_probability;
        let mut contacts = evidence.top_contacts(self.settings.max_contacts);
        for contact in &mut contacts {
            contact.point += a.origin();
        }
        let stats: Stats = evidence.stats;
        Report {
            collision_probability,
            bounds: [lower, upper],
            verdict: self.verdict(collision_probability, upper, stats.undecided),
            clearance_m: evidence.clearance(self.settings.accept),
            contacts,
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

/// Points nearer than this many spacings share the samples their position was estimated from.
const CORRELATION_SPACINGS: f64 = 3.0;

fn add_pair(points: &PairPoints, answer: &PairAnswer, evidence: &mut Evidence) {
    match answer {
        PairAnswer::Separated { a, b, .. } => {
            let mut add_side = |side: Side, points: &[PairPoint], probabilities: &[f64]| {
                for (point, &probability) in points.iter().zip(probabilities) {
                    evidence.add_point(PointProbability {
                        side,
                        index: point.index,
                        position: point.point.mean,
                        probability,
                        correlation_length: CORRELATION_SPACINGS * point.spacing,
                    });
                }
            };
            add_side(Side::A, &points.a, a);
            add_side(Side::B, &points.b, b);
            if let Some(place) = most_probable_place(points, answer) {
                evidence.add_clearance(place.probability, place.clearance);
                if let Some(contact) = place.contact.filter(|c| c.probability >= CONTACT_FLOOR) {
                    evidence.add_contact(contact);
                }
            }
        }
        PairAnswer::Indistinct => {
            for (side, points) in [(Side::A, &points.a), (Side::B, &points.b)] {
                for point in points {
                    evidence.add_point(PointProbability {
                        side,
                        index: point.index,
                        position: point.point.mean,
                        probability: 0.5,
                        correlation_length: f64::INFINITY,
                    });
                }
            }
            evidence.widen(1.0);
        }
        PairAnswer::Undecided => {
            evidence.stats.undecided += 1;
            evidence.widen(1.0);
        }
    }
}

fn signed_contact(point: &SignedPoint, cloud_side: Side, a_from_cloud: &Pose) -> Contact {
    // Out of the mesh is towards the cloud's body; the normal runs from A to B.
    let outward = a_from_cloud.transform_vector(&point.outward);
    Contact {
        point: a_from_cloud.transform_point(&point.surface_point),
        normal_a_to_b: if cloud_side == Side::A { -outward } else { outward },
        probability: point.probability,
        clearance_m: point.distance,
    }
}

fn add_exact(evidence: &mut Evidence, pair: &ExactPair) {
    evidence.stats.leaf_pairs = 1;
    if pair.intersecting {
        evidence.add_certain_collision();
    }
    if let Some((on_a, on_b)) = pair.nearest {
        evidence.add_clearance(0.0, Clearance { mean: (on_b - on_a).norm(), std: 0.0 });
    }
}
