//! How a cloud is prepared by the paper.

use cloudtouch_bvh::{Split, TreeSettings};
use cloudtouch_noise::{
    Combination, Discretization, MotionNoise, NoiseSettings, SensorModel, Summed,
};
use serde::{Deserialize, Serialize};

use crate::cloud::Preparation;
use crate::error::PrepareError;
use crate::filter::FilterSettings;

/// How position noise Σ and discretization Ψ make the covariance of a point.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum PaperNoise {
    /// (Σ⁻¹ + Ψ⁻¹)⁻¹, as printed below eq. 8: never larger than Σ.
    #[default]
    Precision,
    /// Σ + Ψ, what eq. 1 implies: never smaller than Σ.
    Convolution,
}

impl From<PaperNoise> for Combination {
    fn from(noise: PaperNoise) -> Self {
        match noise {
            PaperNoise::Precision => Self::Precision,
            PaperNoise::Convolution => Self::Convolution,
        }
    }
}

/// What points stand for and how they are held, whatever sensor saw them. The defaults are what is
/// printed; numbers that are not printed are ours.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct PaperModel {
    /// How Σ and Ψ are put together.
    pub noise: PaperNoise,
    /// Ψ (eq. 17); its k is that of the coverage weights too (section 5).
    pub discretization: Discretization,
    /// How the tree is split (section 5): its leaves are what the classifier is given. By default
    /// σ_max alone says when a leaf is flat enough, down to leaves of two points.
    #[serde(deserialize_with = "TreeAsPrinted::deserialize")]
    pub tree: TreeSettings,
    /// How a body moves or bends after it was seen (section 3): added to Σ; by default not at all.
    pub motion: MotionNoise,
}

impl Default for PaperModel {
    fn default() -> Self {
        Self {
            noise: PaperNoise::default(),
            discretization: Discretization::default(),
            tree: TreeSettings { min_leaf_points: 1, ..TreeSettings::default() },
            motion: MotionNoise::default(),
        }
    }
}

/// What a file leaves out of its tree has the value it has in [`PaperModel`], which is not that of
/// [`TreeSettings`] in itself.
#[derive(Deserialize)]
#[serde(remote = "TreeSettings", default = "as_printed", deny_unknown_fields)]
struct TreeAsPrinted {
    max_leaf_points: usize,
    min_leaf_points: usize,
    max_variation: f64,
    sibling_overlap: f64,
    split: Split,
}

fn as_printed() -> TreeSettings {
    PaperModel::default().tree
}

impl PaperModel {
    /// With our amendments: Ψ from the nearest neighbours and never larger than the spacing allows,
    /// and no leaf split below ten points for being curved.
    pub fn amended() -> Self {
        let summed = Summed::Neighbors;
        Self {
            discretization: Discretization { summed, is_capped: true, ..Discretization::default() },
            tree: TreeSettings::default(),
            ..Self::default()
        }
    }
}

/// Sensor, cleaning, noise model and tree of one cloud.
#[derive(Debug, Clone)]
pub struct PaperCloudSettings {
    /// How noisy the points are (Σ).
    pub sensor: SensorModel,
    /// What is removed before anything else (section 3).
    pub filter: FilterSettings,
    /// What the points stand for and how they are held.
    pub model: PaperModel,
}

impl PaperCloudSettings {
    /// The settings that suit a sensor.
    pub fn new(sensor: SensorModel) -> Self {
        Self { filter: FilterSettings::for_sensor(&sensor), sensor, model: PaperModel::default() }
    }

    /// Those with our amendments.
    pub fn amended(sensor: SensorModel) -> Self {
        Self { model: PaperModel::amended(), ..Self::new(sensor) }
    }

    /// Checks every field.
    ///
    /// # Errors
    /// Names the setting that is out of range, and its value.
    pub fn validate(&self) -> Result<(), PrepareError> {
        self.preparation().validate()
    }

    pub(super) fn preparation(&self) -> Preparation<'_> {
        Preparation {
            sensor: &self.sensor,
            filter: &self.filter,
            noise: NoiseSettings {
                combination: self.model.noise.into(),
                discretization: self.model.discretization,
                ..NoiseSettings::default()
            },
            tree: &self.model.tree,
            motion: self.model.motion,
        }
    }
}
