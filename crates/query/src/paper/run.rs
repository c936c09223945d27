//! One query by the paper, from two prepared bodies and a pose to a report.

use std::f64::consts::SQRT_2;
use std::time::Instant;

use cloudtouch_bvh::TraversalSettings;
use cloudtouch_geom::{Pose, normal};
use rayon::prelude::*;

use crate::classifier::{ClassifierSettings, Clock, PairPoints, Trained};
use crate::error::{QueryError, SettingsError};
use crate::exact::add_exact;
use crate::mode::Mode;
use crate::record::{Estimate, Evidence, Side, Terms, pool};
use crate::report::Report;
use crate::shape::Shape;

use super::body::{PaperBodyRef, tree};
use super::explain::LeafClassifier;
use super::inside::add_points_inside;
use super::leaf_pairs::traverse_leaf_pairs;
use super::settings::{PaperSettings, Pooling, Scaling};
use super::task::Task;

/// A checked set of settings that answers queries by the paper; cheap to copy, shared by threads.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PaperQuery {
    settings: PaperSettings,
    /// What a classifier takes from them.
    classifier: ClassifierSettings,
    /// `cull_probability` in standard deviations.
    cull_deviations: f64,
}

impl PaperQuery {
    /// Checks the settings.
    ///
    /// # Errors
    /// Names the setting that is out of range, and its value.
    pub fn new(settings: PaperSettings) -> Result<Self, SettingsError> {
        settings.validate()?;
        Ok(Self {
            settings,
            classifier: settings.classifier()?,
            cull_deviations: -normal::quantile(settings.cull_probability),
        })
    }

    /// The settings, as checked.
    pub fn settings(&self) -> &PaperSettings {
        &self.settings
    }

    /// How likely it is that the surfaces behind two bodies collide, by the paper.
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
        a: impl Into<PaperBodyRef<'a>>,
        b: impl Into<PaperBodyRef<'a>>,
        a_from_b: &Pose,
    ) -> Result<Report, QueryError> {
        self.ask((a.into().shape(), b.into().shape()), a_from_b, |_, _| {})
    }

    /// The same, and every classifier that was trained for it, in the order of the search: f, ξ, α, v
    /// and b (eq. 10 to 15).
    ///
    /// # Errors
    /// As [`Self::run`].
    pub fn explain<'a>(
        &self,
        a: impl Into<PaperBodyRef<'a>>,
        b: impl Into<PaperBodyRef<'a>>,
        a_from_b: &Pose,
    ) -> Result<(Report, Vec<LeafClassifier>), QueryError> {
        let bodies = (a.into().shape(), b.into().shape());
        let radius = self.classifier.ellipsoid_radius;
        let mut classifiers = Vec::new();
        let report = self.ask(bodies, a_from_b, |points, trained| {
            classifiers.extend(LeafClassifier::of(points, trained, radius, bodies.0.origin()));
        })?;
        Ok((report, classifiers))
    }

    fn ask(
        &self,
        bodies: (Shape<'_>, Shape<'_>),
        a_from_b: &Pose,
        on_trained: impl FnMut(&PairPoints, &Trained),
    ) -> Result<Report, QueryError> {
        let terms = Terms {
            mode: Mode::Paper,
            seed: self.settings.seed,
            accept: self.settings.accept,
            reject: self.settings.reject,
            safeguards: self.settings.safeguards,
            doubted_below: f64::INFINITY,
            are_alone: true,
            max_contacts: self.settings.max_contacts,
            closeness: self.settings.closeness,
        };
        terms.ask(bodies, a_from_b, |start, local, evidence| {
            gather_evidence(bodies, local, &self.task(start, bodies), evidence, on_trained)?;
            Ok(self.pooled(evidence, bodies))
        })
    }

    /// Answers every pose, on all threads of the current rayon pool, in the order of the poses.
    ///
    /// Apart from times and `leaves_prepared` in the statistics, the reports are the same bits
    /// whatever the number of threads.
    pub fn run_batch<'a>(
        &self,
        a: impl Into<PaperBodyRef<'a>>,
        b: impl Into<PaperBodyRef<'a>>,
        a_from_b: &[Pose],
    ) -> Vec<Result<Report, QueryError>> {
        let (a, b) = (a.into(), b.into());
        a_from_b.par_iter().map(|pose| self.run(a, b, pose)).collect()
    }

    /// Box lengths per metre of the scene, which is as large as the larger body; `None` where each
    /// leaf pair has a scale of its own, or no body a size.
    fn scale(&self, a: Shape<'_>, b: Shape<'_>) -> Option<f64> {
        let radius = |body: Shape<'_>| tree(body).root().map_or(0.0, |root| root.obb().radius());
        // As a leaf pair is scaled: the ball around a unit square.
        let scale = (SQRT_2 * radius(a).max(radius(b))).recip();
        (self.settings.scaling == Scaling::Scene && scale.is_finite()).then_some(scale)
    }

    fn task(&self, start: Instant, (a, b): (Shape<'_>, Shape<'_>)) -> Task<'_> {
        Task {
            settings: &self.settings,
            classifier: ClassifierSettings { scale: self.scale(a, b), ..self.classifier },
            traversal: TraversalSettings {
                kind: self.settings.traversal,
                cull_deviations: self.cull_deviations.max(0.0),
            },
            clock: Clock::new(start, self.settings.deadline),
        }
    }

    /// The probability by the points alone (section 4.4).
    fn pooled(&self, evidence: &mut Evidence, (a, b): (Shape<'_>, Shape<'_>)) -> Estimate {
        let rest = evidence.bound_of_rest();
        let points = evidence.merge_points();
        let (probability, upper) = match self.settings.pooling {
            Pooling::Max => (pool::max(points), pool::max(points).max(rest)),
            Pooling::NoisyOr => {
                let total = a.point_count() + b.point_count();
                let near = &self.settings.closeness;
                (pool::noisy_or(points, near), pool::noisy_or_bound(points, near, rest, total))
            }
        };
        Estimate {
            probability,
            bounds: [probability, upper],
            evidence: None,
            log_likelihood_ratio: None,
            places: None,
            is_too_late: false,
        }
    }
}

fn gather_evidence(
    (a, b): (Shape<'_>, Shape<'_>),
    a_from_b: &Pose,
    task: &Task<'_>,
    evidence: &mut Evidence,
    on_trained: impl FnMut(&PairPoints, &Trained),
) -> Result<(), QueryError> {
    let inside = task.settings.points_inside;
    match (a, b) {
        (Shape::Mesh(a), Shape::Mesh(b)) => {
            return add_exact((a, b), a_from_b, true, evidence);
        }
        (Shape::Cloud(cloud), Shape::Mesh(mesh)) if inside && mesh.is_watertight() => {
            let poses = (&a_from_b.inverse(), &Pose::identity());
            add_points_inside((cloud, Side::A), mesh, poses, task, evidence);
        }
        (Shape::Mesh(mesh), Shape::Cloud(cloud)) if inside && mesh.is_watertight() => {
            add_points_inside((cloud, Side::B), mesh, (a_from_b, a_from_b), task, evidence);
        }
        _ => {}
    }
    if evidence.largest() <= task.settings.stop_above {
        traverse_leaf_pairs((a, b), a_from_b, task, evidence, on_trained)?;
    }
    Ok(())
}
