//! One query on the default path, from two prepared bodies and a pose to a report.

use std::time::Instant;

use cloudtouch_bvh::TraversalSettings;
use cloudtouch_geom::{Pose, normal};

use crate::body::BodyRef;
use crate::classifier::Clock;
use crate::cloud::Cloud;
use crate::error::{QueryError, SettingsError};
use crate::mesh::Mesh;
use crate::mode::Mode;
use crate::paper::pool;
use crate::record::{Estimate, Evidence, Side, Terms, add_exact, add_signed_points};
use crate::report::Report;

use super::calibrated;
use super::exact::exact_pair;
use super::leaf_pairs::traverse_leaf_pairs;
use super::settings::QuerySettings;
use super::signed::signed_points;
use super::task::Task;

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
            classifier: self.settings.classifier(),
            traversal: TraversalSettings {
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
        let (a, b) = (a.into(), b.into());
        let terms = Terms {
            mode: Mode::Calibrated,
            seed: 0,
            accept: self.settings.accept,
            reject: self.settings.reject,
            max_contacts: self.settings.max_contacts,
        };
        terms.ask((a.shape(), b.shape()), a_from_b, |start, local, evidence| {
            estimate((a, b), local, &self.task(start), evidence)
        })
    }
}

fn estimate(
    (a, b): (BodyRef<'_>, BodyRef<'_>),
    a_from_b: &Pose,
    task: &Task<'_>,
    evidence: &mut Evidence,
) -> Result<Estimate, QueryError> {
    let b_from_a = a_from_b.inverse();
    match (a, b) {
        (BodyRef::Cloud(a), BodyRef::Cloud(b)) => {
            return calibrated::estimate((a, b), a_from_b, task, evidence);
        }
        (BodyRef::Mesh(a), BodyRef::Mesh(b)) => add_exact(evidence, &exact_pair(a, b, a_from_b)?),
        (BodyRef::Cloud(cloud), BodyRef::Mesh(mesh)) if mesh.is_watertight() => {
            add_signed((cloud, Side::A), mesh, (&b_from_a, &Pose::identity()), task, evidence);
        }
        (BodyRef::Mesh(mesh), BodyRef::Cloud(cloud)) if mesh.is_watertight() => {
            add_signed((cloud, Side::B), mesh, (a_from_b, a_from_b), task, evidence);
        }
        _ => traverse_leaf_pairs((a.shape(), b.shape()), a_from_b, task, evidence)?,
    }
    let rest = evidence.bound_of_rest();
    let largest = pool::max(evidence.merge_points());
    Ok(Estimate { probability: largest, bounds: [largest, largest.max(rest)], evidence: None })
}

/// Adds the points of `cloud` by their signed distance from a watertight mesh: no surface between the
/// two could be better known than the mesh's own.
fn add_signed(
    (cloud, side): (&Cloud, Side),
    mesh: &Mesh,
    (mesh_from_cloud, a_from_cloud): (&Pose, &Pose),
    task: &Task<'_>,
    evidence: &mut Evidence,
) {
    let until = (task.settings.stop_above, &task.clock);
    let found = signed_points(cloud, mesh, mesh_from_cloud, until);
    evidence.stats.nodes_visited += found.nodes_visited;
    evidence.stats.leaf_pairs += found.leaves_visited;
    evidence.stats.leaves_prepared += found.leaves_prepared;
    evidence.widen(found.culled_bound);
    add_signed_points(&found.points, side, a_from_cloud, evidence);
}
