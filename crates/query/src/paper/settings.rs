//! What a query by the paper is asked to do, checked once.

use std::time::Duration;

use cloudtouch_bvh::Traversal;
use cloudtouch_noise::RadiusRule;
use cloudtouch_svm::Kernel;
use serde::{Deserialize, Serialize};

use crate::check::settings::{fraction, not_negative, positive, thresholds};
use crate::classifier::ClassifierSettings;
use crate::doubt::safeguards::Safeguards;
use crate::error::SettingsError;
use crate::record::Closeness;

/// How point probabilities become the probability of a pair of clouds (section 4.4).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Pooling {
    /// The largest point probability.
    #[default]
    Max,
    /// The chance that at least one of the likely, well separated points collides.
    NoisyOr,
}

/// What is scaled to the unit box, for which γ is meant (section 6.1).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Scaling {
    /// The scene, as printed: one scale for all leaf pairs, that of the larger body. A body of
    /// `size` across gets a kernel as wide as size/√(2γ).
    #[default]
    Scene,
    /// Each leaf pair on its own: the kernel is as wide as the pair wants it.
    LeafPair,
}

/// Which points stand for a triangle of a mesh (section 4.5).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum MeshPoints {
    /// Its three corners and its centroid, as printed. A triangle that is larger than the spacing of
    /// the cloud can be pierced between them, which then reads as free.
    #[default]
    FourPerTriangle,
    /// As dense as the cloud that the mesh faces.
    AsDenseAsCloud,
}

/// All settings of a query by the paper; [`PaperQuery::new`](crate::paper::PaperQuery::new) checks
/// them.
///
/// The defaults are what is printed; numbers that are not printed are ours.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct PaperSettings {
    /// A: a pair with a higher probability is in collision; at least ½.
    pub accept: f64,
    /// B: a pair with a lower probability is free; at most ½.
    pub reject: f64,
    /// How point probabilities are pooled.
    pub pooling: Pooling,
    /// When points are close to each other, for the noisy-or.
    pub closeness: Closeness,
    /// The kernel, its width γ (above 0) per squared length of the unit box. 5 to 20 suits a leaf pair
    /// that fills it; where the scene does, such a kernel is wide, and calls collisions early, while
    /// one that is narrower than the samples are apart (γ in the thousands) misses them.
    pub kernel: Kernel,
    /// What is scaled to the unit box.
    pub scaling: Scaling,
    /// C: what a misclassified point costs; above 0.
    pub penalty: f64,
    /// Whether C is balanced by class size, so that a small leaf is not sacrificed to a large one. Not
    /// printed.
    pub balanced: bool,
    /// How many times as much a misclassified mesh point costs: a mesh is trusted; above 0.
    pub mesh_penalty_factor: f64,
    /// Which points stand for a triangle.
    pub mesh_points: MeshPoints,
    /// Whether points deep inside a closed mesh are found by their distance to it. Not printed: leaves
    /// see only the surface about them, and what is wholly inside another body reads as free.
    pub points_inside: bool,
    /// κ: the probability with which a point is to lie on its side of the surface; a cloud may bring
    /// one for each point.
    pub kappa: f64,
    /// How κ becomes the radius r of the ellipsoids (eq. 11, 12).
    pub radius_rule: RadiusRule,
    /// Relative gap at which a kernel problem counts as solved; between 0 and 1, where more than .03 counts as
    /// that.
    pub relative_gap: f64,
    /// Whether a plane is tried first: one that keeps every point below 1e-6 is the answer, sooner, and
    /// another stands in where the kernel has none. Not printed.
    pub plane_first: bool,
    /// Whether a kernel's "apart" is not believed where the noise across its surface exceeds a
    /// twentieth of the unit box: eq. 16 takes f as linear there, and it is not. Not printed.
    pub distrust_noise: bool,
    /// Which pairs of nodes are descended.
    pub traversal: Traversal,
    /// Whether a leaf has the points that it shares with its siblings, those within ε of a cut; else
    /// only boxes overlap.
    pub shared_points: bool,
    /// Pairs of boxes are culled when no point in them can be more probable than this; between 0
    /// and 1.
    pub cull_probability: f64,
    /// The search ends when a point is this probable; 1 never ends it early.
    pub stop_above: f64,
    /// How long a query may search; in files a number of seconds. What was not looked at by then
    /// raises the upper bound, to 1 as a rule, and is no guess. The clock is looked at before each
    /// leaf pair, and while a classifier is trained: the limit is exceeded by milliseconds as a rule.
    /// With a limit answers depend on the speed of the machine.
    #[serde(with = "seconds", skip_serializing_if = "Option::is_none")]
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
            closeness: Closeness::default(),
            kernel: Kernel::Gaussian { gamma: 10.0 },
            scaling: Scaling::Scene,
            penalty: 100.0,
            balanced: false,
            mesh_penalty_factor: 10.0,
            mesh_points: MeshPoints::FourPerTriangle,
            points_inside: false,
            // An ellipsoid of one standard deviation.
            kappa: 0.841_344_746_068_542_9,
            radius_rule: RadiusRule::Gaussian,
            relative_gap: 1e-3,
            plane_first: false,
            distrust_noise: false,
            traversal: Traversal::Paper,
            shared_points: true,
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
    /// The method with all our amendments: the classifier of a leaf pair scaled to the pair, balanced,
    /// after a plane was tried, and not believed where the noise is large; each point in one leaf;
    /// meshes as dense as the cloud, and known inside.
    pub fn amended() -> Self {
        Self {
            scaling: Scaling::LeafPair,
            balanced: true,
            mesh_points: MeshPoints::AsDenseAsCloud,
            shared_points: false,
            points_inside: true,
            plane_first: true,
            distrust_noise: true,
            ..Self::default()
        }
    }

    /// Checks every field.
    ///
    /// # Errors
    /// Names the setting that is out of range, and its value.
    pub fn validate(&self) -> Result<(), SettingsError> {
        thresholds(self.accept, self.reject)?;
        self.safeguards.validate()?;
        self.classifier()?.validate()?;
        fraction("closeness.share_of_max", self.closeness.share_of_max)?;
        not_negative("closeness.spacings", self.closeness.spacings)?;
        positive("stop_above", self.stop_above)?;
        fraction("cull_probability", self.cull_probability)
    }

    /// But for the scale, which is that of the bodies.
    pub(super) fn classifier(&self) -> Result<ClassifierSettings, SettingsError> {
        Ok(ClassifierSettings {
            kernel: self.kernel,
            penalty: self.penalty,
            is_balanced: self.balanced,
            mesh_penalty_factor: self.mesh_penalty_factor,
            ellipsoid_radius: radius(self.radius_rule, self.kappa)?,
            relative_gap: self.relative_gap,
            scale: None,
            distrusts_noise: self.distrust_noise,
        })
    }
}

/// r of a κ (eq. 11, 12).
fn radius(rule: RadiusRule, kappa: f64) -> Result<f64, SettingsError> {
    let range = match rule {
        RadiusRule::Gaussian => "from 0.5 to below 1",
        RadiusRule::Chebyshev => "from 0 to below 1",
    };
    rule.radius(kappa).map_err(|_| SettingsError::Kappa { kappa, range })
}

/// A time limit as a number of seconds.
mod seconds {
    use std::time::Duration;

    use serde::{Deserialize as _, Deserializer, Serializer, de::Error as _};

    pub(super) fn serialize<S: Serializer>(
        limit: &Option<Duration>,
        to: S,
    ) -> Result<S::Ok, S::Error> {
        match limit {
            Some(limit) => to.serialize_f64(limit.as_secs_f64()),
            None => to.serialize_none(),
        }
    }

    pub(super) fn deserialize<'d, D: Deserializer<'d>>(
        from: D,
    ) -> Result<Option<Duration>, D::Error> {
        let seconds = Option::<f64>::deserialize(from)?;
        seconds.map(Duration::try_from_secs_f64).transpose().map_err(D::Error::custom)
    }
}
