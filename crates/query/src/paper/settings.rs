//! What a query by the paper is asked to do, checked once.

use std::time::Duration;

use cloudtouch_bvh::Traversal;

use crate::checks::{fraction, positive, thresholds};
use crate::classifier::ClassifierSettings;
use crate::error::SettingsError;
use crate::safeguards::Safeguards;

/// How point probabilities become the probability of a pair of clouds (section 4.4).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Pooling {
    /// The largest point probability.
    #[default]
    Max,
    /// The chance that at least one of the likely, well separated points collides.
    NoisyOr,
}

/// All settings of a query by the paper; [`PaperQuery::new`](crate::paper::PaperQuery::new) checks
/// them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PaperSettings {
    /// A: a pair with a higher probability is in collision; at least ½.
    pub accept: f64,
    /// B: a pair with a lower probability is free; at most ½.
    pub reject: f64,
    /// How point probabilities are pooled.
    pub pooling: Pooling,
    /// Kernel width γ for a leaf pair scaled to the unit box; above 0.
    pub gamma: f64,
    /// C: what a misclassified point costs, before balancing by class size; above 0.
    pub penalty: f64,
    /// How many times as much a misclassified mesh point costs: a mesh is trusted; above 0.
    pub mesh_penalty_factor: f64,
    /// r: radius of the uncertainty ellipsoids, in standard deviations (eq. 11, 12); above 0.
    pub ellipsoid_radius: f64,
    /// Relative gap at which a kernel problem counts as solved; between 0 and 1.
    pub relative_gap: f64,
    /// Which pairs of nodes are descended.
    pub traversal: Traversal,
    /// Pairs of boxes are culled when no point in them can be more probable than this; between 0
    /// and 1.
    pub cull_probability: f64,
    /// The search ends when a point is this probable; 1 never ends it early.
    pub stop_above: f64,
    /// How long a query may search. What was not looked at by then raises the upper bound, to 1 as a
    /// rule, and is no guess. The clock is looked at before each leaf pair, and while a classifier
    /// is trained: the limit is exceeded by milliseconds as a rule. With a limit answers depend on
    /// the speed of the machine.
    pub deadline: Option<Duration>,
    /// What keeps a pair from reading as free beside the evidence.
    pub safeguards: Safeguards,
    /// How many contacts are reported at most.
    pub max_contacts: usize,
    /// How many triangles, before and after splitting, the part of a mesh that faces a leaf of a
    /// cloud is sampled by at most; a usual part takes some thousands.
    pub max_mesh_parts: usize,
    /// Seed of the stochastic traversals.
    pub seed: u64,
}

impl Default for PaperSettings {
    fn default() -> Self {
        Self {
            accept: 0.9,
            reject: 0.1,
            pooling: Pooling::Max,
            gamma: 10.0,
            penalty: 100.0,
            mesh_penalty_factor: 10.0,
            // κ = 0.84: an ellipsoid of one standard deviation.
            ellipsoid_radius: 1.0,
            relative_gap: 1e-3,
            traversal: Traversal::Paper,
            cull_probability: 1e-6,
            stop_above: 0.999,
            deadline: None,
            safeguards: Safeguards::default(),
            max_contacts: 16,
            max_mesh_parts: 20_000,
            seed: 0,
        }
    }
}

impl PaperSettings {
    /// Checks every field.
    ///
    /// # Errors
    /// Names the setting that is out of range, and its value.
    pub fn validate(&self) -> Result<(), SettingsError> {
        thresholds(self.accept, self.reject)?;
        self.safeguards.validate()?;
        self.classifier().validate()?;
        positive("stop_above", self.stop_above)?;
        fraction("cull_probability", self.cull_probability)
    }

    pub(super) fn classifier(&self) -> ClassifierSettings {
        ClassifierSettings {
            gamma: self.gamma,
            penalty: self.penalty,
            mesh_penalty_factor: self.mesh_penalty_factor,
            ellipsoid_radius: self.ellipsoid_radius,
            relative_gap: self.relative_gap,
        }
    }
}
